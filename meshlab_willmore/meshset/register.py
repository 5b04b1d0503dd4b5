"""Puts the filters on `pymeshlab.MeshSet`, beside MeshLab's own.

PyMeshLab's methods all end in ``MeshSet.apply_filter``, and its lists come from four functions:
replacing these makes our filters known wherever the native ones are.
"""

from __future__ import annotations

import functools
import inspect
import sys
from collections.abc import Callable
from typing import Any

import pymeshlab
from pymeshlab import MeshSet

from . import layers
from .filters import BY_NAME, FILTERS, Filter
from .parameters import Parameter, read_all

_MISSING = object()

# (owner, attribute, value before), in the order of replacement; empty: not registered.
_replaced: list[tuple[Any, str, Any]] = []


def register() -> None:
    """Make the filters methods of `pymeshlab.MeshSet` and members of PyMeshLab's lists.

    Importing `meshlab_willmore` does it. A second call does nothing.

    Raises
    ------
    RuntimeError
        If PyMeshLab has a filter or method with the name of one of ours; nothing is replaced.
    """
    if _replaced:
        return
    taken = sorted(name for name in BY_NAME if hasattr(MeshSet, name))
    taken += sorted(set(BY_NAME) & set(pymeshlab.filter_list()) - set(taken))
    if taken:
        raise RuntimeError(
            f"PyMeshLab already has {', '.join(taken)}; meshlab_willmore does not replace native "
            "filters. Use a version of meshlab_willmore that fits this PyMeshLab."
        )
    for name in ("apply_filter", "filter_parameter_values"):
        _wrap(MeshSet, name, _WRAPPERS[name])
    for name in ("__init__", "set_verbosity", "set_parameter_verbosity"):
        _wrap(MeshSet, name, _NOTERS[name])
    for name in ("filter_list", "print_filter_list", "print_filter_parameter_list", "search"):
        _wrap(pymeshlab, name, _WRAPPERS[name])
    for filter_ in FILTERS:
        _replace(MeshSet, filter_.name, _method(filter_))


def unregister() -> None:
    """Leave PyMeshLab as it was before `register`. A second call does nothing."""
    while _replaced:
        owner, name, before = _replaced.pop()
        if before is _MISSING:
            delattr(owner, name)
        else:
            setattr(owner, name, before)


def is_registered() -> bool:
    """Whether the filters are there."""
    return bool(_replaced)


def _replace(owner: Any, name: str, value: Any) -> None:
    _replaced.append((owner, name, vars(owner).get(name, _MISSING)))
    setattr(owner, name, value)


def _wrap(owner: Any, name: str, make: Callable[[Any], Any]) -> None:
    native = getattr(owner, name)
    wrapped = make(native)
    _replace(owner, name, functools.wraps(native, updated=())(wrapped))


# --- applying ----------------------------------------------------------------------------------


def _apply(ms: MeshSet, filter_: Filter, given: dict[str, Any]) -> dict[str, Any]:
    values = _values(ms, filter_, given)
    verbosity = layers.verbosity(ms)
    if verbosity.all or verbosity.parameters:
        print(f"\nApplying filter {filter_.name} with the following parameters:\n{values}\n")
    try:
        returned, log = filter_.run(ms, values)
    except Exception as error:
        raise pymeshlab.PyMeshLabException(
            f"Failed to apply filter: {filter_.name}\nDetails: {error}"
        ) from error
    if verbosity.all:
        print(f"LOG: 2 {log}\nLOG: 2 {filter_.name} applied!    [ 100% ]", file=sys.stderr)
        print()
    return returned


def _values(ms: MeshSet, filter_: Filter, given: dict[str, Any]) -> dict[str, Any]:
    if ms.mesh_number() == 0:
        raise pymeshlab.PyMeshLabException(
            f"{filter_.name} requires at least one mesh loaded in the MeshSet."
        )
    return read_all(filter_.name, filter_.parameters, given, ms.current_mesh())


def _ours(args: tuple[Any, ...], key: str, given: dict[str, Any]) -> Filter | None:
    """The filter that a call names, if the call is well-formed and the filter is ours."""
    if len(args) == 1 and isinstance(args[0], str):
        return BY_NAME.get(args[0])
    if not args and isinstance(given.get(key), str):
        return BY_NAME.get(given.pop(key)) if given[key] in BY_NAME else None
    return None


def _wrap_apply_filter(native: Callable) -> Callable:
    def apply_filter(self: MeshSet, *args: Any, **kwargs: Any) -> dict[str, Any]:
        layers.sweep(self)
        filter_ = _ours(args, "filter_name", kwargs)
        if filter_ is None:
            return native(self, *args, **kwargs)
        return _apply(self, filter_, kwargs)

    return apply_filter


def _wrap_filter_parameter_values(native: Callable) -> Callable:
    def filter_parameter_values(self: MeshSet, *args: Any, **kwargs: Any) -> dict[str, Any]:
        filter_ = _ours(args, "arg0", kwargs)
        if filter_ is None:
            return native(self, *args, **kwargs)
        return _values(self, filter_, kwargs)

    return filter_parameter_values


def _note_init(native: Callable) -> Callable:
    def init(self: MeshSet, *args: Any, **kwargs: Any) -> None:
        native(self, *args, **kwargs)
        verbose = args[0] if args else kwargs.get("verbose", False)
        if verbose:
            layers.note_verbosity(self, all=True)

    return init


def _note_verbosity(field: str) -> Callable[[Callable], Callable]:
    def make(native: Callable) -> Callable:
        def set_verbosity(self: MeshSet, verbosity: bool) -> None:
            native(self, verbosity)
            layers.note_verbosity(self, **{field: bool(verbosity)})

        return set_verbosity

    return make


_NOTERS = {
    "__init__": _note_init,
    "set_verbosity": _note_verbosity("all"),
    "set_parameter_verbosity": _note_verbosity("parameters"),
}


# --- lists -------------------------------------------------------------------------------------


def _wrap_filter_list(native: Callable) -> Callable:
    def filter_list() -> list[str]:
        return sorted([*native(), *BY_NAME])

    return filter_list


def _wrap_print_filter_list(_: Callable) -> Callable:
    def print_filter_list() -> None:
        print("MeshSet class - list of filter names:")
        for name in pymeshlab.filter_list():
            print(f"\t{name}")

    return print_filter_list


def _wrap_print_filter_parameter_list(native: Callable) -> Callable:
    def print_filter_parameter_list(filter_name: str) -> None:
        filter_ = BY_NAME.get(filter_name)
        if filter_ is None:
            native(filter_name)
            return
        print(f"{filter_name} filter - list of parameter names:")
        for parameter in filter_.parameters:
            kind = parameter.type.__name__
            print(f"\t{parameter.name} : {kind} = {parameter.shown_default()}")
        if not filter_.parameters:
            print("\tNone.")

    return print_filter_parameter_list


def _wrap_search(native: Callable) -> Callable:
    def search(search_key_word: str) -> None:
        words = search_key_word.lower().split()
        for filter_ in FILTERS:
            text = f"{filter_.name} {filter_.meshlab_name} {filter_.summary}".lower()
            if words and all(word in text for word in words):
                print(f"{filter_.name} : {filter_.summary}")
        sys.stdout.flush()
        native(search_key_word)

    return search


_WRAPPERS = {
    "apply_filter": _wrap_apply_filter,
    "filter_parameter_values": _wrap_filter_parameter_values,
    "filter_list": _wrap_filter_list,
    "print_filter_list": _wrap_print_filter_list,
    "print_filter_parameter_list": _wrap_print_filter_parameter_list,
    "search": _wrap_search,
}


# --- methods -----------------------------------------------------------------------------------


def _method(filter_: Filter) -> Callable:
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
