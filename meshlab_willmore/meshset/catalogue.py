"""The catalogue of all filters, ours and MeshLab's own, with their names and parameters.

MeshLab and its scripts use other names than PyMeshLab, which does not know them: they are in
`native_filters.json`, recorded with one version of PyMeshLab. For filters of other versions, or of
plugins that were loaded later, PyMeshLab itself is asked (see `filter_info`).
"""

from __future__ import annotations

import difflib
import functools
import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pymeshlab

from ..mlx.steps import Percentage
from . import document, filter_info, old_names
from .document import DocumentStep
from .filter import Filter
from .filter_info import FilterInfo, ParamInfo, keyword_of
from .filters import BY_NAME, FILTERS

_FILE = Path(__file__).with_name("native_filters.json")
_RENAMED = Path(pymeshlab.__file__).with_name("keys.txt")
_MANUAL = "https://pymeshlab.readthedocs.io/en/{version}/filter_list.html#{name}"
_TYPES = {
    bool: "RichBool",
    int: "RichInt",
    float: "RichFloat",
    str: "RichString",
    Percentage: "RichAbsPerc",
}
# All filters of this name, and few others, work on an empty set.
_MAKES_MESHES = "create_"
_MOST_SUGGESTIONS = 3
_LEAST_LIKENESS = 0.55
_LONGEST_NAME = 200


def find(name: str) -> FilterInfo | None:
    """The filter of that name in MeshLab or PyMeshLab, today or in older versions.

    Upper and lower case differ, as in MeshLab; blanks at the ends and doubled ones are ignored. A
    filter that only other versions of PyMeshLab have is found too; it is not `available`. Steps of
    old scripts that act on the set are found as well.
    """
    name = old_names.plain(name)
    for filter_ in FILTERS:
        if name in (filter_.name, filter_.meshlab_name):
            return _of_filter(filter_)
    if name in _recorded():
        return _native(name)
    today = _by_meshlab_name().get(name) or _before(name) or _new_name(name)
    if today:
        return _native(today)
    step = document.find(name)
    return _of_document(step) if step else None


def _before(name: str) -> str | None:
    """PyMeshLab's name of a filter that was called `name` in older versions."""
    old = old_names.filter_of(name)
    return old.targets[0].filter if old else None


def closest(name: str) -> list[str]:
    """Up to three filter names that resemble `name`: MeshLab's or PyMeshLab's, the nearer ones."""
    known = (*everything(), *map(_of_document, document.STEPS))
    meshlab, python = [k.meshlab_name for k in known if k.meshlab_name], [k.name for k in known]
    return max(
        (similar(name, names) for names in (meshlab, python)),
        key=lambda found: _likeness(name, found[0]) if found else 0.0,
    )


def similar(word: str, names: Iterable[str]) -> list[str]:
    """Up to three of the names that resemble `word`, the nearest first, ignoring case."""
    by_lower = {name.lower(): name for name in names}
    found = difflib.get_close_matches(
        word.lower()[:_LONGEST_NAME], by_lower, _MOST_SUGGESTIONS, _LEAST_LIKENESS
    )
    return [by_lower[lower] for lower in found]


def everything() -> tuple[FilterInfo, ...]:
    """All filters that the installed PyMeshLab has, and ours, sorted by PyMeshLab's name."""
    natives = (_native(name) for name in _there())
    return tuple(sorted((*natives, *map(_of_filter, FILTERS)), key=lambda known: known.name))


def missing() -> tuple[FilterInfo, ...]:
    """The recorded filters that the installed PyMeshLab does not have."""
    return tuple(_native(name) for name in sorted(_recorded().keys() - _there()))


def version() -> str:
    """The version of the installed PyMeshLab; "latest" if it is unknown."""
    # Takes longer to import than this module with all that it needs.
    from importlib import metadata

    try:
        return metadata.version("pymeshlab")
    except metadata.PackageNotFoundError:
        return "latest"


def recorded_version() -> str:
    """The version of PyMeshLab whose filters were recorded."""
    return _file()["pymeshlab"]


def _likeness(word: str, name: str) -> float:
    return difflib.SequenceMatcher(None, word.lower()[:_LONGEST_NAME], name.lower()).ratio()


# --- MeshLab's own -----------------------------------------------------------------------------


@functools.cache
def _file() -> dict[str, Any]:
    return json.loads(_FILE.read_text(encoding="utf-8"))


def _recorded() -> dict[str, dict[str, Any]]:
    return _file()["filters"]


def _there() -> frozenset[str]:
    """The native filters that PyMeshLab has now; plugins can be loaded while it runs."""
    return _there_with(pymeshlab.plugin_number())


@functools.cache
def _there_with(_plugins: int) -> frozenset[str]:
    return frozenset(pymeshlab.filter_list()) - BY_NAME.keys()


@functools.cache
def _by_meshlab_name() -> dict[str, str]:
    return {old_names.plain(entry["name"]): name for name, entry in _recorded().items()}


@functools.cache
def _renamed() -> dict[str, str]:
    """Today's PyMeshLab name by the one before 2022."""
    text = _RENAMED.read_text(encoding="utf-8") if _RENAMED.exists() else ""
    return dict(re.findall(r"^(\S+) +(\S+)\s*$", text, re.MULTILINE))


def _new_name(name: str) -> str | None:
    """PyMeshLab's name of a filter that is not recorded under `name`, or had it before 2022."""
    old, there = keyword_of(name), _there()
    # An unrecorded filter is known by this name only, or by what its name in MeshLab becomes.
    if old in there - _recorded().keys():
        return old
    today = _renamed().get(old)
    if today not in _recorded() and today not in there:
        return None
    # A name that differs from today's only in case or punctuation is misspelt.
    todays = _recorded().get(today, {"name": ""})["name"]
    return None if name != old and keyword_of(todays) == old else today


def _native(name: str) -> FilterInfo:
    return _read(name, name in _there())


@functools.cache
def _read(name: str, there: bool) -> FilterInfo:
    """A native filter as recorded, or else as PyMeshLab describes it."""
    entry = _recorded().get(name)
    manual = _MANUAL.format(version=version(), name=name)
    if entry is None:
        needs_mesh = not name.startswith(_MAKES_MESHES)
        return FilterInfo(name, "", filter_info.params(name), False, True, manual, needs_mesh)
    params = tuple(_param(entry, *fields) for fields in entry["params"])
    if there and version() != recorded_version():
        params = filter_info.updated(name, params)
    return FilterInfo(
        name,
        entry["name"],
        params,
        False,
        entry["makes_layers"],
        manual,
        entry["needs_mesh"],
        there,
    )


def _param(entry: dict[str, Any], name: str, kind: str, choices: Iterable[str] = ()) -> ParamInfo:
    made = keyword_of(name)
    return ParamInfo(name, made, kind, tuple(choices), made in entry["required"])


@functools.cache
def _of_document(step: DocumentStep) -> FilterInfo:
    return FilterInfo(step.name, step.meshlab_names[0], step.params, False, False, step.summary)


# --- filters of this package --------------------------------------------------------------------


@functools.cache
def _of_filter(filter_: Filter) -> FilterInfo:
    params = tuple(
        ParamInfo(p.name, p.name, "RichEnum" if p.choices else _TYPES[p.type], p.choices, False)
        for p in filter_.parameters
    )
    return FilterInfo(filter_.name, filter_.meshlab_name, params, True, False, filter_.summary)
