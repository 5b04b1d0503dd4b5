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

    def __init__(self, settings):
        self.done, self.mark = 0, settings.mark

    def do(self, task, listen=lambda message: None):
        task, phase = sent(task), ""

        def hear(message):
            nonlocal phase
            phase = message.name if isinstance(message, Phase) else phase
            listen(sent(message))

        module, _, name = task.function.partition(":")
        try:
            function = getattr(importlib.import_module(module), name)
            # What PyMeshLab prints is muted for all threads at once.
            with self.one_at_a_time:
                value = sent(function(task.argument, hear))
        except Exception as error:
            return sent(worker._failed(error, None))._replace(phase=phase)
        self.done += 1
        return Ended(DONE, value, phase=phase, memory=memory.peak())

    def kill(self):
        """Nothing is left to end."""

    close = kill


@pytest.fixture
def workers_here(monkeypatch):
    """Batches and comparisons start no processes: for tests of what is done with their results."""
    monkeypatch.setattr(pool, "WorkerProcess", WorkerHere)
    # A limit would be this process'.
    monkeypatch.setattr(memory, "reachable", lambda: None)
