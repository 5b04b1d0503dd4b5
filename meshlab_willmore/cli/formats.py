"""Which formats PyMeshLab writes, what each can hold, and what a mesh loses in one.

PyMeshLab itself is asked: a small mesh is saved and loaded again.
"""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    import pymeshlab

# What PyMeshLab writes, for people; whether it does is asked.
COMMON = ("ply", "obj", "stl", "off", "3ds", "dae", "wrl", "x3d", "xyz", "dxf")

# Files that name meshes and hold none.
PROJECTS = frozenset({".mlp", ".mlb", ".aln", ".nvm"})

# The parts of `-m`: short name, PyMeshLab's keyword of save_current_mesh, and what it is.
PARTS = {
    "vc": ("save_vertex_color", "vertex colours"),
    "vf": ("save_vertex_flag", "vertex flags"),
    "vq": ("save_vertex_quality", "vertex quality"),
    "vn": ("save_vertex_normal", "vertex normals"),
    "vt": ("save_vertex_coord", "vertex texture coordinates"),
    "vr": ("save_vertex_radius", "vertex radii"),
    "fc": ("save_face_color", "face colours"),
    "ff": ("save_face_flag", "face flags"),
    "fq": ("save_face_quality", "face quality"),
    "fn": ("save_face_normal", "face normals"),
    "wc": ("save_wedge_color", "wedge colours"),
    "wn": ("save_wedge_normal", "wedge normals"),
    "wt": ("save_wedge_texcoord", "wedge texture coordinates"),
}
# Those that are no data: PyMeshLab's keyword and its value.
MANNERS = {"mp": ("save_polygonal", True), "sa": ("binary", False)}

# Their writers cut a path at its first dot, and leave files beside the folder they were given.
_ASTRAY = frozenset({"u3d", "idtf"})
# PyMeshLab does not load these; some of the writers crash for meshes as small as ours.
_WRITTEN_ONLY = frozenset({"dxf", "json", "nxs", "nxz"})

# A mesh so many times farther from the origin than it is wide may lose its shape by rounding.
_FAR = 100.0
# Vertices that move by more of an edge than this change the shape.
_MOST_SHIFT = 0.01


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


def keywords(parts: Iterable[str], ending: str) -> dict[str, bool]:
    """The keywords of ``save_current_mesh`` for parts of `-m`; none if no part is given."""
    wanted = set(parts)
    if not wanted:
        return {}
    given = {keyword: part in wanted for part, (keyword, _) in PARTS.items()}
    given |= {keyword: value for part, (keyword, value) in MANNERS.items() if part in wanted}
    return {key: value for key, value in given.items() if holds(ending, key)}


def not_held(parts: Iterable[str], ending: str) -> str:
    """A message on the parts of `-m` for which the format has no place; empty if it has all."""
    asked = {part: PARTS[part] for part in parts if part in PARTS}
    missing = [f"{name} ({part})" for part, (key, name) in asked.items() if not holds(ending, key)]
    return _no_place(ending, missing) if missing else ""


def _no_place(ending: str, names: Iterable[str]) -> str:
    return f".{ending} files hold no {' and no '.join(names)}"


# --- what a mesh loses in a file ---------------------------------------------------------------


def losses(ms: pymeshlab.MeshSet, file: Path, ending: str, chosen: bool) -> Iterator[str]:
    """What the current mesh has and its `file` has not, one message for each kind.

    If the parts to save were `chosen` by `-m`, no other part is missed.
    """
    mesh = ms.current_mesh()
    wedges = _WEDGES._replace(has_image=mesh.texture_number() > 0)
    parts = _ALWAYS if chosen else (*_ALWAYS, *_BY_DEFAULT, wedges)
    lost = [part.name for part in parts if part.is_there(mesh) and not _keeps(ending, part)]
    if lost:
        yield _no_place(ending, lost)
    yield from _rounding_losses(mesh, file, ending)


class _Part(NamedTuple):
    """A part of a mesh that a format may have no place for."""

    name: str
    # Of ``save_current_mesh``; empty for none.
    keyword: str
    is_there: Callable[[pymeshlab.Mesh], bool]
    # Arguments of `pymeshlab.Mesh` with which a square of two triangles has it.
    given: Callable[[], dict[str, Any]] = dict
    # Whether the square has texture coordinates, and a texture: some writers depend on that.
    is_mapped: bool = False
    has_image: bool = False


def _numbers(*shape: int) -> np.ndarray:
    """Different numbers between 0 and 1."""
    import numpy as np

    return np.linspace(0.0, 1.0, int(np.prod(shape))).reshape(shape)


def _differ(values: np.ndarray) -> bool:
    """Whether there is anything to lose: the values are not all the same."""
    return len(values) > 0 and bool((values != values[0]).any())


def _is_coloured(colours: np.ndarray) -> bool:
    """Whether it is more than one grey, which PyMeshLab gives where there is no colour."""
    return _differ(colours) or bool(len(colours) and (colours[0, :3] != colours[0, 0]).any())


def _has_loose_vertices(mesh: pymeshlab.Mesh) -> bool:
    import numpy as np

    return len(np.unique(mesh.face_matrix())) < mesh.vertex_number()


# No mask names these.
_ALWAYS = (
    _Part("faces", "", lambda mesh: mesh.face_number() > 0),
    _Part(
        "edges",
        "",
        lambda mesh: mesh.edge_number() > 0,
        lambda: {"edge_matrix": [[0, 1], [2, 3]]},
    ),
    _Part(
        "vertices without faces",
        "",
        _has_loose_vertices,
        lambda: {"vertex_matrix": [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 5]]},
    ),
)
_BY_DEFAULT = (
    _Part(
        "vertex colours",
        "save_vertex_color",
        lambda mesh: mesh.has_vertex_color() and _is_coloured(mesh.vertex_color_matrix()),
        lambda: {"v_color_matrix": _numbers(4, 4)},
    ),
    _Part(
        "face colours",
        "save_face_color",
        lambda mesh: mesh.has_face_color() and _is_coloured(mesh.face_color_matrix()),
        lambda: {"f_color_matrix": _numbers(2, 4)},
    ),
    _Part(
        "vertex quality",
        "save_vertex_quality",
        lambda mesh: mesh.has_vertex_scalar() and _differ(mesh.vertex_scalar_array()),
        lambda: {"v_scalar_array": _numbers(4)},
    ),
    _Part(
        "face quality",
        "save_face_quality",
        lambda mesh: mesh.has_face_scalar() and _differ(mesh.face_scalar_array()),
        lambda: {"f_scalar_array": _numbers(2)},
    ),
    _Part(
        "texture coordinates of vertices",
        "save_vertex_coord",
        lambda mesh: mesh.has_vertex_tex_coord() and _differ(mesh.vertex_tex_coord_matrix()),
        lambda: {"v_tex_coords_matrix": _numbers(4, 2)},
    ),
)
_WEDGES = _Part(
    "texture coordinates",
    "save_wedge_texcoord",
    lambda mesh: mesh.has_wedge_tex_coord() and _differ(mesh.wedge_tex_coord_matrix()),
    is_mapped=True,
)


@functools.cache
def _keeps(ending: str, part: _Part) -> bool:
    """Whether a small mesh with the part still has it after it was saved and loaded.

    A format that can't be loaded is asked whether it takes the keyword.
    """
    import pymeshlab

    from ..meshset import native

    takes_keyword = not part.keyword or holds(ending, part.keyword)
    if ending in _WRITTEN_ONLY:
        return takes_keyword
    square = {
        "vertex_matrix": [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
        "face_matrix": [[0, 1, 2], [0, 2, 3]],
    }
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
            return takes_keyword
        return part.is_there(helper.current_mesh())


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


def _mapped_square(folder: Path, has_image: bool) -> Path:
    """A file with a square and texture coordinates: `pymeshlab.Mesh` leaves open of which image."""
    file = folder / "mapped.obj"
    file.write_text(("mtllib m.mtl\nusemtl m\n" if has_image else "") + _MAPPED)
    (folder / "m.mtl").write_text("newmtl m\nmap_Kd image.png\n")
    (folder / "image.png").write_bytes(_IMAGE)
    return file


# --- rounding ----------------------------------------------------------------------------------


def is_far(vertices: np.ndarray) -> bool:
    """Whether points are so far from the origin that rounding may change their shape."""
    import numpy as np

    if not len(vertices):
        return False
    return bool(np.abs(vertices).max() > _FAR * np.ptp(vertices, axis=0).max())


def _rounding_losses(mesh: pymeshlab.Mesh, file: Path, ending: str) -> Iterator[str]:
    """How the vertices of the file differ from those of the mesh, where that matters."""
    import numpy as np

    vertices, faces = mesh.vertex_matrix(), mesh.face_matrix()
    used = vertices[np.unique(faces)] if len(faces) else vertices
    saved = _vertices_of(file) if is_far(used) else None
    if saved is None or not len(saved):
        return
    cure = "move the mesh to the origin, or save it as PLY"
    merged = len(np.unique(used, axis=0)) - len(np.unique(saved, axis=0))
    if merged > 0:
        yield (
            f"so far from the origin, .{ending} files can't hold all vertices apart: {merged} "
            f"get the place of another; {cure}"
        )
        return
    shift, edge = _shift(used, saved), _mean_edge(vertices, faces)
    if shift > _MOST_SHIFT * edge > 0.0:
        yield (
            f"so far from the origin, .{ending} files hold too few digits: vertices move by up to "
            f"{shift:.2g}, where edges are {edge:.2g} long; {cure}"
        )


def _shift(vertices: np.ndarray, saved: np.ndarray) -> float:
    """The largest distance of a coordinate to the nearest saved one.

    That is what rounding did: it goes to the nearest coordinate that can be held. Some formats
    change the order of vertices.
    """
    import numpy as np

    shift = 0.0
    for column, kept in zip(vertices.T, np.sort(saved, axis=0).T, strict=True):
        after = np.searchsorted(kept, column)
        above = np.abs(kept[np.minimum(after, len(kept) - 1)] - column)
        below = np.abs(kept[np.maximum(after - 1, 0)] - column)
        shift = max(shift, float(np.minimum(above, below).max()))
    return shift


def _mean_edge(vertices: np.ndarray, faces: np.ndarray) -> float:
    import numpy as np

    if not len(faces):
        return 0.0
    return float(np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1).mean())


def _vertices_of(file: Path) -> np.ndarray | None:
    """The vertices of a file; None if PyMeshLab can't load it."""
    import pymeshlab

    from ..meshset import native

    helper = pymeshlab.MeshSet()
    try:
        with native.muted():
            native.load(helper, file)
    except native.ERRORS:
        native.forget_failures()
        return None
    return helper.current_mesh().vertex_matrix()
