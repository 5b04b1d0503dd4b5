"""One row of a comparison, computed in a subprocess.

A native filter can't be interrupted, and may crash. The subprocess gets its task as a line on its
standard input, and ends when that is closed: with the parent, however that ended. It answers with
lines of JSON: the name of each phase that begins, and the outcome last.
"""

from __future__ import annotations

import faulthandler
import json
import math
import os
import signal
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple

from .. import machine
from ..mesh_files import loading
from ..mesh_files.paths import check_input
from ..messages import WrongUse, reason
from ..temporary_files import temporary_folder

if TYPE_CHECKING:
    from ..compare.reference import Reference, Sphere, Torus
    from ..compare.rows import Row

# The phases, in their order.
READING = "reading"
WARMING = "warming up"
RUNNING = "running"
MEASURING = "measuring"

REFERENCES = "sphere, sphere:2 or torus:3,1"

# No file of the working folder may hide a module.
_PROGRAM = "import sys; sys.path[:] = {path!r}; from {module} import main; main()"
# The exit code of a subprocess whose filter takes too long.
_TOO_SLOW = 1


class Comparison(NamedTuple):
    """The mesh file, the reference surface (see `read_reference`) and the seconds for a filter."""

    source: str
    reference: str | None
    timeout: float


class Outcome(NamedTuple):
    """The result of a row."""

    # Of the filter alone; None if there was none, or it did not end.
    seconds: float | None = None
    # As `meshlab_willmore.compare.quality.Quality`.
    quality: dict[str, Any] | None = None
    # In one line; a filter that takes too long is no error.
    error: str | None = None
    # Whether the machine is at fault, not the mesh or the filter.
    of_machine: bool = False
    timed_out: bool = False
    # The traceback of an error.
    trace: str = ""


def run(comparison: Comparison, row: Row, notify: Callable[[str], None]) -> Outcome:
    """Compute one row; `notify` is called with each phase that begins."""
    task = {**comparison._asdict(), "filter": row.filter, "given": row.given}
    phase, start = READING, time.monotonic()
    with _subprocess() as process:
        for answer in _answers(process, task):
            if not isinstance(answer, str):
                return Outcome(**answer)
            phase, start = answer, time.monotonic()
            notify(phase)
        code = process.wait()
    # A filter may also end the process with that code, but sooner; clocks of two processes differ.
    was_long = time.monotonic() - start > 0.9 * comparison.timeout
    if phase == RUNNING and code == _TOO_SLOW and was_long:
        return Outcome(timed_out=True)
    if code < 0:
        return Outcome(error=f"crashed ({signal.Signals(-code).name})")
    return Outcome(error=f"the process ended with exit code {code}")


@contextmanager
def _subprocess() -> Iterator[subprocess.Popen[str]]:
    """A process with a folder for temporary files; both are removed in the end."""
    program = _PROGRAM.format(path=sys.path, module=__name__)
    with temporary_folder() as place:
        folder = str(place)
        process = subprocess.Popen(
            [sys.executable, "-c", program],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env={**os.environ, "TMPDIR": folder, "TEMP": folder, "TMP": folder},
            # Ctrl-C on a terminal is for the parent alone, which then ends this process.
            start_new_session=True,
        )
        try:
            yield process
        finally:
            if hasattr(os, "killpg") and process.poll() is None:
                # With the process in which it loads a mesh: the session is a group.
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
            process.kill()
            process.communicate()


def _answers(process: subprocess.Popen[str], task: dict[str, Any]) -> Iterator[Any]:
    """What the process answers, until it ends."""
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        process.stdin.write(json.dumps(task) + "\n")
        process.stdin.flush()
    except BrokenPipeError:
        return
    for line in process.stdout:
        yield json.loads(line)


# --- in the subprocess -------------------------------------------------------------------------


def main() -> None:
    """Do the task on the standard input."""
    answers = _own_stream()
    task = json.loads(sys.stdin.readline())
    threading.Thread(target=_end_with_parent, daemon=True).start()

    def send(answer: object) -> None:
        print(json.dumps(answer), file=answers, flush=True)

    try:
        outcome = _outcome(send=send, **task)
    except Exception as error:
        fault = machine.fault_of(error)
        outcome = Outcome(
            error=reason(fault or error),
            of_machine=fault is not None,
            trace=traceback.format_exc(),
        )
    send(outcome._asdict())


def _own_stream() -> IO[str]:
    """A stream to the parent; the standard output, on which PyMeshLab prints, goes nowhere."""
    answers = os.fdopen(os.dup(1), "w")
    with open(os.devnull, "wb") as sink:
        os.dup2(sink.fileno(), 1)
    return answers


def _end_with_parent() -> None:
    """Wait for the end of the standard input, without Python's buffer and its lock."""
    os.read(0, 1)
    os._exit(1)


def _outcome(
    source: str,
    reference: str | None,
    timeout: float,
    filter: str,
    given: dict[str, Any],
    send: Callable[[str], None],
) -> Outcome:
    from ..compare.quality import quality_of
    from ..compare.rows import warm_up
    from ..demo.models import surface_of

    ms = loading.loaded(Path(source))
    faces = surface_of(ms).faces
    if len(faces) == 0:
        raise ValueError("the mesh has no faces, it is a point cloud")
    surface = read_reference(reference) if reference else None
    seconds = None
    if filter:
        send(WARMING)
        warm_up(filter, given)
        send(RUNNING)
        with _ended_after(timeout):
            start = time.perf_counter()
            ms.apply_filter(filter, **given)
            seconds = time.perf_counter() - start
    send(MEASURING)
    return Outcome(seconds, quality_of(ms, faces, surface)._asdict())


@contextmanager
def _ended_after(seconds: float) -> Iterator[None]:
    """End the process if what is inside takes longer, even in native code."""
    with open(os.devnull, "w") as sink:
        faulthandler.dump_traceback_later(seconds, exit=True, file=sink)
        try:
            yield
        finally:
            faulthandler.cancel_dump_traceback_later()


# --- the reference -----------------------------------------------------------------------------


def check_reference(text: str) -> None:
    """Raise `WrongUse` unless it is the name of a surface, or a file that can be read."""
    if _named_surface(text) is None:
        try:
            check_input(Path(text))
        except WrongUse as error:
            raise WrongUse(
                f"--reference: {error} (nor is it a surface such as {REFERENCES})"
            ) from error


def read_reference(text: str) -> Reference:
    """The surface of a name, or of a file; raises `OSError` if that holds no faces."""
    from ..compare.reference import ReferenceMesh
    from ..demo.models import surface_of

    named = _named_surface(text)
    if named is not None:
        return named
    check_reference(text)
    mesh = ReferenceMesh(*surface_of(loading.loaded(Path(text))))
    if len(mesh.faces) == 0:
        raise OSError(f"{text} can't be the reference: it is a point cloud, without faces")
    return mesh


def _named_surface(text: str) -> Sphere | Torus | None:
    """The sphere or torus; None if it must be a file."""
    from ..compare.reference import Sphere, Torus

    name, colon, sizes = text.partition(":")
    if text != "sphere" and not (colon and name in ("sphere", "torus")):
        return None
    radii = [_radius(text, size) for size in sizes.split(",")] if colon else []
    if name == "sphere" and len(radii) <= 1:
        return Sphere(*radii)
    if name == "torus" and len(radii) == 2:
        return Torus(*radii)
    raise WrongUse(f"--reference {text}: it can be {REFERENCES} (ring, tube), or a file")


def _radius(text: str, size: str) -> float:
    try:
        radius = float(size)
    except ValueError:
        radius = math.nan
    if not (math.isfinite(radius) and radius > 0.0):
        raise WrongUse(f"--reference {text}: {size!r} is no radius; it can be {REFERENCES}")
    return radius
