"""The program of a worker process: it reads tasks, does them, and sends what they return."""

from __future__ import annotations

import importlib
import os
import pickle
import re
import shutil
import signal
import threading
import traceback
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue

from .. import files, machine, memory
from ..messages import reason
from .process import BEGUN, DONE, ERROR, LENGTH, MEMORY, Ended, Task, framed

# What C++ code says of a failed allocation; and, where addresses are limited, what else fails for
# lack of them: threads, and libraries (llvmlite has its own words for those).
_NO_MEMORY = "bad_alloc"
_NO_ADDRESSES = re.compile(
    r"[Cc]annot allocate memory|failed to map segment|can't start new thread"
    r"|Could not (?:find/)?load shared object"
)


def main() -> None:
    """Do tasks until the standard input ends."""
    tasks, answers = _own_streams()
    files.draft_mark, limit = pickle.loads(_read(tasks))
    memory.no_core_files()
    received: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_receive, args=(tasks, received), daemon=True).start()
    while True:
        _send(answers, _ended(pickle.loads(received.get()), limit, answers))


def _own_streams() -> tuple[int, int]:
    """Descriptors from and to the parent; on the standard streams there is nothing to read.

    PyMeshLab prints on the standard output.
    """
    tasks, answers = os.dup(0), os.dup(1)
    for number, flags in ((0, os.O_RDONLY), (1, os.O_WRONLY)):
        sink = os.open(os.devnull, flags)
        os.dup2(sink, number)
        os.close(sink)
    return tasks, answers


def _receive(tasks: int, received: SimpleQueue[bytes]) -> None:
    """Pass on what the parent sends; when it has ended, end this process and its children.

    Without buffers of Python, whose locks a forked process would wait for.
    """
    with suppress(EOFError, OSError):
        while True:
            received.put(_read(tasks))
    for folder in (*files.drafts, Path(os.environ["TMPDIR"])):
        shutil.rmtree(folder, ignore_errors=True)
    if hasattr(os, "killpg") and os.getpgrp() == os.getpid():
        os.killpg(0, signal.SIGKILL)
    os._exit(1)


def _read(descriptor: int) -> bytes:
    return _exactly(descriptor, int.from_bytes(_exactly(descriptor, LENGTH), "big"))


def _exactly(descriptor: int, count: int) -> bytes:
    data = b""
    while len(data) < count:
        more = os.read(descriptor, count - len(data))
        if not more:
            raise EOFError
        data += more
    return data


def _send(answers: int, message: object) -> None:
    data = memoryview(framed(message))
    while data:
        data = data[os.write(answers, data) :]


def _ended(task: Task, limit: int | None, answers: int) -> Ended:
    """Do a task, and report how it ended."""
    memory.reset_peak()
    try:
        module, _, name = task.function.partition(":")
        function = getattr(importlib.import_module(module), name)
        _send(answers, BEGUN)
        with memory.limited(limit if task.is_limited else None):
            value = function(task.argument, lambda message: _send(answers, message))
        framed(value)
    except Exception as error:
        return _failed(error, limit)._replace(memory=memory.peak())
    return Ended(DONE, value, memory=memory.peak())


def _is_memory(error: BaseException | None, is_limited: bool) -> bool:
    """Whether an error, or one that it came from, is for lack of memory."""
    while error is not None:
        text = str(error)
        if isinstance(error, MemoryError) or _NO_MEMORY in text:
            return True
        if is_limited and _NO_ADDRESSES.search(text):
            return True
        error = error.__cause__ or error.__context__
    return False


def _failed(error: Exception, limit: int | None) -> Ended:
    is_memory = _is_memory(error, limit is not None)
    fault = None if is_memory else machine.fault_of(error)
    text = reason(fault or error)
    if is_memory and limit is not None:
        text = f"needs more than the memory limit of {limit / memory.GIB:.3g} GiB"
    return Ended(
        MEMORY if is_memory else ERROR,
        reason=text,
        trace=traceback.format_exc(),
        of_machine=fault is not None,
        stops_all=not is_memory and machine.stops_all(error),
    )
