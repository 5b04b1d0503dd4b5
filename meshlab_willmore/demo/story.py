"""The paper's experiments as chains of PyMeshLab filters, with a row of figures for each stage.

Source: section 4 of "Mesh optimisation based on Willmore energy".
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pymeshlab

from ..mesh.compiling import followed
from ..report.camera import View, Window, view_from
from ..report.table import Stage
from .models import Surface, dented_cube, sampled_torus
from .scan import (
    CLEANING,
    KEEP_ONE_OF,
    SMOOTHING,
    Filters,
    ScanNotFoundError,
    scan_file,
    stretched_triangulation,
)
from .studio import Say, Studio, current

FLIPS: Filters = (("meshing_edge_flip_by_willmore_optimization", {}),)
CUBE_VIEW = view_from((-1.9, -1.0, 1.1), up=(0.0, 0.0, 1.0))
TORUS_VIEW = view_from((0.0, -1.0, 1.1), up=(0.0, 0.0, 1.0))
FACE_VIEW = view_from((0.0, 0.0, 1.0), up=(0.0, 1.0, 0.0))
# The top part of the face, as in Figure 6: from the eyes to the brim of the hat.
CLOSEUP_VIEW = FACE_VIEW._replace(window=Window(left=-50.0, right=16.0, bottom=-20.0, top=32.0))

Views = dict[str, View]


class Sizes(NamedTuple):
    """How large the models are: the torus' vertices, and the share of the scan's points kept."""

    torus_points: int = 2000
    keep_one_of: int = KEEP_ONE_OF


FULL_SIZE = Sizes()


class Story(NamedTuple):
    """The stages in the order of the table, and the files that were written."""

    stages: list[Stage]
    files: list[Path]


def tell(folder: Path, say: Say, sizes: Sizes | None = None) -> Story:
    """Run the three experiments and write meshes and pictures into a folder.

    Parameters
    ----------
    folder
        Made if it isn't there; files of the same name in it are replaced.
    say
        Called with one line for each thing that is begun, or that cannot be done.
    sizes
        Other than full size, for a quicker run.

    Raises
    ------
    OSError
        If the folder cannot be written into; nothing has been computed then.
    """
    sizes = sizes or FULL_SIZE
    studio = Studio(folder, say)
    _warm_up(say)
    _tell_model(studio, "cube", dented_cube(), {"cube": CUBE_VIEW})
    torus = sampled_torus(sizes.torus_points)
    _tell_model(studio, "torus", torus, {"torus": TORUS_VIEW})
    try:
        path = scan_file()
    except ScanNotFoundError as reason:
        say(f"no face: {reason}")
    else:
        _tell_face(studio, path, sizes.keep_one_of)
    return Story(studio.stages, studio.files)


def _tell_model(studio: Studio, name: str, surface: Surface, views: Views) -> None:
    """Flip a model's edges; meshes and pictures of before and after."""
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(*surface), name)
    _tell_flips(studio, meshes, studio.stage(meshes, name, "initial"), views)


def _tell_flips(
    studio: Studio,
    meshes: pymeshlab.MeshSet,
    initial: Stage,
    views: Views,
) -> None:
    """Flip, save and photograph a mesh whose last stage was `initial`."""
    name = initial.model
    studio.save(meshes, f"{name}-before")
    before = initial, current(meshes)
    after = studio.stage(meshes, name, "Willmore flips", FLIPS), current(meshes)
    studio.save(meshes, f"{name}-after")
    for picture, view in views.items():
        studio.photograph(picture, before, after, view)


def _tell_face(studio: Studio, path: Path, keep_one_of: int) -> None:
    """Send the scan through the chain, then its points triangulated as the paper does."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    studio.stage(meshes, "scan", "as scanned")
    cleaned = studio.stage(meshes, "scan", "cleaned", CLEANING)
    scan = current(meshes)
    _tell_flips(studio, meshes, cleaned, views={})
    studio.stage(meshes, "scan", "Taubin smoothing", SMOOTHING)
    studio.save(meshes, "scan-smoothed")

    studio.say("face: the scan's points, Delaunay triangulated in a stretched parameter domain")
    face = stretched_triangulation(scan, keep_one_of=keep_one_of)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(*face), "face")
    initial = studio.stage(meshes, "face", "initial, cleaned", CLEANING)
    views = {"face": FACE_VIEW, "face-closeup": CLOSEUP_VIEW}
    _tell_flips(studio, meshes, initial, views)
    studio.stage(meshes, "face", "Taubin smoothing", SMOOTHING)
    studio.save(meshes, "face-smoothed")


def _warm_up(say: Say) -> None:
    """Compile the kernels now, so that the times in the table are those of the work."""
    has_said = False

    def follow(name: str) -> None:
        nonlocal has_said
        if not has_said:
            say("compiling (the first run only)")
        has_said = True

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(*dented_cube()))
    with followed(follow):
        for name, given in FLIPS:
            meshes.apply_filter(name, **given)
        meshes.get_willmore_measures()
