"""All that PyMeshLab shows of a mesh, read at once.

The mesh comes as PyMeshLab's own PLY (see `ply`): its methods tell nothing of faux edges, texture
indices or radii. Custom attributes are read by the methods of `Mesh`, under their real names.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pymeshlab

from . import layers, ply

MESH_FILE = "mesh.ply"

# The bit of a selected element, the same in the flags of vertices and faces.
_SELECTED = 0x20


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


class Snapshot(NamedTuple):
    """All that PyMeshLab shows of a mesh.

    Attributes
    ----------
    ply : PlyMesh
        Positions, faces, flags, colours, scalars, radii, texture coordinates, names of textures.
    attributes : list of Attribute
        The custom attributes.
    images : dict of str to pymeshlab.Image
        The texture images by name.
    identity : layers.Identity
        Label, visibility and transform.
    unsupported : list of str
        What the mesh has and PyMeshLab offers no way to put back, as phrases.
    """

    ply: ply.PlyMesh
    attributes: list[Attribute]
    images: dict[str, pymeshlab.Image]
    identity: layers.Identity
    unsupported: list[str]

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3) float64, a copy."""
        fields = self.ply.vertices
        return np.column_stack((fields["x"], fields["y"], fields["z"]))

    @property
    def faces(self) -> np.ndarray:
        """(m, 3) int32 view of the records."""
        return self.ply.faces["vertex_indices"]

    @property
    def selected_faces(self) -> np.ndarray:
        """(m,) bool."""
        return selected(self.ply.faces)


def take(ms: pymeshlab.MeshSet) -> Snapshot:
    """Read the current mesh of `ms`; nothing of `ms` changes.

    The current mesh must have faces and be compact, as it is after every filter.
    """
    layers.forget_failures()
    mesh = ms.current_mesh()
    attribute_keys = [k for k in ms.filter_parameter_values("ply") if k.startswith("__ca_")]
    with _copied(mesh) as (copy, folder):
        path = folder / MESH_FILE
        copy.save_current_mesh(str(path), save_textures=False, **_save_flags(mesh))
        records = ply.read(path)
        attributes = _take_attributes(mesh, copy, folder, attribute_keys)
    records = records._replace(edges=mesh.edge_matrix().astype(np.int32))
    images = mesh.textures()
    unsupported = _unsupported(mesh, records, images)
    return Snapshot(records, attributes, images, layers.identity(mesh), unsupported)


@contextmanager
def _copied(mesh: pymeshlab.Mesh) -> Iterator[tuple[pymeshlab.MeshSet, Path]]:
    """A copy of `mesh` in a set of its own, and a folder; saving renames the file of a mesh."""
    with tempfile.TemporaryDirectory(prefix="meshlab_willmore_") as folder:
        copy = pymeshlab.MeshSet()
        copy.add_mesh(mesh, "copy")
        yield copy, Path(folder)


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


def _take_attributes(
    mesh: pymeshlab.Mesh, copy: pymeshlab.MeshSet, folder: Path, keys: list[str]
) -> list[Attribute]:
    if not keys:
        return []
    attributes = []
    for kind, name in _attribute_names(copy, folder, keys):
        reader, _ = ATTRIBUTE_METHODS[kind]
        attributes.append(Attribute(kind, name, getattr(mesh, reader)(name)))
    return attributes


def _attribute_names(
    copy: pymeshlab.MeshSet, folder: Path, keys: list[str]
) -> list[tuple[str, str]]:
    """Kinds and real names of the attributes, which PyMeshLab shows only as Python names.

    The header of a PLY has the real ones; all elements go first, for PyMeshLab crashes when it
    writes the values of copied attributes. `copy` is empty afterwards.
    """
    copy.set_selection_all()
    copy.meshing_remove_selected_vertices()
    path = folder / "attributes.ply"
    copy.save_current_mesh(str(path), save_textures=False, **dict.fromkeys(keys, True))
    header = path.read_bytes().decode("utf-8", "surrogateescape")
    # A dict for its order: an attribute called x stands in the header beside the coordinate.
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
            if f"__ca_{kind}__{_python_name(found[1])}" in keys:
                names[kind, found[1]] = None
    return list(names)


def _python_name(name: str) -> str:
    """PyMeshLab's rule that turns a name of MeshLab's into one of Python's."""
    return re.sub(r"[().,'\":+]+", "", re.sub(r"[ /-]", "_", name.lower()))


def _unsupported(
    mesh: pymeshlab.Mesh, records: ply.PlyMesh, images: dict[str, pymeshlab.Image]
) -> list[str]:
    found = []
    for element in ("vertex", "face"):
        with layers.muted(), suppress(pymeshlab.MissingComponentException):
            getattr(mesh, f"{element}_curvature_principal_dir1_matrix")()
            found.append(f"the principal curvature directions per {element}")
    missing = [name for name in records.textures if name not in images]
    if missing:
        found.append(f"the names of textures without an image ({', '.join(missing)})")
    spaced = [name for name in records.textures if _is_spaced(name)]
    if spaced and not is_set_by_filter(records.textures):
        found.append(f"several textures with white space in a name ({', '.join(spaced)})")
    return found


def _is_spaced(name: str) -> bool:
    return len(name.split()) != 1


def is_set_by_filter(names: tuple[str, ...]) -> bool:
    """Whether the texture must and can be named by a filter; the PLY reader stops at a space."""
    return len(names) == 1 and _is_spaced(names[0]) and "/" not in names[0]


def selected(records: np.ndarray) -> np.ndarray:
    """Which of the vertices or faces are selected, (count,) bool."""
    return (records["flags"] & _SELECTED).astype(bool)
