"""Converts a script's parameter to a value of the filter's own type."""

from __future__ import annotations

from typing import Any

from ..mlx import rich
from ..mlx.steps import Param, Percentage, Value, quoted
from .filter_info import ParamInfo

# MeshLab stores several types as the same kind of value; a value of another kind is read as zero or
# an empty text.
_KINDS = {
    "RichBool": "switch",
    "RichInt": "whole number",
    "RichEnum": "whole number",
    "RichMesh": "whole number",
    "RichFloat": "number",
    "RichDynamicFloat": "number",
    "RichAbsPerc": "number",
    "RichString": "text",
    "RichOpenFile": "text",
    "RichSaveFile": "text",
    "RichPosition": "point",
    "RichDirection": "point",
    "RichPoint3f": "point",
    "RichColor": "colour",
    "RichMatrix44f": "matrix",
    "RichShotf": "camera",
}
_MISREAD = {"RichBool": "false", "RichString": "''", "RichOpenFile": "''", "RichSaveFile": "''"}


def value_of(param: Param, own: ParamInfo) -> Value:
    """The value of a step's parameter, as one of the filter's own type.

    Parameters
    ----------
    param : Param
        As in the script. Without a type, a text is read as the filter's own type demands; an enum
        may be given by its name.
    own : ParamInfo
        What the filter has.

    Returns
    -------
    Value
        An enum's index, or else as in `Param`.

    Raises
    ------
    ValueError
        If it has no such value, or PyMeshLab would read another one.
    """
    if isinstance(param.value, Percentage) and own.type != "RichAbsPerc":
        raise ValueError(f"can't be a percentage: a {own.type} has no range; give a number")
    value = _typed(param, own)
    if own.required and value == "":
        raise ValueError("is empty; the filter can't do without it")
    # Written and read again, it is exactly what a script could say.
    written = Param(own.name, own.type, value, _needed(param, own))
    value = rich.parse(own.type, rich.attributes(written))
    if own.choices:
        _check_choice(param, own, value)
    return value


def _needed(param: Param, own: ParamInfo) -> tuple[tuple[str, str], ...]:
    """Details such as a range, which are not checked yet if the script has another type or none."""
    if param.type == own.type or own.choices:
        return ()
    needs = rich.rich_type(own.type).needs
    return tuple(pair for pair in param.details if pair[0] in needs)


def _typed(param: Param, own: ParamInfo) -> Value:
    """The value, read if it is a text without a type."""
    if own.choices and param.type in ("", own.type) and isinstance(param.value, str):
        return _choice(own, param.value)
    if not param.type:
        untyped = isinstance(param.value, str)
        return rich.parse_text(own.type, str(param.value)) if untyped else param.value
    rich.attributes(param)
    if problem := mismatch(param, own):
        raise ValueError(problem)
    return param.value


def mismatch(param: Param, own: ParamInfo) -> str | None:
    """The message if PyMeshLab would misread the parameter's type for the filter's own."""
    kind = _KINDS.get(param.type)
    if kind is None or kind == _KINDS[own.type]:
        return None
    return (
        f"is given as {param.type}, but is a {own.type}: PyMeshLab would read "
        f"{_MISREAD.get(own.type, 'zero')}; write type='{own.type}'"
    )


def _choice(own: ParamInfo, text: str) -> int:
    """The index that a text names, or is."""
    if text in own.choices:
        return own.choices.index(text)
    try:
        return int(text)
    except ValueError:
        raise ValueError(f"there is no choice {quoted(text)}; {_listed(own.choices)}") from None


def _check_choice(param: Param, own: ParamInfo, index: Any) -> None:
    if not 0 <= index < len(own.choices):
        raise ValueError(f"there is no choice {index}; {_listed(own.choices)}")
    meant = dict(param.details).get(f"enum_val{index}", "")
    if meant in own.choices and own.choices[index] != meant:
        raise ValueError(
            f"choice {index} is {own.choices[index]!r}, but the script says {meant!r}, which is "
            f"{own.choices.index(meant)}"
        )


def _listed(choices: tuple[str, ...]) -> str:
    return "the choices are " + ", ".join(f"{i} {choice!r}" for i, choice in enumerate(choices))
