"""Native filters on sets in which layers took the place of others.

They are called, and leave the set, as if our filters had worked in place: by the ids that callers
know (see `numbering`), away from parked layers (see `layers`), with the partners and the current
layer that PyMeshLab would choose by the order of those ids.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import pymeshlab
from pymeshlab import MeshSet

from . import catalogue, layers, native, numbering, parameter_info
from .catalogue import FilterInfo

_DELETE_HIDDEN = "delete_non_visible_meshes"
_MERGE = "generate_by_merging_visible_meshes"


@contextmanager
def prepared(ms: MeshSet, name: object, given: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Around the call of a native filter; gives the keywords to call it with.

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
    known = _known(name)
    if known is None:
        yield given
        return
    called = physical(ms, known, given)
    if not numbering.has_moved(ms):
        yield called
        return
    hidden, there, current = layers.parked(ms), layers.visible_ids(ms), native.current_id(ms)
    # PyMeshLab sees the parked layers, and crashes where none is current.
    if hidden and not there and known.needs_mesh:
        raise pymeshlab.PyMeshLabException(
            f"{known.name} requires at least one mesh loaded in the MeshSet."
        )
    if hidden and name == _MERGE and not given.get("mergevisible", True):
        raise _still_held(ms, f"{name} with mergevisible=False")
    shown = hidden if name == _DELETE_HIDDEN else ()
    for mesh_id in shown:
        native.show(ms, mesh_id, True)
    try:
        yield {**_partners(known, called, there, current), **called}
    finally:
        for mesh_id in shown:
            native.show(ms, mesh_id, False)
        _hand_over(ms, name, there)


def parameter_values(
    ms: MeshSet, ask: Callable[..., dict[str, Any]], name: str, given: dict[str, Any]
) -> dict[str, Any]:
    """What `ask`, PyMeshLab's ``filter_parameter_values``, tells, with logical ids."""
    known = _known(name)
    if known is None:
        return ask(ms, name, **given)
    with prepared(ms, name, given) as called:
        values = ask(ms, name, **called)
    return {**values, **logical_ids(ms, name, values)}


def logical_ids(ms: MeshSet, name: object, values: dict[str, Any]) -> dict[str, int]:
    """The logical ids for the physical ones among the values of a native filter's parameters."""
    known = _known(name)
    keywords = _id_keywords(known, values) if known else ()
    return {key: numbering.logical_id(ms, values[key]) for key in keywords}


def physical(ms: MeshSet, known: FilterInfo, given: dict[str, Any]) -> dict[str, Any]:
    """The keywords with physical ids of layers in the place of logical ones.

    What is an id, the filter's own types say, not the keyword's name.
    """
    ids = {}
    for keyword in _id_keywords(known, given):
        mesh_id = numbering.physical_of(ms, given[keyword])
        if numbering.is_absent(mesh_id):
            raise pymeshlab.PyMeshLabException(
                f"Failed to apply filter: {known.name}\nDetails: parameter {keyword!r}: "
                f"{layers.no_such_id(ms, given[keyword])}"
            )
        ids[keyword] = mesh_id
    return {**given, **ids}


def _known(name: object) -> FilterInfo | None:
    known = catalogue.find(name) if isinstance(name, str) else None
    return known if known and known.name == name and not known.is_willmore else None


def _id_keywords(known: FilterInfo, given: dict[str, Any]) -> list[str]:
    return [p.keyword for p in known.params if p.type == "RichMesh" and p.keyword in given]


def _partners(
    known: FilterInfo, given: dict[str, Any], there: Sequence[int], current: int | None
) -> dict[str, int]:
    """The layers that a filter takes by itself, by keyword.

    PyMeshLab takes the first ones of its list, where replaced layers have gone to the end.
    """
    missing = [p.keyword for p in known.params if p.type == "RichMesh" and p.keyword not in given]
    if not missing or current not in there:
        return {}
    places = parameter_info.default_places(known.name, missing, len(there), there.index(current))
    # Two filters take the second one also where there is one only.
    return {key: there[min(place, len(there) - 1)] for key, place in places.items()}


def _hand_over(ms: MeshSet, name: object, before: Sequence[int]) -> None:
    """Make current what PyMeshLab would after a filter that deleted layers, by logical ids.

    It takes the one after the last deleted of its list, and at the end of the list the first.
    """
    gone = [i for i in before if not native.is_there(ms, i)]
    # A merged layer is made current whatever is deleted.
    if not gone or name == _MERGE:
        return
    now, there = native.current_id(ms), layers.visible_ids(ms)
    if now is None or now in layers.parked(ms) or now == _after(max(gone), native.ids(ms)):
        logical = {numbering.logical_id(ms, i): i for i in there}
        successor = _after(numbering.logical_id(ms, gone[-1]), list(logical))
        native.make_current(ms, None if successor is None else logical[successor])


def _after(deleted: int, ids: Sequence[int]) -> int | None:
    """The id after a deleted one, of ascending ids; after the last one the first."""
    return next((i for i in ids if i > deleted), next(iter(ids), None))


def _still_held(ms: MeshSet, what: str) -> pymeshlab.PyMeshLabException:
    labels = ", ".join(repr(native.mesh(ms, i).label()) for i in sorted(layers.parked(ms)))
    return pymeshlab.PyMeshLabException(
        f"{what} would reach a mesh as it was before its flips ({labels}), which is there only "
        "because a Mesh object of it is held. Let go of the object first (del)."
    )
