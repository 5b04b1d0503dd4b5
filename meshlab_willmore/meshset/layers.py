"""Replacing a layer of a `MeshSet` so that nobody who looks on is harmed.

PyMeshLab edits a mesh in place only from C++, so a mesh with other faces is a new layer. Where the
set has just that mesh and nobody holds it, the set is filled anew and the id stays. Elsewhere the
new layer gets a new id, and if somebody holds a `Mesh` object of the old layer, that layer is
*parked*: hidden, left out when layers are counted or gone through, and deleted when the object is
gone (`sweep`). So no object that was handed out ever points to freed memory.
"""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np
import pymeshlab
from pymeshlab import MeshSet

from . import interrupts, native

# A set that has seen more layers than this gives the new mesh a new id.
_MOST_IDS_TO_REBUILD = 1000

_parked: native.PerSet[frozenset[int]] = native.PerSet(frozenset())


class Identity(NamedTuple):
    """What a layer is called and where it stands: label, visibility, (4, 4) transform."""

    label: str
    visible: bool
    transform: np.ndarray


def identity(mesh: pymeshlab.Mesh) -> Identity:
    """The identity of `mesh`."""
    return Identity(mesh.label(), mesh.is_visible(), mesh.transform_matrix())


def _can_refill(ms: MeshSet) -> bool:
    """Whether the current mesh is all there is in `ms`, and nobody holds it."""
    alone = len(native.ids(ms)) == 1 and ms.raster_number() == 0
    current = ms.current_mesh_id()
    return alone and current <= _MOST_IDS_TO_REBUILD and not _is_held(ms, current)


def replace_current(
    ms: MeshSet, trial: MeshSet, load: Callable[[MeshSet], None], who: Identity
) -> None:
    """Let `load` bring a new layer into `ms`, and let it take the place of the current one.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
        Changed in place: afterwards the new layer is current and carries the identity `who`.
        Where the old layer was the only one and nobody held it, the new one has its id.
    trial : pymeshlab.MeshSet
        Its current mesh is what `load` brings; the way back if `load` fails half-way.
    load : callable
        Called with `ms`; must add one layer and make it current.
    who : Identity
        Label, visibility and transform of the new layer.
    """
    old_id = ms.current_mesh_id()
    refill = _can_refill(ms)
    with interrupts.deferred(), native.without_trace(ms):
        if refill:
            _refill(ms, old_id, trial, load)
        else:
            load(ms)
            _retire(ms, old_id)
        _identify(ms, who)


def _refill(ms: MeshSet, wanted_id: int, trial: MeshSet, load: Callable[[MeshSet], None]) -> None:
    """Empty the set and load: ids start again at 0, so stand-ins use up those below."""
    native.clear(ms)
    stand_in = pymeshlab.Mesh(np.zeros((1, 3)))
    for _ in range(wanted_id):
        ms.add_mesh(stand_in)
        ms.set_current_mesh_visibility(False)
    try:
        load(ms)
    except BaseException:
        ms.add_mesh(trial.current_mesh())
        raise
    finally:
        if wanted_id:
            native.apply(ms, "delete_non_visible_meshes")
            ms.set_current_mesh(wanted_id)


def _retire(ms: MeshSet, old_id: int) -> None:
    """Delete the old layer, or park it as long as somebody holds it."""
    if _is_held(ms, old_id):
        ms.set_mesh_visibility(old_id, False)
        _parked.put(ms, parked(ms) | {old_id})
    else:
        _delete(ms, old_id)


def _delete(ms: MeshSet, mesh_id: int) -> None:
    current = ms.current_mesh_id()
    ms.set_current_mesh(mesh_id)
    native.apply(ms, "delete_current_mesh")
    ms.set_current_mesh(current)


def _identify(ms: MeshSet, who: Identity) -> None:
    ms.current_mesh().set_label(who.label)
    ms.set_current_mesh_visibility(who.visible)
    if not np.array_equal(who.transform, np.eye(4)):
        native.apply(ms, "set_matrix", transformmatrix=who.transform, compose=False, freeze=False)


# --- parked layers -----------------------------------------------------------------------------


def parked(ms: MeshSet) -> frozenset[int]:
    """Ids of the layers that are there only because somebody holds their `Mesh`."""
    return _parked.get(ms)


def forget_parked(ms: MeshSet) -> None:
    """Forget all parked layers, of a set that was emptied."""
    if parked(ms):
        _parked.put(ms, frozenset())


def visible_ids(ms: MeshSet) -> list[int]:
    """The ids of the layers that are not parked, in their order."""
    hidden = parked(ms)
    return [i for i in native.ids(ms) if i not in hidden]


def sweep(ms: MeshSet) -> None:
    """Delete the parked layers of `ms` that nobody holds any more.

    A layer that was made visible or current belongs to the user again.
    """
    waiting = parked(ms)
    if not waiting:
        return
    there = {i for i in waiting if ms.mesh_id_exists(i)}
    current = ms.current_mesh_id() if len(native.ids(ms)) else None
    taken_back = {i for i in there if ms.mesh(i).is_visible()}
    free = {i for i in there - taken_back if i != current and not _has_wrapper(ms, i)}
    _parked.put(ms, frozenset(there - taken_back - free))
    if free:
        with interrupts.deferred(), native.without_trace(ms):
            for mesh_id in sorted(free):
                _delete(ms, mesh_id)


@contextmanager
def parked_aside(ms: MeshSet, filter_name: object) -> Iterator[None]:
    """Keep a native filter that deletes layers away from the parked ones."""
    hidden = parked(ms)
    if not hidden:
        yield
        return
    was_parked = ms.current_mesh_id() in hidden
    spare = filter_name == "delete_non_visible_meshes"
    for mesh_id in hidden if spare else ():
        ms.set_mesh_visibility(mesh_id, True)
    try:
        yield
    finally:
        for mesh_id in hidden if spare else ():
            ms.set_mesh_visibility(mesh_id, False)
        # A deleted layer hands over to its neighbour, which should not be a parked one.
        others = visible_ids(ms)
        if others and not was_parked and ms.current_mesh_id() in hidden:
            ms.set_current_mesh(others[0])


def _is_held(ms: MeshSet, mesh_id: int) -> bool:
    """Whether a `Mesh` object of this layer is alive, apart from garbage."""
    if not _has_wrapper(ms, mesh_id):
        return False
    gc.collect()
    return _has_wrapper(ms, mesh_id)


def _has_wrapper(ms: MeshSet, mesh_id: int) -> bool:
    """PyMeshLab hands out the living object if there is one, and a new one dies at once."""
    return weakref.ref(ms.mesh(mesh_id))() is not None
