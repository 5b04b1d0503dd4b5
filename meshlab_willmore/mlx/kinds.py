"""MeshLab's parameter types as a table: which attributes hold a value, and how."""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any, NamedTuple

from . import numerals
from .steps import Percentage


class Kind(NamedTuple):
    """How a type stands in a script.

    Attributes
    ----------
    fields : tuple of str
        The attributes that hold the value.
    read, show : callable
        One field's text to Python and back. `read` raises `ValueError`, `show` `TypeError`.
    expected : str
        What a value in Python has to be.
    needs : tuple of str
        Further attributes without which MeshLab drops the parameter.
    """

    fields: tuple[str, ...]
    read: Callable[[str], Any]
    show: Callable[[Any], str]
    expected: str
    needs: tuple[str, ...] = ()


def _show_bool(value: Any) -> str:
    if not isinstance(value, bool):
        raise TypeError
    return "true" if value else "false"


def _show_int(value: Any) -> str:
    if isinstance(value, bool):
        raise TypeError
    return str(operator.index(value))


def _show_float(value: Any) -> str:
    if isinstance(value, (bool, str, bytes)):
        raise TypeError
    return numerals.show_float(float(value))


def _show_percentage(value: Any) -> str:
    if not isinstance(value, Percentage):
        raise TypeError
    return _show_float(value.percent) + "%"


def _show_share(value: Any) -> str:
    return _show_percentage(value) if isinstance(value, Percentage) else _show_float(value)


def _show_str(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError
    return value


def _read_share(text: str) -> float | Percentage:
    if text.strip().endswith("%"):
        return numerals.parse_percentage(text)
    return numerals.parse_float(text)


VALUE = ("value",)
RANGE = ("min", "max")
_POINT = Kind(("x", "y", "z"), numerals.parse_float, _show_float, "3 numbers")
# An addition to MeshLab's types.
PERCENTAGE = "PercentageValue"
KINDS = {
    "RichBool": Kind(VALUE, numerals.parse_bool, _show_bool, "a bool"),
    "RichInt": Kind(VALUE, numerals.parse_int, _show_int, "an int"),
    "RichFloat": Kind(VALUE, numerals.parse_float, _show_float, "a float"),
    "RichString": Kind(VALUE, str, _show_str, "a str"),
    "RichEnum": Kind(
        VALUE, numerals.parse_index, _show_int, "an index", needs=("enum_cardinality",)
    ),
    "RichAbsPerc": Kind(VALUE, _read_share, _show_share, "a float or a Percentage", RANGE),
    "RichDynamicFloat": Kind(VALUE, numerals.parse_float, _show_float, "a float", RANGE),
    "RichColor": Kind(("r", "g", "b", "a"), numerals.parse_byte, _show_int, "4 ints from 0 to 255"),
    "RichPosition": _POINT,
    "RichDirection": _POINT,
    "RichPoint3f": _POINT,
    "RichMatrix44f": Kind(
        tuple(f"val{i}" for i in range(16)), numerals.parse_float, _show_float, "16 numbers"
    ),
    "RichMesh": Kind(VALUE, numerals.parse_index, _show_int, "a mesh id"),
    "RichOpenFile": Kind(VALUE, str, _show_str, "a str", needs=("exts_cardinality",)),
    "RichSaveFile": Kind(VALUE, str, _show_str, "a str"),
    "RichShotf": Kind((), str, _show_str, "None"),
    PERCENTAGE: Kind(VALUE, numerals.parse_percentage, _show_percentage, "a Percentage"),
}
