"""Replacing a layer of a `MeshSet`, without freeing memory that a held `Mesh` object points to.

PyMeshLab edits a mesh in place only from C++, so a mesh with other faces is a new layer. If the set
has only that mesh and no `Mesh` object of it is held, the set is emptied and filled again.
Otherwise the new layer goes to the end of PyMeshLab's list with an id of its own, and keeps the old
one as its logical id (see `ids`). If a `Mesh` object of the old layer is held, that layer is
*parked*: hidden, left out when layers are counted, iterated over or found by id, and deleted when
the object is gone (`sweep`).
"""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pymeshlab
from pymeshlab import MeshSet

from . import ids, interrupts, native

# A set that has seen more layers than this gives the new mesh a new id.
_MOST_IDS_TO_REBUILD = 1000
# The older one of the garbage collector's generations that it collects often.
_YOUNG = 1

_UNMOVED = np.eye(4)

# By set: the ids of the parked layers. Ids are physical in this module.
_parked: native.PerSet[frozenset[int]] = native.PerSet(frozenset())


class Identity(NamedTuple):
    """Label, visibility and (4, 4) transform of a layer."""

    label: str
    visible: bool
    transform: np.ndarray


def identity_of(mesh: pymeshlab.Mesh) -> Identity:
    """The identity of `mesh`."""
    return Identity(mesh.label(), mesh.is_visible(), mesh.transform_matrix())


def _is_alone_and_free(ms: MeshSet) -> bool:
    """Whether the current mesh is all there is in `ms`, and no `Mesh` object of it is held."""
    alone = len(native.ids(ms)) == 1 and ms.raster_number() == 0
    return alone and not _is_held(ms, native.ids(ms)[0])


def replace_current(
    ms: MeshSet,
    load: Callable[[MeshSet], None],
    reload: Callable[[MeshSet], None],
    identity: Identity,
    by_copies: bool = False,
    by_filters: bool = False,
) -> None:
    """Replace the current layer of `ms` by one that `load` adds.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
        Changed in place: afterwards the new layer is current and has `identity` and the logical
        id of the old one. If `load` fails, the set is as it was.
    load : callable
        Called with `ms`; must add one layer and make it current.
    reload : callable
        Adds the old layer again in the same way, if `load` fails.
    identity : Identity
        Label, visibility and transform of the new layer.
    by_copies : bool
        Whether `load` uses up more than one id, and notes the others.
    by_filters : bool
        Whether `load` or `reload` applies filters.
    """
    old_id = _current_id(ms)
    alone = not by_copies and _is_alone_and_free(ms)
    with interrupts.deferred(), native.without_trace(ms):
        if not alone or by_filters or _is_moved(identity):
            native.keep_script(ms)
        next_id = _use_up_id(ms) if alone else None
        if next_id is not None and next_id <= _MOST_IDS_TO_REBUILD:
            try:
                _refill(ms, old_id, next_id, load)
            except BaseException:
                _refill(ms, old_id, next_id, reload)
                _identify(ms, identity)
                raise
        else:
            if next_id is not None:
                native.make_current(ms, old_id)
                delete(ms, next_id)
                ids.note_used(ms, next_id)
            _add(ms, load)
            ids.note_replaced(ms, old_id, _current_id(ms))
            _retire(ms, old_id)
        _identify(ms, identity)


def _refill(ms: MeshSet, wanted_id: int, next_id: int, load: Callable[[MeshSet], None]) -> None:
    """Empty the set and load; ids start again at 0, so placeholder layers use up the others."""
    native.clear(ms)
    for _ in range(wanted_id):
        _add_placeholder(ms)
    load(ms)
    for _ in range(wanted_id + 1, next_id):
        _add_placeholder(ms)
    if next_id > 1:
        native.apply(ms, "delete_non_visible_meshes")
        native.make_current(ms, wanted_id)


def _add_placeholder(ms: MeshSet) -> int:
    """Add a hidden layer of one point, which becomes the current one; its id."""
    native.add(ms, pymeshlab.Mesh(np.zeros((1, 3))))
    native.show(ms, _current_id(ms), False)
    return _current_id(ms)


def _use_up_id(ms: MeshSet) -> int:
    """The id that the next layer would have had, which is used up for a placeholder."""
    current = _current_id(ms)
    next_id = _add_placeholder(ms)
    if next_id > 1:
        # Filters will delete it and others.
        try:
            native.keep_script(ms)
        except OSError:
            native.make_current(ms, current)
            _park(ms, next_id)
            ids.note_used(ms, next_id)
            raise
    return next_id


def _add(ms: MeshSet, load: Callable[[MeshSet], None]) -> None:
    """Load a layer beside the others; if that fails, leave the set as it was."""
    current, before = _current_id(ms), native.ids(ms)
    try:
        load(ms)
    except BaseException:
        for mesh_id in sorted(set(native.ids(ms)) - set(before)):
            ids.note_used(ms, mesh_id)
            native.make_current(ms, mesh_id)
            native.apply(ms, "delete_current_mesh")
        native.make_current(ms, current)
        raise


def _retire(ms: MeshSet, old_id: int) -> None:
    """Delete the old layer, or park it as long as a `Mesh` object of it is held."""
    if _is_held(ms, old_id):
        _park(ms, old_id)
    else:
        delete(ms, old_id)


def delete(ms: MeshSet, mesh_id: int) -> None:
    """Delete a layer that is not the current one, by its physical id."""
    current = native.current_id(ms)
    native.make_current(ms, mesh_id)
    native.apply(ms, "delete_current_mesh")
    native.make_current(ms, current)


def _identify(ms: MeshSet, identity: Identity) -> None:
    label, visible, transform = identity
    native.current_mesh(ms).set_label(label)
    native.show(ms, _current_id(ms), visible)
    if _is_moved(identity):
        native.apply(ms, "set_matrix", transformmatrix=transform, compose=False, freeze=False)


def _is_moved(identity: Identity) -> bool:
    return bool((identity.transform != _UNMOVED).any())


def _current_id(ms: MeshSet) -> int:
    return native.id_of(native.current_mesh(ms))


# --- parked layers -----------------------------------------------------------------------------


def _park(ms: MeshSet, mesh_id: int) -> None:
    _parked.put(ms, _parked.get(ms) | {mesh_id})
    native.show(ms, mesh_id, False)


def parked(ms: MeshSet) -> frozenset[int]:
    """Ids of the layers that exist only because a `Mesh` object of them is held."""
    return frozenset(i for i in _parked.get(ms) if native.is_there(ms, i))


def forget(ms: MeshSet) -> None:
    """Forget all layers, of a set that was emptied."""
    ids.forget(ms)
    if _parked.get(ms):
        _parked.put(ms, frozenset())


def shown_ids(ms: MeshSet) -> list[int]:
    """The ids of the layers that are not parked, in the order of their logical ids.

    That is the order that PyMeshLab would have them in, had no layer taken the place of another.
    """
    if not ids.has_moved(ms):
        return native.ids(ms)
    there = set(native.ids(ms)) - parked(ms)
    return sorted(there, key=lambda i: ids.logical_id(ms, i))


def logical_ids(ms: MeshSet) -> list[int]:
    """The logical ids of the layers that are not parked, ascending."""
    return [ids.logical_id(ms, mesh_id) for mesh_id in shown_ids(ms)]


def no_such_id(ms: MeshSet, mesh_id: int) -> str:
    """The message for a logical id that no layer has."""
    there = ", ".join(map(str, logical_ids(ms))) or "none"
    return f"there is no mesh {mesh_id} (there are: {there})"


def sweep(ms: MeshSet) -> None:
    """Delete the parked layers of `ms` that are not held any more."""
    if not _parked.get(ms):
        return
    free = {i for i in parked(ms) if not _has_wrapper(ms, i)}
    _parked.put(ms, parked(ms) - free)
    if free:
        with interrupts.deferred(), native.without_trace(ms):
            for mesh_id in sorted(free):
                delete(ms, mesh_id)


# --- held meshes -------------------------------------------------------------------------------


def _is_held(ms: MeshSet, mesh_id: int) -> bool:
    """Whether a `Mesh` object of this layer is alive, apart from young garbage.

    An older one in garbage counts as held. Its layer is parked, and deleted like all others of
    objects that are gone.
    """
    if not _has_wrapper(ms, mesh_id):
        return False
    # To collect all garbage takes longer than to flip the edges of a mesh of middle size.
    gc.collect(_YOUNG)
    return _has_wrapper(ms, mesh_id)


def _has_wrapper(ms: MeshSet, mesh_id: int) -> bool:
    """Whether a `Mesh` object of this layer is alive.

    PyMeshLab returns that object then, and else a new one, which is gone at once.
    """
    return weakref.ref(native.mesh(ms, mesh_id))() is not None
