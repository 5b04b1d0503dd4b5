"""Old names of filters and parameters: steps of MeshLab's older versions in today's names.

The table is `old_names.json`. Each entry says in which versions of MeshLab a name was in use, and
in which of its sources (a path below the folder of plugins); a version without a release of that
name is MeshLab's source of that month. Entries are:

filters
    A filter's old name and today's, and parameters that have to be `given` for the same meaning.
    Where one filter became several, `by` is the parameter that says which one was meant.
params
    A parameter's old name, its type then, and today's name (null: it was removed, and did nothing
    where its value is the `idle` one). `as` says how the value changes: `times` a number, that
    number of `percent`, one of the `values` listed by what was written, or `part` of a colour.
choices
    Choices of an enum in their old order, and where each of them is now.
defaults
    Values of parameters that are not given, where they have changed.
expressions
    Parameters that are formulas.
removed
    Filters that nothing took the place of, with the last version that had them.
"""

from __future__ import annotations

import functools
import json
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..mlx import rich
from ..mlx.steps import Param, Percentage, Step, Value, quoted
from .filter_info import FilterInfo, ParamInfo, keyword_of

_FILE = Path(__file__).with_name("old_names.json")
# MeshLab's parser of formulas had words for these until the end of 2015.
_SYMBOLS = {"and": "&&", "or": "||"}
_LAST_WITH_WORDS = "2015.03"
_WORD = re.compile(r"\b(and|or)\b")
# Attributes that only MeshLab's scripts of up to this version have.
_OLD_ATTRIBUTE, _LAST_WITH_ATTRIBUTE = "isxmlparam", "2020.06"
# What MeshLab's old filter for one colour took for a part that is not given.
_FULL = 255
# Attributes that say the same of a parameter whatever its value becomes.
_DESCRIBING = frozenset({"description", "tooltip"})


class Target(NamedTuple):
    """Today's filter, by PyMeshLab's name, and parameters without which it means another thing."""

    filter: str
    given: dict[str, Value]


class OldFilter(NamedTuple):
    """A filter under an old name.

    Attributes
    ----------
    targets : tuple of Target
        What it is today; more than one if a parameter decides.
    by : str
        The parameter that does; its value is the index of the target.
    note : str
        What has changed; empty if nothing has.
    until : str
        The last version that had the name.
    """

    targets: tuple[Target, ...]
    by: str
    note: str
    until: str

    def target(self, step: Step) -> Target:
        """Today's filter of a step; the first, where the step does not decide."""
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


# --- the table ---------------------------------------------------------------------------------


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
    olds = _params().get(filter_name, ())
    found = tuple(old for old in olds if old.old == plain(name))
    return found or tuple(o for o in olds if keyword_of(o.old) == keyword_of(plain(name)))


def defaults_of(filter_name: str) -> tuple[OldDefault, ...]:
    """Which defaults of a filter have changed."""
    return tuple(
        OldDefault(entry["param"], entry["was"], entry["now"], entry["until"])
        for entry in _file()["defaults"]
        if entry["filter"] == filter_name
    )


def last_version_with(name: str) -> str | None:
    """The last version of MeshLab that had a filter which nothing took the place of."""
    return _file()["removed"].get(plain(name))


def age(version: str) -> int:
    """The place of a version in the history: less is older."""
    return _file()["versions"].index(version)


def older(one: int | None, other: int | None) -> int | None:
    """The lesser of two ages, which may be unknown."""
    return min((a for a in (one, other) if a is not None), default=None)


@functools.cache
def _file() -> dict[str, Any]:
    return json.loads(_FILE.read_text(encoding="utf-8"))


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
def _params() -> Mapping[str, list[OldParam]]:
    """The old parameters by today's filter."""
    table = defaultdict(list)
    for entry in _file()["params"]:
        change, idle, note = entry.get("as", {}), entry.get("idle"), entry.get("note", "")
        table[entry["filter"]].append(
            OldParam(
                entry["old"], entry["type"], entry["param"], change, idle, note, entry["until"]
            )
        )
    return table


def _choices_of(filter_name: str, param: str) -> Iterator[OldChoices]:
    """The choices that an enum had before."""
    for entry in _file()["choices"]:
        if (entry["filter"], entry["param"]) == (filter_name, param):
            note = entry.get("note", "")
            yield OldChoices(tuple(entry["old"]), tuple(entry["now"]), note, entry["until"])


# --- migration ---------------------------------------------------------------------------------


class Given(NamedTuple):
    """A parameter under today's name, and the name that the script shows."""

    shown: str
    param: Param


class Remark(NamedTuple):
    """What one should know of a parameter."""

    shown: str
    text: str
    changes_result: bool = False


class Migration:
    """The parameters of one step, as today's filter has them.

    Attributes
    ----------
    given : list of Given
        Under the names of today's filter; those that it never had are left as they are.
    remarks : list of Remark
        Which names and meanings have changed.
    problems : list of Remark
        Values that can't be converted.
    age : int, optional
        At most how new the script is (see `age`), by what its parameters show.
    """

    def __init__(self, step: Step, known: FilterInfo, given: Mapping[str, Value], by: str) -> None:
        self.given: list[Given] = []
        self.remarks: list[Remark] = []
        self.problems: list[Remark] = []
        self.age: int | None = None
        self._known = known
        self._parts: dict[str, list[tuple[str, OldParam, Value]]] = {}
        for param in step.params:
            if not by or param.name.strip() != by:
                self._take(param)
        self.given += self._colours()
        there = {known.param(item.param.name) for item in self.given}
        for name, value in given.items():
            if known.param(name) not in there:
                self.given.append(Given(name, Param(name, "", value)))

    def _take(self, param: Param) -> None:
        if any(key == _OLD_ATTRIBUTE for key, _ in param.details):
            self._is_of(_LAST_WITH_ATTRIBUTE)
        own = self._known.param(plain(param.name))
        olds = () if own else params_of(self._known.name, param.name)
        if own:
            as_today = self._in_todays_symbols(own, self._in_todays_choices(own, param))
            self.given.append(Given(param.name, as_today._replace(name=own.name)))
        elif not olds:
            self.given.append(Given(param.name, param))
        for old in olds:
            self._is_of(old.until)
            try:
                self.given += self._converted(param, old)
            except ValueError as error:
                self.problems.append(Remark(param.name, str(error)))

    def _converted(self, param: Param, old: OldParam) -> Iterator[Given]:
        value = _value_then(param, old)
        more = f": {old.note}" if old.note else ""
        if old.param is None:
            is_idle = old.idle in ("any", value)
            text = f"is ignored: the filter has had none such since MeshLab {old.until}{more}"
            self.remarks.append(Remark(param.name, text, changes_result=not is_idle))
            return
        text = f"is {old.param!r} today{more}"
        self.remarks.append(Remark(param.name, text, changes_result=bool(more)))
        new = _convert(value, old)
        if "part" in old.change:
            self._parts.setdefault(old.param, []).append((param.name, old, new))
        elif old.change:
            kept = tuple(pair for pair in param.details if pair[0] in _DESCRIBING)
            yield Given(param.name, Param(old.param, "", new, kept))
        else:
            yield Given(param.name, param._replace(name=old.param))

    def _colours(self) -> Iterator[Given]:
        """Colours whose parts were parameters of their own."""
        for name, parts in self._parts.items():
            colour = [_FULL] * 4
            for shown, old, value in parts:
                if not isinstance(value, (int, float)) or not 0 <= value <= _FULL:
                    self.problems.append(Remark(shown, f"is not between 0 and {_FULL}"))
                else:
                    colour[old.change["part"]] = int(value)
            yield Given(parts[0][0], Param(name, "", tuple(colour)))

    def _in_todays_choices(self, own: ParamInfo, param: Param) -> Param:
        """The parameter; an enum whose choices were in another order gets today's index."""
        choices = _choices_of(self._known.name, own.name)
        if not param.type and isinstance(param.value, str) and param.value not in own.choices:
            return self._by_old_choice(param, choices)
        if param.type != "RichEnum" or not isinstance(param.value, int):
            return param
        details = dict(param.details)
        names = {key: name for key, name in details.items() if key.startswith("enum_val")}
        for old in choices:
            then = {f"enum_val{i}": name for i, name in enumerate(old.old)}
            fits = details.get("enum_cardinality", "").strip() == str(len(then))
            # Without names, only another number of choices decides.
            decides = bool(names) or len(then) != len(own.choices)
            if fits and decides and names.items() <= then.items() and param.value < len(then):
                self._is_of(old.until)
                return self._renumbered(own, param, param.value, old)
        return param

    def _by_old_choice(self, param: Param, choices: Iterable[OldChoices]) -> Param:
        """The parameter; a choice that is given by its old name gets today's index."""
        for old in choices:
            if param.value in old.old:
                self._is_of(old.until)
                return param._replace(value=old.now[old.old.index(str(param.value))])
        return param

    def _renumbered(self, own: ParamInfo, param: Param, then: int, old: OldChoices) -> Param:
        name, now = old.old[then], old.now[then]
        today = own.choices[now]
        if name != today and name in own.choices:
            more = f"; {old.note}" if old.note else ""
            text = f"choice {then}, {quoted(name)}, is {now}, {today!r}, today{more}"
            self.remarks.append(Remark(param.name, text))
        elif now != then:
            text = f"choice {then}, {quoted(name)}, is {now} today"
            self.remarks.append(Remark(param.name, text))
        kept = tuple(pair for pair in param.details if not pair[0].startswith("enum_"))
        return Param(param.name, "", now, kept)

    def _in_todays_symbols(self, own: ParamInfo, param: Param) -> Param:
        """The parameter; a formula gets `&&` for `and`, `||` for `or`."""
        formulas = _file()["expressions"].get(self._known.name, ())
        if not isinstance(param.value, str) or own.name not in formulas:
            return param
        new = _WORD.sub(lambda word: _SYMBOLS[word[0]], param.value)
        if new != param.value:
            self._is_of(_LAST_WITH_WORDS)
            text = "formulas have '&&' for 'and', '||' for 'or' today"
            self.remarks.append(Remark(param.name, text))
        return param._replace(value=new)

    def _is_of(self, version: str) -> None:
        """Note that the script is not newer than a version."""
        self.age = older(self.age, age(version))


def _value_then(param: Param, old: OldParam) -> Value:
    """The value of a script's parameter, read in the type that it had; `ValueError` if it fails."""
    if param.type or not isinstance(param.value, str):
        return param.value
    return rich.parse_text(old.type, param.value)


def _convert(value: Value, old: OldParam) -> Value:
    """An old parameter's value as today's parameter has it; `ValueError` if it was none."""
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
