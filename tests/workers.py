"""Workers of batches and comparisons that are no processes of their own, for what needs none."""

import importlib
import pickle

import pytest

from meshlab_willmore import memory
from meshlab_willmore.batch import pool, worker
from meshlab_willmore.batch.process import DONE, Ended, Phase


def sent(message):
    """What a process would get of a message."""
    return pickle.loads(pickle.dumps(message))


class WorkerHere:
    """As a `WorkerProcess`, but tasks are done by the caller; no limit is kept."""

    def __init__(self, mark, *_):
        self.done, self.mark = 0, mark

    def do(self, task, listen=lambda phase: None):
        task, phase, messages = sent(task), "", []

        def hear(message):
            nonlocal phase
            if isinstance(message, Phase):
                phase = message.name
                listen(sent(message))
            else:
                messages.append(sent(message))

        module, _, name = task.function.partition(":")
        try:
            function = getattr(importlib.import_module(module), name)
            value = sent(function(task.argument, hear))
            self.done += 1
            ended = Ended(DONE, value, memory=memory.peak())
        except Exception as error:
            ended = sent(worker._failed(error, None))
        return ended._replace(phase=phase, messages=tuple(messages))

    def kill(self):
        """Nothing is left to end."""

    close = kill


def ended(self, tasks, tick=lambda: None):
    """As `Pool.ended`, without threads: what PyMeshLab prints is muted in all of them at once."""
    (seat, *_) = self._seats
    for key, task in tasks:
        yield key, seat.attempt(task, lambda phase: None)


@pytest.fixture
def workers_here(monkeypatch):
    """Batches and comparisons start no processes: for tests of what is done with their results."""
    monkeypatch.setattr(pool, "WorkerProcess", WorkerHere)
    monkeypatch.setattr(pool.Pool, "ended", ended)
    # A limit would be this process'.
    monkeypatch.setattr(memory, "reachable", lambda: None)
