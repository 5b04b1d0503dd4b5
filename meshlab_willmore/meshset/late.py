"""Large meshes of little else than positions and faces, which are saved after their flips.

To copy a mesh takes longer than to save it, but PyMeshLab notes the name of the file with a mesh
that it saves. So of these meshes what flips depend on is read by the methods of `Mesh`, and the
mesh itself is saved only once there are flips: soon after, its name is that of another temporary
file in any case. Meanwhile the new mesh is written, on another core, as if the old one had nothing
but what those methods show. Flags and radii, which they don't, are in the saved file.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pymeshlab

from ..temporary_files import temporary_folder
from . import ply
from .exchange import GREY, NORMAL, WHITE
from .snapshot import MESH_FILE, MeshSnapshot, Surface, attribute_keys, take

# To copy a smaller mesh takes no time that counts.
LEAST_FACES = 10_000

_FACE = np.dtype([("vertex_indices_count", "u1"), ("vertex_indices", "<i4", (3,))])
# The bytes of a colour, as `Mesh` packs them.
_BYTES = {"red": 2, "green": 1, "blue": 0, "alpha": 3}
_MOST_BYTES_OF_VERTEX = 6 * 8 + 4 + 8


class Saved(NamedTuple):
    """A mesh that was saved after its flips.

    Attributes
    ----------
    old : MeshSnapshot
        The mesh, which still has its old faces.
    new : MeshSnapshot or None
        The mesh with new faces, if the methods of `Mesh` have shown all of it.
    folder : Path
        Where `MESH_FILE` holds the new mesh.
    """

    old: MeshSnapshot
    new: MeshSnapshot | None
    folder: Path


def can_be_saved_late(ms: pymeshlab.MeshSet) -> bool:
    """Whether the current mesh is large, and flips depend on nothing but a `Surface` and flags."""
    mesh = ms.current_mesh()
    has_mapping = mesh.has_wedge_tex_coord() or mesh.has_vertex_tex_coord()
    return (
        mesh.face_number() >= LEAST_FACES
        and not (has_mapping or mesh.texture_number())
        and not attribute_keys(ms)
    )


def surface_of(mesh: pymeshlab.Mesh, selection: bool) -> Surface:
    """Read what flips depend on, with or without the selection; nothing of `mesh` changes."""
    return Surface(
        np.ascontiguousarray(mesh.vertex_matrix()),
        np.ascontiguousarray(mesh.face_matrix(), np.int32),
        mesh.face_selection_array() if selection else None,
    )


@contextmanager
def saved(ms: pymeshlab.MeshSet, surface: Surface, faces: np.ndarray) -> Iterator[Saved]:
    """Save the current mesh of `ms`, with the `surface` that was read, and write it with new faces.

    PyMeshLab saves on one core, and Python can go on meanwhile.
    """
    size = _MOST_BYTES_OF_VERTEX * len(surface.vertices) + _FACE.itemsize * len(faces)
    columns, normals = _columns(ms.current_mesh()), ms.current_mesh().vertex_normal_matrix()
    with temporary_folder(size) as folder:
        path = folder / MESH_FILE
        with ThreadPoolExecutor(1) as pool:
            written = pool.submit(_write, path, surface.vertices, columns, faces, normals)
            old = take(ms, late=surface)
        mesh, normals = written.result()
        new = old._replace(faces=faces, ply=mesh, normals=normals)
        yield Saved(old, new if _is_all(old.ply, mesh) else None, folder)


def _columns(mesh: pymeshlab.Mesh) -> dict[str, np.ndarray]:
    """The columns of the vertices beside positions, as `Mesh` shows them."""
    columns = {}
    if mesh.has_vertex_color():
        packed = mesh.vertex_color_array().astype("<u4")
        if (packed == WHITE).all():
            # All meshes that were made of arrays are white, and one number is read in less time.
            columns[GREY] = np.ones(len(packed), "<f4")
        else:
            parts = packed.view(np.uint8).reshape(-1, 4)
            columns.update({name: parts[:, place] for name, place in _BYTES.items()})
    if mesh.has_vertex_scalar():
        columns["quality"] = mesh.vertex_scalar_array()
    return columns


def _write(
    path: Path,
    vertices: np.ndarray,
    columns: dict[str, np.ndarray],
    faces: np.ndarray,
    others: np.ndarray,
) -> tuple[ply.PlyMesh, np.ndarray]:
    """Write a mesh with these columns, and return it with its (n, 3) normals.

    `others` are the normals of the vertices without faces.
    """
    # Numba takes too long to import for programs that don't flip.
    from ..mesh.normals import vertex_normals

    normals = vertex_normals(vertices, faces, others)
    positions, directions = (
        dict(zip(names, of.T, strict=True)) for names, of in (("xyz", vertices), (NORMAL, normals))
    )
    points = {**positions, **columns, **directions}
    corners = {"vertex_indices_count": np.full(len(faces), 3), "vertex_indices": faces}
    mesh = ply.PlyMesh(
        ply.records(points, [(name, column.dtype) for name, column in points.items()]),
        ply.records(corners, _FACE),
        np.empty((0, 2), np.int32),
        (),
    )
    ply.write(path, mesh)
    return mesh, normals


def _is_all(old: ply.PlyMesh, new: ply.PlyMesh) -> bool:
    """Whether a mesh that was saved has no flags that are set, and no other data than `new`."""
    has_flags = any(records["flags"].any() for records in (old.vertices, old.faces))
    return not has_flags and not len(old.edges) and _contents(old) == _contents(new)


def _contents(mesh: ply.PlyMesh) -> list[set[str]]:
    """The columns of vertices and faces, but for normals, flags and how colours are written."""
    contents = [set(records.dtype.names or ()) for records in (mesh.vertices, mesh.faces)]
    if GREY in contents[0]:
        contents[0] |= _BYTES.keys()
    return [names - {*NORMAL, "flags", GREY} for names in contents]
