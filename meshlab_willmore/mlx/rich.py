"""MeshLab's parameter types ("Rich" in its source): which attributes hold a value, and how.

What MeshLab drops, or takes for something else without a word, is refused.
"""

from __future__ import annotations

import difflib
import operator
import re
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any, NamedTuple

from .steps import Param, Percentage, Value, quoted, shortened

LARGEST_FLOAT = (2 - 2**-23) * 2.0**127
SMALLEST_FLOAT = 2.0**-150  # halfway to the least single above zero; this half rounds to zero
LARGEST_INT = 2**31 - 1
LARGEST_BYTE = 255
# MeshLab makes room for the number that a script says, however large.
MOST_CHOICES = 10_000
# Longer ones are no numbers that somebody wrote, and take long to read.
LONGEST = 400

_WHOLE = re.compile(r"[+-]?[0-9]+")
_DECIMAL = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")
_NOT_ZERO = re.compile(r"[+-]?[0.]*[1-9]")
# Whatever else isn't allowed in a name can't change what the element says.
_NAME = re.compile(r"""[^\s"'=<>&/\d.-][^\s"'=<>&/]*""")
# Attributes that are never misspellings of others.
_USUAL_ATTRIBUTES = ("name", "type", "value")
_USUAL_RANGE = (0.0, 100.0)


# --- text to values: each reader raises a ValueError that goes on after the text -----------------


def parse_bool(text: str) -> bool:
    """True or false, in the cases that MeshLab reads as meant."""
    if text == "false":
        return False
    if text.lower() == "true":
        return True
    if text.lower() == "false":
        raise ValueError("counts as true in MeshLab; write 'false' in lower case")
    raise ValueError("is neither 'true' nor 'false'")


def parse_int(text: str, low: int = -LARGEST_INT - 1, high: int = LARGEST_INT) -> int:
    """A whole number within limits."""
    number = text.strip()
    if len(number) > LONGEST or not _WHOLE.fullmatch(number):
        raise ValueError("is not a whole number")
    if not low <= int(number) <= high:
        raise ValueError(f"is not between {low} and {high}")
    return int(number)


# A mesh id, or the index of a choice; how many numbered attributes follow; a part of a colour.
parse_index = partial(parse_int, low=0)
parse_cardinality = partial(parse_int, low=0, high=MOST_CHOICES)
parse_byte = partial(parse_int, low=0, high=LARGEST_BYTE)


def parse_float(text: str) -> float:
    """A finite number that single precision holds, since MeshLab reads no others."""
    number = text.strip()
    if number.lstrip("+-").lower() in ("nan", "inf", "infinity"):
        raise ValueError("is not a finite number")
    if len(number) > LONGEST or not _DECIMAL.fullmatch(number):
        raise ValueError("is not a number")
    value = float(number)
    if abs(value) > LARGEST_FLOAT:
        raise ValueError(f"is beyond {LARGEST_FLOAT:.8g}, the largest that MeshLab reads")
    if abs(value) <= SMALLEST_FLOAT and _NOT_ZERO.match(number):
        raise ValueError("is too close to zero for MeshLab to read; write 0")
    return value


def parse_percentage(text: str) -> Percentage:
    """A number from 0 to 100, with or without a percent sign."""
    percent = parse_float(text.strip().removesuffix("%"))
    if not 0 <= percent <= 100:
        raise ValueError("is not between 0 and 100 percent")
    return Percentage(percent)


def parse_share(text: str) -> float | Percentage:
    """An absolute value, or a percentage with its sign."""
    return parse_percentage(text) if text.strip().endswith("%") else parse_float(text)


# --- values to text: TypeError for a value of another type ---------------------------------------


def show_bool(value: Any) -> str:
    if not isinstance(value, bool):
        raise TypeError
    return "true" if value else "false"


def show_int(value: Any) -> str:
    if isinstance(value, bool):
        raise TypeError
    return str(operator.index(value))


def show_float(value: Any) -> str:
    """The shortest text that reads back as the same number."""
    if isinstance(value, (bool, str, bytes)):
        raise TypeError
    return repr(float(value)).removesuffix(".0")


def show_percentage(value: Any) -> str:
    if not isinstance(value, Percentage):
        raise TypeError
    return show_float(value.percent) + "%"


def show_share(value: Any) -> str:
    return show_percentage(value) if isinstance(value, Percentage) else show_float(value)


def show_str(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError
    return value


# --- the types -----------------------------------------------------------------------------------


class RichType(NamedTuple):
    """How values of a type are written in a script."""

    # The attributes that hold the value.
    fields: tuple[str, ...]
    # One field's text to Python and back: they raise `ValueError`, and `TypeError`.
    parse: Callable[[str], Any]
    show: Callable[[Any], str]
    # What a value in Python has to be.
    expected: str
    # Further attributes without which MeshLab drops the parameter.
    needs: tuple[str, ...] = ()


VALUE = ("value",)
RANGE = ("min", "max")
MATRIX = tuple(f"val{i}" for i in range(16))
_POINT = RichType(("x", "y", "z"), parse_float, show_float, "3 numbers")
# An addition to MeshLab's types.
PERCENTAGE = "PercentageValue"
RICH_TYPES = {
    "RichBool": RichType(VALUE, parse_bool, show_bool, "a bool"),
    "RichInt": RichType(VALUE, parse_int, show_int, "an int"),
    "RichFloat": RichType(VALUE, parse_float, show_float, "a float"),
    "RichString": RichType(VALUE, str, show_str, "a str"),
    "RichEnum": RichType(VALUE, parse_index, show_int, "an index", ("enum_cardinality",)),
    "RichAbsPerc": RichType(VALUE, parse_share, show_share, "a float or a Percentage", RANGE),
    "RichDynamicFloat": RichType(VALUE, parse_float, show_float, "a float", RANGE),
    "RichColor": RichType(("r", "g", "b", "a"), parse_byte, show_int, "4 ints from 0 to 255"),
    "RichPosition": _POINT,
    "RichDirection": _POINT,
    "RichPoint3f": _POINT,
    "RichMatrix44f": RichType(MATRIX, parse_float, show_float, "16 numbers"),
    "RichMesh": RichType(VALUE, parse_index, show_int, "a mesh id"),
    "RichOpenFile": RichType(VALUE, str, show_str, "a str", ("exts_cardinality",)),
    "RichSaveFile": RichType(VALUE, str, show_str, "a str"),
    "RichShotf": RichType((), str, show_str, "None"),
    PERCENTAGE: RichType(VALUE, parse_percentage, show_percentage, "a Percentage"),
}
TYPES = tuple(type for type in RICH_TYPES if type != PERCENTAGE)


def rich_type(type: str) -> RichType:
    """The row of a type, or a `ValueError` that names the one which may be meant."""
    if type in RICH_TYPES:
        return RICH_TYPES[type]
    meant = closest(type, RICH_TYPES)
    cure = f"did you mean {meant!r}?" if meant else "known are " + ", ".join(TYPES)
    raise ValueError(f"unknown type {quoted(type)}; {cure}")


def fields_in(attributes: Mapping[str, str]) -> tuple[str, ...]:
    """The attributes that hold a value of an unknown type; none if there is no value."""
    known = (row.fields for row in RICH_TYPES.values() if row.fields)
    return next((fields for fields in known if all(f in attributes for f in fields)), ())


# --- reading -------------------------------------------------------------------------------------


def parse(type: str, attributes: Mapping[str, str]) -> Value:
    """The value that a ``<Param>`` of the type holds.

    Parameters
    ----------
    type : str
        One of `TYPES`, or "PercentageValue": a RichAbsPerc that is a percentage in any case.
    attributes : mapping
        All attributes of the element.

    Raises
    ------
    ValueError
        If the type is unknown, or MeshLab would drop the parameter or misread its value; with all
        that is wrong.
    """
    row = rich_type(type)
    problems = [missing(row.fields, attributes)]
    values = [_parse_attribute(name, row.parse, attributes, problems) for name in row.fields]
    # A percentage needs no range.
    is_share = row.needs == RANGE and attributes.get("value", "").strip().endswith("%")
    if not is_share:
        problems.append(missing(row.needs, attributes))
        read: Callable[[str], Any] = parse_float if row.needs == RANGE else parse_cardinality
        needed = [_parse_attribute(name, read, attributes, problems) for name in row.needs]
    found = [problem for problem in problems if problem]
    if found:
        raise ValueError("; ".join(found))
    if type == "RichEnum" and values[0] >= needed[0]:
        cardinality = f"enum_cardinality={quoted(attributes['enum_cardinality'])}"
        raise ValueError(f"index {values[0]} is not below {cardinality}; the first choice is 0")
    if not values:
        return None
    return values[0] if row.fields == VALUE else tuple(values)


def _parse_attribute(
    name: str,
    read: Callable[[str], Any],
    attributes: Mapping[str, str],
    problems: list[str | None],
) -> Any:
    """The value of an attribute that is there; what is wrong with it goes into `problems`."""
    if name not in attributes:
        return None
    try:
        return _parse_piece(attributes[name], read, f"{name}={quoted(attributes[name])}")
    except ValueError as error:
        problems.append(str(error))
        return None


def _parse_piece(text: str, read: Callable[[str], Any], shown: str) -> Any:
    try:
        return read(text)
    except ValueError as error:
        raise ValueError(f"{shown} {error}") from None


def parse_text(type: str, text: str) -> Value:
    """The value of one piece of text, as people write it and old scripts do.

    Parameters
    ----------
    type : str
        One of `TYPES`.
    text : str
        "5%" is a percentage for RichAbsPerc. The numbers of points, colours and matrices are
        parted by spaces or commas, in brackets or not. A colour may do without its alpha.

    Raises
    ------
    ValueError
        If the text is no value of that type.
    """
    row = rich_type(type)
    if not row.fields:
        raise ValueError(f"a {type} can't be given as text")
    if row.fields == VALUE:
        # MeshLab itself doesn't see the text, so that the case of a switch doesn't matter.
        piece = text.strip().lower() if type == "RichBool" else text
        value: Value = _parse_piece(piece, row.parse, quoted(text))
        return value
    pieces = re.split(r"\s*,\s*|\s+", re.sub(r"[][(){}]", " ", text).strip())
    if type == "RichColor" and len(pieces) == len(row.fields) - 1:
        pieces.append(str(LARGEST_BYTE))
    if len(pieces) != len(row.fields):
        raise ValueError(f"{quoted(text)} is not {len(row.fields)} numbers")
    return tuple(_parse_piece(piece, row.parse, quoted(piece)) for piece in pieces)


# --- writing -------------------------------------------------------------------------------------


def attributes(param: Param) -> dict[str, str]:
    """All attributes of a ``<Param>``, in their order; what MeshLab needs is added.

    Raises
    ------
    ValueError
        If the type is unknown or none, the value is not of that type, or a detail's name can't
        be one beside the others.
    """
    if not param.type:
        raise ValueError("has no type; look up the filter's own first")
    row = rich_type(param.type)
    written = {"name": param.name, "type": param.type, **_shown(row, param.value)}
    for key, text in param.details:
        if not _NAME.fullmatch(key):
            raise ValueError(f"{quoted(key)} can't be an attribute's name")
        if key in written:
            raise ValueError(f"the attribute {quoted(key)} is given twice")
        written[key] = text
    needed = {} if isinstance(param.value, Percentage) else _needed(row, param.value, written)
    return {**written, **{name: needed[name] for name in needed if name not in written}}


def _shown(row: RichType, value: Any) -> dict[str, str]:
    """The fields of a value."""
    try:
        if not row.fields:
            values = [] if value is None else [value]
        else:
            values = [value] if row.fields == VALUE else list(value)
        return dict(zip(row.fields, map(row.show, values), strict=True))
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{shortened(repr(value))} is not {row.expected}") from None


def _needed(row: RichType, value: Any, written: Mapping[str, str]) -> dict[str, str]:
    """The attributes without which MeshLab drops the parameter."""
    if row.needs == RANGE:
        low, high = _USUAL_RANGE
        return {"min": show_float(min(low, value)), "max": show_float(max(high, value))}
    if "enum_cardinality" in row.needs:
        return {"enum_cardinality": str(max(value + 1, _count("enum_val", written)))}
    if "exts_cardinality" in row.needs:
        return {"exts_cardinality": str(_count("ext_val", written))}
    return {}


def _count(prefix: str, written: Mapping[str, str]) -> int:
    """How many attributes prefix0, prefix1, ... there are."""
    count = 0
    while f"{prefix}{count}" in written:
        count += 1
    return count


# --- misspellings --------------------------------------------------------------------------------


def closest(word: str, known: Iterable[str]) -> str | None:
    """The known word that `word` is most likely a misspelling of, whatever its case."""
    by_lower = {name.lower(): name for name in known}
    found = difflib.get_close_matches(shortened(word).lower(), by_lower, n=1)
    return by_lower[found[0]] if found else None


def missing(needed: Iterable[str], given: Iterable[str]) -> str | None:
    """What to say if needed attributes aren't given, and which misspelt ones may be meant."""
    needed, given = tuple(needed), tuple(given)
    absent = [name for name in needed if name not in given]
    if not absent:
        return None
    what = ", ".join(map(repr, absent))
    text = f"attributes {what} are missing" if len(absent) > 1 else f"attribute {what} is missing"
    return text + meant_for(absent[0], [name for name in given if name not in needed])


def meant_for(absent: str, given: Iterable[str]) -> str:
    """A question about a given attribute that looks like the absent one, or nothing."""
    meant = closest(absent, [name for name in given if name not in _USUAL_ATTRIBUTES])
    return f"; is {quoted(meant)} meant for it?" if meant else ""
