"""The paper's experiments, and a technical part, as chains of PyMeshLab filters, stage by stage.

Source: section 4 of "Mesh optimisation based on Willmore energy".
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pymeshlab

from ..mesh.compiling import followed
from ..options import FILTER
from ..report.pictures import Camera, Window, camera_from
from ..report.stages import Stage
from .models import (
    Surface,
    dented_cube,
    sampled_torus,
    scrambled,
    set_of,
    surface_of,
    technical_part,
)
from .recorder import Notify, Recorder, State
from .scan import (
    CLEANING,
    KEEP_ONE_OF,
    SMOOTHING,
    Filters,
    ScanNotFoundError,
    scan_file,
    stretched_triangulation,
)

FLIPS: Filters = ((FILTER, {}),)
FAITHFUL: Filters = ((FILTER, {"preset": "faithful"}),)
CUBE_CAMERA = camera_from((-1.9, -1.0, 1.1), up=(0.0, 0.0, 1.0))
TORUS_CAMERA = camera_from((0.0, -1.0, 1.1), up=(0.0, 0.0, 1.0))
PART_CAMERA = camera_from((0.6, 1.0, 0.8), up=(0.0, 0.0, 1.0))
FACE_CAMERA = camera_from((0.0, 0.0, 1.0), up=(0.0, 1.0, 0.0))
# The top part of the face, as in Figure 6: from the eyes to the brim of the hat.
CLOSEUP_CAMERA = FACE_CAMERA._replace(window=Window(left=-50.0, right=16.0, bottom=-20.0, top=32.0))

Cameras = dict[str, Camera]


class Sizes(NamedTuple):
    """Sizes of the models.

    Vertices of the torus; edges of the part, in percent of its diagonal; one of how many points of
    the scan is kept.
    """

    torus_points: int = 2000
    part_edge_percent: float = 3.0
    keep_one_of: int = KEEP_ONE_OF


FULL_SIZE = Sizes()


class DemoResult(NamedTuple):
    """The stages in the order of the table, and the files that were written."""

    stages: list[Stage]
    files: list[Path]


def run_demo(folder: Path, notify: Notify, sizes: Sizes | None = None) -> DemoResult:
    """Run the experiments, and write meshes and pictures into a folder.

    Parameters
    ----------
    folder
        Made if it doesn't exist; files of the same name in it are replaced.
    notify
        Called with one line for each thing that begins, or that cannot be done.
    sizes
        Smaller models, for a quicker run.

    Raises
    ------
    OSError
        If the folder cannot be written into; nothing has been computed then.
    """
    sizes = sizes or FULL_SIZE
    recorder = Recorder(folder, notify)
    _warm_up(notify)
    _run_model(recorder, "cube", dented_cube(), {"cube": CUBE_CAMERA})
    torus = sampled_torus(sizes.torus_points)
    _run_model(recorder, "torus", torus, {"torus": TORUS_CAMERA})
    _run_part(recorder, scrambled(technical_part(sizes.part_edge_percent)))
    try:
        path = scan_file()
    except ScanNotFoundError as reason:
        notify(f"no face: {reason}")
    else:
        _run_face(recorder, path, sizes.keep_one_of)
    return DemoResult(recorder.stages, recorder.files)


def _run_model(recorder: Recorder, name: str, surface: Surface, cameras: Cameras) -> None:
    """Flip the edges of a model, with meshes and pictures before and after."""
    meshes = set_of(surface, name)
    _run_flips(recorder, meshes, recorder.run_stage(meshes, name, "initial"), cameras)


def _run_flips(
    recorder: Recorder, meshes: pymeshlab.MeshSet, initial: Stage, cameras: Cameras
) -> State:
    """Flip the current mesh, whose last stage was `initial`; save meshes and pictures."""
    name = initial.model
    recorder.save(meshes, f"{name}-before")
    before = initial, surface_of(meshes)
    after = recorder.run_stage(meshes, name, "Willmore flips", FLIPS), surface_of(meshes)
    recorder.save(meshes, f"{name}-after")
    for picture, camera in cameras.items():
        recorder.save_picture(picture, camera, before, after)
    return after


def _run_faithful(recorder: Recorder, surface: Surface, name: str) -> State:
    """Flip the edges of a model by the preset that finds creases back."""
    meshes = set_of(surface, name)
    after = recorder.run_stage(meshes, name, "faithful", FAITHFUL), surface_of(meshes)
    recorder.save(meshes, f"{name}-faithful")
    return after


def _run_part(recorder: Recorder, surface: Surface) -> None:
    """Flip the edges of a part as the paper does, and by the preset that finds creases back."""
    meshes = set_of(surface, "part")
    initial = recorder.run_stage(meshes, "part", "scrambled")
    paper = _run_flips(recorder, meshes, initial, cameras={})
    faithful = _run_faithful(recorder, surface, "part")
    recorder.save_picture("part", PART_CAMERA, (initial, surface), paper, faithful)


def _run_face(recorder: Recorder, path: Path, keep_one_of: int) -> None:
    """Run the chain on the scan, then on its points as the paper triangulates them."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    recorder.run_stage(meshes, "scan", "as scanned")
    cleaned = recorder.run_stage(meshes, "scan", "cleaned", CLEANING)
    scan = surface_of(meshes)
    _run_flips(recorder, meshes, cleaned, cameras={})
    recorder.run_stage(meshes, "scan", "Taubin smoothing", SMOOTHING)
    recorder.save(meshes, "scan-smoothed")

    recorder.notify(
        "face: the scan's points, Delaunay triangulated in a stretched parameter domain"
    )
    face = stretched_triangulation(scan, keep_one_of=keep_one_of)
    meshes = set_of(face, "face")
    initial = recorder.run_stage(meshes, "face", "initial, cleaned", CLEANING)
    cleaned_face = surface_of(meshes)
    cameras = {"face": FACE_CAMERA, "face-closeup": CLOSEUP_CAMERA}
    paper = _run_flips(recorder, meshes, initial, cameras)
    recorder.run_stage(meshes, "face", "Taubin smoothing", SMOOTHING)
    recorder.save(meshes, "face-smoothed")
    faithful = _run_faithful(recorder, cleaned_face, "face")
    recorder.save_picture("face-presets", CLOSEUP_CAMERA, paper, faithful)


def _warm_up(notify: Notify) -> None:
    """Compile the kernels now, so that the times in the table do not include it."""
    has_notified = False

    def follow(name: str) -> None:
        nonlocal has_notified
        if not has_notified:
            notify("compiling (the first run only)")
        has_notified = True

    meshes = set_of(dented_cube())
    with followed(follow):
        for name, given in (*FLIPS, *FAITHFUL):
            meshes.apply_filter(name, **given)
        meshes.get_willmore_measures()
