"""What a filter script says: steps, their parameters, and what can be wrong with them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

# The longest piece of a script that a message shows.
SHOWN = 60


class Percentage(NamedTuple):
    """A share of a parameter's range on the mesh at hand, in percent."""

    percent: float


# A RichShotf has no value in a script (None); points, colours and matrices are tuples.
Value = bool | int | float | str | Percentage | tuple[float, ...] | tuple[int, ...] | None


class Param(NamedTuple):
    """A parameter of a step.

    Attributes
    ----------
    name : str
        As in the script: MeshLab's name, or PyMeshLab's keyword.
    type : str
        "RichBool", "RichFloat", ...; empty in the old form that has no types, where `value` is the
        text and the filter's own type decides what it means.
    value : Value
        In the Python type that fits.
    details : tuple of (str, str)
        The other attributes, in their order: description, tooltip, min, max, enum_cardinality, ...
    """

    name: str
    type: str
    value: Value
    details: tuple[tuple[str, str], ...] = ()


class Step(NamedTuple):
    """One filter of a script: its name as in the script, and the parameters that are given."""

    filter: str
    params: tuple[Param, ...] = ()


class Fault(NamedTuple):
    """What is wrong, and where.

    Attributes
    ----------
    text : str
        What is wrong, in one line.
    step : int
        The number of the step, from 1; 0 is the whole script.
    filter, param : str
        Names as in the script, shortened if they are long; empty where there is none.
    source : str
        The file; empty in a `ScriptError`, which names it itself.
    """

    text: str
    step: int = 0
    filter: str = ""
    param: str = ""
    source: str = ""

    def __str__(self) -> str:
        """One line: file, step, filter and parameter as far as they are known, then the text."""
        return _line(self)


# Of a script no more are reported, but that there are more.
MOST_FAULTS = 100
MORE_FAULTS = Fault(f"has more than {MOST_FAULTS} faults; these are the first")


def add_fault(faults: list[Fault], fault: Fault) -> bool:
    """Add a fault to a list, or `MORE_FAULTS` to one that is full; return whether it was added."""
    is_full = len(faults) >= MOST_FAULTS
    faults.append(MORE_FAULTS if is_full else fault)
    return not is_full


class ScriptWarning(NamedTuple):
    """What one should know of a step that can be run.

    Attributes
    ----------
    text, step, filter, param, source
        As of a `Fault`.
    changes_result : bool
        Whether the step does something else than it did where the script was written.
    """

    text: str
    step: int = 0
    filter: str = ""
    param: str = ""
    source: str = ""
    changes_result: bool = False

    def __str__(self) -> str:
        """One line, as of a `Fault`."""
        return _line(self)


def _line(found: Fault | ScriptWarning) -> str:
    where = f"step {found.step}" if found.step else ""
    where += f" ({found.filter})" if found.filter else ""
    where += f", parameter {found.param!r}" if found.param else ""
    text = f"{where}: {found.text}" if where else found.text
    return f"{found.source}: {text}" if found.source else text


class ScriptError(ValueError):
    """A filter script that can't be read or run, with all its `faults`.

    There is at least one. The `source` is the file, or another name of the script.
    """

    def __init__(self, source: str, faults: Iterable[Fault]) -> None:
        self.source = source
        self.faults: tuple[Fault, ...] = tuple(faults)
        super().__init__("\n".join(f"{source}: {fault}" for fault in self.faults))


class Gap(NamedTuple):
    """What of a step could not be read, or only with the filter's help."""

    # Parameters without a value that can be read; their value is None.
    broken: tuple[Param, ...] = ()
    # Names of parameters that have no type where they should have one.
    untyped: frozenset[str] = frozenset()
    # Whether the step may have had more parameters.
    is_cut: bool = False
    # Whether the step has no name.
    is_nameless: bool = False
    # Whether something before the step was not read, which may have been another step.
    follows_unread: bool = False


class Reading(NamedTuple):
    """All that could be read of a script."""

    # What could be read; steps and parameters with faults are left out, or in part.
    steps: tuple[Step, ...]
    # Why the others could not.
    faults: tuple[Fault, ...] = ()
    # By a step's number.
    gaps: Mapping[int, Gap] = MappingProxyType({})
    # Whether there are comments, which no step holds.
    has_comments: bool = False
    # Whether it is XML only with blanks between attributes, and each of them once.
    is_loose: bool = False


def quoted(text: str) -> str:
    """`text` in quotes, on one line, cut where it gets too long for a message."""
    return repr(shortened(text))


def shortened(text: str) -> str:
    """`text` on one line, cut where it gets too long for a message."""
    begin = " ".join(text[: 2 * SHOWN].split())
    return begin if len(begin) <= SHOWN else begin[: SHOWN - 3] + "..."
