"""Parameters of a filter, read from keyword arguments as PyMeshLab reads those of its own."""

from __future__ import annotations

import numbers
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import pymeshlab

from ..mlx.steps import Percentage
from ..options import Length

# What MeshLab can hold.
LEAST_INT, MOST_INT = -(2**31), 2**31 - 1


class ParameterTypeError(pymeshlab.PyMeshLabException, RuntimeError):
    """A value has a type that the parameter can't take; native filters raise `RuntimeError`."""


class Parameter(NamedTuple):
    """One parameter of a filter.

    Attributes
    ----------
    name : str
        The keyword: lower case, without underscores.
    type : type
        bool, int, float, or str: an enum where there are choices, else a text. `Percentage`: a
        length, or a percentage of the bounding box's diagonal.
    default : object or callable
        The default, or a function of the mesh set, which is None where there is no mesh, and of the
        values of the parameters before. (Of the set, as an exception would keep a reference to the
        mesh.) With a function, None can be given for the default.
    label, tooltip : str
        What MeshLab would write beside and over the field.
    choices : tuple of str
        The values of an enum.
    check : callable, optional
        Gets a value that was read, and returns it as functions on arrays take it. Raises
        `ValueError` if it is out of range, also for scripts, which are checked before they run.
    """

    name: str
    type: type
    default: Any
    label: str
    tooltip: str
    choices: tuple[str, ...] = ()
    check: Callable[[Any], Any] | None = None

    def default_for(self, ms: pymeshlab.MeshSet | None, values: Mapping[str, Any]) -> Any:
        """The default value for the current mesh of `ms`; an enum's index."""
        value = self.default(ms, values) if callable(self.default) else self.default
        return self.choices.index(value) if self.choices else value

    def shown_default(self) -> str:
        """The default without a mesh, as ``print_filter_parameter_list`` shows it."""
        value = self.default(None, {}) if callable(self.default) else self.default
        if self.type is str:
            return f"'{value}'"
        if self.type is Percentage:
            return f"{value.percent:g}%"
        return f"{value:g}" if self.type is float else str(value)

    def core_value(self, value: Any) -> Any:
        """A value that was read, as functions on arrays take it, or a `ValueError`."""
        if self.choices:
            return self.choices[value]
        return value if self.check is None else self.check(value)

    def type_name(self) -> str:
        """The type as PyMeshLab calls it."""
        return "PercentageValue" if self.type is Percentage else self.type.__name__

    def _expected(self) -> str:
        if self.type is str:
            return f"one of {self._listed()}" if self.choices else "a text or a number"
        return _EXPECTED[self.type]

    def _listed(self) -> str:
        """The choices, each with its index, which may be given instead."""
        return ", ".join(f"{index} '{choice}'" for index, choice in enumerate(self.choices))

    def read(self, value: Any) -> Any:
        """The given value in the parameter's own type; the index of an enum.

        Raises
        ------
        ParameterTypeError
            If `value` has a wrong type.
        pymeshlab.InvalidEnumException
            If an enum has no such value.
        """
        try:
            return _READERS[self.type](self, value)
        except OverflowError as error:
            raise ParameterTypeError(
                f"Parameter {self.name}: {value!r} is out of range, a whole number from "
                f"{LEAST_INT} to {MOST_INT} is expected."
            ) from error
        except TypeError as error:
            raise ParameterTypeError(
                f"Parameter {self.name}: {value!r} is a {type(value).__name__}, "
                f"{self._expected()} is expected."
            ) from error


def _read_bool(_: Parameter, value: Any) -> bool:
    if not hasattr(value, "__bool__") and value is not None:
        raise TypeError
    return bool(value)


def _read_int(_: Parameter, value: Any) -> int:
    index = operator.index(value)
    if not LEAST_INT <= index <= MOST_INT:
        raise OverflowError
    return index


def _read_float(_: Parameter, value: Any) -> float:
    if isinstance(value, (str, bytes)):
        raise TypeError
    return float(value)


def _read_share(_: Parameter, value: Any) -> float | Percentage:
    # As in PyMeshLab, no plain number: it could be meant as either.
    if isinstance(value, (Percentage, Length)):
        return value
    if isinstance(value, pymeshlab.PercentageValue):
        return Percentage(value.value())
    if isinstance(value, pymeshlab.PureValue):
        return float(value.value())
    raise TypeError


def _read_str(parameter: Parameter, value: Any) -> int | str:
    return _read_enum(parameter, value) if parameter.choices else _read_text(value)


def _read_text(value: Any) -> str:
    """A text; a number, which is a text too, is written with all its digits."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError
    return repr(float(value))


def _read_enum(parameter: Parameter, value: Any) -> int:
    choices = parameter.choices
    if isinstance(value, str):
        if value not in choices:
            known = "".join(f"'{choice}'; " for choice in choices)
            raise pymeshlab.InvalidEnumException(
                f"Parameter {parameter.name}: Enum '{value}' not found. Possible values are {known}"
            )
        return choices.index(value)
    index = operator.index(value)
    if not 0 <= index < len(choices):
        raise pymeshlab.InvalidEnumException(
            f"Parameter {parameter.name}: Enum {index} not valid. Must be a value between 0 and "
            f"{len(choices) - 1}: {parameter._listed()}"
        )
    return index


_READERS: dict[type, Callable[[Parameter, Any], Any]] = {
    bool: _read_bool,
    int: _read_int,
    float: _read_float,
    str: _read_str,
    Percentage: _read_share,
}
_EXPECTED = {
    bool: "a bool",
    int: "an int",
    float: "a float",
    Percentage: "a pymeshlab.PercentageValue, or a pymeshlab.PureValue for a length,",
}


def read_all(
    filter_name: str,
    parameters: Sequence[Parameter],
    given: Mapping[str, Any],
    ms: pymeshlab.MeshSet | None,
) -> dict[str, Any]:
    """All values of a call: the given ones, and the defaults for the current mesh of `ms`.

    Raises
    ------
    pymeshlab.PyMeshLabException
        For a keyword that is no parameter, with PyMeshLab's own message.
    """
    names = {parameter.name for parameter in parameters}
    for name in given:
        if name not in names:
            raise pymeshlab.PyMeshLabException(
                f"Parameter {name} not found for filter {filter_name}. "
                "Please check the documentation."
            )
    values: dict[str, Any] = {}
    for parameter in parameters:
        name = parameter.name
        is_default = given.get(name) is None and callable(parameter.default)
        is_given = name in given and not is_default
        values[name] = (
            parameter.read(given[name]) if is_given else parameter.default_for(ms, values)
        )
    return values
