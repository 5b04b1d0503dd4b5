"""Kernels on all cores: threads of Python, in which compiled code runs side by side.

Numba's own parallel loops are left out on purpose. Of its threading layers, one ends the process if
two threads use it at the same time, another one in processes that were forked, and the third does
not work beside the library that PyMeshLab brings along. Here, threads live as long as a search.
"""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import numba

# Items of one call of a kernel: far more work than the call itself, and far less than a second.
PIECE = 2048


def core_count() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def thread_count():
    """Return on how many threads to run: what Numba is set to."""
    if numba.config.DISABLE_JIT:
        return 1
    # Numba knows of `set_num_threads` only once its own threads run; to ask would start them.
    from numba.np.ufunc import parallel

    is_running = getattr(parallel, "_is_initialized", False)
    return numba.get_num_threads() if is_running else numba.config.NUMBA_NUM_THREADS


@contextmanager
def crew(threads=None) -> Iterator[Callable]:
    """Give a function that shares work among threads; they end with the context.

    Parameters
    ----------
    threads : int, optional
        Their number, the caller's own included; what Numba is set to if left out.

    Yields
    ------
    callable
        ``share(kernel, task, count, piece=PIECE)`` calls ``kernel(task, start, stop)`` for pieces
        of so many items that cover 0 .. count, and returns when all are done. The pieces run at the
        same time, in any order, so a kernel must not write what it reads, or may read, in another
        piece.
    """
    threads = thread_count() if threads is None else threads
    if threads == 1:
        yield _alone
        return
    with ThreadPoolExecutor(threads - 1) as pool:

        def share(kernel, task, count, piece=None):
            piece = PIECE if piece is None else piece
            if count <= piece:
                _alone(kernel, task, count, piece)
            else:
                helpers = min(threads - 1, (count - 1) // piece)
                _together(pool, helpers, kernel, task, count, piece)

        yield share


def _alone(kernel, task, count, piece=None):
    piece = PIECE if piece is None else piece
    for start in range(0, count, piece):
        kernel(task, start, min(start + piece, count))


def _together(pool, helpers, kernel, task, count, piece):
    # Taken one by one, by whoever is free; an exception, such as an interrupt, leaves none.
    starts = iter(range(0, count, piece))

    def work():
        for start in starts:
            kernel(task, start, min(start + piece, count))

    others = [pool.submit(work) for _ in range(helpers)]
    try:
        work()
    finally:
        for _ in starts:
            pass
        for other in others:
            other.result()
