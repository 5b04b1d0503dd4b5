"""Replacing a layer of a `MeshSet` so that nobody who looks on is harmed.

PyMeshLab edits a mesh in place only from C++, so a mesh with other faces is a new layer. This
room sees to it that

- a `Mesh` object that somebody holds never points to freed memory: its layer stays, hidden, until
  the object is gone (`sweep`);
- the id stays, where the set holds just that mesh;
- the helper filters leave no trace in the set's filter script and print nothing;
- Ctrl-C waits for the few milliseconds in which the set is between two states.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import os
import sys
import tempfile
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pymeshlab

from . import interrupts

# A set that has seen more layers than this gives the new mesh a new id.
_MOST_IDS_TO_REBUILD = 1000

_PARKED_SUFFIX = " (before Willmore flips)"

# Ids of the layers that stay only because somebody holds their `Mesh`, by set.
_parked: weakref.WeakKeyDictionary[pymeshlab.MeshSet, set[int]] = weakref.WeakKeyDictionary()


class Identity(NamedTuple):
    """What a layer is called and where it stands: label, visibility, (4, 4) transform."""

    label: str
    visible: bool
    transform: np.ndarray


def identity(mesh: pymeshlab.Mesh) -> Identity:
    """The identity of `mesh`."""
    return Identity(mesh.label(), mesh.is_visible(), mesh.transform_matrix())


def replace_current(
    ms: pymeshlab.MeshSet,
    trial: pymeshlab.MeshSet,
    load: Callable[[pymeshlab.MeshSet], None],
    who: Identity,
) -> None:
    """Let `load` bring a new layer into `ms`, and let it take the place of the current one.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
        Changed in place: afterwards the new layer is current and carries the identity `who`.
        Where the old layer was the set's only one, the new one has its id.
    trial : pymeshlab.MeshSet
        Its current mesh is what `load` brings; the way back if `load` fails half-way.
    load : callable
        Called with `ms`; must add one layer and make it current.
    who : Identity
        Label, visibility and transform of the new layer.
    """
    old_id = ms.current_mesh_id()
    held = _is_held(ms, old_id)
    alone = ms.mesh_number() == 1 and ms.raster_number() == 0
    with interrupts.deferred(), quiet(ms), unrecorded(ms):
        if alone and not held and old_id <= _MOST_IDS_TO_REBUILD:
            _refill(ms, old_id, trial, load)
        else:
            load(ms)
            _retire(ms, old_id, held)
        _identify(ms, who)


def _refill(
    ms: pymeshlab.MeshSet,
    wanted_id: int,
    trial: pymeshlab.MeshSet,
    load: Callable[[pymeshlab.MeshSet], None],
) -> None:
    """Empty the set and load: ids start again at 0, so stand-ins use up those below."""
    ms.clear()
    stand_in = pymeshlab.Mesh(np.zeros((1, 3)))
    for _ in range(wanted_id):
        ms.add_mesh(stand_in)
        ms.set_current_mesh_visibility(False)
    try:
        load(ms)
    except BaseException:
        ms.add_mesh(trial.current_mesh())
        raise
    finally:
        if wanted_id:
            ms.delete_non_visible_meshes()
            ms.set_current_mesh(wanted_id)


def _retire(ms: pymeshlab.MeshSet, old_id: int, held: bool) -> None:
    """Delete the old layer, or hide it as long as somebody holds it."""
    if held:
        old = ms.mesh(old_id)
        old.set_label(old.label() + _PARKED_SUFFIX)
        ms.set_mesh_visibility(old_id, False)
        _parked.setdefault(ms, set()).add(old_id)
    else:
        _delete(ms, old_id)


def _delete(ms: pymeshlab.MeshSet, mesh_id: int) -> None:
    current = ms.current_mesh_id()
    ms.set_current_mesh(mesh_id)
    ms.delete_current_mesh()
    ms.set_current_mesh(current)


def _identify(ms: pymeshlab.MeshSet, who: Identity) -> None:
    ms.current_mesh().set_label(who.label)
    ms.set_current_mesh_visibility(who.visible)
    if not np.array_equal(who.transform, np.eye(4)):
        ms.set_matrix(transformmatrix=who.transform, compose=False, freeze=False)


def sweep(ms: pymeshlab.MeshSet) -> None:
    """Delete the hidden layers of `ms` that nobody holds any more."""
    waiting = _parked.get(ms)
    if not waiting:
        return
    gone = {i for i in waiting if not ms.mesh_id_exists(i)}
    free = {i for i in waiting - gone if i != ms.current_mesh_id() and not _has_wrapper(ms, i)}
    waiting -= gone | free
    if free:
        with interrupts.deferred(), quiet(ms), unrecorded(ms):
            for mesh_id in sorted(free):
                _delete(ms, mesh_id)


def _is_held(ms: pymeshlab.MeshSet, mesh_id: int) -> bool:
    """Whether a `Mesh` object of this layer is alive, apart from garbage."""
    if not _has_wrapper(ms, mesh_id):
        return False
    gc.collect()
    return _has_wrapper(ms, mesh_id)


def _has_wrapper(ms: pymeshlab.MeshSet, mesh_id: int) -> bool:
    """PyMeshLab hands out the living object if there is one, and a new one dies at once."""
    return weakref.ref(ms.mesh(mesh_id))() is not None


# --- without a trace ---------------------------------------------------------------------------


@contextmanager
def unrecorded(ms: pymeshlab.MeshSet) -> Iterator[None]:
    """Native filters that run inside don't stay in the filter script of `ms`."""
    with tempfile.TemporaryDirectory(prefix="meshlab_willmore_") as folder:
        path = Path(folder) / "before.mlx"
        ms.save_filter_script(str(path))
        before = path.read_bytes()
        try:
            yield
        finally:
            after = Path(folder) / "after.mlx"
            ms.save_filter_script(str(after))
            if after.read_bytes() != before:
                ms.clear_filter_script()
                if b"<filter" in before:
                    with muted():
                        ms.load_filter_script(str(path))


@contextmanager
def muted() -> Iterator[None]:
    """PyMeshLab's C++ side prints nothing inside, not even what no verbosity controls.

    Its streams don't ask Python, so the file descriptors are turned away, for the while of one
    short call.
    """
    with contextlib.ExitStack() as stack:
        _flush_c_streams()
        for descriptor in (1, 2):
            # A program without a console has no such descriptors, and nothing to hide.
            with contextlib.suppress(OSError):
                saved = os.dup(descriptor)
                stack.callback(os.close, saved)
                stack.callback(os.dup2, saved, descriptor)
                with open(os.devnull, "wb") as sink:
                    os.dup2(sink.fileno(), descriptor)
        stack.callback(_flush_c_streams)
        yield


def _flush_c_streams() -> None:
    runtime = ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None)
    runtime.fflush(None)


def forget_failures() -> None:
    """Make saving and loading safe after a native filter failed.

    A filter that fails leaves PyMeshLab with a pointer to the log of its set, which the next
    file operation writes to, even if the set is gone by then. A filter that succeeds clears it.
    """
    helper = pymeshlab.MeshSet()
    helper.add_mesh(pymeshlab.Mesh(np.zeros((1, 3))))
    helper.set_selection_none()


class Verbosity(NamedTuple):
    """What a set prints: `all` of a filter's doings, or its `parameters` only."""

    all: bool = False
    parameters: bool = False


# PyMeshLab has no way to ask, so `register` notes what it is told.
_verbosity: weakref.WeakKeyDictionary[pymeshlab.MeshSet, Verbosity] = weakref.WeakKeyDictionary()


def note_verbosity(ms: pymeshlab.MeshSet, **changes: bool) -> None:
    """Remember that `ms` was told to print more or less; `changes` are fields of `Verbosity`."""
    _verbosity[ms] = verbosity(ms)._replace(**changes)


def verbosity(ms: pymeshlab.MeshSet) -> Verbosity:
    """What `ms` prints, as far as is known."""
    return _verbosity.get(ms, Verbosity())


@contextmanager
def quiet(ms: pymeshlab.MeshSet) -> Iterator[None]:
    """Native calls on `ms` print nothing inside, whatever its verbosity."""
    before = verbosity(ms)
    if before == Verbosity():
        yield
        return
    ms.set_verbosity(False)
    ms.set_parameter_verbosity(False)
    try:
        yield
    finally:
        ms.set_verbosity(before.all)
        ms.set_parameter_verbosity(before.parameters)
