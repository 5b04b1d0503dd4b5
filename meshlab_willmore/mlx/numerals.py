"""Numbers and switches as MeshLab reads them from a script's attributes.

Each function gets an attribute's text and raises a `ValueError` that goes on after that text: "is
not a whole number". What MeshLab drops or takes for something else without a word is refused.
"""

from __future__ import annotations

import re

from .steps import Percentage

LARGEST_FLOAT = (2 - 2**-23) * 2.0**127
SMALLEST_FLOAT = 2.0**-150  # halfway to the least single above zero; this half rounds to zero
LARGEST_INT = 2**31 - 1
LARGEST_BYTE = 255
WHOLE = 100
# MeshLab makes room for the number that a script says, however large.
MOST_CHOICES = 10_000
# Longer ones are not somebody's number, and long ones take long to read.
LONGEST = 400

_WHOLE = re.compile(r"[+-]?[0-9]+")
_DECIMAL = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")
_NOT_ZERO = re.compile(r"[+-]?[0.]*[1-9]")


def parse_bool(text: str) -> bool:
    """True or false, in the cases that MeshLab reads as meant."""
    if text == "false":
        return False
    if text.lower() == "true":
        return True
    if text.lower() == "false":
        raise ValueError("counts as true in MeshLab; write 'false' in lower case")
    raise ValueError("is neither 'true' nor 'false'")


def parse_bool_in_any_case(text: str) -> bool:
    """True or false, where MeshLab itself doesn't get to see the text."""
    return parse_bool(text.strip().lower())


def parse_int(text: str) -> int:
    """A whole number of 32 bits."""
    number = text.strip()
    if len(number) > LONGEST or not _WHOLE.fullmatch(number):
        raise ValueError("is not a whole number")
    return _between(-LARGEST_INT - 1, int(number), LARGEST_INT)


def parse_index(text: str) -> int:
    """A whole number that isn't negative: a mesh id, or the index of a choice."""
    return _between(0, parse_int(text), LARGEST_INT)


def parse_cardinality(text: str) -> int:
    """How many attributes follow that are numbered."""
    return _between(0, parse_int(text), MOST_CHOICES)


def parse_byte(text: str) -> int:
    """A part of a colour."""
    return _between(0, parse_int(text), LARGEST_BYTE)


def _between(low: int, value: int, high: int) -> int:
    if not low <= value <= high:
        raise ValueError(f"is not between {low} and {high}")
    return value


def parse_float(text: str) -> float:
    """A finite number that single precision holds, since MeshLab reads no others."""
    number = text.strip()
    if len(number) > LONGEST or not _DECIMAL.fullmatch(number):
        raise ValueError("is not a finite number" if _infinite(number) else "is not a number")
    value = float(number)
    if abs(value) > LARGEST_FLOAT:
        raise ValueError(f"is beyond {LARGEST_FLOAT:.8g}, the largest that MeshLab reads")
    if abs(value) <= SMALLEST_FLOAT and _NOT_ZERO.match(number):
        raise ValueError("is too close to zero for MeshLab to read; write 0")
    return value


def _infinite(number: str) -> bool:
    return number.lstrip("+-").lower() in ("nan", "inf", "infinity")


def parse_percentage(text: str) -> Percentage:
    """A number from 0 to 100, with or without a percent sign."""
    percent = parse_float(text.strip().removesuffix("%"))
    if not 0 <= percent <= WHOLE:
        raise ValueError(f"is not between 0 and {WHOLE} percent")
    return Percentage(percent)


def show_float(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return float.__repr__(value).removesuffix(".0")
