"""What a filter script says: steps, their parameters, and what can be wrong with them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple


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
        The number of the step, from 1; 0 stands for the whole script.
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
        text = self._within_the_script()
        return f"{self.source}: {text}" if self.source else text

    def _within_the_script(self) -> str:
        where = f"step {self.step}" if self.step else ""
        where += f" ({self.filter})" if self.filter else ""
        where += f", parameter {self.param!r}" if self.param else ""
        return f"{where}: {self.text}" if where else self.text


class ScriptError(ValueError):
    """A filter script that can't be read or run, with all its faults.

    Attributes
    ----------
    source : str
        The file, or another name of the script.
    faults : tuple of Fault
        At least one.
    """

    def __init__(self, source: str, faults: Iterable[Fault]) -> None:
        self.source = source
        self.faults = tuple(faults)
        super().__init__("\n".join(f"{source}: {fault}" for fault in self.faults))
