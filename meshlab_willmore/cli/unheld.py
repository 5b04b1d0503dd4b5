"""What a mesh has and the format of its file can't hold, in words."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import formats
from .formats import Part

if TYPE_CHECKING:
    import numpy as np
    import pymeshlab

# So many times farther from the origin than it is wide, a mesh may lose what it is made of.
_FAR = 100.0
# Vertices that move by more of an edge than this change the shape.
_MOST_SHIFT = 0.01


def _array(*shape: int) -> Callable[[], Any]:
    """Numbers of which no two are the same, between 0 and 1."""

    def numbers() -> Any:
        import numpy as np

        return np.linspace(0.0, 1.0, int(np.prod(shape))).reshape(shape)

    return numbers


def _differ(values: np.ndarray) -> bool:
    """Whether there is anything to lose: not all of it is the same."""
    return len(values) > 0 and bool((values != values[0]).any())


def _is_coloured(colours: np.ndarray) -> bool:
    """Whether it is more than one grey, which PyMeshLab gives where there is no colour."""
    return _differ(colours) or bool(len(colours) and (colours[0, :3] != colours[0, 0]).any())


def _loose(mesh: pymeshlab.Mesh) -> int:
    """How many vertices no face has."""
    import numpy as np

    is_used = np.zeros(mesh.vertex_number(), bool)
    is_used[mesh.face_matrix().ravel()] = True
    return int((~is_used).sum())


# What no mask names.
ALWAYS = (
    Part("faces", "", dict, lambda mesh: mesh.face_number() > 0),
    Part(
        "edges",
        "",
        lambda: {"edge_matrix": [[0, 1], [2, 3]]},
        lambda mesh: mesh.edge_number() > 0,
    ),
    Part(
        "vertices without faces",
        "",
        lambda: {"vertex_matrix": [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 5]]},
        lambda mesh: _loose(mesh) > 0,
    ),
)
BY_DEFAULT = (
    Part(
        "vertex colours",
        "save_vertex_color",
        lambda: {"v_color_matrix": _array(4, 4)()},
        lambda mesh: mesh.has_vertex_color() and _is_coloured(mesh.vertex_color_matrix()),
    ),
    Part(
        "face colours",
        "save_face_color",
        lambda: {"f_color_matrix": _array(2, 4)()},
        lambda mesh: mesh.has_face_color() and _is_coloured(mesh.face_color_matrix()),
    ),
    Part(
        "vertex quality",
        "save_vertex_quality",
        lambda: {"v_scalar_array": _array(4)()},
        lambda mesh: mesh.has_vertex_scalar() and _differ(mesh.vertex_scalar_array()),
    ),
    Part(
        "face quality",
        "save_face_quality",
        lambda: {"f_scalar_array": _array(2)()},
        lambda mesh: mesh.has_face_scalar() and _differ(mesh.face_scalar_array()),
    ),
    Part(
        "texture coordinates of vertices",
        "save_vertex_coord",
        lambda: {"v_tex_coords_matrix": _array(4, 2)()},
        lambda mesh: mesh.has_vertex_tex_coord() and _differ(mesh.vertex_tex_coord_matrix()),
    ),
)

_WEDGES = Part(
    "texture coordinates",
    "save_wedge_texcoord",
    dict,
    lambda mesh: mesh.has_wedge_tex_coord() and _differ(mesh.wedge_tex_coord_matrix()),
    is_mapped=True,
)


def losses(ms: pymeshlab.MeshSet, file: Path, ending: str, chosen: bool) -> Iterator[str]:
    """What the current mesh has and its file has not, a text for each kind.

    Parameters
    ----------
    file : Path
        What was saved.
    ending : str
        That of the name that it will have, without the dot.
    chosen : bool
        Whether the parts to be saved were named; then no other of them is missed.
    """
    mesh = ms.current_mesh()
    wedges = _WEDGES._replace(has_image=mesh.texture_number() > 0)
    parts = ALWAYS if chosen else (*ALWAYS, *BY_DEFAULT, wedges)
    lost = [part.name for part in _lost(mesh, ending, parts)]
    if lost:
        yield f".{ending} files hold no {' and no '.join(lost)}"
    yield from _far_losses(mesh, file, ending)


def _lost(mesh: pymeshlab.Mesh, ending: str, parts: Iterable[Part]) -> Iterator[Part]:
    for part in parts:
        if part.is_there(mesh) and not formats.keeps(ending, part):
            yield part


def is_far(vertices: np.ndarray) -> bool:
    """Whether points are so much farther from the origin than from each other that digits lack."""
    import numpy as np

    if not len(vertices):
        return False
    return bool(np.abs(vertices).max() > _FAR * np.ptp(vertices, axis=0).max())


def _far_losses(mesh: pymeshlab.Mesh, file: Path, ending: str) -> Iterator[str]:
    """What rounding does to vertices in the file, and not in the mesh."""
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
    """How far a coordinate is from the nearest one that was saved; some formats change the order.

    Rounding takes a coordinate to the nearest one that can be held, so this is what it did.
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
    """The vertices of a file; nothing if PyMeshLab can't load it."""
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
