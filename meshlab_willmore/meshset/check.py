"""Checks the steps of a filter script, reports all faults at once, and turns them into calls.

Nothing is run. Whatever PyMeshLab would skip, misread or crash at is a fault.
"""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterable, Iterator
from typing import Any, NamedTuple

from ..mlx.steps import (
    MORE_FAULTS,
    MOST_FAULTS,
    Fault,
    Gap,
    Param,
    Reading,
    ScriptError,
    ScriptWarning,
    Step,
    Value,
    add_fault,
    quoted,
    shortened,
)
from . import catalogue, document, old_names
from .catalogue import FilterInfo
from .filter_info import ParamInfo
from .filters import BY_NAME
from .old_names import Given, Migration, Remark
from .values import mismatch, value_of

# A longer list of parameters would not help.
_MOST_LISTED = 12
_NO_GAP = Gap()
# Attributes of the time of meshlabserver, without a meaning today.
_OLD_ATTRIBUTES = frozenset({"isxmlparam"})


class Call(NamedTuple):
    """A checked step.

    Attributes
    ----------
    number : int
        Its place in the script, from 1.
    known : FilterInfo
        The filter.
    given : dict
        The parameters that the step gives, by PyMeshLab's keyword; an enum's value is its index.
    details : dict
        The other attributes of each in the script: description, range and so on.
    """

    number: int
    known: FilterInfo
    given: dict[str, Value]
    details: dict[str, tuple[tuple[str, str], ...]] = {}  # noqa: RUF012 - never changed


class Findings(NamedTuple):
    """What a check found: calls of the steps that can be run, faults, warnings, and its input."""

    calls: tuple[Call, ...]
    faults: tuple[Fault, ...]
    warnings: tuple[ScriptWarning, ...]
    reading: Reading


def resolve(
    steps: Iterable[Step], source: str, mesh_ids: Collection[int] | None = None
) -> tuple[Call, ...]:
    """Check steps and turn them into calls.

    Parameters
    ----------
    steps : iterable of Step
        As read from a script, or made by hand.
    source : str
        The name of the script in errors.
    mesh_ids : collection of int, optional
        The ids before the first step; if it is not given, ids are not checked.

    Returns
    -------
    tuple of Call
        One for each step.

    Raises
    ------
    ScriptError
        With all faults.
    """
    found = examine(Reading(tuple(steps)), mesh_ids)
    if found.faults:
        raise ScriptError(source, found.faults)
    return found.calls


def faults_of(steps: Iterable[Step], mesh_ids: Collection[int] | None = None) -> list[Fault]:
    """All faults of steps; empty if they can be run. Parameters are those of `resolve`."""
    return list(examine(Reading(tuple(steps)), mesh_ids).faults)


def examine(reading: Reading, mesh_ids: Collection[int] | None = None) -> Findings:
    """Check what was read of a script, and merge its faults with those of the reading.

    A consequence of a fault of the reading is not reported again.
    """
    checker = _Checker(mesh_ids)
    if reading.is_loose:
        checker.warnings.append(ScriptWarning(_LOOSE))
    calls: list[Call] = []
    with contextlib.suppress(_TooManyFaultsError):
        for number, step in enumerate(reading.steps, start=1):
            calls += checker.calls(number, step, reading.gaps.get(number, _NO_GAP))
        checker.warn_of_defaults()
    faults = _merged(reading.faults, checker.faults)
    return Findings(tuple(calls), faults, tuple(checker.warnings), reading)


def _merged(read: Iterable[Fault], checked: Iterable[Fault]) -> tuple[Fault, ...]:
    """Faults by the number of the step; of each step, those of the reading come first."""
    faults = sorted([*read, *checked], key=lambda fault: fault.step)
    first = [fault for fault in faults if fault != MORE_FAULTS]
    are_more = len(first) < len(faults) or len(first) > MOST_FAULTS
    return (*first[:MOST_FAULTS], MORE_FAULTS) if are_more else tuple(first)


_LOOSE = (
    "is no XML: attributes have no blank between them, or are given twice; MeshLab still reads it"
)


def is_todays(step: Step) -> bool:
    """Whether PyMeshLab itself knows the filter and the parameters of a step by their names."""
    known = catalogue.find(step.filter)
    if known is None or step.filter != known.meshlab_name or document.is_step(known.name):
        return False
    names = {own.name for own in known.params}
    has_names = all(param.type and param.name in names for param in step.params)
    return has_names and not Migration(step, known, {}, "").remarks


# --- calls to steps in today's names -------------------------------------------------------------


def modernised(steps: Iterable[Step]) -> tuple[Step, ...]:
    """The steps in today's form; a step with a fault stays as it is."""
    return tuple(map(_modernised, steps))


def _modernised(step: Step) -> Step:
    try:
        (call,) = resolve([step], "")
    except ScriptError:
        return step
    return in_todays_form(call, step)


def in_todays_form(call: Call, step: Step) -> Step:
    """The step that `call` was made of, in today's form; descriptions and ranges stay."""
    params = []
    for keyword, value in call.given.items():
        known = call.known.param(keyword)
        if known is not None:
            details = tuple(
                pair for pair in call.details[keyword] if pair[0] not in _OLD_ATTRIBUTES
            )
            params.append(Param(known.name, known.type, value, with_choices(known, details)))
    # The MeshLab name of a plugin that the user brought is not known.
    return step._replace(filter=call.known.meshlab_name or step.filter, params=tuple(params))


def with_choices(
    known: ParamInfo, details: tuple[tuple[str, str], ...]
) -> tuple[tuple[str, str], ...]:
    """The details of a parameter, with the names of an enum's choices as they are today."""
    if not known.choices:
        return details
    names = [(f"enum_val{i}", choice) for i, choice in enumerate(known.choices)]
    choices = [("enum_cardinality", str(len(known.choices))), *names]
    kept = [pair for pair in details if not pair[0].startswith(("enum_val", "enum_card"))]
    is_there = len(details) == len(kept) + len(choices) and set(choices) <= set(details)
    return details if is_there else (*kept, *choices)


# --- checking ----------------------------------------------------------------------------------


class _TooManyFaultsError(Exception):
    """There are more faults than are reported."""


class _Checker:
    """Checks steps in order, keeps track of the meshes that can exist, and collects faults."""

    def __init__(self, mesh_ids: Collection[int] | None) -> None:
        self.faults: list[Fault] = []
        self.warnings: list[ScriptWarning] = []
        self._ids = mesh_ids
        # The number of meshes, as long as none can have been added.
        self._left = len(mesh_ids) if mesh_ids is not None else 0
        self._may_be_more = False
        # At most how new the script is, by the old names in it; see `old_names.age`.
        self._age: int | None = None
        self._checked: list[tuple[int, Step, Call]] = []
        # The step that is being checked.
        self._number = 0
        self._step = Step("")

    def calls(self, number: int, step: Step, gap: Gap) -> list[Call]:
        """The call of one step; none if there is no such filter."""
        self._number, self._step = number, step
        if gap.follows_unread:
            self._may_be_more = True
        old = old_names.filter_of(step.filter)
        target = old.target(step) if old else None
        known = catalogue.find(target.filter if target else step.filter)
        if known is None or not known.available:
            if not gap.is_nameless:
                problem = _absent(step.filter) if known is None else _unavailable(known)
                self._add(problem)
            self._may_be_more = True
            return []
        if known.needs_mesh and self._is_empty():
            self._add(_NO_MESH)
            self._may_be_more = True
        self._warn_of_name(known)
        migration = Migration(step, known, target.given if target else {}, old.by if old else "")
        self._age = old_names.older(self._age, migration.age)
        for remark in migration.problems:
            self._add(remark.text, remark.shown)
        for remark in migration.remarks:
            self._warn(remark)
        call = Call(number, known, {}, {})
        for item, own in self._params(known, migration, gap):
            self._take(call, item, own)
        if known.is_willmore:
            self._check_barred(call)
        self._may_be_more = self._may_be_more or known.makes_layers
        self._left -= known.name == _DELETE
        self._checked.append((number, step, call))
        return [call]

    def _take(self, call: Call, item: Given, own: ParamInfo) -> None:
        """Put a parameter's value into a call, or add the fault."""
        try:
            value = value_of(item.param, own)
            _check_range(call.known, own, value)
            self._check_id(own, value)
        except ValueError as error:
            self._add(str(error), item.shown)
            return
        # PyMeshLab takes no cameras from scripts, and writes none: it is empty.
        if own.type != "RichShotf":
            call.given[own.keyword] = value
            call.details[own.keyword] = item.param.details

    def _check_barred(self, call: Call) -> None:
        """Take out what can't be given beside other parameters; a fault, but for defaults.

        Scripts that programs write have all parameters, whether somebody has set them or not.
        """
        filter_ = BY_NAME[call.known.name]
        barred = filter_.barred(call.given)
        for parameter in filter_.parameters:
            name = parameter.name
            if name in barred and name in call.given:
                if call.given[name] != parameter.default_for(None, {}):
                    self._add(barred[name], name)
                del call.given[name], call.details[name]

    def _params(
        self, known: FilterInfo, migration: Migration, gap: Gap
    ) -> Iterator[tuple[Given, ParamInfo]]:
        """The parameters that the filter has, each once."""
        seen: dict[str, str] = {}
        for item in migration.given:
            own = known.param(item.param.name)
            if own is None:
                self._add(_no_parameter(known, item.shown), item.shown)
            elif own.keyword in seen:
                first = seen[own.keyword]
                also = "" if first == item.shown else f", also as {quoted(first)}"
                self._add(f"is given twice{also}", item.shown)
            else:
                seen[own.keyword] = item.shown
                if item.shown in gap.untyped:
                    text = f"has no type; it is read as {own.type}, the filter's own"
                    self._warn(Remark(item.shown, text))
                yield item, own
        self._check_broken(known, gap)
        unread = {own.keyword for param in gap.broken if (own := known.param(param.name))}
        lost = {remark.shown for remark in migration.problems}
        for own in known.params:
            if own.required and own.keyword not in {*seen, *unread} and not (gap.is_cut or lost):
                self._add("is missing; the filter can't do without it", own.name)

    def _check_broken(self, known: FilterInfo, gap: Gap) -> None:
        """Add what else is wrong with parameters whose values can't be read."""
        for param in gap.broken:
            own = known.param(old_names.plain(param.name))
            if own is not None:
                if problem := mismatch(param, own):
                    self._add(problem, param.name)
            elif not old_names.params_of(known.name, param.name):
                self._add(_no_parameter(known, param.name), param.name)

    # --- warnings ------------------------------------------------------------------------------

    def _warn_of_name(self, known: FilterInfo) -> None:
        step = self._step
        if step.filter in (known.name, known.meshlab_name):
            if document.is_step(known.name):
                self._warn(Remark("", "MeshLab has no such step any more"))
            return
        old = old_names.filter_of(step.filter)
        today = known.meshlab_name or known.name
        only_blanks = step.filter.strip() == today.strip()
        text = "has other blanks around its name than " if only_blanks else "is "
        text += f"{today!r} in today's MeshLab"
        if old and old.note:
            text += f": {old.note}"
        self._warn(Remark("", text, changes_result=bool(old and old.note)))
        if old:
            self._age = old_names.older(self._age, old_names.age(old.until))

    def warn_of_defaults(self) -> None:
        """Warn of defaults that have changed since the script was written, if its age shows."""
        if self._age is None:
            return
        for number, step, call in self._checked:
            self._number, self._step = number, step
            for old in old_names.defaults_of(call.known.name):
                own = call.known.param(old.param)
                is_old = self._age <= old_names.age(old.until)
                if own and own.keyword not in call.given and is_old:
                    text = (
                        f"is not given: it was {old.was} until MeshLab {old.until}, and is "
                        f"{old.now} today"
                    )
                    self._warn(Remark(old.param, text, changes_result=True))

    def _warn(self, remark: Remark) -> None:
        if len(self.warnings) < MOST_FAULTS:
            name, shown = shortened(self._step.filter), shortened(remark.shown)
            changes = remark.changes_result
            warning = ScriptWarning(remark.text, self._number, name, shown, "", changes)
            self.warnings.append(warning)

    # --- faults --------------------------------------------------------------------------------

    def _check_id(self, own: ParamInfo, value: Any) -> None:
        if own.type != "RichMesh" or self._ids is None or value in self._ids:
            return
        there = ", ".join(map(str, sorted(self._ids))) or "none"
        if not self._may_be_more:
            raise ValueError(f"there will be no mesh {value} (there are: {there})")
        if value < max(self._ids, default=0):
            raise ValueError(
                f"there will be no mesh {value} (there are: {there}; new ones get higher ids)"
            )

    def _is_empty(self) -> bool:
        return self._ids is not None and self._left <= 0 and not self._may_be_more

    def _add(self, text: str, param: str = "") -> None:
        name = shortened(self._step.filter)
        if not add_fault(self.faults, Fault(text, self._number, name, shortened(param))):
            raise _TooManyFaultsError


def _check_range(known: FilterInfo, own: ParamInfo, value: Value) -> None:
    """Raise `ValueError` if a parameter of ours is out of range; MeshLab's have no known ranges."""
    for parameter in BY_NAME[known.name].parameters if known.is_willmore else ():
        if parameter.name == own.keyword and parameter.check is not None:
            parameter.check(value)


# --- names -------------------------------------------------------------------------------------

_DELETE = "delete_current_mesh"
_NO_MESH = "needs a mesh; give an input, or begin with a filter that creates one"


def _absent(name: str) -> str:
    if not name:
        return "has no name"
    last = old_names.last_version_with(name)
    if last:
        return f"MeshLab had this filter until {last}, and has none in its place"
    return "no such filter; " + _meant(
        name, catalogue.closest(name), "pymeshlab.print_filter_list() lists them"
    )


def _unavailable(known: FilterInfo) -> str:
    recorded, here = catalogue.recorded_version(), catalogue.version()
    reason = "its plugin is not loaded here"
    if recorded != here:
        reason = f"PyMeshLab {here} does not have it, or has not loaded its plugin"
    cure = "pymeshlab.print_plugin_list() shows what is there"
    return f"is a filter of PyMeshLab {recorded}, but {reason}; {cure}"


def _no_parameter(known: FilterInfo, name: str) -> str:
    keywords, names = [p.keyword for p in known.params], [p.name for p in known.params]
    similar = catalogue.similar(name, names) or catalogue.similar(name, keywords)
    if not known.params:
        return "no such parameter; the filter has none"
    more = ", ..." if len(names) > _MOST_LISTED else ""
    listed = "it has " + ", ".join(names[:_MOST_LISTED]) + more
    return "no such parameter; " + _meant(name, similar, listed)


def _meant(name: str, similar: list[str], otherwise: str) -> str:
    if not similar:
        return otherwise
    if similar[0].lower() == name.lower():
        return f"did you mean {similar[0]!r}? Upper and lower case differ"
    return f"did you mean {' or '.join(map(repr, similar))}?"
