"""The header of a PLY file: its elements, their properties, and the textures it names."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

# One number or one list of them; names have no spaces.
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


class Property(NamedTuple):
    """A property of an element, with the type of its numbers."""

    element: str
    name: str
    type: str


class Header(NamedTuple):
    """What a header names; an element without entries counts for nothing."""

    properties: tuple[Property, ...]
    textures: tuple[str, ...]


def read(file: Path) -> Header:
    """The header of a PLY file, as far as it can be made out."""
    properties: list[Property] = []
    textures: list[str] = []
    element = ""
    for line in _lines(file):
        words = line.split()
        if words[:1] == ["element"]:
            element = words[1] if len(words) == 3 and words[2] != "0" else ""
        elif found := _TEXTURE.fullmatch(line):
            textures.append(found[1].strip())
        elif element and (found := _PROPERTY.fullmatch(line)):
            kind = _SYNONYMS.get(found[1], found[1])
            properties.append(Property(element, found[2], kind))
    return Header(tuple(properties), tuple(textures))


def _lines(file: Path) -> list[str]:
    lines: list[str] = []
    with file.open("rb") as stream:
        for line in stream:
            if line.rstrip() == _END or len(lines) == _MOST_LINES:
                break
            lines.append(line.rstrip(b"\r\n").decode("utf-8", errors="replace"))
    return lines
