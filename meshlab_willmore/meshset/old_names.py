"""What filters and their parameters were called in MeshLab's older versions.

The table is `old_names.json`. Each entry says in which versions of MeshLab a name stood, and in
which of its sources (a path below the folder of plugins); a version without a release of that name
is MeshLab's source of that month. Entries are:

filters
    A filter's old name and today's, and parameters that have to be `given` for the same meaning.
    Where one filter became several, `by` is the parameter that tells which one was meant.
params
    A parameter's old name, its type then, and today's name (null: it is gone, and did nothing
    where its value is the `idle` one). `as` says how the value changes; see `convert`.
choices
    Choices of an enum in their old order, and where each of them is now.
defaults
    Values of parameters that are not given, where they have changed.
expressions
    Parameters that are formulas.
gone
    Filters that nothing took the place of, with the last version that had them.
"""

from __future__ import annotations

import functools
import json
import re
from pathlib import Path
from typing import Any, NamedTuple

from ..mlx import rich
from ..mlx.steps import Param, Percentage, Step, Value
from .parameter_info import keyword_of

_FILE = Path(__file__).with_name("old_names.json")
# MeshLab's parser of formulas had words for these until the end of 2015.
_WORDS = {"and": "&&", "or": "||"}
_LAST_WITH_WORDS = "2015.03"
_WORD = re.compile(r"\b(and|or)\b")
# Attributes that only MeshLab's scripts of up to this version have.
_OLD_ATTRIBUTE, _LAST_WITH_ATTRIBUTE = "isxmlparam", "2020.06"


class Target(NamedTuple):
    """Today's filter, by PyMeshLab's name, and parameters without which it means another thing."""

    filter: str
    given: dict[str, Value]


class OldFilter(NamedTuple):
    """A filter under an old name.

    Attributes
    ----------
    targets : tuple of Target
        What it is today; more than one where a parameter tells which.
    by : str
        The parameter that does; its value is the index of the target.
    note : str
        What is not as it was; empty if all is.
    until : str
        The last version that had the name.
    """

    targets: tuple[Target, ...]
    by: str
    note: str
    until: str

    def target(self, step: Step) -> Target:
        """Today's filter of a step; the first, where the step does not tell."""
        chosen = next((p.value for p in step.params if p.name.strip() == self.by), 0)
        try:
            return self.targets[int(chosen)]  # type: ignore[arg-type]
        except (IndexError, TypeError, ValueError):
            return self.targets[0]


class OldParam(NamedTuple):
    """A parameter under an old name; see the module for the fields."""

    old: str
    type: str
    param: str | None
    change: dict[str, Any]
    idle: Value
    note: str
    until: str


class OldChoices(NamedTuple):
    """The choices of an enum as they were: names, and the index of each today."""

    old: tuple[str, ...]
    now: tuple[int, ...]
    note: str
    until: str


class OldDefault(NamedTuple):
    """A default that has changed: in words, what it was until a version, and what it is now."""

    param: str
    was: str
    now: str
    until: str


def plain(name: str) -> str:
    """A filter's or parameter's name without blanks at its ends and doubled ones within."""
    return " ".join(name.split())


def filter_of(name: str) -> OldFilter | None:
    """The filter that had this name in MeshLab or PyMeshLab once."""
    return _filters().get(plain(name))


def params_of(filter_name: str, name: str) -> tuple[OldParam, ...]:
    """What became of a parameter of today's filter, by its old name or what PyMeshLab made of it.

    Several, if its meaning is today in several parameters; none, if it never had that name.
    """
    old = _params().get(filter_name, {})
    return old.get(plain(name)) or old.get(keyword_of(plain(name)), ())


def choices_of(filter_name: str, param: str) -> tuple[OldChoices, ...]:
    """The choices that an enum had before."""
    return _choices().get((filter_name, param), ())


def defaults_of(filter_name: str) -> tuple[OldDefault, ...]:
    """Which defaults of a filter have changed."""
    return _defaults().get(filter_name, ())


def last_version_with(name: str) -> str | None:
    """The last version of MeshLab that had a filter which nothing took the place of."""
    return _file()["gone"].get(plain(name))


def age(version: str) -> int:
    """The place of a version in the history: less is older."""
    return _ages()[version]


def age_of_attributes(param: Param) -> int | None:
    """At most how new the script is that a parameter stands in, by its attributes."""
    is_old = any(key == _OLD_ATTRIBUTE for key, _ in param.details)
    return age(_LAST_WITH_ATTRIBUTE) if is_old else None


def in_todays_symbols(filter_name: str, param: str, text: Value) -> tuple[Value, int | None]:
    """A formula with `&&` for `and`, `||` for `or`, and how old it is at least if it had them."""
    if not isinstance(text, str) or param not in _file()["expressions"].get(filter_name, ()):
        return text, None
    new = _WORD.sub(lambda word: _WORDS[word[0]], text)
    return new, age(_LAST_WITH_WORDS) if new != text else None


def value_then(param: Param, old: OldParam) -> Value:
    """The value of a script's parameter, read in the type that it had.

    Raises
    ------
    ValueError
        If it is none.
    """
    if param.type or not isinstance(param.value, str):
        return param.value
    return rich.parse_text(old.type, param.value)


def convert(value: Value, old: OldParam) -> Value:
    """An old parameter's value as today's parameter has it.

    It is the same, `times` a number, that number of `percent`, or one of the `values` that are
    listed by what was written. (What was a `part` of a colour is put together by the caller.)

    Raises
    ------
    ValueError
        If it was none.
    """
    change = old.change
    if "values" in change:
        written = str(value).lower()
        if written not in change["values"]:
            raise ValueError(
                f"there was no choice {value}; they were {', '.join(change['values'])}"
            )
        return change["values"][written]
    if not change or "part" in change:
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"is not a number: {value!r}")
    return value * change["times"] if "times" in change else Percentage(value * change["percent"])


# --- the file ----------------------------------------------------------------------------------


@functools.cache
def _file() -> dict[str, Any]:
    return json.loads(_FILE.read_text(encoding="utf-8"))


@functools.cache
def _ages() -> dict[str, int]:
    return {version: place for place, version in enumerate(_file()["versions"])}


@functools.cache
def _filters() -> dict[str, OldFilter]:
    return {
        entry["old"]: OldFilter(
            tuple(Target(to["filter"], to.get("given", {})) for to in entry.get("to", [entry])),
            entry.get("by", ""),
            entry.get("note", ""),
            entry["until"],
        )
        for entry in _file()["filters"]
    }


@functools.cache
def _params() -> dict[str, dict[str, tuple[OldParam, ...]]]:
    table: dict[str, dict[str, tuple[OldParam, ...]]] = {}
    for entry in _file()["params"]:
        old = OldParam(
            entry["old"],
            entry["type"],
            entry["param"],
            entry.get("as", {}),
            entry.get("idle"),
            entry.get("note", ""),
            entry["until"],
        )
        of_filter = table.setdefault(entry["filter"], {})
        for name in {old.old, keyword_of(old.old)}:
            of_filter[name] = (*of_filter.get(name, ()), old)
    return table


@functools.cache
def _choices() -> dict[tuple[str, str], tuple[OldChoices, ...]]:
    table: dict[tuple[str, str], tuple[OldChoices, ...]] = {}
    for entry in _file()["choices"]:
        old = OldChoices(
            tuple(entry["old"]), tuple(entry["now"]), entry.get("note", ""), entry["until"]
        )
        key = (entry["filter"], entry["param"])
        table[key] = (*table.get(key, ()), old)
    return table


@functools.cache
def _defaults() -> dict[str, tuple[OldDefault, ...]]:
    table: dict[str, tuple[OldDefault, ...]] = {}
    for entry in _file()["defaults"]:
        old = OldDefault(entry["param"], entry["was"], entry["now"], entry["until"])
        table[entry["filter"]] = (*table.get(entry["filter"], ()), old)
    return table
