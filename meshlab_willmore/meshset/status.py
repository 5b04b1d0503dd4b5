"""What PyMeshLab prints and saves of the layers of a set, as if our filters worked in place.

It goes by its own list: with parked layers, physical ids, and replaced layers at the end.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import AnyStr

from pymeshlab import MeshSet

from . import layers, native, numbering

_COUNT = re.compile(r"(?<=\ANumber meshes: )\d+")
_STATUS = re.compile(r"^\tMesh id: .*?\n\tFull name: [^\n]*\n\n", re.MULTILINE | re.DOTALL)
_ID = re.compile(r"(?<=\A\tMesh id: )\d+")
_PROJECT = re.compile(rb"^ *<MLMesh .*?</MLMesh>\n", re.MULTILINE | re.DOTALL)


def status(ms: MeshSet, text: str) -> str:
    """The status of `ms`, of what ``print_status`` prints."""
    by_id = dict(zip(native.ids(ms), _STATUS.findall(text), strict=False))
    there = layers.visible_ids(ms)
    parts = [_ID.sub(str(numbering.logical_id(ms, i)), by_id[i]) for i in there if i in by_id]
    return _COUNT.sub(str(len(there)), _with_parts(_STATUS, text, parts))


def reorder_project(ms: MeshSet, path: Path) -> None:
    """Bring the layers in a project file of `ms` into order; hidden ones are not in it."""
    text = path.read_bytes()
    shown = [i for i in native.ids(ms) if native.mesh(ms, i).is_visible()]
    by_id = dict(zip(shown, _PROJECT.findall(text), strict=False))
    parts = [by_id[i] for i in layers.visible_ids(ms) if i in by_id]
    path.write_bytes(_with_parts(_PROJECT, text, parts))


def _with_parts(pattern: re.Pattern[AnyStr], text: AnyStr, parts: list[AnyStr]) -> AnyStr:
    """The text with other parts, of which there may be fewer."""
    new = iter(parts)
    return pattern.sub(lambda _: next(new, text[:0]), text)
