"""Loading meshes: first in a process of its own, since PyMeshLab crashes on some damaged files.

One such file would end a run with all files after it.
"""

from __future__ import annotations

import faulthandler
import multiprocessing
import os
import signal
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from itertools import islice
from multiprocessing.connection import Connection
from pathlib import Path
from typing import TYPE_CHECKING

from .. import memory
from ..messages import note, reason
from ..signals import killable
from . import losses

if TYPE_CHECKING:
    import pymeshlab

# On some files that end early PyMeshLab reads or allocates memory without end.
_SECONDS = 20.0
_SECONDS_PER_BYTE = 1e-6
# The process ends itself so much later than the parent would end it.
_LONGER = 1.0

_IMAGES = {".bmp", ".jpeg", ".jpg", ".png", ".tga", ".tif", ".tiff"}
# In an OFF file: vertices and faces; a third number, of edges, can be left out.
_COUNTS = 2


def loaded(path: Path) -> pymeshlab.MeshSet:
    """A new set with the meshes of a file."""
    import pymeshlab

    ms = pymeshlab.MeshSet()
    load(ms, path)
    return ms


def load(ms: pymeshlab.MeshSet, path: Path, is_isolated: bool = False) -> None:
    """Load a mesh file as new layers of `ms`, and print notes on what of it is not read.

    Where this process `is_isolated` already, the file is not tried in another one before. Raises
    `OSError` in one line: which file, and why it can't be read.
    """
    from ..meshset import native

    errors: tuple[type[Exception], ...] = (*native.ERRORS, OSError)
    before = ms.mesh_number()
    native.forget_failures()
    try:
        with killable():
            _check_corners_of_off(path)
            # Starting a process flushes Python's streams: they are muted in it only.
            if not is_isolated:
                try_in_process(path, _try, _why)
        with killable(), native.overheard(ms) as printed:
            _load_checked(ms, path)
    except errors as error:
        raise OSError(f"cannot read {path}: {_why(path, error)}") from error
    if ms.current_mesh().vertex_number() == 0:
        raise OSError(f"cannot read {path}: there is no mesh in it (no vertices)")
    count = ms.mesh_number() - before
    if count > 1:
        note(f"{path}: it holds {count} meshes; the last one is used, the others are layers")
    for loss in losses.losses(path, printed, ms.current_mesh()):
        note(f"{path}: {loss}")


def _try(path: Path) -> None:
    import pymeshlab

    from ..meshset import native

    with native.muted():
        _load_checked(pymeshlab.MeshSet(), path)


def _load_checked(ms: pymeshlab.MeshSet, path: Path) -> None:
    """Load a mesh; raise `OSError` if a face has a corner that is no vertex.

    Filters would read and write anywhere in memory.
    """
    from ..meshset import native

    native.load(ms, path)
    mesh = ms.current_mesh()
    count, faces = mesh.vertex_number(), mesh.face_matrix()
    is_bad = ((faces < 0) | (faces >= count)).any(axis=1)
    if is_bad.any():
        raise _no_vertex(int(is_bad.argmax()), count)


def _check_corners_of_off(path: Path) -> None:
    """Raise `OSError` if a face of an OFF file, line by line as usual, has such a corner.

    PyMeshLab looks for them itself in PLY files and, nearly, in OBJ files.
    """
    if path.suffix.lower() != ".off":
        return
    with path.open("rb") as file:
        lines = (text for line in file if (text := line.partition(b"#")[0].split()))
        head = next(lines, [])
        counts = head[1:] or next(lines, [])
        if len(counts) < _COUNTS or not all(number.isdigit() for number in counts[:_COUNTS]):
            return
        vertices, faces = (int(number) for number in counts[:_COUNTS])
        for face, numbers in enumerate(islice(lines, vertices, vertices + faces)):
            size = int(numbers[0]) if numbers[0].isdigit() else 0
            for number in numbers[1 : size + 1]:
                if number.isdigit() and int(number) >= vertices:
                    raise _no_vertex(face, vertices)


def _no_vertex(face: int, vertices: int) -> OSError:
    return OSError(f"face {face} has a vertex that is not in 0 .. {vertices - 1}")


def _why(path: Path, error: Exception) -> str:
    """Why a file can't be read, in one line."""
    if not path.suffix:
        return "its name has no ending, which determines the format"
    if "Unknown format" in str(error):
        return f"PyMeshLab knows no mesh format {path.suffix!r}"
    # Without details nothing but the names of file and class is left.
    details = reason(error).rstrip(".")
    return "it is no mesh of that format" if details in ("", type(error).__name__) else details


# --- in a process of its own -------------------------------------------------------------------


def try_in_process(
    path: Path, load: Callable[[Path], None], why: Callable[[Path, Exception], str]
) -> None:
    """Raise `OSError` if `load` fails, crashes or does not end in a forked process.

    The message, which for errors comes from `why`, is one line without the name of the file.
    """
    if sys.platform != "linux":
        return
    seconds = time_limit(path)
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=_answer, args=(sender, path, load, why, seconds + _LONGER))
    with warnings.catch_warnings(), receiver:
        # Other threads do not matter to a child that only loads.
        warnings.simplefilter("ignore", DeprecationWarning)
        child.start()
        sender.close()
        try:
            problem = f"PyMeshLab does not finish within {seconds:.0f} s"
            if receiver.poll(seconds):
                problem = receiver.recv()
        except EOFError:
            child.join()
            code = child.exitcode or 0
            name = signal.Signals(-code).name if code < 0 else f"exit code {code}"
            problem = f"PyMeshLab crashes on it ({name}); the file is damaged, or ends early"
        finally:
            child.kill()
            child.join()
            child.close()
    if problem:
        raise OSError(problem)


def time_limit(path: Path) -> float:
    """How many seconds loading may take: textures can be far larger than the mesh."""
    size = path.stat().st_size
    with suppress(OSError):
        images = (p for p in path.parent.iterdir() if p.suffix.lower() in _IMAGES)
        size += sum(image.stat().st_size for image in images)
    return _SECONDS + _SECONDS_PER_BYTE * size


def _answer(
    sender: Connection,
    path: Path,
    load: Callable[[Path], None],
    why: Callable[[Path, Exception], str],
    seconds: float,
) -> None:
    """Load, and send why that failed, or an empty text. Runs in the forked process."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # A parent that was killed can't end this process.
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    faulthandler.disable()
    problem = ""
    # A damaged file must neither use up the memory of others nor leave a core file.
    memory.no_core_files()
    try:
        with memory.limited(memory.reachable()):
            load(path)
    except Exception as error:
        problem = why(path, error)
    sender.send(problem)
    # Without exit handlers, which are those of the parent.
    os._exit(0)
