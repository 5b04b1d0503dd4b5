"""A filter script as `MeshSet.print_filter_script` prints it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..mlx.steps import Param, Percentage, Step
from . import catalogue

_ROW = 4
_POINT = "numpy.ndarray[numpy.float64[3]]"

# PyMeshLab's names for the types of parameters.
_TYPE_NAMES = {
    "RichBool": "bool",
    "RichInt": "int",
    "RichMesh": "int",
    "RichFloat": "float",
    "RichDynamicFloat": "float (bounded)",
    "RichAbsPerc": "PercentageValue",
    "RichColor": "Color",
    "RichPosition": _POINT,
    "RichDirection": _POINT,
    "RichPoint3f": _POINT,
    "RichMatrix44f": "numpy.ndarray[numpy.float64[4, 4]]",
    "RichShotf": "Shotf [still unsupported]",
}


def listing(steps: Sequence[Step]) -> str:
    """The text, as PyMeshLab would lay it out."""
    lines = [f"Filter Script Size : {len(steps)}", ""]
    for index, step in enumerate(steps):
        lines.append(f"{index}: {catalogue.keyword_of(step.filter)}")
        lines += [f"\t{_line(step, param)}" for param in step.params]
        lines.append("")
    return "\n".join(lines)


def _line(step: Step, param: Param) -> str:
    kind = param.type
    if not kind:
        known = catalogue.find(step.filter)
        own = known.param(param.name) if known else None
        kind = own.type if own else ""
    show = _SHOWN.get(kind, _text)
    return f"{catalogue.keyword_of(param.name)} : {_TYPE_NAMES.get(kind, 'str')} = {show(param)}"


def _text(param: Param) -> str:
    return f"'{param.value}'"


def _number(param: Param) -> str:
    return f"{param.value:g}" if isinstance(param.value, float) else str(param.value)


def _enum(param: Param) -> str:
    return f"'{dict(param.details).get(f'enum_val{param.value}', param.value)}'"


def _share(param: Param) -> str:
    """PyMeshLab prints a percentage, of the range that the script gives."""
    if isinstance(param.value, Percentage):
        return f"{param.value.percent:g}%"
    details = dict(param.details)
    low, high = float(details.get("min", 0)), float(details.get("max", 0))
    if high == low or not isinstance(param.value, (int, float)):
        return str(param.value)
    # The range has six digits, so the last one of the quotient means nothing.
    return f"{(param.value - low) / (high - low) * 100:.5g}%"


def _bounded(param: Param) -> str:
    details = dict(param.details)
    return f"{_number(param)} [min: {details.get('min', '')}; max: {details.get('max', '')}]"


def _joined(separator: str, ends: str = "[]") -> Callable[[Any], str]:
    def join(numbers: Any) -> str:
        return ends[0] + separator.join(f"{number:g}" for number in numbers) + ends[1]

    return join


_comma, _semicolon = _joined(", "), _joined("; ")


def _matrix(param: Param) -> str:
    values = param.value if isinstance(param.value, tuple) else ()
    rows = [_comma(values[i : i + _ROW]) for i in range(0, len(values), _ROW)]
    return f"[{','.join(rows)}]"


_SHOWN: dict[str, Callable[[Param], str]] = {
    "RichBool": lambda param: str(param.value),
    "RichInt": _number,
    "RichMesh": _number,
    "RichFloat": _number,
    "RichEnum": _enum,
    "RichAbsPerc": _share,
    "RichDynamicFloat": _bounded,
    "RichColor": lambda param: _semicolon(param.value),
    "RichPosition": lambda param: _comma(param.value),
    "RichDirection": lambda param: _comma(param.value),
    "RichPoint3f": lambda param: _comma(param.value),
    "RichMatrix44f": _matrix,
    "RichShotf": lambda _: "None",
}
