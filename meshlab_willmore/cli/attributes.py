"""Custom attributes, which PyMeshLab saves only where it is told each by its name."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

from . import plyheader

if TYPE_CHECKING:
    import pymeshlab

# PyMeshLab's keywords: v or f, s or p, then the name in small letters.
_KEYWORD = re.compile(r"__ca_[vf][sp]__(.*)", re.DOTALL)


def of(ms: pymeshlab.MeshSet) -> tuple[str, ...]:
    """The keywords that make PyMeshLab save the attributes of the current mesh, as PLY."""
    from ..meshset import native

    return tuple(key for key in native.defaults(ms, "ply") if _KEYWORD.fullmatch(key))


def odd(file: Path, keys: Collection[str]) -> tuple[str, ...]:
    """The attributes whose names don't stand in the header of a PLY file as they should."""
    names = {_plain(found.name) for found in plyheader.read(file).properties}
    return tuple(key for key in keys if _plain(_name(key)) not in names)


def _plain(name: str) -> str:
    """A name without what PyMeshLab's keywords leave out or replace."""
    return re.sub(r"[\W_]", "", name.lower())


def _name(key: str) -> str:
    match = _KEYWORD.fullmatch(key)
    return match[1] if match else ""
