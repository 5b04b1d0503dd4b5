"""The methods of `MeshSet` and `Mesh` that take, tell or count ids of layers.

Each is made of PyMeshLab's own. They leave out parked layers (see `layers`), and go by logical ids
(see `numbering`): a flipped mesh is reached by the id that it had, at the place that it had.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pymeshlab
from pymeshlab import MeshSet

from . import layers, native, numbering


def _wrap_iter(_: Callable) -> Callable:
    """Go through the layers that are there when the loop begins, and still there at their turn.

    PyMeshLab's own iterator points to freed memory once its layer is deleted, and a loop in which
    each step replaces a layer would never end.
    """

    def iterate(self: MeshSet) -> Iterator[pymeshlab.Mesh]:
        there = layers.shown_ids(self)
        now = (numbering.physical_id(self, mesh_id) for mesh_id in there)
        return (_shown(self, native.mesh(self, i)) for i in now if i is not None)

    return iterate


def _wrap_count(wrapped: Callable) -> Callable:
    def count(self: MeshSet) -> int:
        return wrapped(self) - len(layers.parked(self))

    return count


def _wrap_clear(wrapped: Callable) -> Callable:
    def clear(self: MeshSet) -> None:
        wrapped(self)
        layers.forget(self)

    return clear


def _wrap_mesh(wrapped: Callable) -> Callable:
    def mesh(self: MeshSet, id: int) -> pymeshlab.Mesh:
        return _shown(self, wrapped(self, _physical(self, id)))

    return mesh


def _wrap_current_mesh(wrapped: Callable) -> Callable:
    def current_mesh(self: MeshSet) -> pymeshlab.Mesh:
        return _shown(self, wrapped(self))

    return current_mesh


def _wrap_current_mesh_id(wrapped: Callable) -> Callable:
    def current_mesh_id(self: MeshSet) -> int:
        return numbering.logical_id(self, wrapped(self))

    return current_mesh_id


def _wrap_mesh_id_exists(wrapped: Callable) -> Callable:
    def mesh_id_exists(self: MeshSet, id: int) -> bool:
        return wrapped(self, numbering.physical_of(self, id) if numbering.has_moved(self) else id)

    return mesh_id_exists


def _wrap_set_current_mesh(wrapped: Callable) -> Callable:
    def set_current_mesh(self: MeshSet, new_curr_id: int) -> None:
        # As in any set, no mesh is current after an id that doesn't exist.
        if numbering.has_moved(self):
            new_curr_id = numbering.physical_of(self, new_curr_id)
        wrapped(self, new_curr_id)

    return set_current_mesh


def _wrap_is_mesh_visible(wrapped: Callable) -> Callable:
    def is_mesh_visible(self: MeshSet, id: int) -> bool:
        return wrapped(self, _physical(self, id))

    return is_mesh_visible


def _wrap_set_mesh_visibility(wrapped: Callable) -> Callable:
    def set_mesh_visibility(self: MeshSet, id: int, visibility: bool) -> None:
        wrapped(self, _physical(self, id), visibility)

    return set_mesh_visibility


def _wrap_id(wrapped: Callable) -> Callable:
    def id(self: pymeshlab.Mesh) -> int:
        shown = numbering.shown_id(self)
        return wrapped(self) if shown is None else shown

    return id


def _physical(ms: MeshSet, given: Any) -> Any:
    """The physical id for a logical one, or an error in PyMeshLab's words."""
    if not numbering.has_moved(ms):
        return given
    mesh_id = numbering.physical_of(ms, given)
    if numbering.is_absent(mesh_id):
        raise pymeshlab.PyMeshLabException(f"Mesh ID {given} not found in MeshSet.")
    return mesh_id


def _shown(ms: MeshSet, mesh: pymeshlab.Mesh) -> pymeshlab.Mesh:
    """The object, which from now on tells its logical id."""
    numbering.note_shown(ms, mesh)
    return mesh


SET_METHODS: dict[str, Callable[[Callable], Callable]] = {
    "__getitem__": _wrap_mesh,
    "__iter__": _wrap_iter,
    "__len__": _wrap_count,
    "clear": _wrap_clear,
    "current_mesh": _wrap_current_mesh,
    "current_mesh_id": _wrap_current_mesh_id,
    "is_mesh_visible": _wrap_is_mesh_visible,
    "mesh": _wrap_mesh,
    "mesh_id_exists": _wrap_mesh_id_exists,
    "mesh_number": _wrap_count,
    "number_meshes": _wrap_count,
    "set_current_mesh": _wrap_set_current_mesh,
    "set_mesh_visibility": _wrap_set_mesh_visibility,
}
MESH_METHODS: dict[str, Callable[[Callable], Callable]] = {"id": _wrap_id}
