"""Custom attributes, which PyMeshLab saves only where it is told each by its name."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pymeshlab

# PyMeshLab's keywords: v or f, s or p, then the name in small letters.
_KEYWORD = re.compile(r"__ca_[vf][sp]__(.*)", re.DOTALL)
# A line of a PLY header for one number or one list of them; names have no spaces.
_PROPERTY = re.compile(r"property (?:list \S+ )?\S+ (\S+)")
_END = b"end_header"


def of(ms: pymeshlab.MeshSet) -> tuple[str, ...]:
    """The keywords that make PyMeshLab save the attributes of the current mesh, as PLY."""
    from ..meshset import native

    return tuple(key for key in native.defaults(ms, "ply") if _KEYWORD.fullmatch(key))


def odd(file: Path, keys: Collection[str]) -> tuple[str, ...]:
    """The attributes whose names don't stand in the header of a PLY file as they should."""
    found = (_PROPERTY.fullmatch(line) for line in _header(file))
    names = {_plain(match[1]) for match in found if match}
    return tuple(key for key in keys if _plain(_name(key)) not in names)


def _plain(name: str) -> str:
    """A name without what PyMeshLab's keywords leave out or replace."""
    return re.sub(r"[\W_]", "", name.lower())


def _header(file: Path) -> list[str]:
    lines = []
    with file.open("rb") as stream:
        for line in stream:
            if line.rstrip() == _END:
                break
            lines.append(line.rstrip(b"\r\n").decode("utf-8", errors="replace"))
    return lines


def _name(key: str) -> str:
    match = _KEYWORD.fullmatch(key)
    return match[1] if match else ""
