"""What a mesh file holds that PyMeshLab does not read, as messages.

PyMeshLab's verbose log has most of it; the properties of PLY files that it reads are those in
vcglib's ``import_ply.h``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from . import formats

if TYPE_CHECKING:
    import pymeshlab

_NO_TEXTURE = re.compile(r"Failed loading (.*); using a dummy texture")
_LEFT_OUT = re.compile(r"mesh contains (\d+) vertices with NAN coords and (\d+) degenerated faces")
# In the log of a load that succeeded: what went wrong.
_DETAILS = re.compile(r"Error details: (.+)")
_IGNORED = "faces ignored"
_SKIPPED = re.compile(r"error: skip line")

_MATERIALS = re.compile(rb"^[ \t]*mtllib[ \t]+(\S[^\r\n]*?)[ \t\r]*$", re.MULTILINE)
# Textures with options or blanks in the name, which PyMeshLab reads as no name at all.
_TEXTURES = re.compile(rb"^[ \t]*map_Kd[ \t]+(\S+[ \t][^\r\n]*?)[ \t\r]*$", re.MULTILINE)
# Images of a material beside its colour, of which PyMeshLab reads none.
_MAPS = re.compile(
    rb"^[ \t]*((?:map_(?!Kd\b)\w+|bump|disp|decal|norm|refl))[ \t]+(\S[^\r\n]*?)[ \t\r]*$",
    re.MULTILINE | re.IGNORECASE,
)
# Counting is far quicker than a regular expression.
_FACES = (b"\nf ", b"\nf\t")

# Formats that PyMeshLab reads in single precision.
_SINGLE = (".stl", ".wrl", ".x3d", ".dae")
_NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?(?![\w.])")


def losses(path: Path, printed: Iterable[str], mesh: pymeshlab.Mesh) -> Iterator[str]:
    """What of a file was not read into `mesh`, one message for each kind.

    `printed` are the lines that PyMeshLab printed meanwhile.
    """
    lines = list(printed)
    ending = path.suffix.lower()
    yield from _textures(path, _all(_NO_TEXTURE, lines))
    left_out = [found.groups() for line in lines if (found := _LEFT_OUT.search(line))]
    vertices, faces = (sum(int(counts[i]) for counts in left_out) for i in (0, 1))
    if vertices:
        yield f"vertices with NaN or infinite coordinates, left out with their faces: {vertices}"
    if faces:
        yield f"faces with a corner twice, left out: {faces}"
    if ending == ".obj":
        yield from _unread_maps(path)
        # PyMeshLab does not count the faces that it left out with vertices or ignored.
        if not vertices and not any(_IGNORED in line for line in lines):
            data = _data(path)
            lost = sum(map(data.count, _FACES)) - faces - mesh.face_number()
            if lost > 0:
                yield f"faces with vertices that do not exist, left out: {lost}"
    details = [text.strip() for text in _all(_DETAILS, lines)]
    yield from dict.fromkeys(text[:1].lower() + text[1:] for text in details)
    skipped = sum(bool(_SKIPPED.search(line)) for line in lines)
    if skipped:
        yield f"lines that are no points, left out: {skipped}"
    if ending in _SINGLE and formats.is_far(mesh.vertex_matrix()) and _merges_numbers(path):
        yield "so far from the origin, different coordinates become the same in single precision"
    if ending == ".ply":
        yield from _unread_properties(path)
    elif ending == ".stl" and _ends_early(path):
        yield "it ends before its endsolid; what comes after is missing"


def _all(pattern: re.Pattern[str], lines: Iterable[str]) -> list[str]:
    return [found[1] for line in lines if (found := pattern.search(line))]


def _data(path: Path) -> bytes:
    """The content of a file; nothing if it can't be read."""
    try:
        return path.read_bytes()
    except OSError:
        return b""


# --- textures and materials --------------------------------------------------------------------


def _textures(path: Path, missing: list[str]) -> Iterator[str]:
    if not missing:
        return
    names, odd = _missing_names(path, missing)
    if names:
        yield f"textures that were not found, and became dummy.png: {', '.join(names)}"
    if odd:
        yield f"textures with blanks in the name, which PyMeshLab can't read: {', '.join(odd)}"
    elif "" in missing:
        yield "textures without a name, which became dummy.png"


def _missing_names(path: Path, missing: list[str]) -> tuple[list[str], list[str]]:
    """The missing textures as the file names them: usual names, and names with blanks."""
    odd: list[str] = []
    if path.suffix.lower() == ".ply":
        # PyMeshLab removes the blanks.
        _, textures = ply_header(path)
        odd = [name for name in textures if " " in name and name.replace(" ", "") in missing]
    elif path.suffix.lower() == ".obj" and "" in missing:
        for file in _material_files(path):
            found = dict.fromkeys(name.strip() for name in _TEXTURES.findall(_data(file)))
            odd += [name.decode("utf-8", "replace") for name in found if b" " in name]
    without_blanks = {text.replace(" ", "") for text in odd}
    names = [name for name in dict.fromkeys(missing) if name and name not in without_blanks]
    return names, odd


def _unread_maps(path: Path) -> Iterator[str]:
    """Images of materials that are not read, unless they are the colour's as well."""
    maps: dict[str, str] = {}
    for file in _material_files(path):
        data = _data(file)
        for kind, name in _MAPS.findall(data):
            if not re.search(rb"^[ \t]*map_Kd[ \t]+" + re.escape(name) + rb"[ \t\r]*$", data, re.M):
                maps.setdefault(name.decode("utf-8", "replace"), kind.decode())
    if maps:
        names = ", ".join(f"{name} ({kind})" for name, kind in maps.items())
        yield f"images of materials that PyMeshLab does not read: {names}"


def _material_files(path: Path) -> list[Path]:
    data = _data(path)
    found = _MATERIALS.findall(data) if b"mtllib" in data else []
    return [path.parent / name.decode("utf-8", "surrogateescape") for name in dict.fromkeys(found)]


# --- PLY ---------------------------------------------------------------------------------------

# One number or one list of them; names have no blanks.
_PROPERTY = re.compile(r"property (?:list \S+ )?(\S+) (\S+)")
_TEXTURE = re.compile(r"comment TextureFile (.+)", re.IGNORECASE)
_END = b"end_header"
# No header of a mesh is so long.
_MOST_LINES = 10_000
_SYNONYMS = {
    "int8": "char",
    "uint8": "uchar",
    "int16": "short",
    "uint16": "ushort",
    "int32": "int",
    "uint32": "uint",
    "float32": "float",
    "float64": "double",
}

_COLOURS = ("red", "green", "blue", "alpha")
_NUMBERS = ("float", "double")
# Element and property, and the types of numbers that PyMeshLab reads. It reads a "confidence" as
# well, but makes other numbers of it.
_READ: dict[tuple[str, str], tuple[str, ...]] = {
    **{("vertex", name): _NUMBERS for name in ("x", "y", "z", "nx", "ny", "nz")},
    **{("vertex", name): _NUMBERS for name in ("quality", "radius", "texture_u", "texture_v")},
    **{("vertex", name): ("float",) for name in ("texture_w", "intensity", "s", "t")},
    **{("vertex", name): ("uchar",) for name in _COLOURS},
    **{("vertex", f"diffuse_{name}"): ("uchar",) for name in _COLOURS},
    ("vertex", "flags"): ("int",),
    **{("face", name): _NUMBERS for name in ("nx", "ny", "nz", "quality")},
    **{("face", name): ("uchar",) for name in _COLOURS},
    **{("face", name): ("int", "uint", "short") for name in ("vertex_indices", "vertex_index")},
    **{("face", name): ("float",) for name in ("texcoord", "color")},
    **{("face", name): ("int",) for name in ("flags", "texnumber")},
    **{("edge", name): ("int", "uint") for name in ("vertex1", "vertex2")},
    ("tristrips", "vertex_indices"): ("int",),
    ("range_grid", "vertex_indices"): ("int",),
}
# The point of view of a scan, which is no part of the surface.
_NO_SURFACE = "camera"


class Property(NamedTuple):
    """A property of an element, with the type of its numbers."""

    element: str
    name: str
    type: str


def ply_header(file: Path) -> tuple[list[Property], list[str]]:
    """The properties of all elements of a PLY file that are not empty, and its textures."""
    properties: list[Property] = []
    textures: list[str] = []
    element = ""
    with file.open("rb") as stream:
        for number, data in enumerate(stream):
            if data.rstrip() == _END or number == _MOST_LINES:
                break
            line = data.rstrip(b"\r\n").decode("utf-8", errors="replace")
            words = line.split()
            if words[:1] == ["element"]:
                element = words[1] if len(words) == 3 and words[2] != "0" else ""
            elif found := _TEXTURE.fullmatch(line):
                textures.append(found[1].strip())
            elif element and (found := _PROPERTY.fullmatch(line)):
                kind = _SYNONYMS.get(found[1], found[1])
                properties.append(Property(element, found[2], kind))
    return properties, textures


def _unread_properties(path: Path) -> Iterator[str]:
    properties, _ = ply_header(path)
    unread = [
        f"{found.name} ({found.element}, {found.type})"
        for found in properties
        if found.element != _NO_SURFACE
        and found.type not in _READ.get((found.element, found.name), ())
    ]
    if unread:
        yield f"properties that PyMeshLab does not read: {', '.join(unread)}"


# --- texts -------------------------------------------------------------------------------------


def _merges_numbers(path: Path) -> bool:
    """Whether different numbers of a text are the same in single precision."""
    import numpy as np

    data = path.read_bytes()
    if b"\0" in data:
        return False
    numbers = np.array(sorted(set(_NUMBER.findall(data))), dtype=np.float64)
    with np.errstate(over="ignore"):
        return len(np.unique(numbers.astype(np.float32))) < len(np.unique(numbers))


def _ends_early(path: Path) -> bool:
    """Whether a text file of STL has no end."""
    with path.open("rb") as file:
        if not file.read(6).lstrip().lower().startswith(b"solid"):
            return False
        file.seek(0, 2)
        file.seek(-min(file.tell(), 1000), 1)
        end = file.read()
    return b"\0" not in end and b"endsolid" not in end.lower()
