"""The same work on a Dask cluster: the body of its tasks is the same isolated worker.

Dask has no time limit for a task, blames the neighbours of a task that crashes, and loses results
that stay in workers. So here it only chooses where a task runs. The task itself runs in a process
that Dask does not see, writes its output, and returns a small record. What a machine was doing when
it was lost is done again elsewhere.
"""

from __future__ import annotations

import asyncio
import os
import socket
import threading
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Generic, TypeVar

from ..machine import core_count
from ..messages import one_line
from .pool import PoolSettings, Seat
from .process import CRASH, ERROR, Ended, Task

if TYPE_CHECKING:
    from distributed import Client, Future

Key = TypeVar("Key")

EXTRA = "pip install 'meshlab-willmore[cluster]'"
# Tasks that the scheduler knows of, for each thread of the cluster.
_AHEAD = 4
# How often the machine that does a task can be lost.
_LOSSES = 10


class Cluster(Generic[Key]):
    """As `Pool`, on the machines of a Dask cluster."""

    def __init__(self, client: Client, settings: PoolSettings) -> None:
        self._client = client
        self._settings = settings

    def ended(
        self,
        tasks: Iterable[tuple[Key, Task]],
        tick: Callable[[], object] | None = None,
    ) -> Iterator[tuple[Key, Ended]]:
        """As `Pool.ended`, but `tick` is never called.

        Raises `ConnectionError` if the scheduler is lost.
        """
        from distributed import as_completed

        left = iter(tasks)
        running: dict[Future, tuple[Key, Task, int]] = {}
        completed = as_completed(loop=self._client.loop)

        def submit(key: Key, task: Task, losses: int = 0) -> None:
            future = self._client.submit(attempt, task, self._settings, pure=False)
            running[future] = (key, task, losses)
            completed.add(future)

        def submit_more() -> None:
            threads = sum(self._client.nthreads().values())
            while len(running) < _AHEAD * max(threads, 1):
                following = next(left, None)
                if following is None:
                    return
                submit(*following)

        try:
            submit_more()
            while running:
                future = next(completed)
                key, task, losses = running.pop(future)
                if future.status == "finished":
                    yield key, future.result()
                elif losses >= _LOSSES:
                    reason = f"the machine that did it was lost {losses} times"
                    yield key, Ended(CRASH, reason=reason, attempts=losses)
                else:
                    self._check(future)
                    submit(key, task, losses + 1)
                future.release()
                submit_more()
        finally:
            for future in running:
                future.cancel()

    def _check(self, future: Future) -> None:
        """Raise an error unless a task was lost with a worker."""
        from distributed import KilledWorker

        if future.status == "error":
            error = future.exception()
            if not isinstance(error, KilledWorker):
                raise error
        elif self._client.status != "running":
            address = self._client.scheduler.address if self._client.scheduler else "of the cluster"
            raise ConnectionError(f"the scheduler {address} is lost")


# --- on a machine of the cluster ---------------------------------------------------------------

# Places whose process waits for a task.
_free: dict[PoolSettings, list[Seat]] = {}
_lock = threading.Lock()


def attempt(task: Task, settings: PoolSettings) -> Ended:
    """Do a task in a process that stays alive for others."""
    host = socket.gethostname()
    if settings.folder is not None and not os.path.isdir(settings.folder):
        reason = f"{host} has no folder {settings.folder}; start the batch in one that all share"
        return Ended(ERROR, reason=reason, of_machine=True, stops_all=True)
    seat = _seat(settings)
    ended = seat.attempt(task, lambda phase: None)
    with _lock:
        _free[settings].append(seat)
    return ended._replace(host=host)


def _seat(settings: PoolSettings) -> Seat:
    from distributed import get_worker

    with _lock:
        # Those of other batches have ended.
        for other in [key for key in _free if key != settings]:
            for seat in _free.pop(other):
                seat.close()
        idle = _free.setdefault(settings, [])
        if idle:
            return idle.pop()
    threads = max(1, core_count() // get_worker().state.nthreads)
    return Seat(settings._replace(threads=threads))


def client_of(address: str) -> Client:
    """A client of the scheduler at an address, with the TLS settings of Dask's configuration.

    Raises
    ------
    ModuleNotFoundError
        Dask is not installed.
    OSError
        The scheduler can't be reached.
    """
    try:
        from distributed import Client
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(f"--scheduler needs Dask: {EXTRA}") from error
    try:
        # A client that finds no scheduler would take a minute to end.
        asyncio.run(_reach(address))
        return Client(address, set_as_default=False)
    except (OSError, RuntimeError, ValueError) as error:
        raise OSError(f"the scheduler {address} can't be reached: {one_line(error)}") from error


async def _reach(address: str) -> None:
    """Connect to a scheduler once."""
    from distributed.comm import connect
    from distributed.security import Security

    comm = await connect(address, **Security().get_connection_args("client"))
    await comm.close()
