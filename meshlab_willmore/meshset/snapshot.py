"""Snapshot of a mesh: everything that PyMeshLab shows of it.

The mesh is read from PyMeshLab's own PLY (see `ply`): no method gives faux or selected edges,
texture indices or radii, nor whether there are any (`polygonal_face_list` takes three times as long
as the file). Custom attributes are read by the methods of `Mesh`, under their real names.

PyMeshLab notes the name of the file with a mesh that it saves, and nothing puts the old name back.
So a copy is saved, but of the meshes in `late`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path, PurePosixPath
from typing import NamedTuple

import numpy as np
import pymeshlab

from ..temporary_files import temporary_folder
from . import layers, native, ply
from .filter_info import python_name

MESH_FILE = "mesh.ply"

# The bit of a selected element, the same in the flags of vertices and faces.
_SELECTED = 0x20

_BYTES_OF_VERTEX = 28
_BYTES_OF_FACE = 17
_LONGEST_NAME = 255


class Attribute(NamedTuple):
    """One custom attribute: `kind` is a key of `ATTRIBUTE_METHODS`, `name` the real name."""

    kind: str
    name: str
    values: np.ndarray


ATTRIBUTE_METHODS = {
    "vs": ("vertex_custom_scalar_attribute_array", "add_vertex_custom_scalar_attribute"),
    "vp": ("vertex_custom_point_attribute_matrix", "add_vertex_custom_point_attribute"),
    "fs": ("face_custom_scalar_attribute_array", "add_face_custom_scalar_attribute"),
    "fp": ("face_custom_point_attribute_matrix", "add_face_custom_point_attribute"),
}


class Surface(NamedTuple):
    """What flips depend on, of a mesh of triangles without texture coordinates.

    The attributes are those of a `MeshSnapshot`.
    """

    vertices: np.ndarray
    faces: np.ndarray
    selected_faces: np.ndarray | None
    wedge_uv: None = None


class MeshSnapshot(NamedTuple):
    """Everything that PyMeshLab shows of a mesh.

    Attributes
    ----------
    vertices : (n, 3) float64 ndarray
        The positions, as in `ply`.
    faces : (m, 3) int32 ndarray
        The corners of the faces, as in `ply`.
    ply : PlyMesh
        Positions, faces, flags, colours, scalars, radii, texture coordinates, names of textures.
    normals : (n, 3) float64 ndarray
        The vertex normals.
    attributes : list of Attribute
        The custom attributes.
    images : dict of str to pymeshlab.Image
        The texture images by name.
    identity : layers.Identity
        Label, visibility and transform.
    unsupported : list of str
        Data of the mesh that PyMeshLab can't put on a new one, as phrases.
    """

    vertices: np.ndarray
    faces: np.ndarray
    ply: ply.PlyMesh
    normals: np.ndarray
    attributes: list[Attribute]
    images: dict[str, pymeshlab.Image]
    identity: layers.Identity
    unsupported: list[str]

    @property
    def wedge_uv(self) -> np.ndarray | None:
        """Texture coordinates of the corners of all faces, (m, 3, 2 k) for k mappings, or None.

        Faces can have coordinates for each corner, and vertices can have some: both are mappings.
        """
        mappings = []
        if "texcoord" in (self.ply.faces.dtype.names or ()):
            mappings.append(self.ply.faces["texcoord"].reshape(-1, 3, 2))
        if "texture_u" in (self.ply.vertices.dtype.names or ()):
            at_vertices = [self.ply.vertices[name] for name in ("texture_u", "texture_v")]
            mappings.append(np.column_stack(at_vertices)[self.faces])
        return np.concatenate(mappings, axis=2) if mappings else None

    @property
    def is_without_pixels(self) -> bool:
        """Whether there are textures, and none has an image of any size."""
        return bool(self.ply.textures) and not any(map(has_pixels, self.images.values()))

    @property
    def selected_faces(self) -> np.ndarray:
        """(m,) bool."""
        return selected(self.ply.faces)


def take(ms: pymeshlab.MeshSet, late: Surface | None = None) -> MeshSnapshot:
    """Read the current mesh of `ms`, which must have faces and be compact.

    Meshes are compact after every filter.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
        Without `late` nothing of it changes.
    late : Surface, optional
        What was read of the mesh before, if no copy of it is to be saved: PyMeshLab notes the name
        of the file with it.
    """
    native.forget_failures()
    mesh = ms.current_mesh()
    # A mesh without a label has the name of its file as one.
    identity = layers.identity_of(mesh)
    keys = attribute_keys(ms)
    with _copied(mesh) if late is None else _itself(ms) as (source, folder):
        path = folder / MESH_FILE
        native.save(source, path, save_textures=False, **_save_flags(mesh))
        records = ply.read(path)
        attributes = _take_attributes(mesh, _attribute_names(source, folder, keys))
        textures = records.textures or _unmapped_textures(source, folder)
    edges = mesh.edge_matrix().astype(np.int32)
    records = records._replace(edges=edges, textures=textures)
    images = mesh.textures()
    unsupported = [
        *shown_losses(mesh),
        *_lost_digits(records),
        *_lost_names(records.textures, images),
    ]
    if len(attributes) < len(keys):
        unsupported.append("custom attributes with odd names")
    return MeshSnapshot(
        np.column_stack([records.vertices[axis] for axis in "xyz"])
        if late is None
        else late.vertices,
        # Entries of the records start at odd addresses.
        np.ascontiguousarray(records.faces["vertex_indices"]) if late is None else late.faces,
        records,
        mesh.vertex_normal_matrix(),
        attributes,
        images,
        identity,
        unsupported,
    )


def attribute_keys(ms: pymeshlab.MeshSet) -> list[str]:
    """PyMeshLab's keywords for saving the custom attributes of the current mesh."""
    return [key for key in native.defaults(ms, "ply") if key.startswith("__ca_")]


@contextmanager
def _copied(mesh: pymeshlab.Mesh) -> Iterator[tuple[pymeshlab.MeshSet, Path]]:
    """A copy of `mesh` in a set of its own, whose file name saving may change, and a folder."""
    with temporary_folder(_least_size(mesh)) as folder:
        copy = pymeshlab.MeshSet()
        native.add(copy, mesh, "copy")
        yield copy, folder


@contextmanager
def _itself(ms: pymeshlab.MeshSet) -> Iterator[tuple[pymeshlab.MeshSet, Path]]:
    """The set itself, which prints nothing meanwhile, and a folder."""
    with temporary_folder(_least_size(ms.current_mesh())) as folder, native.without_trace(ms):
        yield ms, folder


def _least_size(mesh: pymeshlab.Mesh) -> int:
    """How many bytes the PLY has at least: coordinates and flags, corners and flags."""
    return _BYTES_OF_VERTEX * mesh.vertex_number() + _BYTES_OF_FACE * mesh.face_number()


def _save_flags(mesh: pymeshlab.Mesh) -> dict[str, bool]:
    return {
        "save_vertex_flag": True,
        "save_vertex_coord": True,
        "save_vertex_radius": True,
        "save_vertex_normal": False,
        "save_vertex_color": mesh.has_vertex_color(),
        "save_vertex_quality": mesh.has_vertex_scalar(),
        "save_face_flag": True,
        "save_face_color": mesh.has_face_color(),
        "save_face_quality": mesh.has_face_scalar(),
        "save_wedge_texcoord": mesh.has_wedge_tex_coord(),
    }


def _take_attributes(mesh: pymeshlab.Mesh, names: list[tuple[str, str]]) -> list[Attribute]:
    attributes = []
    for kind, name in names:
        reader, _ = ATTRIBUTE_METHODS[kind]
        attributes.append(Attribute(kind, name, getattr(mesh, reader)(name)))
    return attributes


def _attribute_names(
    copy: pymeshlab.MeshSet, folder: Path, keys: list[str]
) -> list[tuple[str, str]]:
    """Kinds and real names of the attributes, which PyMeshLab shows only as Python names.

    The header of a PLY has the real ones. All elements are deleted before, since PyMeshLab crashes
    when it writes the values of copied attributes; `copy` is empty afterwards.
    """
    if not keys:
        return []
    _delete_all(copy)
    path = folder / "attributes.ply"
    native.save(copy, path, save_textures=False, **dict.fromkeys(keys, True))
    header = path.read_bytes().decode("utf-8", "surrogateescape")
    # A dict is an ordered set: an attribute called x has the name of the coordinate in the header.
    names: dict[tuple[str, str], None] = {}
    element = ""
    for line in header.split("\n"):
        if line.startswith("element "):
            element = line.split()[1][0]
        scalar = re.match(r"property double (.*)", line)
        point = re.match(r"property list uchar double (.*)", line)
        found = scalar or point
        if found:
            kind = element + ("s" if scalar else "p")
            if f"__ca_{kind}__{python_name(found[1])}" in keys:
                names[kind, found[1]] = None
    return list(names)


def _unmapped_textures(copy: pymeshlab.MeshSet, folder: Path) -> tuple[str, ...]:
    """Names of textures, in their order, of a mesh without texture coordinates.

    PyMeshLab's PLY names textures only beside coordinates, so the mesh gets some; `copy` is empty
    afterwards.
    """
    if not copy.current_mesh().texture_number():
        return ()
    _delete_all(copy)
    native.apply(copy, "compute_texcoord_by_function_per_wedge")
    path = folder / "textures.ply"
    native.save(copy, path, save_textures=False)
    return ply.read(path).textures


def _delete_all(copy: pymeshlab.MeshSet) -> None:
    native.apply(copy, "set_selection_all")
    native.apply(copy, "meshing_remove_selected_vertices")


def shown_losses(mesh: pymeshlab.Mesh) -> list[str]:
    """What methods of `mesh` show that PyMeshLab can't put on a new mesh, as phrases."""
    found = []
    with native.muted():
        for element in ("vertex", "face"):
            with suppress(pymeshlab.MissingComponentException):
                getattr(mesh, f"{element}_curvature_principal_dir1_matrix")()
                found.append(f"the principal curvature directions per {element}")
    return found


def _lost_digits(records: ply.PlyMesh) -> Iterator[str]:
    if "radius" in (records.vertices.dtype.names or ()):
        radii = records.vertices["radius"]
        if not np.array_equal(radii.astype(np.float32), radii, equal_nan=True):
            yield "the last digits of the radii"


def _lost_names(textures: tuple[str, ...], images: dict[str, pymeshlab.Image]) -> Iterator[str]:
    missing = [n for n in dict.fromkeys(textures) if n not in images or not has_pixels(images[n])]
    # If all are missing, the mesh is loaded in another way.
    if missing and any(map(has_pixels, images.values())):
        yield f"the names of textures without an image ({', '.join(missing)})"
    odd = [name for name in textures if name != plain_name(name)]
    if odd and not is_set_by_filter(textures):
        yield f"the names of textures with other than plain characters ({', '.join(odd)})"


def has_pixels(image: pymeshlab.Image) -> bool:
    """Whether an image has any size; layers that a filter split off have textures without."""
    return image.width() > 0 and image.height() > 0


def plain_name(name: str) -> str:
    """`name` with what PyMeshLab's PLY reader can't read in percent encoding.

    It is cut to the longest name that a file can have.
    """
    plain = re.sub("[^!-|]|%", lambda odd: "".join(f"%{b:02X}" for b in odd[0].encode()), name)
    return plain if len(PurePosixPath(plain).name) <= _LONGEST_NAME else plain[-_LONGEST_NAME:]


def is_set_by_filter(names: tuple[str, ...]) -> bool:
    """Whether the name of the only texture must be set by a filter, as the PLY can't hold it."""
    return len(names) == 1 and names[0] != plain_name(names[0]) and "/" not in names[0]


def selected(records: np.ndarray) -> np.ndarray:
    """Which of the vertices or faces are selected, (count,) bool."""
    if "flags" not in (records.dtype.names or ()):
        return np.zeros(len(records), bool)
    return (records["flags"] & _SELECTED).astype(bool)
