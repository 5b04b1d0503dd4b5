"""How a step is written by hand: a script with all parameters of one filter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .text import WIDTH

if TYPE_CHECKING:
    from ..meshset.catalogue import FilterInfo, ParamInfo
    from ..mlx.steps import Param

_INDENT = "  "
# Attributes of an element that goes on in the next line.
_HANGING = "         "
# Values of parameters for which PyMeshLab has no default on a cube.
_ANY = {"RichBool": False, "RichEnum": 0, "RichFloat": 0.0, "RichInt": 0, "RichDynamicFloat": 0.0}


def script_with(known: FilterInfo) -> str:
    """A script with one step: the filter, its parameters, and their defaults.

    What depends on the mesh is in comments, as a step that gives it has the same for all meshes.
    """
    first, second = (_script_defaults(known, size) for size in (1.0, 2.0))
    lines = ["<!DOCTYPE FilterScript>", "<FilterScript>"]
    name = known.meshlab_name or known.name
    lines.append(f' <filter name="{_escaped(name)}">')
    for own in known.params:
        value = first.get(own.keyword)
        text = "\n".join(_wrapped(_attributes(own, value)))
        is_fixed = _same(own, value, second.get(own.keyword)) and not _depends(known, own)
        if not (is_fixed or own.required):
            text = f"{_INDENT}<!-- This default depends on the mesh:\n{text} -->"
        lines.append(text)
    return "\n".join([*lines, " </filter>", "</FilterScript>"])


def element_of(known: FilterInfo, own: ParamInfo) -> str:
    """The element of a parameter with its default, in one line."""
    value = _script_defaults(known, 1.0).get(own.keyword)
    return f"<Param {' '.join(_attributes(own, value))}/>"


def _attributes(own: ParamInfo, value: Any) -> list[str]:
    """The attributes of a parameter's element, with the names of an enum's choices."""
    from ..mlx import rich

    attributes = rich.attributes(_param(own, value))
    return [f'{key}="{_escaped(text)}"' for key, text in attributes.items()]


def defaults(known: FilterInfo, size: float = 1.0) -> dict[str, Any]:
    """The defaults on a cube; none for a filter that needs what a cube has not.

    That of an edge of 2 is selected, so that what depends on the mesh differs.
    """
    import pymeshlab

    from ..meshset import native

    ms = pymeshlab.MeshSet()
    with native.muted():
        try:
            # Some filters need two meshes.
            for _ in range(2):
                native.apply(ms, "create_cube", size=size)
            if size > 1.0:
                native.apply(ms, "set_selection_all")
            return dict(ms.filter_parameter_values(known.name))
        except native.ERRORS:
            return {}


def _param(own: ParamInfo, value: Any) -> Param:
    from ..meshset.check import with_choices
    from ..mlx.steps import Param

    return Param(own.name, own.type, _plain(own, value), with_choices(own, ()))


def _plain(own: ParamInfo, value: Any) -> Any:
    """A value as scripts hold it; for an unknown one, any that the parameter can have."""
    if own.type == "RichShotf":
        return None
    if value is None:
        return _ANY[own.type]
    if own.type == "RichColor":
        return (value.red(), value.green(), value.blue(), value.alpha())
    return tuple(value.ravel().tolist()) if hasattr(value, "ravel") else value


def _script_defaults(known: FilterInfo, size: float) -> dict[str, Any]:
    """The defaults as scripts hold them."""
    from ..meshset.filters import BY_NAME
    from ..mlx.steps import Percentage

    values = defaults(known, size)
    if known.is_willmore:
        for own in BY_NAME[known.name].parameters:
            if own.type is Percentage:
                values[own.name] = own.default_for(None, {})
    return values


def _depends(known: FilterInfo, own: ParamInfo) -> bool:
    """Whether the default of a parameter of our own depends on the mesh, or on another one."""
    from ..meshset.filters import BY_NAME

    parameters = BY_NAME[known.name].parameters if known.is_willmore else ()
    return any(p.name == own.keyword and callable(p.default) for p in parameters)


def _same(own: ParamInfo, left: Any, right: Any) -> bool:
    return bool(_plain(own, left) == _plain(own, right))


def _escaped(text: str) -> str:
    from ..mlx.write import escaped

    return escaped(text)


def _wrapped(attributes: Sequence[str]) -> list[str]:
    """The lines of an element, which fit the window as far as one attribute does."""
    lines = [f"{_INDENT}<Param"]
    for place, attribute in enumerate(attributes):
        piece = attribute + ("/>" if place == len(attributes) - 1 else "")
        if len(lines[-1]) + 1 + len(piece) > WIDTH:
            lines.append(f"{_HANGING}{piece}")
        else:
            lines[-1] += f" {piece}"
    return lines
