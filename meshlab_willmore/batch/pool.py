"""A pool of worker processes: each task costs itself at most, whatever it does.

A process that has done other tasks may crash by what those left behind. So a task with which such a
process dies gets a second chance in a fresh one, and is blamed only for what happens there.
"""

from __future__ import annotations

import hashlib
import itertools
import os
import re
import shutil
import socket
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from tempfile import gettempdir
from typing import Generic, NamedTuple, TypeVar

from ..files import remove_drafts
from .process import CRASH, DONE, ERROR, MEMORY, Ended, Phase, Task, WorkerProcess

Key = TypeVar("Key")

# How many tasks a process does before another one takes its place.
RENEWED_AFTER = 200
_STARTING = Phase("starting")
# Numbers of the processes that this one has started.
_numbers = itertools.count()
# Between looks at Ctrl-C, which does not interrupt a wait on Windows.
_SECONDS = 0.5


class PoolSettings(NamedTuple):
    """How many processes a pool has, and what it does with them."""

    workers: int = 1
    # How often a task that failed is done again.
    retries: int = 0
    # After how many tasks a process is replaced.
    renewed_after: int = RENEWED_AFTER
    # What each process does first, one of them before all others: it compiles what they load.
    warm_up: Task | None = None
    # For Numba, in each process.
    threads: int = 1
    # The most bytes that a process may use.
    memory: int | None = None
    # The working folder of the processes; that of this one if None.
    folder: str | None = None


def own_mark() -> str:
    """The end of names of temporary folders of this process' workers, without a number."""
    host = hashlib.sha256(socket.gethostname().encode()).hexdigest()[:6]
    return f".mw-{host}-{os.getpid()}"


def is_running(pid: int) -> bool:
    """Whether there is a process of this number, as far as the system says."""
    if not hasattr(os, "killpg"):
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def remove_stale(folders: Iterable[Path]) -> None:
    """Remove what workers have left whose batch was killed with them, on this machine."""
    pattern = re.compile(re.escape(own_mark()).replace(str(os.getpid()), r"(\d+)") + r"-\d+")
    for folder in (*folders, Path(gettempdir())):
        with suppress(OSError):
            for entry in os.scandir(folder):
                found = pattern.search(entry.name)
                if found and found.end() == len(entry.name) and not is_running(int(found[1])):
                    shutil.rmtree(entry.path, ignore_errors=True)


class Seat:
    """A place for one worker process, which is started when it is needed."""

    def __init__(self, settings: PoolSettings) -> None:
        self._settings = settings
        self._worker: WorkerProcess | None = None
        self._lock = threading.Lock()
        self._is_closed = False
        # Whether the process has done nothing but its warm-up, and whether it has done that.
        self._is_fresh = self._is_warm = False

    def attempt(self, task: Task, listen: Callable[[Phase], None]) -> Ended:
        """Do a task, again where it fails and may; `listen` is called with its phases."""
        attempts = 0
        while True:
            worker, is_fresh = self.ready(), self._is_fresh
            self._is_fresh = False
            ended = worker.do(task, listen)
            if ended.status not in (DONE, ERROR):
                self._drop()
                for folder in task.folders:
                    remove_drafts(Path(folder), worker.mark)
            elif worker.done >= self._settings.renewed_after:
                self._drop()
            if ended.status in (CRASH, MEMORY) and not is_fresh and not self._is_closed:
                continue
            attempts += 1
            is_final = ended.status == DONE or ended.stops_all or self._is_closed
            if is_final or attempts > self._settings.retries:
                return ended._replace(attempts=attempts)

    def start(self) -> WorkerProcess:
        """Start the process unless it runs. Raises `InterruptedError` if the place was closed."""
        if self._worker is not None:
            return self._worker
        settings = self._settings
        mark = f"{own_mark()}-{next(_numbers)}"
        worker = WorkerProcess(mark, settings.threads, settings.memory, settings.folder)
        self._is_fresh, self._is_warm = True, settings.warm_up is None
        with self._lock:
            self._worker = worker
        if self._is_closed:
            self.close()
            raise InterruptedError
        return worker

    def ready(self) -> WorkerProcess:
        """The process, started and warmed up."""
        worker = self.start()
        if self._settings.warm_up is not None and not self._is_warm:
            self._is_warm = True
            if worker.do(self._settings.warm_up).status not in (DONE, ERROR):
                # The meshes will say what is wrong.
                self._drop()
                self._settings = self._settings._replace(warm_up=None)
                return self.start()
        return worker

    def _drop(self) -> None:
        with self._lock:
            worker, self._worker = self._worker, None
        if worker is not None:
            worker.close()

    def kill(self) -> None:
        """End the process at once, and start no other; another thread may be using it."""
        self._is_closed = True
        with self._lock:
            if self._worker is not None:
                self._worker.kill()

    def close(self) -> None:
        """End the process and remove its files."""
        self.kill()
        self._drop()


class Pool(Generic[Key]):
    """Several workers; `ended` does tasks in them, and `close` ends all at once.

    The attribute `running` has what each is doing: the key of a task and the phase it is in.
    """

    def __init__(self, settings: PoolSettings) -> None:
        self.running: dict[int, tuple[Key, str]] = {}
        self._settings = settings
        self._seats = [Seat(settings) for _ in range(settings.workers)]
        self._results: SimpleQueue[tuple[Key, Ended] | BaseException | None] = SimpleQueue()
        self._is_warm = threading.Event()
        self._threads: list[threading.Thread] = []
        self._lock = threading.Lock()

    def ended(
        self,
        tasks: Iterable[tuple[Key, Task]],
        tick: Callable[[], object] = lambda: None,
    ) -> Iterator[tuple[Key, Ended]]:
        """Do tasks, each when a worker is free; give their keys with how they ended, as they end.

        `tick` is called about twice a second while no task ends.
        """
        queue = iter(tasks)
        self._threads = [
            threading.Thread(target=self._serve, args=(place, queue), daemon=True)
            for place in range(len(self._seats))
        ]
        for thread in self._threads:
            thread.start()
        left = len(self._threads)
        while left:
            result = self._next(tick)
            if isinstance(result, BaseException):
                raise result
            if result is None:
                left -= 1
            else:
                yield result

    def _next(self, tick: Callable[[], object]) -> tuple[Key, Ended] | BaseException | None:
        while True:
            with suppress(Empty):
                return self._results.get(timeout=_SECONDS)
            tick()

    def left_over(self) -> Iterator[tuple[Key, Ended]]:
        """What has ended, but was not given yet: the caller has stopped."""
        with suppress(Empty):
            while True:
                result = self._results.get_nowait()
                if isinstance(result, tuple):
                    yield result

    def _serve(self, place: int, queue: Iterator[tuple[Key, Task]]) -> None:
        seat = self._seats[place]
        try:
            while True:
                with self._lock:
                    following = next(queue, None)
                if following is None:
                    break
                key, task = following
                self._start(place, seat)

                def listen(phase: Phase, key: Key = key) -> None:
                    self.running[place] = (key, phase.name)

                listen(_STARTING)
                self._results.put((key, seat.attempt(task, listen)))
                self.running.pop(place, None)
        except BaseException as error:
            self._results.put(error)
        else:
            self._results.put(None)
        finally:
            self.running.pop(place, None)
            seat.close()
            # Where the first has no task, the others need not wait.
            self._is_warm.set()

    def _start(self, place: int, seat: Seat) -> None:
        """Start the worker; the others wait until the first one has compiled what all need."""
        if self._settings.warm_up is None:
            return
        if place == 0:
            seat.ready()
            self._is_warm.set()
        else:
            seat.start()
            self._is_warm.wait()

    def close(self) -> None:
        """End all workers at once, and remove their files."""
        for seat in self._seats:
            seat.kill()
        self._is_warm.set()
        for thread in self._threads:
            thread.join()
        for seat in self._seats:
            seat.close()
