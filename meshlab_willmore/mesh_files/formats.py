"""Which formats PyMeshLab writes, what each can hold, and what a mesh loses in one."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

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

# Formats without a binary form.
_TEXTS = frozenset({"dae", "dxf", "json", "obj", "off", "wrl", "x3d", "xyz"})

# Their writers cut a path at its first dot, and leave files beside the folder they were given.
_ASTRAY = frozenset({"u3d", "idtf"})

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


def can_be_text(ending: str) -> bool:
    """Whether files with this ending are texts, or can be."""
    return ending.lower() in _TEXTS or holds(ending, "binary")


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


# Parts that `-m` does not name.
_FACES, _EDGES, _LOOSE = "faces", "edges", "vertices without faces"
_OTHER_PARTS = (_FACES, _EDGES, _LOOSE)
# Some formats hold texture coordinates only of meshes with a texture.
_WITH_TEXTURE = "wt with a texture"
# And these hold names of textures only of meshes with texture coordinates.
_MAPPED_TEXTURES = ("obj", "ply")
# What a mesh still has after PyMeshLab saved and loaded it; what is not loaded takes the keywords.
_HELD = {
    "3ds": (_FACES, _LOOSE),
    "ctm": (_FACES, _LOOSE),
    "dae": (_FACES, _LOOSE, "vc", _WITH_TEXTURE),
    "dxf": (_FACES, _EDGES, _LOOSE),
    "e57": (_LOOSE, "vc", "vq"),
    "json": (_FACES, _EDGES, _LOOSE, "vc", "vt"),
    "nxs": (_FACES, _EDGES, _LOOSE, "vc", "vt", "wt"),
    "nxz": (_FACES, _EDGES, _LOOSE, "vc", "vt", "wt"),
    "obj": (_FACES, _EDGES, _LOOSE, "vc", "fc", "vt", "wt"),
    "off": (_FACES, _LOOSE, "vc", "fc", "vt"),
    "ply": (_FACES, _LOOSE, "vc", "fc", "vq", "fq", "vt", "wt"),
    "stl": (_FACES, "fc"),
    "wrl": (_FACES, _LOOSE, "vc", _WITH_TEXTURE),
    "x3d": (_FACES, _LOOSE, "vc", _WITH_TEXTURE),
    "xyz": (_LOOSE,),
}


def losses(ms: pymeshlab.MeshSet, file: Path, ending: str, chosen: bool) -> Iterator[str]:
    """What the current mesh has and its `file` has not, one message for each kind.

    If the parts to save were `chosen` by `-m`, no other part is missed.
    """
    mesh = ms.current_mesh()
    lost = [
        PARTS[part][1] if part in PARTS else part
        for part in _parts_of(mesh)
        if not (_is_held(part, mesh, ending) or (chosen and part in PARTS))
    ]
    if lost:
        yield _no_place(ending, lost)
    names = sorted(mesh.textures())
    is_mapped = mesh.has_wedge_tex_coord() or mesh.has_vertex_tex_coord()
    if names and not (is_mapped or chosen) and ending in _MAPPED_TEXTURES:
        yield (
            "without texture coordinates PyMeshLab does not save the names of textures "
            f"({', '.join(names)})"
        )
    yield from _rounding_losses(mesh, file, ending)


def _is_held(part: str, mesh: pymeshlab.Mesh, ending: str) -> bool:
    held = _HELD.get(ending, (*_OTHER_PARTS, *PARTS))
    return part in held or (part == "wt" and _WITH_TEXTURE in held and mesh.texture_number() > 0)


def _parts_of(mesh: pymeshlab.Mesh) -> Iterator[str]:
    """The parts of a mesh that have anything to lose."""
    import numpy as np

    if mesh.face_number():
        yield _FACES
    if mesh.edge_number():
        yield _EDGES
    if len(np.unique(mesh.face_matrix())) < mesh.vertex_number():
        yield _LOOSE
    if mesh.has_vertex_color() and _is_coloured(mesh.vertex_color_matrix()):
        yield "vc"
    if mesh.has_face_color() and _is_coloured(mesh.face_color_matrix()):
        yield "fc"
    if mesh.has_vertex_scalar() and _differ(mesh.vertex_scalar_array()):
        yield "vq"
    if mesh.has_face_scalar() and _differ(mesh.face_scalar_array()):
        yield "fq"
    if mesh.has_vertex_tex_coord() and _differ(mesh.vertex_tex_coord_matrix()):
        yield "vt"
    if mesh.has_wedge_tex_coord() and _differ(mesh.wedge_tex_coord_matrix()):
        yield "wt"


def _differ(values: np.ndarray) -> bool:
    """Whether the values are not all the same."""
    return len(values) > 0 and bool((values != values[0]).any())


def _is_coloured(colours: np.ndarray) -> bool:
    """Whether it is more than one grey, which PyMeshLab gives where there is no colour."""
    return _differ(colours) or bool(len(colours) and (colours[0, :3] != colours[0, 0]).any())


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
