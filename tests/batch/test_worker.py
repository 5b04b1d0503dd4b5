"""How a worker reports what went wrong in it."""

import pytest

from meshlab_willmore.batch import worker
from meshlab_willmore.batch.process import ERROR, MEMORY
from meshlab_willmore.machine import SettingError

LIMIT = 2**28


def caused(error, cause):
    error.__cause__ = cause
    return error


@pytest.mark.parametrize(
    "error",
    [
        MemoryError(),
        OSError(12, "Cannot allocate memory"),
        OSError("Could not find/load shared object file 'libllvmlite.so' from resource location"),
        ImportError("numba.so: failed to map segment from shared object"),
        RuntimeError("can't start new thread"),
        caused(ValueError("Details: no room"), MemoryError()),
        caused(ImportError("Numba could not be loaded"), OSError("Could not load shared object")),
    ],
)
def test_what_fails_for_lack_of_memory_under_a_limit(error):
    ended = worker._failed(error, LIMIT)
    assert ended.status == MEMORY
    assert ended.reason == "needs more than the memory limit of 0.25 GiB"
    assert (ended.of_machine, ended.stops_all) == (False, False)


@pytest.mark.parametrize(
    ("error", "limit"),
    [
        (ModuleNotFoundError("No module named 'nope'"), LIMIT),
        (SettingError("NUMBA_NUM_THREADS is x"), LIMIT),
        (OSError("Could not find/load shared object file 'libllvmlite.so'"), None),
        (RuntimeError("can't start new thread"), None),
    ],
)
def test_other_errors_are_what_they_say(error, limit):
    ended = worker._failed(error, limit)
    assert ended.status == ERROR
    assert ended.reason == str(error)
