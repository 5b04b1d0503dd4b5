"""What the ids of a set's layers would be if our filters worked in place, as MeshLab's do.

A flipped mesh can be a new layer with a new id, and helper layers use up ids too. Filter scripts
speak of layers by id, and are to be run on other sets: in them, ids count as if none of that
happened. Such an id is called *logical* here, and one that the set shows *physical*.
"""

from __future__ import annotations

import operator
from bisect import bisect_left
from collections.abc import Mapping
from typing import Any, NamedTuple

from pymeshlab import MeshSet

from . import native


class _Numbering(NamedTuple):
    """By set: ids that our filters used up, ascending, and which layer each took the place of."""

    used: tuple[int, ...] = ()
    replaced: tuple[tuple[int, int], ...] = ()


_numberings: native.PerSet[_Numbering] = native.PerSet(_Numbering())


def note_used(ms: MeshSet, mesh_id: int) -> None:
    """Remember that a helper layer used up an id."""
    numbering = _numberings.get(ms)
    _numberings.put(ms, numbering._replace(used=(*numbering.used, mesh_id)))


def note_replaced(ms: MeshSet, old_id: int, new_id: int) -> None:
    """Remember that a new layer took the place of another."""
    note_used(ms, new_id)
    numbering = _numberings.get(ms)
    _numberings.put(ms, numbering._replace(replaced=(*numbering.replaced, (new_id, old_id))))


def forget(ms: MeshSet) -> None:
    """Start anew, with a set that was emptied."""
    if _numberings.get(ms) != _Numbering():
        _numberings.put(ms, _Numbering())


def has_moved(ms: MeshSet) -> bool:
    """Whether there are layers whose logical and physical ids differ, or can come to."""
    return bool(_numberings.get(ms).used)


def logical_id(ms: MeshSet, mesh_id: int) -> int:
    """The logical id of the layer with physical id `mesh_id`."""
    numbering = _numberings.get(ms)
    older = dict(numbering.replaced)
    while mesh_id in older:
        mesh_id = older[mesh_id]
    return mesh_id - bisect_left(numbering.used, mesh_id)


def physical_id(ms: MeshSet, mesh_id: int) -> int | None:
    """The physical id of the layer with logical id `mesh_id`; the newest, None if there is none."""
    there = [i for i in native.ids(ms) if logical_id(ms, i) == mesh_id]
    return max(there, default=None)


def redirected(ms: MeshSet, given: Mapping[str, Any]) -> dict[str, Any]:
    """Keywords of a native call in which ids of replaced layers are those of the layers now there.

    PyMeshLab crashes on the id of a layer that is gone, and that it is gone is our doing.
    """
    newer = {old: new for new, old in _numberings.get(ms).replaced}
    return {key: _newest(ms, newer, key, value) for key, value in given.items()}


def _newest(ms: MeshSet, newer: Mapping[int, int], keyword: str, value: Any) -> Any:
    # All of PyMeshLab's parameters that are mesh ids, and no others of whole numbers, end so.
    if not keyword.endswith("mesh") or isinstance(value, bool):
        return value
    try:
        mesh_id = operator.index(value)
    except TypeError:
        return value
    while mesh_id in newer and not ms.mesh_id_exists(mesh_id):
        mesh_id = newer[mesh_id]
    return mesh_id
