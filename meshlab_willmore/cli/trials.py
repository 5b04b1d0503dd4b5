"""One row of a comparison, in a process of its own that can be killed.

A native filter can't be interrupted, and may crash. The process is told what to do in a line on
its standard input, and ends when that is closed: with the parent, whatever ended it. It answers
with lines of JSON on its standard output: a word for what it begins with, and the result last.
"""

from __future__ import annotations

import json
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
from . import inputs, references
from .errors import reason

if TYPE_CHECKING:
    from ..compare.contenders import Contender

# What the process begins with, in this order.
READING = "reading"
WARMING = "warming up"
RUNNING = "running"
MEASURING = "measuring"

# No file of the working directory may hide a module.
_PROGRAM = "import sys; sys.path[:] = {path!r}; from {module} import main; main()"


class Task(NamedTuple):
    """What all rows have in common.

    Attributes
    ----------
    source : str
        The file of the mesh.
    reference : str or None
        See `references`.
    timeout : float
        Seconds that the filter itself may take.
    """

    source: str
    reference: str | None
    timeout: float


class Outcome(NamedTuple):
    """What became of a row.

    Attributes
    ----------
    seconds : float or None
        Time of the filter alone; None if there was none, or it did not end.
    figures : dict or None
        Those of `meshlab_willmore.compare.figures.Figures`; None if there is no mesh.
    error : str or None
        What went wrong, in a line. A filter that is too slow is no error.
    of_machine : bool
        Whether that is a fault of the machine, not of the mesh or the filter.
    timed_out : bool
        Whether the filter took longer than it may, and was killed.
    trace : str
        The traceback of an error.
    """

    seconds: float | None = None
    figures: dict[str, Any] | None = None
    error: str | None = None
    of_machine: bool = False
    timed_out: bool = False
    trace: str = ""


def run(task: Task, contender: Contender, say: Callable[[str], None]) -> Outcome:
    """Run one row; `say` gets a word for what begins."""
    job = {
        "source": task.source,
        "reference": task.reference,
        "filter": contender.filter,
        "given": contender.given,
    }
    with _process() as process:
        stopwatch = _Stopwatch(task.timeout, process)
        for answer in _answers(process, job):
            stopwatch.note(answer)
            if isinstance(answer, str):
                say(answer)
            else:
                return Outcome(**answer)
        stopwatch.stop()
        code = process.wait()
    return Outcome(timed_out=True) if stopwatch.ran_out else Outcome(error=_ended(code))


class _Stopwatch:
    """Kills a process whose filter takes too long."""

    def __init__(self, seconds: float, process: subprocess.Popen[str]) -> None:
        self.ran_out = False
        self._process = process
        self._timer = threading.Timer(seconds, self._run_out)
        self._timer.daemon = True

    def note(self, answer: object) -> None:
        # A timer that is cancelled before its start never runs out.
        if answer == RUNNING:
            self._timer.start()
        elif answer != WARMING:
            self.stop()

    def stop(self) -> None:
        self._timer.cancel()

    def _run_out(self) -> None:
        self.ran_out = True
        self._process.kill()


@contextmanager
def _process() -> Iterator[subprocess.Popen[str]]:
    """A process for one row, with a folder for temporary files; both are gone in the end."""
    program = _PROGRAM.format(path=sys.path, module=__name__)
    with machine.temporary_folder() as place:
        folder = str(place)
        process = subprocess.Popen(
            [sys.executable, "-c", program],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env={**os.environ, "TMPDIR": folder, "TEMP": folder, "TMP": folder},
            # Ctrl-C on a terminal is for the parent alone, which knows what to do.
            start_new_session=True,
        )
        try:
            yield process
        finally:
            _kill_all(process)
            process.communicate()


def _kill_all(process: subprocess.Popen[str]) -> None:
    """Kill a process, and one in which it loads a mesh first (see `isolation`)."""
    if hasattr(os, "killpg") and process.poll() is None:
        # It is a session of its own, and so a group.
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()


def _answers(process: subprocess.Popen[str], job: dict[str, Any]) -> Iterator[Any]:
    """What the process says, until it ends."""
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        process.stdin.write(json.dumps(job) + "\n")
        process.stdin.flush()
    except BrokenPipeError:
        return
    for line in process.stdout:
        yield json.loads(line)


def _ended(code: int) -> str:
    """How a process ended that gave no result."""
    if code >= 0:
        return f"the process ended with exit code {code}"
    return f"crashed ({signal.Signals(-code).name})"


# --- in the process ----------------------------------------------------------------------------


def main() -> None:
    """Do the job on the standard input."""
    answers = _alone()
    job = json.loads(sys.stdin.readline())
    threading.Thread(target=_end_with_parent, daemon=True).start()

    def say(answer: object) -> None:
        print(json.dumps(answer), file=answers, flush=True)

    try:
        outcome = _outcome(job, say)
    except Exception as error:
        fault = machine.fault_of(error)
        outcome = Outcome(
            error=reason(fault or error),
            of_machine=fault is not None,
            trace=traceback.format_exc(),
        )
    say(outcome._asdict())


def _alone() -> IO[str]:
    """A stream to the parent that nobody else prints on: PyMeshLab's C++ side prints at will."""
    answers = os.fdopen(os.dup(1), "w")
    with open(os.devnull, "wb") as sink:
        os.dup2(sink.fileno(), 1)
    return answers


def _end_with_parent() -> None:
    """Wait for the end of the standard input, past Python's own buffer and its lock."""
    os.read(0, 1)
    os._exit(1)


def _outcome(job: dict[str, Any], say: Callable[[str], None]) -> Outcome:
    from ..compare.contenders import warm_up
    from ..compare.figures import arrays, figures

    ms = inputs.loaded(Path(job["source"]))
    _, faces = arrays(ms)
    if len(faces) == 0:
        raise ValueError("the mesh has no faces, it is a point cloud")
    reference = references.read(job["reference"]) if job["reference"] else None
    seconds = None
    if job["filter"]:
        say(WARMING)
        warm_up(job["filter"], job["given"])
        say(RUNNING)
        start = time.perf_counter()
        ms.apply_filter(job["filter"], **job["given"])
        seconds = time.perf_counter() - start
    say(MEASURING)
    return Outcome(seconds, figures(ms, faces, reference)._asdict())
