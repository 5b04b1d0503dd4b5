"""Reading and writing the binary PLY of MeshLab as NumPy records.

Only by PLY does PyMeshLab import and export a mesh as a whole: with flags (selection, faux edges),
several textures with an index per face, and radii. The module reads what MeshLab's own writer
writes of a triangle mesh: little-endian scalar properties, and lists of one fixed length.
"""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np

SCALARS = {
    "char": "i1",
    "uchar": "u1",
    "short": "<i2",
    "ushort": "<u2",
    "int": "<i4",
    "uint": "<u4",
    "float": "<f4",
    "double": "<f8",
}
_LIST_LENGTHS = {"vertex_indices": 3, "texcoord": 6}
_COUNT_SUFFIX = "_count"
_TEXTURE_COMMENT = "comment TextureFile "
_ROWS = 4096
_END = b"end_header\n"


class PlyMesh(NamedTuple):
    """A triangle mesh as PLY records.

    Attributes
    ----------
    vertices, faces : structured ndarray
        One record an element, one field a property. A list property ``p`` of fixed length k is
        a field of shape (k,) behind a field ``p_count``.
    edges : (e, 2) int32 ndarray
        The edge elements (polylines), not the sides of the faces.
    textures : tuple of str
        Names of the texture images, in the order that ``texnumber`` counts.
    """

    vertices: np.ndarray
    faces: np.ndarray
    edges: np.ndarray
    textures: tuple[str, ...]


class _Element(NamedTuple):
    name: str
    size: int
    fields: list[tuple]


def _parse_header(lines: list[str]) -> tuple[list[_Element], tuple[str, ...]]:
    elements: list[_Element] = []
    textures = []
    for line in lines:
        if line.startswith(_TEXTURE_COMMENT):
            textures.append(line[len(_TEXTURE_COMMENT) :])
            continue
        words = line.split()
        if words[:1] == ["element"]:
            elements.append(_Element(words[1], int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            name = words[4]
            elements[-1].fields.append((name + _COUNT_SUFFIX, SCALARS[words[2]]))
            elements[-1].fields.append((name, SCALARS[words[3]], (_LIST_LENGTHS[name],)))
        elif words[:1] == ["property"]:
            elements[-1].fields.append((words[2], SCALARS[words[1]]))
    return elements, tuple(textures)


def read(path: Path) -> PlyMesh:
    """Read a triangle mesh that MeshLab wrote as binary PLY.

    Raises
    ------
    ValueError
        If a list has another length than a triangle's, or the file ends early.
    KeyError
        If a property has an unknown type or is an unknown list.
    """
    with path.open("rb") as file:
        elements, textures = _parse_header(_header(file))
        blocks = {element.name: _block(file, element) for element in elements}
    return PlyMesh(blocks["vertex"], blocks["face"], np.empty((0, 2), np.int32), textures)


def _header(file: BinaryIO) -> list[str]:
    """The lines of the header; afterwards the file is at the first element."""
    lines: list[str] = []
    for line in file:
        if line == _END:
            return lines
        lines.append(line.decode("utf-8", "surrogateescape").rstrip("\n"))
    raise ValueError(f"{Path(file.name).name} has no whole header; is the disk full?")


def _block(file: BinaryIO, element: _Element) -> np.ndarray:
    records = np.fromfile(file, np.dtype(element.fields), element.size)
    if len(records) < element.size:
        raise ValueError(f"{Path(file.name).name} ends early; is the disk full?")
    for name, length in _LIST_LENGTHS.items():
        counts = name + _COUNT_SUFFIX
        if counts in (records.dtype.names or ()) and (records[counts] != length).any():
            raise ValueError(
                f"{Path(file.name).name}: a list {name} does not have {length} entries"
            )
    return records


def records(columns: dict[str, np.ndarray], fields: list[tuple] | np.dtype) -> np.ndarray:
    """Records with the fields of a dtype, from a column for each."""
    count = len(next(iter(columns.values())))
    new = np.empty(count, fields)
    # A block of rows stays in the processor's cache for all columns.
    for start in range(0, count, _ROWS):
        rows = slice(start, start + _ROWS)
        for name, values in columns.items():
            new[name][rows] = values[rows]
    return new


def _type_name(dtype: np.dtype) -> str:
    return next(name for name, code in SCALARS.items() if np.dtype(code) == dtype)


@functools.cache
def _properties(records: np.dtype) -> list[str]:
    lines = []
    fields: Any = records.fields
    for name in records.names or ():
        if name.endswith(_COUNT_SUFFIX):
            continue
        dtype = fields[name][0]
        if dtype.subdtype:
            count = fields[name + _COUNT_SUFFIX][0]
            item = dtype.subdtype[0]
            lines.append(f"property list {_type_name(count)} {_type_name(item)} {name}")
        else:
            lines.append(f"property {_type_name(dtype)} {name}")
    return lines


def write(path: Path, mesh: PlyMesh) -> None:
    """Write `mesh` to `path`, in the form that `read` and MeshLab read."""
    edges = np.ascontiguousarray(mesh.edges, "<i4")
    header = ["ply", "format binary_little_endian 1.0"]
    header += [_TEXTURE_COMMENT + name for name in mesh.textures]
    header += [f"element vertex {len(mesh.vertices)}", *_properties(mesh.vertices.dtype)]
    header += [f"element face {len(mesh.faces)}", *_properties(mesh.faces.dtype)]
    if len(edges):
        header += [f"element edge {len(edges)}", "property int vertex1", "property int vertex2"]
    with path.open("wb") as file:
        file.write("\n".join(header).encode("utf-8", "surrogateescape") + b"\n" + _END)
        for block in (mesh.vertices, mesh.faces, edges):
            file.write(np.ascontiguousarray(block).data)
