"""Records the stages of an experiment: a row of measures for each, meshes and pictures."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from time import perf_counter

import numpy as np
import pymeshlab

from ..files import atomic_write, writable_folder
from ..measure import triangle_shapes
from ..report import pictures
from ..report.stages import Stage, significant
from .models import Surface, surface_of
from .scan import Filters

WORST_SHARE = 0.01

NO_PICTURES = (
    'no pictures: matplotlib is not installed (it comes with: pip install "meshlab-willmore[demo]")'
)

Notify = Callable[[str], None]
State = tuple[Stage, Surface]


class Recorder:
    """Measures the stages, saves the meshes and draws the pictures.

    Parameters and errors are those of `meshlab_willmore.demo.experiments.run_demo`.
    """

    def __init__(self, folder: Path, notify: Notify) -> None:
        self.folder = writable_folder(folder)
        self.notify = notify
        self.stages: list[Stage] = []
        self.files: list[Path] = []
        self._can_draw = pictures.can_draw()
        if not self._can_draw:
            notify(NO_PICTURES)

    def run_stage(
        self, meshes: pymeshlab.MeshSet, model: str, name: str, filters: Filters = ()
    ) -> Stage:
        """Apply filters to the current mesh, and add a row with measures of the result."""
        self.notify(f"{model}: {name}")
        start = perf_counter()
        results = [meshes.apply_filter(filter_name, **given) for filter_name, given in filters]
        seconds = perf_counter() - start
        flips = [result["flips"] for result in results if "flips" in result]
        totals = meshes.get_willmore_measures()
        surface = surface_of(meshes)
        stage = Stage(
            model,
            name,
            faces=len(surface.faces),
            flips=sum(flips) if flips else None,
            willmore=totals["willmore_energy"],
            area=totals["area"],
            mean_curvature=totals["absolute_mean_curvature"],
            worst_shape=float(np.quantile(triangle_shapes(*surface), WORST_SHARE)),
            seconds=seconds if filters else None,
            preset=next((given["preset"] for _, given in filters if "preset" in given), ""),
        )
        self.stages.append(stage)
        return stage

    def save(self, meshes: pymeshlab.MeshSet, name: str) -> None:
        """Write the current mesh as a binary PLY file."""
        path = self.folder / f"{name}.ply"
        with atomic_write(path) as draft:
            meshes.save_current_mesh(str(draft), binary=True)
        self.files.append(path)

    def save_picture(self, name: str, camera: pictures.Camera, *shown: State) -> None:
        """Draw states of a mesh side by side, if matplotlib is installed."""
        if not self._can_draw:
            return
        self.notify(f"picture: {name}")
        figure = pictures.comparison(camera, *(_shot(*state) for state in shown))
        path = self.folder / f"{name}.png"
        with atomic_write(path) as draft:
            figure.savefig(draft)
        self.files.append(path)


def _shot(stage: Stage, surface: Surface) -> pictures.Shot:
    state = "before" if stage.flips is None else f"after {stage.flips} flips"
    if stage.preset:
        state += f" ({stage.preset})"
    return pictures.Shot(f"{state}: W = {significant(stage.willmore)}", *surface)
