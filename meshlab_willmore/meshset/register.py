"""Puts the filters on `pymeshlab.MeshSet`, beside MeshLab's own.

PyMeshLab's methods all end in ``MeshSet.apply_filter``, and its lists come from four functions:
replacing these makes our filters known wherever the native ones are. What counts the layers of a
set, goes through them, or takes or tells ids is replaced as well, see `ids`.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pymeshlab
from pymeshlab import MeshSet

from ..mlx.write import write
from . import ids, layers, native, native_calls, numbering, recording, status
from .apply import apply, values_of
from .check import resolve
from .filter import Filter
from .filters import BY_NAME, FILTERS
from .listing import listing
from .methods import method_of
from .play import play
from .recording import our_script

_MISSING = object()

# (owner, attribute, value before), in the order of replacement; empty: not registered.
_replaced: list[tuple[Any, str, Any]] = []

# On the wrapper of apply_filter: how to undo a registration, also one of a module that was
# imported before and dropped from sys.modules since.
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
    for owner, wrappers in (
        (MeshSet, {**ids.SET_METHODS, **_METHODS}),
        (pymeshlab.Mesh, ids.MESH_METHODS),
        (pymeshlab, _FUNCTIONS),
    ):
        for name, make in wrappers.items():
            _wrap(owner, name, make)
    setattr(MeshSet.apply_filter, _UNDO, unregister)
    for filter_ in FILTERS:
        _replace(MeshSet, filter_.name, method_of(filter_))


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


def _wrap(owner: Any, name: str, make: Callable[[Callable], Callable]) -> None:
    before = getattr(owner, name)
    _replace(owner, name, functools.wraps(before, updated=())(make(before)))


# --- applying ----------------------------------------------------------------------------------


def _ours(args: tuple[Any, ...], key: str, given: dict[str, Any]) -> Filter | None:
    """The filter that a call names, if the call is well-formed and the filter is ours."""
    if len(args) == 1 and isinstance(args[0], str):
        return BY_NAME.get(args[0])
    if not args and isinstance(given.get(key), str):
        return BY_NAME.get(given.pop(key)) if given[key] in BY_NAME else None
    return None


def _wrap_apply_filter(wrapped: Callable) -> Callable:
    def apply_filter(self: MeshSet, *args: Any, **kwargs: Any) -> dict[str, Any]:
        layers.sweep(self)
        filter_ = _ours(args, "filter_name", kwargs)
        if filter_ is not None:
            values = values_of(self, filter_, kwargs)
            with _as_pymeshlab_error():
                recording.catch_up(self)
            returned = apply(self, filter_, values)
            recording.note_ours(self, filter_, values)
            return returned
        name = args[0] if args else kwargs.get("filter_name")
        if not numbering.has_moved(self):
            with native.spoken(self):
                returned = wrapped(self, *args, **kwargs)
            recording.note_native(self, recording.NO_IDS)
            return returned
        with native_calls.prepared(self, name, kwargs) as given, native.spoken(self):
            returned = wrapped(self, *args, **given)
        recording.note_native(self, native_calls.logical_ids(self, name, given))
        return returned

    return apply_filter


def _wrap_filter_parameter_values(wrapped: Callable) -> Callable:
    def filter_parameter_values(self: MeshSet, *args: Any, **kwargs: Any) -> dict[str, Any]:
        filter_ = _ours(args, "arg0", kwargs)
        if filter_ is not None:
            return values_of(self, filter_, kwargs)
        if len(args) == 1 and numbering.has_moved(self):
            return native_calls.parameter_values(self, wrapped, args[0], kwargs)
        return wrapped(self, *args, **kwargs)

    return filter_parameter_values


def _wrap_init(wrapped: Callable) -> Callable:
    def init(self: MeshSet, *args: Any, **kwargs: Any) -> None:
        wrapped(self, *args, **kwargs)
        verbose = args[0] if args else kwargs.get("verbose", False)
        if verbose:
            native.note_verbosity(self, all=True)

    return init


def _wrap_set_verbosity(field: str) -> Callable[[Callable], Callable]:
    def make(wrapped: Callable) -> Callable:
        def set_verbosity(self: MeshSet, verbosity: bool) -> None:
            wrapped(self, verbosity)
            native.note_verbosity(self, **{field: bool(verbosity)})

        return set_verbosity

    return make


# --- files, and what prints ----------------------------------------------------------------------

# Functions of PyMeshLab that print, and know nothing of filters.
_PRINTING = ("print_plugin_filter_list", "print_plugin_list", "print_pymeshlab_version")


def _printing(wrapped: Callable) -> Callable:
    """The same, in order with all else that is printed."""

    @functools.wraps(wrapped)
    def printing(*args: Any, **kwargs: Any) -> None:
        with native.in_order():
            wrapped(*args, **kwargs)

    return printing


def _wrap_print_status(wrapped: Callable) -> Callable:
    def print_status(self: MeshSet) -> None:
        if numbering.has_moved(self):
            print(status.status(self, native.printed(lambda: wrapped(self))), end="")
        else:
            wrapped(self)

    return _printing(print_status)


def _wrap_file_method(wrapped: Callable) -> Callable:
    """PyMeshLab's own, which leaves the working folder as it is also where it fails."""

    def file_method(self: MeshSet, *args: Any, **kwargs: Any) -> None:
        with native.kept_working_folder(), native.spoken(self):
            wrapped(self, *args, **kwargs)

    return file_method


def _wrap_save_project(wrapped: Callable) -> Callable:
    def save_project(self: MeshSet, file_name: str) -> None:
        with native.kept_working_folder(), native.spoken(self):
            wrapped(self, file_name)
        if numbering.has_moved(self) and os.path.isfile(_path(file_name)):
            status.reorder_project(self, Path(_path(file_name)))

    return save_project


# --- filter scripts ----------------------------------------------------------------------------


def _wrap_apply_filter_script(wrapped: Callable) -> Callable:
    def apply_filter_script(self: MeshSet) -> None:
        layers.sweep(self)
        # PyMeshLab would go by its own ids and order, and reach parked layers.
        if not recording.holds_more(self) and not numbering.has_moved(self):
            with native.spoken(self):
                wrapped(self)
            return
        with _as_pymeshlab_error():
            source = recording.source_of(self)
            calls = resolve(recording.steps_of(self), source, layers.shown_ids(self))
        play(self, calls, source)

    return apply_filter_script


def _wrap_load_filter_script(wrapped: Callable) -> Callable:
    def load_filter_script(self: MeshSet, filter_script_name: str) -> None:
        with _as_pymeshlab_error():
            steps = our_script(_path(filter_script_name)) if filter_script_name else None
        if steps is None:
            wrapped(self, filter_script_name)
            recording.forget(self)
        else:
            recording.put(self, steps, _path(filter_script_name))

    return load_filter_script


def _path(name: str | bytes) -> str:
    """The name of a file; PyMeshLab's functions take bytes as well."""
    return os.fsdecode(name)


def _wrap_save_filter_script(wrapped: Callable) -> Callable:
    def save_filter_script(self: MeshSet, filter_script_name: str) -> None:
        if recording.holds_more(self) and isinstance(filter_script_name, (str, bytes)):
            with _as_pymeshlab_error():
                write(_path(filter_script_name), recording.steps_of(self))
        else:
            wrapped(self, filter_script_name)

    return save_filter_script


def _wrap_print_filter_script(wrapped: Callable) -> Callable:
    def print_filter_script(self: MeshSet) -> None:
        if recording.holds_more(self):
            with _as_pymeshlab_error():
                steps = recording.steps_of(self)
            print(listing(steps))
        else:
            wrapped(self)

    return _printing(print_filter_script)


def _wrap_clear_filter_script(wrapped: Callable) -> Callable:
    def clear_filter_script(self: MeshSet) -> None:
        wrapped(self)
        recording.forget(self)

    return clear_filter_script


@contextmanager
def _as_pymeshlab_error() -> Iterator[None]:
    try:
        yield
    except (ValueError, OSError) as error:
        raise pymeshlab.PyMeshLabException(str(error)) from error


# --- lists -------------------------------------------------------------------------------------


def _wrap_filter_list(wrapped: Callable) -> Callable:
    def filter_list() -> list[str]:
        return sorted([*wrapped(), *BY_NAME])

    return filter_list


def _wrap_print_filter_list(_: Callable) -> Callable:
    def print_filter_list() -> None:
        print("MeshSet class - list of filter names:")
        for name in pymeshlab.filter_list():
            print(f"\t{name}")

    return _printing(print_filter_list)


def _wrap_print_filter_parameter_list(wrapped: Callable) -> Callable:
    def print_filter_parameter_list(filter_name: str) -> None:
        filter_ = BY_NAME.get(filter_name)
        if filter_ is None:
            wrapped(filter_name)
            return
        print(f"{filter_name} filter - list of parameter names:")
        for parameter in filter_.parameters:
            kind = parameter.type.__name__
            print(f"\t{parameter.name} : {kind} = {parameter.shown_default()}")
        if not filter_.parameters:
            print("\tNone.")

    return _printing(print_filter_parameter_list)


def _wrap_search(wrapped: Callable) -> Callable:
    def search(search_key_word: str) -> None:
        words = search_key_word.lower().split()
        for filter_ in FILTERS:
            text = f"{filter_.name} {filter_.meshlab_name} {filter_.summary}".lower()
            if words and all(word in text for word in words):
                print(f"{filter_.name} : {filter_.summary}")
        wrapped(search_key_word)

    return _printing(search)


_METHODS: dict[str, Callable[[Callable], Callable]] = {
    "__init__": _wrap_init,
    "apply_filter": _wrap_apply_filter,
    "apply_filter_script": _wrap_apply_filter_script,
    "clear_filter_script": _wrap_clear_filter_script,
    "filter_parameter_values": _wrap_filter_parameter_values,
    "load_filter_script": _wrap_load_filter_script,
    "load_new_mesh": _wrap_file_method,
    "load_new_raster": _wrap_file_method,
    "load_project": _wrap_file_method,
    "print_filter_script": _wrap_print_filter_script,
    "print_status": _wrap_print_status,
    "save_current_mesh": _wrap_file_method,
    "save_filter_script": _wrap_save_filter_script,
    "save_project": _wrap_save_project,
    "set_parameter_verbosity": _wrap_set_verbosity("parameters"),
    "set_verbosity": _wrap_set_verbosity("all"),
}
_FUNCTIONS: dict[str, Callable[[Callable], Callable]] = {
    "filter_list": _wrap_filter_list,
    **dict.fromkeys(_PRINTING, _printing),
    "print_filter_list": _wrap_print_filter_list,
    "print_filter_parameter_list": _wrap_print_filter_parameter_list,
    "search": _wrap_search,
}
