"""Which formats PyMeshLab writes, and what each holds; asked of PyMeshLab itself."""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import pymeshlab

# What PyMeshLab writes, for people; whether it does is asked.
COMMON = ("ply", "obj", "stl", "off", "3ds", "dae", "wrl", "x3d", "xyz", "dxf")

# Files that name meshes and hold none.
PROJECTS = frozenset({".mlp", ".mlb", ".aln", ".nvm"})

# Their writers cut a path at its first dot, and leave files beside the folder they were given.
_ASTRAY = frozenset({"u3d", "idtf"})
# PyMeshLab does not load these; some of the writers crash for meshes as small as ours.
_WRITTEN_ONLY = frozenset({"dxf", "json", "nxs", "nxz"})

_MAPPED = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
f 1/1 2/2 3/3
f 1/1 3/3 4/4
"""
# A PNG of one pixel.
_IMAGE = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108000000003a7e9b550000000a49"
    "444154789c63f80f0001010100b138f6140000000049454e44ae426082"
)


def is_written(ending: str) -> bool:
    """Whether PyMeshLab writes files with this ending (without the dot)."""
    return ending.lower() not in _ASTRAY and _takes(ending.lower())


def holds(ending: str, keyword: str) -> bool:
    """Whether files with this ending take a ``save_...`` keyword of ``save_current_mesh``."""
    return _takes(ending.lower(), keyword)


@functools.cache
def _takes(ending: str, *keywords: str) -> bool:
    import numpy as np
    import pymeshlab

    from ..meshset import native

    if ending in pymeshlab.filter_list():
        return False
    helper = pymeshlab.MeshSet()
    native.add(helper, pymeshlab.Mesh(np.zeros((1, 3))))
    given: dict[str, Any] = dict.fromkeys(keywords, True)
    try:
        with native.muted():
            helper.filter_parameter_values(ending, **given)
    except native.ERRORS:
        return False
    return True


class Part(NamedTuple):
    """A part of a mesh that a format may have no place for.

    Attributes
    ----------
    name : str
        What messages call it.
    keyword : str
        That of ``save_current_mesh`` which speaks of it; empty for none.
    given : callable
        Arguments of `pymeshlab.Mesh` that make a square of two triangles have it.
    is_there : callable
        Whether a mesh has it.
    is_mapped : bool
        Whether the mesh is to have texture coordinates.
    has_image : bool
        Whether it is to have a texture as well: some writers go by that.
    """

    name: str
    keyword: str
    given: Callable[[], dict[str, Any]]
    is_there: Callable[[pymeshlab.Mesh], bool]
    is_mapped: bool = False
    has_image: bool = False


def keeps(ending: str, part: Part) -> bool:
    """Whether what is saved with this ending, as PyMeshLab does of itself, still has the part."""
    return _round_trip(ending.lower(), part)


@functools.cache
def _round_trip(ending: str, part: Part) -> bool:
    """Save a small mesh and load it; a format that can't be loaded says itself what it holds."""
    if ending in _WRITTEN_ONLY:
        return not part.keyword or holds(ending, part.keyword)
    import numpy as np
    import pymeshlab

    from ..meshset import native

    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    square = {"vertex_matrix": corners, "face_matrix": np.array([[0, 1, 2], [0, 2, 3]])}
    helper = pymeshlab.MeshSet()
    with tempfile.TemporaryDirectory(prefix="meshlab_willmore_") as folder:
        file = Path(folder) / f"square.{ending}"
        try:
            with native.muted():
                if part.is_mapped:
                    native.load(helper, _mapped_square(Path(folder), part.has_image))
                else:
                    native.add(helper, pymeshlab.Mesh(**{**square, **part.given()}))
                helper.save_current_mesh(str(file), save_textures=False)
                native.load(helper, file)
        except native.ERRORS:
            native.forget_failures()
            return not part.keyword or holds(ending, part.keyword)
        return part.is_there(helper.current_mesh())


def _mapped_square(folder: Path, has_image: bool) -> Path:
    """A file with a square and texture coordinates: `pymeshlab.Mesh` leaves open of which image."""
    file = folder / "mapped.obj"
    file.write_text(("mtllib m.mtl\nusemtl m\n" if has_image else "") + _MAPPED)
    (folder / "m.mtl").write_text("newmtl m\nmap_Kd image.png\n")
    (folder / "image.png").write_bytes(_IMAGE)
    return file
