"""A worker process that does one task after another, and may crash, hang or run out of memory.

The process gets tasks by its standard input and answers by its standard output. It has a process
group and a folder for temporary files of its own, and ends with this process, however that ends.
Its `__main__` is none of the caller's: scripts need no guard.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from typing import IO, Any, NamedTuple

from ..temporary_files import temporary_folder

# How tasks end.
DONE = "done"
ERROR = "error"
CRASH = "crash"
TIMEOUT = "timeout"
MEMORY = "memory"

# What a worker sends when it has imported what a task needs: now its time begins.
BEGUN = None

# No file of the working folder may hide a module.
_PROGRAM = "import sys; sys.path[:] = {path!r}; from {module} import main; main()"
_MODULE = "meshlab_willmore.batch.worker"
_THREADS = "NUMBA_NUM_THREADS"
# Bytes of the length before each message.
LENGTH = 8


class Task(NamedTuple):
    """A function to call in a worker, its argument, and how many seconds that may take.

    The function has the name ``module:function`` and is called with the argument and a function
    that sends a message to the parent. In the folders it may leave drafts if it is killed. Only if
    it `is_limited`, the worker's limit of memory is for it.
    """

    function: str
    argument: Any = None
    seconds: float | None = None
    folders: tuple[str, ...] = ()
    is_limited: bool = True


class Phase(NamedTuple):
    """A message: what a task does from now on, how many seconds that may take, and more on it."""

    name: str
    seconds: float | None = None
    text: str = ""


class Ended(NamedTuple):
    """How a task ended."""

    # DONE, ERROR, CRASH, TIMEOUT or MEMORY.
    status: str
    # What the function returned; or why it did not, in one line, and the traceback of an error.
    value: Any = None
    reason: str = ""
    trace: str = ""
    # Whether the machine is at fault, and whether all other tasks would fail in the same way.
    of_machine: bool = False
    stops_all: bool = False
    # In which phase it failed; and the messages that were no phases.
    phase: str = ""
    messages: tuple[Any, ...] = ()
    # The most bytes that the process had in memory meanwhile, and how long it took.
    memory: int | None = None
    seconds: float = 0.0
    # The machine; empty for this one.
    host: str = ""
    # How many there were; this is the last one.
    attempts: int = 1


class WorkerProcess:
    """A process that is alive from the start to `close`, or to a task that it does not survive.

    The mark ends the names of its temporary folders, those beside outputs too. The rest is as in
    `meshlab_willmore.batch.pool.PoolSettings`.
    """

    def __init__(self, mark: str, threads: int, memory: int | None, folder: str | None) -> None:
        self.done = 0
        self.mark = mark
        self._memory = memory
        self._phase = ""
        self._timed_out: float | None = None
        self._lock = threading.Lock()
        self._timers: dict[str, threading.Timer] = {}
        self._stack = ExitStack()
        temporary = str(self._stack.enter_context(temporary_folder(mark=mark)))
        variables = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), temporary)
        if _allows_more(threads):
            variables[_THREADS] = str(threads)
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-c", _PROGRAM.format(path=sys.path, module=_MODULE)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                cwd=folder,
                env={**os.environ, **variables},
                # Ctrl-C on a terminal is for the parent alone, which then ends this process.
                start_new_session=True,
            )
        except BaseException:
            self._stack.close()
            raise
        if hasattr(os, "waitid"):
            threading.Thread(target=self._end_group, daemon=True).start()
        with suppress(BrokenPipeError):
            _write(_stream(self._process.stdin), (mark, memory))

    def do(self, task: Task, listen: Callable[[Phase], None] = lambda phase: None) -> Ended:
        """Do a task; `listen` is called with its phases. Unless it is done, close the worker."""
        start = time.monotonic()
        self._phase, self._timed_out = "", None
        messages: list[Any] = []
        ended = self._ended(task, listen, messages)
        seconds = time.monotonic() - start
        return ended._replace(seconds=seconds, phase=self._phase, messages=tuple(messages))

    def _ended(self, task: Task, listen: Callable[[Phase], None], messages: list[Any]) -> Ended:
        try:
            _write(_stream(self._process.stdin), task)
            while not isinstance(message := read(_stream(self._process.stdout)), Ended):
                if message is BEGUN:
                    self._limit("task", task.seconds)
                elif isinstance(message, Phase):
                    self._phase = message.name
                    self._limit("phase", message.seconds)
                    listen(message)
                else:
                    messages.append(message)
        except (OSError, EOFError, pickle.UnpicklingError, ValueError):
            return self._death()
        finally:
            self._limit("task", None)
            self._limit("phase", None)
        self.done += 1
        return message

    def kill(self) -> None:
        """End the process and its children at once; another thread may be waiting for an answer."""
        with self._lock:
            if self._process.returncode is not None:
                return
            if hasattr(os, "killpg"):
                with suppress(ProcessLookupError, PermissionError):
                    os.killpg(self._process.pid, signal.SIGKILL)
            else:
                self._process.kill()

    def close(self) -> None:
        """End the process and its children, and remove its temporary files."""
        self.kill()
        self._wait()
        for stream in (self._process.stdin, self._process.stdout):
            with suppress(OSError):
                _stream(stream).close()
        self._stack.close()

    def _wait(self) -> int:
        """Wait for the end; the number of the group is free only then."""
        with self._lock:
            return self._process.wait()

    def _end_group(self) -> None:
        """Kill the children of a process that has ended: they would hold its standard output."""
        with suppress(ChildProcessError):
            os.waitid(os.P_PID, self._process.pid, os.WEXITED | os.WNOWAIT)
        self.kill()

    def _limit(self, what: str, seconds: float | None) -> None:
        if what in self._timers:
            self._timers.pop(what).cancel()
        if seconds is not None:
            timer = self._timers[what] = threading.Timer(seconds, self._time_out, (seconds,))
            timer.daemon = True
            timer.start()

    def _time_out(self, seconds: float) -> None:
        self._timed_out = seconds
        self.kill()

    def _death(self) -> Ended:
        self.kill()
        code = self._wait()
        if self._timed_out is not None:
            reason = f"not finished within {self._timed_out:.3g} s"
            return Ended(TIMEOUT, reason=reason)
        if code >= 0:
            return Ended(CRASH, reason=f"the process ended with exit code {code}")
        reason = f"crashed ({signal.Signals(-code).name})"
        if -code == signal.SIGKILL:
            reason = "the process was killed (SIGKILL), perhaps for lack of memory"
        elif self._memory is not None:
            reason += "; the memory limit may be the cause"
        return Ended(CRASH, reason=reason)


def _allows_more(threads: int) -> bool:
    """Whether the user's own setting is none, or more; Numba's check names a wrong one."""
    own = os.environ.get(_THREADS, str(threads))
    return own.isdigit() and int(own) >= threads


def _stream(stream: IO[bytes] | None) -> IO[bytes]:
    assert stream is not None
    return stream


def _write(stream: IO[bytes], message: object) -> None:
    stream.write(framed(message))
    stream.flush()


def framed(message: object) -> bytes:
    """A message with its length before it."""
    data = pickle.dumps(message)
    return len(data).to_bytes(LENGTH, "big") + data


def read(stream: IO[bytes]) -> Any:
    """The next message of a buffered stream; raises `EOFError` at its end."""
    head = stream.read(LENGTH)
    data = stream.read(int.from_bytes(head, "big")) if len(head) == LENGTH else b""
    if not data:
        raise EOFError
    return pickle.loads(data)
