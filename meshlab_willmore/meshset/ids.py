"""Logical and physical ids of layers: callers count as if our filters worked in place.

A flipped mesh can be a new layer with a new id, and helper layers use up ids too. Callers, loops
and filter scripts need not know: the ids that they see are *logical*, PyMeshLab's own *physical*. A
layer keeps its logical id as long as it exists, and so does the layer that takes its place.
"""

from __future__ import annotations

import operator
from bisect import bisect_left, bisect_right
from typing import Any, NamedTuple

import pymeshlab
from pymeshlab import MeshSet

from . import native


class _Ids(NamedTuple):
    """The ids of a set.

    `used` are the physical ids that our filters used up, ascending; `origins` the logical ids of
    layers that took the place of others, by physical id; `newest` the last such layer, by logical
    id.
    """

    used: tuple[int, ...]
    origins: dict[int, int]
    newest: dict[int, int]


_UNMOVED = _Ids((), {}, {})
_ids: native.PerSet[_Ids] = native.PerSet(_UNMOVED)
# By `Mesh` object that a caller got: its logical id, where that is not the physical one.
_noted: native.PerSet[int | None] = native.PerSet(None)


def note_used(ms: MeshSet, mesh_id: int) -> None:
    """Remember that a helper layer used up a physical id."""
    of_set = _ids.get(ms)
    _ids.put(ms, of_set._replace(used=(*of_set.used, mesh_id)))


def note_replaced(ms: MeshSet, old_id: int, new_id: int) -> None:
    """Remember that a new layer took the place of another; the ids are physical."""
    logical = logical_id(ms, old_id)
    note_used(ms, new_id)
    used, origins, newest = _ids.get(ms)
    _ids.put(ms, _Ids(used, {**origins, new_id: logical}, {**newest, logical: new_id}))


def forget(ms: MeshSet) -> None:
    """Start again, with a set that was emptied."""
    if has_moved(ms):
        _ids.put(ms, _UNMOVED)


def has_moved(ms: MeshSet) -> bool:
    """Whether there are layers whose logical and physical ids differ, or can differ later."""
    return bool(_ids.get(ms).used)


def logical_id(ms: MeshSet, mesh_id: int) -> int:
    """The logical id of the layer with physical id `mesh_id`."""
    used, origins, _ = _ids.get(ms)
    if mesh_id in origins:
        return origins[mesh_id]
    return mesh_id - bisect_left(used, mesh_id)


def physical_id(ms: MeshSet, mesh_id: int) -> int | None:
    """The physical id of the layer with logical id `mesh_id`; None if there is none.

    Where a layer took the place of another that is still there, it is the new one.
    """
    used, _, newest = _ids.get(ms)
    physical = newest.get(mesh_id)
    if physical is None:
        physical = mesh_id
        while physical != mesh_id + bisect_right(used, physical):
            physical = mesh_id + bisect_right(used, physical)
    return physical if _fits_int32(physical) and native.is_there(ms, physical) else None


def _fits_int32(number: int) -> bool:
    return 0 <= number < 2**31


def physical_of(ms: MeshSet, value: Any) -> Any:
    """The physical id for a logical one that a caller gave; `NO_LAYER` if there is no such layer.

    What is no whole number comes back as it is: PyMeshLab refuses it.
    """
    try:
        mesh_id = operator.index(value)
    except TypeError:
        return value
    physical = physical_id(ms, mesh_id)
    return native.NO_LAYER if physical is None else physical


def is_absent(physical: Any) -> bool:
    """Whether `physical_of` has found no layer."""
    return isinstance(physical, int) and physical == native.NO_LAYER


def note(ms: MeshSet, mesh: pymeshlab.Mesh) -> None:
    """Remember the logical id of a `Mesh` object that a caller gets."""
    # The object can have belonged to another layer, at the same place of memory.
    if has_moved(ms) or _noted.get(mesh) is not None:
        _noted.put(mesh, logical_id(ms, native.id_of(mesh)))


def noted_id(mesh: pymeshlab.Mesh) -> int | None:
    """The logical id of a `Mesh` object, where it was noted."""
    return _noted.get(mesh)
