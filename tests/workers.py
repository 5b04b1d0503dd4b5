"""Workers of batches and comparisons that are no processes of their own, for what needs none."""

import importlib
import pickle
import threading

import pytest

from meshlab_willmore import memory
from meshlab_willmore.batch import pool, worker
from meshlab_willmore.batch.process import DONE, Ended, Phase


def sent(message):
    """What a process would get of a message."""
    return pickle.loads(pickle.dumps(message))


class WorkerHere:
    """As a `WorkerProcess`, but tasks are done in the thread that asks; no limit is kept."""

    one_at_a_time = threading.Lock()

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
            # What PyMeshLab prints is muted for all threads at once.
            with self.one_at_a_time:
                value = sent(function(task.argument, hear))
            self.done += 1
            ended = Ended(DONE, value, memory=memory.peak())
        except Exception as error:
            ended = sent(worker._failed(error, None))
        return ended._replace(phase=phase, messages=tuple(messages))

    def kill(self):
        """Nothing is left to end."""

    close = kill


@pytest.fixture
def workers_here(monkeypatch):
    """Batches and comparisons start no processes: for tests of what is done with their results."""
    monkeypatch.setattr(pool, "WorkerProcess", WorkerHere)
    # A limit would be this process'.
    monkeypatch.setattr(memory, "reachable", lambda: None)
