"""Where the experiments run: figures, meshes and pictures of each stage are kept here."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from types import ModuleType

import numpy as np
import pymeshlab

from ..files import atomic_write, writable_folder
from ..measure import triangle_shapes
from ..report.camera import View
from ..report.table import Stage, significant
from .models import Surface
from .scan import Filters

WORST_SHARE = 0.01

NO_PICTURES = (
    'no pictures: matplotlib is not installed (it comes with: pip install "meshlab-willmore[demo]")'
)

Say = Callable[[str], None]
State = tuple[Stage, Surface]


class Studio:
    """Takes the figures, saves the meshes and makes the pictures.

    Parameters
    ----------
    folder
        Made if it isn't there; files of the same name in it are replaced.
    say
        Called with one line for each thing that is begun, or that cannot be done.

    Raises
    ------
    OSError
        If the folder cannot be written into.
    """

    def __init__(self, folder: Path, say: Say) -> None:
        self.folder = writable_folder(folder)
        self.say = say
        self.pictures = _pictures(say)
        self.stages: list[Stage] = []
        self.files: list[Path] = []

    def stage(
        self, meshes: pymeshlab.MeshSet, model: str, name: str, filters: Filters = ()
    ) -> Stage:
        """Apply filters to the current mesh, and add a row with the figures of the result."""
        self.say(f"{model}: {name}")
        start = perf_counter()
        results = [meshes.apply_filter(filter_name, **given) for filter_name, given in filters]
        seconds = perf_counter() - start
        flips = [result["flips"] for result in results if "flips" in result]
        totals = meshes.get_willmore_measures()
        surface = current(meshes)
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
        )
        self.stages.append(stage)
        return stage

    def save(self, meshes: pymeshlab.MeshSet, name: str) -> None:
        """Write the current mesh as a binary PLY file."""
        path = self.folder / f"{name}.ply"
        with atomic_write(path) as beside:
            meshes.save_current_mesh(str(beside), binary=True)
        self.files.append(path)

    def photograph(self, name: str, before: State, after: State, view: View) -> None:
        """Write the picture of a mesh before and after the flips, if pictures can be made."""
        if self.pictures is None:
            return
        self.say(f"picture: {name}")
        shots = [self.pictures.Shot(_caption(stage), *mesh) for stage, mesh in (before, after)]
        figure = self.pictures.comparison(*shots, view)
        path = self.folder / f"{name}.png"
        with atomic_write(path) as beside:
            figure.savefig(beside)
        self.files.append(path)


def current(meshes: pymeshlab.MeshSet) -> Surface:
    """Copy vertices and faces of the current mesh."""
    mesh = meshes.current_mesh()
    return Surface(mesh.vertex_matrix(), mesh.face_matrix())


def _pictures(say: Say) -> ModuleType | None:
    """Import the module that draws; None, with a word to the person, without matplotlib."""
    try:
        from ..report import pictures
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != "matplotlib":
            raise
        say(NO_PICTURES)
        return None
    return pictures


def _caption(stage: Stage) -> str:
    state = "before" if stage.flips is None else f"after {stage.flips} flips"
    return f"{state}: W = {significant(stage.willmore)}"
