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
from typing import Any, NamedTuple

import numpy as np
import pymeshlab
from pymeshlab import MeshSet

from . import interrupts, native, numbering

# A set that has seen more layers than this gives the new mesh a new id.
_MOST_IDS_TO_REBUILD = 1000

# By set: the id of each parked layer, and whether it was visible before.
_parked: native.PerSet[dict[int, bool]] = native.PerSet({})


class Identity(NamedTuple):
    """What a layer is called and where it stands: label, visibility, (4, 4) transform."""

    label: str
    visible: bool
    transform: np.ndarray


def identity(mesh: pymeshlab.Mesh) -> Identity:
    """The identity of `mesh`."""
    return Identity(mesh.label(), mesh.is_visible(), mesh.transform_matrix())


def _is_alone_and_free(ms: MeshSet) -> bool:
    """Whether the current mesh is all there is in `ms`, and nobody holds it."""
    alone = len(native.ids(ms)) == 1 and ms.raster_number() == 0
    return alone and not _is_held(ms, ms.current_mesh_id())


def replace_current(
    ms: MeshSet, load: Callable[[MeshSet], None], reload: Callable[[MeshSet], None], who: Identity
) -> None:
    """Let `load` bring a new layer into `ms`, and let it take the place of the current one.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
        Changed in place: afterwards the new layer is current and carries the identity `who`.
        Where the old layer was the only one and nobody held it, the new one has its id. If `load`
        fails, the set is as it was.
    load : callable
        Called with `ms`; must add one layer and make it current.
    reload : callable
        Brings the old layer back in the same way, if `load` fails.
    who : Identity
        Label, visibility and transform of the new layer.
    """
    old_id = ms.current_mesh_id()
    alone = _is_alone_and_free(ms)
    with interrupts.deferred(), native.without_trace(ms):
        next_id = _use_up_id(ms) if alone else None
        if next_id is not None and next_id <= _MOST_IDS_TO_REBUILD:
            try:
                _refill(ms, old_id, next_id, load)
            except BaseException:
                _refill(ms, old_id, next_id, reload)
                _identify(ms, who)
                raise
        else:
            if next_id is not None:
                numbering.note_used(ms, next_id)
            _add(ms, load)
            numbering.note_replaced(ms, old_id, ms.current_mesh_id())
            _retire(ms, old_id)
        _identify(ms, who)


def _refill(ms: MeshSet, wanted_id: int, next_id: int, load: Callable[[MeshSet], None]) -> None:
    """Empty the set and load: ids start again at 0, so stand-ins use up the others."""
    native.clear(ms)
    for _ in range(wanted_id):
        _stand_in(ms)
    load(ms)
    for _ in range(wanted_id + 1, next_id):
        _stand_in(ms)
    if next_id > 1:
        native.apply(ms, "delete_non_visible_meshes")
        native.make_current(ms, wanted_id)


def _stand_in(ms: MeshSet) -> int:
    """Add a hidden layer of one point, which becomes the current one; its id."""
    native.add(ms, pymeshlab.Mesh(np.zeros((1, 3))))
    native.show(ms, ms.current_mesh_id(), False)
    return ms.current_mesh_id()


def _use_up_id(ms: MeshSet) -> int:
    """The id that the next layer would have had: PyMeshLab tells only by giving it away."""
    current = ms.current_mesh_id()
    mesh_id = _stand_in(ms)
    native.apply(ms, "delete_current_mesh")
    native.make_current(ms, current)
    return mesh_id


def _add(ms: MeshSet, load: Callable[[MeshSet], None]) -> None:
    """Load beside what is there, or leave all as it is."""
    current, before = ms.current_mesh_id(), native.ids(ms)
    try:
        load(ms)
    except BaseException:
        for mesh_id in sorted(set(native.ids(ms)) - set(before)):
            numbering.note_used(ms, mesh_id)
            native.make_current(ms, mesh_id)
            native.apply(ms, "delete_current_mesh")
        native.make_current(ms, current)
        raise


def _retire(ms: MeshSet, old_id: int) -> None:
    """Delete the old layer, or park it as long as somebody holds it."""
    if _is_held(ms, old_id):
        _parked.put(ms, {**_parked.get(ms), old_id: ms.mesh(old_id).is_visible()})
        native.show(ms, old_id, False)
    else:
        _delete(ms, old_id)


def _delete(ms: MeshSet, mesh_id: int) -> None:
    current = ms.current_mesh_id()
    native.make_current(ms, mesh_id)
    native.apply(ms, "delete_current_mesh")
    native.make_current(ms, current)


def _identify(ms: MeshSet, who: Identity) -> None:
    ms.current_mesh().set_label(who.label)
    native.show(ms, ms.current_mesh_id(), who.visible)
    if not np.array_equal(who.transform, np.eye(4)):
        native.apply(ms, "set_matrix", transformmatrix=who.transform, compose=False, freeze=False)


# --- parked layers -----------------------------------------------------------------------------


def parked(ms: MeshSet) -> frozenset[int]:
    """Ids of the layers that are there only because somebody holds their `Mesh`."""
    return frozenset(i for i in _parked.get(ms) if ms.mesh_id_exists(i))


def forget(ms: MeshSet) -> None:
    """Forget all layers, of a set that was emptied."""
    numbering.forget(ms)
    if _parked.get(ms):
        _parked.put(ms, {})


def give_back(ms: MeshSet, mesh_id: int) -> None:
    """Make a parked layer one like others, because the user asks for it."""
    if mesh_id in parked(ms):
        layers = dict(_parked.get(ms))
        native.show(ms, mesh_id, layers.pop(mesh_id))
        _parked.put(ms, layers)


def visible_ids(ms: MeshSet) -> list[int]:
    """The ids of the layers that are not parked, in their order."""
    hidden = parked(ms)
    return [i for i in native.ids(ms) if i not in hidden]


def sweep(ms: MeshSet) -> None:
    """Delete the parked layers of `ms` that nobody holds any more."""
    if not _parked.get(ms):
        return
    free = {i for i in parked(ms) if i != ms.current_mesh_id() and not _has_wrapper(ms, i)}
    stay = parked(ms) - free
    _parked.put(ms, {i: shown for i, shown in _parked.get(ms).items() if i in stay})
    if free:
        with interrupts.deferred(), native.without_trace(ms):
            for mesh_id in sorted(free):
                _delete(ms, mesh_id)


# --- native filters beside parked layers -------------------------------------------------------

_DELETE_HIDDEN = "delete_non_visible_meshes"
_MERGE = "generate_by_merging_visible_meshes"


@contextmanager
def parked_aside(ms: MeshSet, name: object, given: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Keep a native filter away from the parked layers; gives the keywords to call it with.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If the filter would merge parked layers.
    """
    hidden = parked(ms)
    if not hidden:
        yield given
        return
    if name == _MERGE and not given.get("mergevisible", True):
        raise _still_held(ms, f"{name} with mergevisible=False")
    was_current = ms.current_mesh_id() in hidden
    for mesh_id in hidden if name == _DELETE_HIDDEN else ():
        native.show(ms, mesh_id, True)
    try:
        yield {**partners_beside_parked(ms, name, given), **given}
    finally:
        for mesh_id in hidden if name == _DELETE_HIDDEN else ():
            native.show(ms, mesh_id, False)
        # A deleted layer hands over to its neighbour, which should not be a parked one.
        others = visible_ids(ms)
        if others and not was_current and ms.current_mesh_id() in hidden:
            native.make_current(ms, others[0])


def partners_beside_parked(ms: MeshSet, name: object, given: dict[str, Any]) -> dict[str, int]:
    """The layers that a native filter should take instead of parked ones, by keyword.

    Without a word from the caller, filters of two meshes take the first layer of the set.
    """
    hidden = parked(ms)
    if not hidden or name not in pymeshlab.filter_list():
        return {}
    with native.muted():
        defaults = native.defaults(ms, str(name))
    seen = visible_ids(ms)
    other = next((i for i in seen if i != ms.current_mesh_id()), ms.current_mesh_id())
    return {
        keyword: other
        for keyword, value in defaults.items()
        if keyword.endswith("mesh") and keyword not in given and value in hidden
    }


def _still_held(ms: MeshSet, what: str) -> pymeshlab.PyMeshLabException:
    labels = ", ".join(repr(ms.mesh(i).label()) for i in sorted(parked(ms)))
    return pymeshlab.PyMeshLabException(
        f"{what} would reach a mesh as it was before its flips ({labels}), which is there only "
        "because a Mesh object of it is held. Let go of the object first (del)."
    )


# --- held meshes -------------------------------------------------------------------------------


def _is_held(ms: MeshSet, mesh_id: int) -> bool:
    """Whether a `Mesh` object of this layer is alive, apart from garbage."""
    if not _has_wrapper(ms, mesh_id):
        return False
    gc.collect()
    return _has_wrapper(ms, mesh_id)


def _has_wrapper(ms: MeshSet, mesh_id: int) -> bool:
    """PyMeshLab hands out the living object if there is one, and a new one dies at once."""
    return weakref.ref(ms.mesh(mesh_id))() is not None
