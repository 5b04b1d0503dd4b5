"""Steps of a filter script to calls of filters, with all that is wrong in them said at once.

Nothing is run for it. What PyMeshLab would skip, take for something else or crash at is a fault.
"""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterable, Iterator
from typing import Any, NamedTuple

from ..mlx.elements import MOST_FAULTS
from ..mlx.steps import Fault, Param, ScriptError, Step, Value
from ..mlx.words import quoted, shortened
from . import catalogue
from .catalogue import Known
from .filters import BY_NAME
from .probe import KnownParam
from .values import value_of

# A longer list of parameters would not help.
_MOST_LISTED = 12


class Call(NamedTuple):
    """A checked step.

    Attributes
    ----------
    number : int
        Its place in the script, from 1.
    known : Known
        The filter.
    given : dict
        The parameters that the step gives, by PyMeshLab's keyword; an enum's value is its index.
    """

    number: int
    known: Known
    given: dict[str, Value]


def resolve(
    steps: Iterable[Step], source: str, mesh_ids: Collection[int] | None = None
) -> tuple[Call, ...]:
    """Check steps and say what to call.

    Parameters
    ----------
    steps : iterable of Step
        As read from a script, or made by hand.
    source : str
        What errors call the script.
    mesh_ids : collection of int, optional
        The meshes that are there before the first step; if it is not given, ids are not checked.

    Returns
    -------
    tuple of Call
        One for each step.

    Raises
    ------
    ScriptError
        With all faults.
    """
    checker = _Checker(mesh_ids)
    calls = []
    with contextlib.suppress(_EnoughError):
        for number, step in enumerate(steps, start=1):
            calls += checker.calls(number, step)
    if checker.faults:
        raise ScriptError(source, checker.faults)
    return tuple(calls)


def faults_of(steps: Iterable[Step], mesh_ids: Collection[int] | None = None) -> list[Fault]:
    """All that is wrong with steps; empty if they can be run. Parameters are those of `resolve`."""
    try:
        resolve(steps, "", mesh_ids)
    except ScriptError as error:
        return list(error.faults)
    return []


class _EnoughError(Exception):
    """There is no sense in going on."""


class _Checker:
    """Goes through steps in order; knows which meshes there can be, and collects faults."""

    def __init__(self, mesh_ids: Collection[int] | None) -> None:
        self.faults: list[Fault] = []
        self._ids = mesh_ids
        # How many meshes are left , as long as none can have been added.
        self._left = len(mesh_ids) if mesh_ids is not None else 0
        self._may_be_more = False

    def calls(self, number: int, step: Step) -> list[Call]:
        """The call of one step; none if there is no such filter."""
        known = catalogue.find(step.filter)
        if known is None or not known.available:
            problem = _absent(step.filter) if known is None else _unavailable(known)
            self._add(number, step, problem)
            self._may_be_more = True
            return []
        if known.needs_mesh and self._is_empty():
            self._add(number, step, _NO_MESH)
            self._may_be_more = True
        given = dict(self._values(number, step, known))
        self._may_be_more = self._may_be_more or known.makes_layers
        self._left -= known.name == _DELETE
        return [Call(number, known, given)]

    def _values(self, number: int, step: Step, known: Known) -> Iterator[tuple[str, Value]]:
        for param, own in self._params(number, step, known):
            try:
                value = value_of(param, own)
                _check_range(known, own, value)
                self._check_id(own, value)
            except ValueError as error:  # noqa: PERF203 - every fault is to be told
                self._add(number, step, str(error), param.name)
            else:
                # PyMeshLab takes no cameras from scripts, and writes none: it is empty.
                if own.type != "RichShotf":
                    yield own.keyword, value

    def _params(self, number: int, step: Step, known: Known) -> Iterator[tuple[Param, KnownParam]]:
        """The parameters that the filter has, each once."""
        seen: dict[str, str] = {}
        for param in step.params:
            own = known.param(param.name)
            if own is None:
                self._add(number, step, _no_parameter(known, param.name), param.name)
            elif own.keyword in seen:
                first = seen[own.keyword]
                also = "" if first == param.name else f", also as {quoted(first)}"
                self._add(number, step, f"is given twice{also}", param.name)
            else:
                seen[own.keyword] = param.name
                yield param, own
        for own in known.params:
            if own.required and own.keyword not in seen:
                self._add(number, step, "is missing; the filter can't do without it", own.name)

    def _check_id(self, own: KnownParam, value: Any) -> None:
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

    def _add(self, number: int, step: Step, text: str, param: str = "") -> None:
        if len(self.faults) == MOST_FAULTS:
            self.faults.append(Fault(f"has more than {MOST_FAULTS} faults; these are the first"))
            raise _EnoughError
        self.faults.append(Fault(text, number, shortened(step.filter), shortened(param)))


def _check_range(known: Known, own: KnownParam, value: Value) -> None:
    """Raise `ValueError` if a parameter of ours is out of range; MeshLab's tell no ranges."""
    for parameter in BY_NAME[known.name].parameters if known.ours else ():
        if parameter.name == own.keyword and parameter.check is not None:
            parameter.check(own.keyword, value)


# --- names -------------------------------------------------------------------------------------

_DELETE = "delete_current_mesh"
_NO_MESH = "needs a mesh; give an input, or begin with a filter that creates one"


def _absent(name: str) -> str:
    if not name:
        return "has no name"
    return "no such filter; " + _meant(
        name, catalogue.closest(name), "'meshlab-willmore filters' lists them"
    )


def _unavailable(known: Known) -> str:
    recorded, here = catalogue.recorded_version(), catalogue.version()
    reason = "its plugin is not loaded here"
    if recorded != here:
        reason = f"PyMeshLab {here} has not got it, or not loaded its plugin"
    cure = "'meshlab-willmore doctor' tells more"
    return f"is a filter of PyMeshLab {recorded}, but {reason}; {cure}"


def _no_parameter(known: Known, name: str) -> str:
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
