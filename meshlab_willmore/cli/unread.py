"""What a file holds and the mesh that PyMeshLab makes of it does not, in words.

PyMeshLab's verbose log tells most of it; which properties of a PLY file it knows is written in
vcglib's ``import_ply.h``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from . import plyheader, unheld

if TYPE_CHECKING:
    import pymeshlab

_NO_TEXTURE = re.compile(r"Failed loading (.*); using a dummy texture")
_LEFT_OUT = re.compile(r"mesh contains (\d+) vertices with NAN coords and (\d+) degenerated faces")
# Of a load that succeeded: what went wrong and was no obstacle.
_DETAILS = re.compile(r"Error details: (.+)")
_IGNORED = "faces ignored"
_SKIPPED = re.compile(r"error: skip line")

_MATERIALS = re.compile(rb"^[ \t]*mtllib[ \t]+(\S[^\r\n]*?)[ \t\r]*$", re.MULTILINE)
# Options of a texture and names with blanks, which PyMeshLab reads as no name at all.
_TEXTURES = re.compile(rb"^[ \t]*map_Kd[ \t]+(\S+[ \t][^\r\n]*?)[ \t\r]*$", re.MULTILINE)

# Images of a material beside its colour, of which PyMeshLab reads none.
_MAPS = re.compile(
    rb"^[ \t]*((?:map_(?!Kd\b)\w+|bump|disp|decal|norm|refl))[ \t]+(\S[^\r\n]*?)[ \t\r]*$",
    re.MULTILINE | re.IGNORECASE,
)
# Far quicker to count than with a regular expression.
_FACES = (b"\nf ", b"\nf\t")

# Texts that PyMeshLab reads in single precision.
_SINGLE = (".stl", ".wrl", ".x3d", ".dae")
_NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?(?![\w.])")

_COLOURS = ("red", "green", "blue", "alpha")
_NUMBERS = ("float", "double")
# Element and property, and the types of numbers in which PyMeshLab takes it. It takes a
# "confidence" as well, but makes other numbers of it.
_KNOWN: dict[tuple[str, str], tuple[str, ...]] = {
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
# Where it was looked at from, which is no part of the surface.
_NO_SURFACE = "camera"


def losses(path: Path, printed: Iterable[str], mesh: pymeshlab.Mesh) -> Iterator[str]:
    """What was left out, a text for each kind.

    Parameters
    ----------
    path : Path
        The file that was loaded.
    printed : iterable of str
        What PyMeshLab printed meanwhile.
    mesh : pymeshlab.Mesh
        What PyMeshLab made of it.
    """
    lines = list(printed)
    yield from _textures(path, [found[1] for line in lines if (found := _NO_TEXTURE.search(line))])
    yield from _elements(lines)
    if path.suffix.lower() == ".obj":
        yield from _maps(path)
        yield from _corners_without_vertex(path, lines, mesh.face_number())
    details = [found[1].strip() for line in lines if (found := _DETAILS.search(line))]
    yield from dict.fromkeys(text[:1].lower() + text[1:] for text in details)
    skipped = sum(bool(_SKIPPED.search(line)) for line in lines)
    if skipped:
        yield f"lines that are no points, left out: {skipped}"
    ending = path.suffix.lower()
    is_far = ending in _SINGLE and unheld.is_far(mesh.vertex_matrix())
    if is_far and _numbers_fall_together(path):
        yield "so far from the origin, different coordinates become the same in single precision"
    if ending == ".ply":
        yield from _properties(path)
    elif ending == ".stl" and _ends_early(path):
        yield "it ends before its endsolid; what comes after is missing"


def _elements(lines: Iterable[str]) -> Iterator[str]:
    counts = [found for line in lines if (found := _LEFT_OUT.search(line))]
    vertices = sum(int(found[1]) for found in counts)
    faces = sum(int(found[2]) for found in counts)
    if vertices:
        yield f"vertices with NaN or infinite coordinates, left out with their faces: {vertices}"
    if faces:
        yield f"faces with a corner twice, left out: {faces}"


def _textures(path: Path, missing: list[str]) -> Iterator[str]:
    if not missing:
        return
    names, odd = _names(path, missing)
    if names:
        yield f"textures that were not found, and became dummy.png: {', '.join(names)}"
    if odd:
        yield f"textures with blanks in the name, which PyMeshLab can't read: {', '.join(odd)}"
    elif "" in missing:
        yield "textures without a name, which became dummy.png"


def _names(path: Path, missing: list[str]) -> tuple[list[str], list[str]]:
    """The names of missing textures as the file has them: the usual ones, and those with blanks."""
    ending = path.suffix.lower()
    odd: list[str] = []
    if ending == ".ply":
        # PyMeshLab leaves blanks out.
        names = [name for name in plyheader.read(path).textures if " " in name]
        odd = [name for name in names if name.replace(" ", "") in missing]
    elif ending == ".obj" and "" in missing:
        odd = [text for file in _material_files(path) for text in _odd_textures(file)]
    told = {text.replace(" ", "") for text in odd}
    names = [name for name in dict.fromkeys(missing) if name and name not in told]
    return names, odd


def _maps(path: Path) -> Iterator[str]:
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


def _corners_without_vertex(path: Path, lines: list[str], loaded: int) -> Iterator[str]:
    """Faces that were left out without a word, where there are fewer than lines for them."""
    counts = [found for line in lines if (found := _LEFT_OUT.search(line))]
    # How many faces went with vertices, or were ignored, is not told.
    if any(int(found[1]) for found in counts) or any(_IGNORED in line for line in lines):
        return
    data = _data(path)
    lines_of_faces = sum(map(data.count, _FACES))
    lost = lines_of_faces - sum(int(found[2]) for found in counts) - loaded
    if lost > 0:
        yield f"faces with vertices that are not there, left out: {lost}"


def _material_files(path: Path) -> list[Path]:
    data = _data(path)
    found = _MATERIALS.findall(data) if b"mtllib" in data else []
    names = [name.decode("utf-8", "surrogateescape") for name in found]
    return [path.parent / name for name in dict.fromkeys(names)]


def _odd_textures(file: Path) -> list[str]:
    names = [found.strip() for found in _found(_TEXTURES, file)]
    return [name.decode("utf-8", "replace") for name in dict.fromkeys(names) if b" " in name]


def _found(pattern: re.Pattern[bytes], path: Path) -> list[bytes]:
    return pattern.findall(_data(path))


def _data(path: Path) -> bytes:
    """The content of a file; nothing where there is none."""
    try:
        return path.read_bytes()
    except OSError:
        return b""


def _properties(path: Path) -> Iterator[str]:
    unknown = [
        found
        for found in plyheader.read(path).properties
        if found.element != _NO_SURFACE
        and found.type not in _KNOWN.get((found.element, found.name), ())
    ]
    if unknown:
        names = ", ".join(f"{p.name} ({p.element}, {p.type})" for p in unknown)
        yield f"properties that PyMeshLab does not read: {names}"


def _numbers_fall_together(path: Path) -> bool:
    """Whether numbers of a text are different, and the same in single precision."""
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
