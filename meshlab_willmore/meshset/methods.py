"""The methods of `MeshSet` that stand for the filters, with signatures and docstrings."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from pymeshlab import MeshSet

from .filter import Filter
from .parameters import Parameter


def method_of(filter_: Filter) -> Callable:
    """A method of `MeshSet` as PyMeshLab makes them, but with a signature and a docstring."""

    def filter_function(self: MeshSet, **kwargs: Any) -> dict[str, Any] | None:
        return self.apply_filter(filter_.name, **kwargs) or None

    filter_function.__name__ = filter_.name
    filter_function.__qualname__ = f"MeshSet.{filter_.name}"
    filter_function.__module__ = "meshlab_willmore"
    filter_function.__doc__ = _docstring(filter_)
    filter_function.__signature__ = _signature(filter_)  # type: ignore[attr-defined]
    return filter_function


def _signature(filter_: Filter) -> inspect.Signature:
    parameters = [inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)]
    for p in filter_.parameters:
        default = inspect.Parameter.empty if callable(p.default) else p.default
        parameters.append(
            inspect.Parameter(p.name, inspect.Parameter.KEYWORD_ONLY, default=default)
        )
    return inspect.Signature(parameters)


def _docstring(filter_: Filter) -> str:
    lines = [filter_.summary, "", f"MeshLab name: {filter_.meshlab_name!r}.", "", filter_.info]
    if filter_.parameters:
        lines += ["", "Parameters", "----------"]
    for parameter in filter_.parameters:
        lines += [f"{parameter.name} : {_type(parameter)}", f"    {parameter.tooltip}"]
    if filter_.returns:
        lines += ["", "Returns", "-------", "dict"]
        lines += [f"    ``{name}`` ({kind}): {text}" for name, kind, text in filter_.returns]
    return "\n".join(lines)


def _type(parameter: Parameter) -> str:
    if parameter.choices:
        names = ", ".join(map(repr, parameter.choices))
        return f"{{{names}}} or index, default {parameter.shown_default()}"
    if callable(parameter.default):
        return f"{parameter.type.__name__}, optional"
    return f"{parameter.type.__name__}, default {parameter.shown_default()}"
