"""The parallel for loop: all work is done once, and no thread stays."""

import threading

import numba
import numpy as np
import pytest

from meshlab_willmore.mesh import parallel
from meshlab_willmore.mesh.parallel import CHUNK


@pytest.mark.parametrize("threads", [1, 2, 4])
@pytest.mark.parametrize("count", [0, 1, CHUNK, CHUNK + 1, 10 * CHUNK + 3])
def test_all_work_is_done_once(threads, count):
    done = np.zeros(count, int)

    def kernel(task, start, stop):
        # There need not be room for the results of none.
        assert start < stop
        done[start:stop] += task

    with parallel.thread_pool(threads) as parallel_for:
        parallel_for(kernel, 1, count)
        parallel_for(kernel, 1, count)
    assert (done == 2).all()


@pytest.mark.parametrize("threads", [1, 3])
def test_an_error_in_a_chunk_reaches_the_caller_and_no_thread_stays(threads):
    def kernel(task, start, _):
        if start >= 2 * CHUNK:
            raise KeyboardInterrupt

    before = threading.active_count()
    with pytest.raises(KeyboardInterrupt), parallel.thread_pool(threads) as parallel_for:
        parallel_for(kernel, None, 40 * CHUNK)
    assert threading.active_count() == before


def test_the_number_of_threads_is_numbas(monkeypatch):
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 0)
    monkeypatch.setattr(numba.config, "NUMBA_NUM_THREADS", 7)
    assert parallel.thread_count() == 7
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    assert parallel.thread_count() == 1
