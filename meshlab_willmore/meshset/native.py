"""PyMeshLab's own functions, called without side effects that a user could notice.

Helper filters of this package don't show in a set's filter script, print nothing, and don't go
through subclasses or wrappers of `MeshSet`. Ids here are PyMeshLab's own, the physical ones of
`ids`.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import inspect
import io
import os
import sys
import tempfile
import weakref
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import IO, Any, Generic, NamedTuple, TypeVar

import numpy as np
import pymeshlab
from pymeshlab import MeshSet

from ..temporary_files import temporary_folder

# PyMeshLab's own, not what `register` (of a module that was imported before) replaced them with.
_own = SimpleNamespace(
    **{name: inspect.unwrap(value) for name, value in vars(MeshSet).items() if callable(value)}
)
add = _own.add_mesh
clear = _own.clear
clear_script = _own.clear_filter_script
current_mesh = _own.current_mesh
defaults = _own.filter_parameter_values
_iterate = inspect.unwrap(MeshSet.__iter__)
id_of = inspect.unwrap(pymeshlab.Mesh.id)
is_there = _own.mesh_id_exists
mesh = _own.mesh
show = _own.set_mesh_visibility

# The id that no layer has.
NO_LAYER = -1

# What PyMeshLab's functions raise; not all of it is a PyMeshLabException.
ERRORS: tuple[type[Exception], ...] = (
    RuntimeError,
    pymeshlab.PyMeshLabException,
    pymeshlab.InvalidEnumException,
    pymeshlab.InvalidPercentageException,
    pymeshlab.MissingComponentException,
    pymeshlab.MissingCompactnessException,
)

# Bytes of a filter script, about.
_SCRIPT_SIZE = 10_000

T = TypeVar("T")


class PerSet(Generic[T]):
    """A value for each `MeshSet` or `Mesh`, by identity."""

    def __init__(self, default: T) -> None:
        self._default = default
        self._values: dict[int, T] = {}

    def get(self, ms: MeshSet | pymeshlab.Mesh) -> T:
        """The value of `ms`, or the default."""
        return self._values.get(id(ms), self._default)

    def put(self, ms: MeshSet | pymeshlab.Mesh, value: T) -> None:
        """Set the value of `ms`; it is dropped with the set."""
        if id(ms) not in self._values:
            weakref.finalize(ms, self._values.pop, id(ms), None).atexit = False
        self._values[id(ms)] = value


# The sets whose script must be saved before a filter is applied, see `without_trace`.
_untraced: PerSet[contextlib.ExitStack | None] = PerSet(None)


def apply(ms: MeshSet, name: str, /, **given: Any) -> dict[str, Any]:
    """Apply a native filter."""
    keep_script(ms)
    with in_order_if_verbose(ms):
        return _own.apply_filter(ms, name, **given)


def load(ms: MeshSet, path: Path) -> None:
    """Load a mesh as a new layer, which becomes the current one.

    Meanwhile the working folder is the root: PyMeshLab looks for textures there first.
    """
    absolute = path.absolute()
    with kept_working_folder():
        os.chdir(absolute.anchor)
        _own.load_new_mesh(ms, str(absolute))


def save(ms: MeshSet, path: Path, **options: bool) -> None:
    """Save the current mesh, which is noted to have the name of that file then."""
    _own.save_current_mesh(ms, str(path), **options)


def make_current(ms: MeshSet, mesh_id: int | None) -> None:
    """Make a layer the current one, or none."""
    _own.set_current_mesh(ms, NO_LAYER if mesh_id is None else mesh_id)


def current_id(ms: MeshSet) -> int | None:
    """The id of the current layer; None if there is none."""
    try:
        return _own.current_mesh_id(ms)
    except pymeshlab.PyMeshLabException:
        return None


def ids(ms: MeshSet) -> list[int]:
    """The ids of all layers, in PyMeshLab's order."""
    return [id_of(layer) for layer in _iterate(ms)]


@contextmanager
def kept_working_folder() -> Iterator[None]:
    """The process is in the same working folder afterwards, whatever native calls do inside.

    A load that fails leaves PyMeshLab in the folder of its file, and so does one that succeeds
    where the working folder was deleted: relative names then mean other files. Screened
    Poisson reconstruction that fails leaves it in a temporary folder that is gone.
    """
    if sys.platform == "win32":
        folder = os.getcwd()
        try:
            yield
        finally:
            os.chdir(folder)
        return
    # A descriptor finds the folder also after it was renamed, and needs no right to read it.
    descriptor = os.open(".", getattr(os, "O_PATH", os.O_RDONLY))
    try:
        yield
    finally:
        try:
            os.fchdir(descriptor)
        finally:
            os.close(descriptor)


@contextmanager
def without_trace(ms: MeshSet) -> Iterator[None]:
    """Filters that `apply` runs on `ms` inside print nothing, and don't stay in its filter script.

    The script is saved before the first of them at the latest (see `keep_script`).
    """
    outer = _untraced.get(ms)
    with _quiet(ms), contextlib.ExitStack() as stack:
        _untraced.put(ms, stack)
        try:
            yield
        finally:
            _untraced.put(ms, outer)


def keep_script(ms: MeshSet) -> None:
    """Save the script of a set that is `without_trace` now: filters will be applied.

    Raises
    ------
    OSError
        If PyMeshLab can't write it.
    """
    stack = _untraced.get(ms)
    if stack is not None:
        _untraced.put(ms, None)
        stack.enter_context(unrecorded(ms))


def script_of(ms: MeshSet) -> bytes:
    """The filter script of `ms` as XML; characters that can't be read are replaced."""
    with temporary_folder(_SCRIPT_SIZE) as folder:
        written = _script(ms, folder / "script.mlx")
    # PyMeshLab writes in the encoding of the system, which is not always the UTF-8 of XML.
    return written.decode("utf-8", errors="replace").encode("utf-8")


@contextmanager
def unrecorded(ms: MeshSet) -> Iterator[None]:
    """Native filters inside don't stay in the filter script of `ms`."""
    with temporary_folder(_SCRIPT_SIZE) as folder:
        path = folder / "script.mlx"
        before = _script(ms, path)
        try:
            yield
        finally:
            if _script(ms, path.with_name("after.mlx")) != before:
                clear_script(ms)
                if b"<filter" in before:
                    _load_script(ms, path)


_WHOLE_SCRIPT = (b"</FilterScript>", b"<FilterScript/>")


def _load_script(ms: MeshSet, path: Path) -> None:
    with muted():
        _own.load_filter_script(ms, str(path))


def script_listing(path: Path) -> str:
    """What PyMeshLab prints of the filter script in a file."""
    ms = MeshSet()
    _load_script(ms, path)
    return printed(lambda: _own.print_filter_script(ms))


def _script(ms: MeshSet, path: Path) -> bytes:
    """The filter script of `ms` as XML, which stays at `path`."""
    _own.save_filter_script(ms, str(path))
    script = path.read_bytes() if path.exists() else b""
    # PyMeshLab reports no error if it can't write.
    if not script.rstrip().endswith(_WHOLE_SCRIPT):
        raise OSError(f"the filter script could not be written to {path.parent}; is the disk full?")
    return script


class Verbosity(NamedTuple):
    """What a set prints: `all` that filters report (None: not set), or their `parameters` only."""

    all: bool | None = None
    parameters: bool = False


_SILENT = (Verbosity(), Verbosity(all=False))

# PyMeshLab has no getter for it, so `register` notes what is set.
_verbosity: PerSet[Verbosity] = PerSet(Verbosity())


def note_verbosity(ms: MeshSet, **changes: bool) -> None:
    """Remember what `ms` was set to print; `changes` are fields of `Verbosity`."""
    _verbosity.put(ms, verbosity(ms)._replace(**changes))


def verbosity(ms: MeshSet) -> Verbosity:
    """What `ms` prints, as far as is known."""
    return _verbosity.get(ms)


@contextmanager
def _quiet(ms: MeshSet) -> Iterator[None]:
    before = verbosity(ms)
    if before == Verbosity():
        yield
        return
    _own.set_verbosity(ms, False)
    _own.set_parameter_verbosity(ms, False)
    try:
        yield
    finally:
        _own.set_verbosity(ms, bool(before.all))
        _own.set_parameter_verbosity(ms, before.parameters)


@contextmanager
def muted() -> Iterator[None]:
    """PyMeshLab's C++ side prints nothing inside, including what no verbosity controls."""
    with open(os.devnull, "wb") as sink, _redirected((1, 2), sink):
        yield


def printed(call: Callable[[], object]) -> str:
    """What PyMeshLab's C++ side would print to standard output in a call, which prints nothing."""
    with tempfile.TemporaryFile() as file:
        with _redirected((1,), file):
            call()
        file.seek(0)
        return file.read().decode("utf-8", errors="replace")


@contextmanager
def _redirected(descriptors: Iterable[int], sink: IO[bytes]) -> Iterator[None]:
    """Redirect file descriptors into a file during one short call.

    PyMeshLab's C++ streams don't go through Python's.
    """
    with contextlib.ExitStack() as stack:
        _flush_c_streams()
        for descriptor in descriptors:
            # A program without a console has no such descriptors, and prints nothing.
            with contextlib.suppress(OSError):
                saved = os.dup(descriptor)
                stack.callback(os.close, saved)
                stack.callback(os.dup2, saved, descriptor)
                os.dup2(sink.fileno(), descriptor)
        stack.callback(_flush_c_streams)
        yield


@contextmanager
def overheard(ms: MeshSet) -> Iterator[list[str]]:
    """PyMeshLab prints nothing inside; afterwards the list holds the lines of a verbose set."""
    lines: list[str] = []
    # The parameters of a call are printed by Python.
    with tempfile.TemporaryFile() as sink, contextlib.redirect_stdout(io.StringIO()):
        _own.set_verbosity(ms, True)
        try:
            with _redirected((1, 2), sink):
                yield lines
        finally:
            _own.set_verbosity(ms, bool(verbosity(ms).all))
        sink.seek(0)
        lines += sink.read().decode("utf-8", "surrogateescape").splitlines()


class _InTurn:
    """Python's standard output, flushed in turn with C's."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        _flush_c_streams()
        count = self._stream.write(text)
        self._stream.flush()
        return count

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def in_order() -> Iterator[None]:
    """What Python and PyMeshLab print inside comes in order, also with what is before and after.

    PyMeshLab prints to C's standard output, and some of it to Python's: in a pipe both are
    buffered.
    """
    _flush()
    out: Any = sys.stdout and _InTurn(sys.stdout)
    try:
        with contextlib.redirect_stdout(out):
            yield
    finally:
        _flush()


@contextmanager
def in_order_if_verbose(ms: MeshSet) -> Iterator[None]:
    """As `in_order`, if `ms` is verbose."""
    if verbosity(ms) in _SILENT:
        yield
        return
    with in_order():
        yield


def _flush() -> None:
    for stream in (sys.stdout, sys.__stdout__):
        # A program can have no standard output, or have closed it.
        if stream is not None and not stream.closed:
            stream.flush()
    _flush_c_streams()


def _flush_c_streams() -> None:
    _c_runtime().fflush(None)


@functools.cache
def _c_runtime() -> ctypes.CDLL:
    return ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None)


def forget_failures() -> None:
    """Make saving and loading safe after a native filter failed.

    A filter that fails leaves PyMeshLab with a pointer to the log of its set, which the next
    file operation writes to, even if the set is gone by then. A filter that succeeds clears it.
    """
    helper = MeshSet()
    helper.add_mesh(pymeshlab.Mesh(np.zeros((1, 3))))
    # Any filter would do; PyMeshLab finds this one soonest.
    apply(helper, "apply_color_inverse_per_vertex")
