"""MeshLab's parameter types ("Rich" in its source): their attributes in a script, and values."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from . import numerals
from .kinds import KINDS, PERCENTAGE, RANGE, VALUE, Kind
from .steps import Param, Percentage, Value
from .words import closest, missing, quoted, shortened

TYPES = tuple(type for type in KINDS if type != PERCENTAGE)
# Whatever else isn't allowed in a name can't change what the element says.
_NAME = re.compile(r"""[^\s"'=<>&/\d.-][^\s"'=<>&/]*""")
_COLOR_PARTS_WITHOUT_ALPHA = 3
_USUAL_RANGE = (0.0, 100.0)


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
    kind = _kind(type)
    problems = [missing(kind.fields, attributes)]
    values = [_read_into(problems, kind.read, name, attributes) for name in kind.fields]
    # A percentage needs no range.
    is_share = kind.needs == RANGE and attributes.get("value", "").strip().endswith("%")
    if not is_share:
        problems.append(missing(kind.needs, attributes))
        read = numerals.parse_float if kind.needs == RANGE else numerals.parse_cardinality
        for name in kind.needs:
            _read_into(problems, read, name, attributes)
    told = [problem for problem in problems if problem]
    if told:
        raise ValueError("; ".join(told))
    if type == "RichEnum":
        _check_index(values[0], attributes)
    return _joined(kind, values)


def _read_into(
    problems: list[str | None],
    read: Callable[[str], Any],
    name: str,
    attributes: Mapping[str, str],
) -> Any:
    """The value of an attribute that is there; why it is none goes into `problems`."""
    try:
        return _parse_attribute(name, read, attributes) if name in attributes else None
    except ValueError as error:
        problems.append(str(error))
        return None


def parse_text(type: str, text: str) -> Value:
    """The value that one piece of text stands for, as people write it and old scripts do.

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
    kind = _kind(type)
    if not kind.fields:
        raise ValueError(f"a {type} can't be given as text")
    if kind.fields == VALUE:
        read = numerals.parse_bool_in_any_case if type == "RichBool" else kind.read
        return _parse_piece(quoted(text), read, text)
    parts = re.split(r"\s*,\s*|\s+", re.sub(r"[][(){}]", " ", text).strip())
    if type == "RichColor" and len(parts) == _COLOR_PARTS_WITHOUT_ALPHA:
        parts.append(str(numerals.LARGEST_BYTE))
    if len(parts) != len(kind.fields):
        raise ValueError(f"{quoted(text)} is not {len(kind.fields)} numbers")
    return _joined(kind, [_parse_piece(quoted(part), kind.read, part) for part in parts])


def attributes(param: Param) -> dict[str, str]:
    """All attributes of a ``<Param>``, in their order; what MeshLab needs is added.

    Raises
    ------
    ValueError
        If the type is unknown or none, the value is not of that type, or a detail's name can't
        stand beside the others.
    """
    if not param.type:
        raise ValueError("has no type; look up the filter's own first")
    kind = _kind(param.type)
    written = {"name": param.name, "type": param.type, **_shown(kind, param.value)}
    for key, text in param.details:
        if not _NAME.fullmatch(key):
            raise ValueError(f"{quoted(key)} can't be an attribute's name")
        if key in written:
            raise ValueError(f"the attribute {quoted(key)} is given twice")
        written[key] = text
    return written | _completion(kind, param.value, written)


def fields(type: str) -> tuple[str, ...]:
    """The attributes that hold a value of the type."""
    return _kind(type).fields


def needs(type: str) -> tuple[str, ...]:
    """The attributes that MeshLab needs beside those of the value."""
    return _kind(type).needs


def fields_in(attributes: Mapping[str, str]) -> tuple[str, ...]:
    """The attributes that hold a value whose type nobody says; none if there is no value."""
    known = (kind.fields for kind in KINDS.values() if kind.fields)
    found = [fields for fields in known if all(field in attributes for field in fields)]
    return found[0] if found else ()


def _kind(type: str) -> Kind:
    if type in KINDS:
        return KINDS[type]
    meant = closest(type, KINDS)
    cure = f"did you mean {meant!r}?" if meant else "known are " + ", ".join(TYPES)
    raise ValueError(f"unknown type {quoted(type)}; {cure}")


def _parse_attribute(name: str, read: Callable[[str], Any], attributes: Mapping[str, str]) -> Any:
    return _parse_piece(_named(name, attributes), read, attributes[name])


def _parse_piece(shown: str, read: Callable[[str], Any], text: str) -> Any:
    try:
        return read(text)
    except ValueError as error:
        raise ValueError(f"{shown} {error}") from None


def _named(name: str, attributes: Mapping[str, str]) -> str:
    return f"{name}={quoted(attributes[name])}"


def _check_index(index: int, attributes: Mapping[str, str]) -> None:
    if index >= int(attributes["enum_cardinality"]):
        cardinality = _named("enum_cardinality", attributes)
        raise ValueError(f"index {index} is not below {cardinality}; the first choice is 0")


def _joined(kind: Kind, values: list[Any]) -> Value:
    if not values:
        return None
    return values[0] if kind.fields == VALUE else tuple(values)


def _shown(kind: Kind, value: Any) -> dict[str, str]:
    """The fields of a value."""
    try:
        if not kind.fields:
            values = [] if value is None else [value]
        else:
            values = [value] if kind.fields == VALUE else list(value)
        return dict(zip(kind.fields, map(kind.show, values), strict=True))
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{shortened(repr(value))} is not {kind.expected}") from None


def _completion(kind: Kind, value: Any, written: Mapping[str, str]) -> dict[str, str]:
    """The attributes that MeshLab needs and `written` lacks."""
    if isinstance(value, Percentage):
        return {}
    needed: dict[str, str] = {}
    if kind.needs == RANGE:
        low, high = _USUAL_RANGE
        needed = {
            "min": numerals.show_float(min(low, value)),
            "max": numerals.show_float(max(high, value)),
        }
    elif "enum_cardinality" in kind.needs:
        needed = {"enum_cardinality": str(max(value + 1, _listed("enum_val", written)))}
    elif "exts_cardinality" in kind.needs:
        needed = {"exts_cardinality": str(_listed("ext_val", written))}
    return {name: text for name, text in needed.items() if name not in written}


def _listed(prefix: str, written: Mapping[str, str]) -> int:
    """How many attributes prefix0, prefix1, ... there are."""
    count = 0
    while f"{prefix}{count}" in written:
        count += 1
    return count
