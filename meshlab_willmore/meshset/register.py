"""Adds the filters to `pymeshlab.MeshSet`, beside MeshLab's own.

PyMeshLab's methods all end in ``MeshSet.apply_filter``, and its lists come from four functions:
replacing these makes our filters known wherever the native ones are. What counts the layers of a
set, iterates over them, or takes or returns ids is replaced as well, see `native_calls`. Functions
here that replace another get it as `before`.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pymeshlab
from pymeshlab import MeshSet

from . import help_text, ids, layers, native, native_calls, recording
from .check import resolve
from .filter import Filter, apply, shown_values, values_of
from .filters import BY_NAME, FILTERS
from .play import play

_MISSING = object()

# (owner, attribute, value before), in the order of replacement; empty: not registered.
_replaced: list[tuple[Any, str, Any]] = []

# On the replaced apply_filter: how to undo a registration, also one of a module that was imported
# before and dropped from sys.modules since.
_UNDO = "_meshlab_willmore_unregister"


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
    getattr(MeshSet.apply_filter, _UNDO, lambda: None)()
    taken = sorted(name for name in BY_NAME if hasattr(MeshSet, name))
    taken += sorted(set(BY_NAME) & set(pymeshlab.filter_list()) - set(taken))
    if taken:
        raise RuntimeError(
            f"PyMeshLab already has {', '.join(taken)}; meshlab_willmore does not replace native "
            "filters. Use a version of meshlab_willmore that fits this PyMeshLab."
        )
    for owner, functions in _REPLACEMENTS:
        for name, function in functions.items():
            _replace(owner, name, _replacement(function, getattr(owner, name)))
    setattr(MeshSet.apply_filter, _UNDO, unregister)
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
    """Whether the filters are registered."""
    return bool(_replaced)


def _replace(owner: Any, name: str, value: Any) -> None:
    _replaced.append((owner, name, vars(owner).get(name, _MISSING)))
    setattr(owner, name, value)


def _replacement(function: Callable, before: Callable) -> Callable:
    @functools.wraps(before, updated=())
    def replacement(*args: Any, **kwargs: Any) -> Any:
        return function(before, *args, **kwargs)

    return replacement


# --- the methods of our filters ------------------------------------------------------------------


def _method(filter_: Filter) -> Callable:
    """A method of `MeshSet` as PyMeshLab makes them, but with a signature and a docstring."""

    def filter_function(self: MeshSet, **kwargs: Any) -> dict[str, Any] | None:
        return self.apply_filter(filter_.name, **kwargs) or None

    filter_function.__name__ = filter_.name
    filter_function.__qualname__ = f"MeshSet.{filter_.name}"
    filter_function.__module__ = "meshlab_willmore"
    filter_function.__doc__ = help_text.docstring(filter_)
    filter_function.__signature__ = help_text.signature(filter_)  # type: ignore[attr-defined]
    return filter_function


# --- applying ----------------------------------------------------------------------------------


def _willmore_filter(args: tuple[Any, ...], key: str, given: dict[str, Any]) -> Filter | None:
    """The filter that a call names, if the call is well-formed and the filter is ours."""
    if len(args) == 1 and isinstance(args[0], str):
        return BY_NAME.get(args[0])
    if not args and isinstance(given.get(key), str):
        return BY_NAME.get(given.pop(key)) if given[key] in BY_NAME else None
    return None


def _apply_filter(before: Callable, ms: MeshSet, /, *args: Any, **given: Any) -> dict[str, Any]:
    layers.sweep(ms)
    filter_ = _willmore_filter(args, "filter_name", given)
    if filter_ is not None:
        values = values_of(ms, filter_, given)
        with _as_pymeshlab_error():
            recording.catch_up(ms)
        returned = apply(ms, filter_, values)
        recording.note_step(ms, filter_, values)
        return returned
    if not ids.has_moved(ms):
        with native.kept_working_folder(), native.in_order_if_verbose(ms):
            returned = before(ms, *args, **given)
        recording.note_native_step(ms, recording.NO_IDS)
        return returned
    name = args[0] if args else given.get("filter_name")
    with (
        native.kept_working_folder(),
        native_calls.prepared(ms, name, given) as called,
        native.in_order_if_verbose(ms),
    ):
        returned = before(ms, *args, **called)
    recording.note_native_step(ms, native_calls.logical_ids(ms, name, called))
    return returned


def _filter_parameter_values(
    before: Callable, ms: MeshSet, /, *args: Any, **given: Any
) -> dict[str, Any]:
    filter_ = _willmore_filter(args, "arg0", given)
    if filter_ is not None:
        return shown_values(ms, values_of(ms, filter_, given))
    if len(args) == 1 and ids.has_moved(ms):
        return native_calls.parameter_values(before, ms, args[0], given)
    return before(ms, *args, **given)


# --- verbosity, and what prints ------------------------------------------------------------------


def _init(before: Callable, ms: MeshSet, *args: Any, **kwargs: Any) -> None:
    before(ms, *args, **kwargs)
    if args[0] if args else kwargs.get("verbose", False):
        native.note_verbosity(ms, all=True)


def _set_verbosity(before: Callable, ms: MeshSet, verbosity: bool) -> None:
    before(ms, verbosity)
    native.note_verbosity(ms, all=bool(verbosity))


def _set_parameter_verbosity(before: Callable, ms: MeshSet, verbosity: bool) -> None:
    before(ms, verbosity)
    native.note_verbosity(ms, parameters=bool(verbosity))


def _in_order(function: Callable) -> Callable:
    """A replacement that prints, in order with all else that is printed."""

    def printing(*args: Any, **kwargs: Any) -> None:
        with native.in_order():
            function(*args, **kwargs)

    return printing


@_in_order
def _as_before(before: Callable, *args: Any) -> None:
    before(*args)


def _file_method(before: Callable, ms: MeshSet, *args: Any, **kwargs: Any) -> None:
    """PyMeshLab's own, which leaves the working folder as it is also where it fails."""
    with native.kept_working_folder(), native.in_order_if_verbose(ms):
        before(ms, *args, **kwargs)


# --- filter scripts ----------------------------------------------------------------------------


def _apply_filter_script(before: Callable, ms: MeshSet) -> None:
    layers.sweep(ms)
    # PyMeshLab would go by its own ids and order, and reach parked layers.
    if not recording.holds_more(ms) and not ids.has_moved(ms):
        with native.in_order_if_verbose(ms):
            before(ms)
        return
    with _as_pymeshlab_error():
        source = recording.source_of(ms)
        calls = resolve(recording.steps_of(ms), source, layers.logical_ids(ms))
    play(ms, calls, source)


def _load_filter_script(before: Callable, ms: MeshSet, filter_script_name: str | bytes) -> None:
    with _as_pymeshlab_error():
        path = os.fsdecode(filter_script_name) if filter_script_name else ""
        steps = recording.script_to_load(path) if path else None
    if steps is None:
        before(ms, filter_script_name)
        recording.forget(ms)
    else:
        recording.put(ms, steps, path)


def _save_filter_script(before: Callable, ms: MeshSet, filter_script_name: str | bytes) -> None:
    if recording.holds_more(ms) and isinstance(filter_script_name, (str, bytes)):
        with _as_pymeshlab_error():
            recording.save(ms, os.fsdecode(filter_script_name))
    else:
        before(ms, filter_script_name)


def _print_filter_script(before: Callable, ms: MeshSet) -> None:
    if not recording.holds_more(ms):
        before(ms)
        return
    with _as_pymeshlab_error():
        text = recording.listing(recording.steps_of(ms))
    print(text, end="")


def _clear_filter_script(before: Callable, ms: MeshSet) -> None:
    before(ms)
    recording.forget(ms)


@contextmanager
def _as_pymeshlab_error() -> Iterator[None]:
    try:
        yield
    except (ValueError, OSError) as error:
        raise pymeshlab.PyMeshLabException(str(error)) from error


# --- lists -------------------------------------------------------------------------------------


def _filter_list(before: Callable) -> list[str]:
    return sorted([*before(), *BY_NAME])


def _print_filter_list(_: Callable) -> None:
    print("MeshSet class - list of filter names:")
    for name in pymeshlab.filter_list():
        print(f"\t{name}")


def _print_filter_parameter_list(before: Callable, filter_name: str) -> None:
    filter_ = BY_NAME.get(filter_name)
    if filter_ is None:
        before(filter_name)
        return
    print(f"{filter_name} filter - list of parameter names:")
    for parameter in filter_.parameters:
        print(f"\t{parameter.name} : {parameter.type_name()} = {parameter.shown_default()}")
    if not filter_.parameters:
        print("\tNone.")


def _search(before: Callable, search_key_word: str) -> None:
    words = search_key_word.lower().split()
    for filter_ in FILTERS:
        text = f"{filter_.name} {filter_.meshlab_name} {filter_.summary}".lower()
        if words and all(word in text for word in words):
            print(f"{filter_.name} : {filter_.summary}")
    before(search_key_word)


# What is replaced, by owner and name.
_REPLACEMENTS: tuple[tuple[Any, dict[str, Callable]], ...] = (
    (
        MeshSet,
        {
            "__getitem__": native_calls.mesh,
            "__init__": _init,
            "__iter__": native_calls.iterate,
            "__len__": native_calls.count,
            "apply_filter": _apply_filter,
            "apply_filter_script": _apply_filter_script,
            "clear": native_calls.clear,
            "clear_filter_script": _clear_filter_script,
            "current_mesh": native_calls.current_mesh,
            "current_mesh_id": native_calls.current_mesh_id,
            "filter_parameter_values": _filter_parameter_values,
            "is_mesh_visible": native_calls.is_mesh_visible,
            "load_filter_script": _load_filter_script,
            "load_new_mesh": _file_method,
            "load_new_raster": _file_method,
            "load_project": _file_method,
            "mesh": native_calls.mesh,
            "mesh_id_exists": native_calls.mesh_id_exists,
            "mesh_number": native_calls.count,
            "number_meshes": native_calls.count,
            "print_filter_script": _in_order(_print_filter_script),
            "print_status": _in_order(native_calls.print_status),
            "save_current_mesh": _file_method,
            "save_filter_script": _save_filter_script,
            "save_project": native_calls.save_project,
            "set_current_mesh": native_calls.set_current_mesh,
            "set_mesh_visibility": native_calls.set_mesh_visibility,
            "set_parameter_verbosity": _set_parameter_verbosity,
            "set_verbosity": _set_verbosity,
        },
    ),
    (pymeshlab.Mesh, {"id": native_calls.id_of}),
    (
        pymeshlab,
        {
            "filter_list": _filter_list,
            "print_filter_list": _in_order(_print_filter_list),
            "print_filter_parameter_list": _in_order(_print_filter_parameter_list),
            "print_plugin_filter_list": _as_before,
            "print_plugin_list": _as_before,
            "print_pymeshlab_version": _as_before,
            "search": _in_order(_search),
        },
    ),
)
