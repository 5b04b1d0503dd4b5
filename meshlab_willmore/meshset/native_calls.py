"""PyMeshLab's own methods and filters on a set in which layers took the place of others.

They act, and leave the set, as if our filters worked in place: by logical ids (see `ids`), without
parked layers (see `layers`), and with the meshes and the current layer that PyMeshLab would choose
by the order of those ids. Functions that replace a method get PyMeshLab's own as `before`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, AnyStr

import pymeshlab
from pymeshlab import MeshSet

from . import catalogue, filter_info, ids, layers, native
from .catalogue import FilterInfo

_DELETE_HIDDEN = "delete_non_visible_meshes"
_MERGE = "generate_by_merging_visible_meshes"

# --- methods of MeshSet and Mesh ---------------------------------------------------------------


def iterate(_: Callable, ms: MeshSet) -> Iterator[pymeshlab.Mesh]:
    """Go through the layers that are there when the loop begins, and still there at their turn.

    PyMeshLab's own iterator points to freed memory once its layer is deleted, and a loop in which
    each step replaces a layer would never end.
    """
    at_first = layers.logical_ids(ms)
    now = (ids.physical_id(ms, mesh_id) for mesh_id in at_first)
    return (_noted(ms, native.mesh(ms, i)) for i in now if i is not None)


def count(before: Callable, ms: MeshSet) -> int:
    """The number of layers that are not parked."""
    return before(ms) - len(layers.parked(ms))


def clear(before: Callable, ms: MeshSet) -> None:
    """Empty the set."""
    before(ms)
    layers.forget(ms)


def mesh(before: Callable, ms: MeshSet, id: int) -> pymeshlab.Mesh:
    """The layer of a logical id."""
    return _noted(ms, before(ms, _physical_or_error(ms, id)))


def current_mesh(before: Callable, ms: MeshSet) -> pymeshlab.Mesh:
    """The current layer, whose id is logical from now on."""
    return _noted(ms, before(ms))


def current_mesh_id(before: Callable, ms: MeshSet) -> int:
    """The logical id of the current layer."""
    return ids.logical_id(ms, before(ms))


def mesh_id_exists(before: Callable, ms: MeshSet, id: int) -> bool:
    """Whether there is a layer of a logical id."""
    return before(ms, ids.physical_of(ms, id) if ids.has_moved(ms) else id)


def set_current_mesh(before: Callable, ms: MeshSet, new_curr_id: int) -> None:
    """Make the layer of a logical id the current one; without such a layer, none is current."""
    before(ms, ids.physical_of(ms, new_curr_id) if ids.has_moved(ms) else new_curr_id)


def is_mesh_visible(before: Callable, ms: MeshSet, id: int) -> bool:
    """Whether the layer of a logical id is visible."""
    return before(ms, _physical_or_error(ms, id))


def set_mesh_visibility(before: Callable, ms: MeshSet, id: int, visibility: bool) -> None:
    """Show or hide the layer of a logical id."""
    before(ms, _physical_or_error(ms, id), visibility)


def id_of(before: Callable, mesh: pymeshlab.Mesh) -> int:
    """The logical id of a layer."""
    noted = ids.noted_id(mesh)
    return before(mesh) if noted is None else noted


def _physical_or_error(ms: MeshSet, given: Any) -> Any:
    """The physical id for a logical one, or an error in PyMeshLab's words."""
    if not ids.has_moved(ms):
        return given
    mesh_id = ids.physical_of(ms, given)
    if ids.is_absent(mesh_id):
        raise pymeshlab.PyMeshLabException(f"Mesh ID {given} not found in MeshSet.")
    return mesh_id


def _noted(ms: MeshSet, mesh: pymeshlab.Mesh) -> pymeshlab.Mesh:
    """The object, whose id is logical from now on."""
    ids.note(ms, mesh)
    return mesh


# --- filters -----------------------------------------------------------------------------------


@contextmanager
def prepared(ms: MeshSet, name: object, given: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Surround the call of a native filter, and give the keywords to call it with.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
    name : object
        The name that the caller gave, which need not be one.
    given : dict
        The caller's keywords; ids of layers in them are logical.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If there is no layer of a given id, or none at all, or the filter would merge parked layers.
    """
    known = _native_filter(name)
    if known is None:
        yield given
        return
    called = _with_physical_ids(ms, known, given)
    if not ids.has_moved(ms):
        yield called
        return
    parked, shown, current = layers.parked(ms), layers.shown_ids(ms), native.current_id(ms)
    # PyMeshLab counts the parked layers too, and crashes if none is current.
    if parked and not shown and known.needs_mesh:
        raise pymeshlab.PyMeshLabException(
            f"{known.name} requires at least one mesh loaded in the MeshSet."
        )
    if parked and name == _MERGE and not given.get("mergevisible", True):
        raise _still_held(ms, f"{name} with mergevisible=False")
    kept = parked if name == _DELETE_HIDDEN else ()
    for mesh_id in kept:
        native.show(ms, mesh_id, True)
    try:
        yield {**_default_meshes(known, called, shown, current), **called}
    finally:
        for mesh_id in kept:
            native.show(ms, mesh_id, False)
        _choose_current(ms, name, shown)


def parameter_values(
    before: Callable, ms: MeshSet, name: str, given: dict[str, Any]
) -> dict[str, Any]:
    """The parameters of a native filter with logical ids."""
    with prepared(ms, name, given) as called:
        values = before(ms, name, **called)
    return {**values, **logical_ids(ms, name, values)}


def logical_ids(ms: MeshSet, name: object, values: dict[str, Any]) -> dict[str, int]:
    """The logical ids for the physical ones among the values of a native filter's parameters."""
    known = _native_filter(name)
    keywords = _id_keywords(known, values) if known else ()
    return {key: ids.logical_id(ms, values[key]) for key in keywords}


def _with_physical_ids(ms: MeshSet, known: FilterInfo, given: dict[str, Any]) -> dict[str, Any]:
    """The keywords with physical ids of layers in the place of logical ones.

    The filter's own types decide what is an id, not the keyword's name.
    """
    physical = {}
    for keyword in _id_keywords(known, given):
        mesh_id = ids.physical_of(ms, given[keyword])
        if ids.is_absent(mesh_id):
            raise pymeshlab.PyMeshLabException(
                f"Failed to apply filter: {known.name}\nDetails: parameter {keyword!r}: "
                f"{layers.no_such_id(ms, given[keyword])}"
            )
        physical[keyword] = mesh_id
    return {**given, **physical}


def _native_filter(name: object) -> FilterInfo | None:
    known = catalogue.find(name) if isinstance(name, str) else None
    return known if known and known.name == name and not known.is_willmore else None


def _id_keywords(known: FilterInfo, given: dict[str, Any]) -> list[str]:
    return [p.keyword for p in known.params if p.type == "RichMesh" and p.keyword in given]


def _default_meshes(
    known: FilterInfo, given: dict[str, Any], shown: Sequence[int], current: int | None
) -> dict[str, int]:
    """The layers that a filter takes by default, by keyword.

    PyMeshLab takes the first ones of its list, where replaced layers have gone to the end.
    """
    missing = [p.keyword for p in known.params if p.type == "RichMesh" and p.keyword not in given]
    if not missing or current not in shown:
        return {}
    places = filter_info.default_places(known.name, missing, len(shown), shown.index(current))
    # Two filters take the second one also where there is one only.
    return {key: shown[min(place, len(shown) - 1)] for key, place in places.items()}


def _choose_current(ms: MeshSet, name: object, before: Sequence[int]) -> None:
    """Make current what PyMeshLab would after a filter that deleted layers, by logical ids.

    It takes the one after the last deleted of its list, and at the end of the list the first.
    """
    deleted = [i for i in before if not native.is_there(ms, i)]
    # A merged layer is made current whatever is deleted.
    if not deleted or name == _MERGE:
        return
    now, there = native.current_id(ms), layers.shown_ids(ms)
    if now is None or now in layers.parked(ms) or now == _after(max(deleted), native.ids(ms)):
        by_logical = {ids.logical_id(ms, i): i for i in there}
        successor = _after(ids.logical_id(ms, deleted[-1]), list(by_logical))
        native.make_current(ms, None if successor is None else by_logical[successor])


def _after(deleted: int, ascending: Sequence[int]) -> int | None:
    """The id after a deleted one; after the last one the first."""
    return next((i for i in ascending if i > deleted), next(iter(ascending), None))


def _still_held(ms: MeshSet, what: str) -> pymeshlab.PyMeshLabException:
    labels = ", ".join(repr(native.mesh(ms, i).label()) for i in sorted(layers.parked(ms)))
    return pymeshlab.PyMeshLabException(
        f"{what} would reach a mesh as it was before its flips ({labels}), which is there only "
        "because a Mesh object of it is held. Let go of the object first (del)."
    )


# --- the status and projects, which PyMeshLab writes by its own list ------------------------------

_COUNT = re.compile(r"(?<=\ANumber meshes: )\d+")
_STATUS = re.compile(r"^\tMesh id: .*?\n\tFull name: [^\n]*\n\n", re.MULTILINE | re.DOTALL)
_ID = re.compile(r"(?<=\A\tMesh id: )\d+")
_PROJECT = re.compile(rb"^ *<MLMesh .*?</MLMesh>\n", re.MULTILINE | re.DOTALL)


def print_status(before: Callable, ms: MeshSet) -> None:
    """Print the status of a set, with logical ids."""
    if not ids.has_moved(ms):
        before(ms)
        return
    text = native.printed(lambda: before(ms))
    by_id = dict(zip(native.ids(ms), _STATUS.findall(text), strict=False))
    shown = layers.shown_ids(ms)
    parts = [_ID.sub(str(ids.logical_id(ms, i)), by_id[i]) for i in shown if i in by_id]
    print(_COUNT.sub(str(len(shown)), _with_parts(_STATUS, text, parts)), end="")


def save_project(before: Callable, ms: MeshSet, file_name: str | bytes) -> None:
    """Save a project, with the layers in the order of their logical ids."""
    with native.kept_working_folder(), native.in_order_if_verbose(ms):
        before(ms, file_name)
    path = Path(os.fsdecode(file_name))
    if not (ids.has_moved(ms) and path.is_file()):
        return
    text = path.read_bytes()
    # Hidden layers are not in it.
    visible = [i for i in native.ids(ms) if native.mesh(ms, i).is_visible()]
    by_id = dict(zip(visible, _PROJECT.findall(text), strict=False))
    parts = [by_id[i] for i in layers.shown_ids(ms) if i in by_id]
    path.write_bytes(_with_parts(_PROJECT, text, parts))


def _with_parts(pattern: re.Pattern[AnyStr], text: AnyStr, parts: list[AnyStr]) -> AnyStr:
    """The text with other parts, of which there may be fewer."""
    new = iter(parts)
    return pattern.sub(lambda _: next(new, text[:0]), text)
