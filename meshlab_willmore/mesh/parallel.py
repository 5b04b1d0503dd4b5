"""A parallel for loop: kernels on all cores, in threads of Python.

Compiled kernels release the interpreter's lock, so they run side by side. Numba's own parallel
loops are avoided. Of its threading layers, one ends the process if two threads use it at the same
time, another one in processes that were forked, and the third does not work beside the library that
PyMeshLab brings along.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import numba

# Items of one call of a kernel: far more work than the call itself, and far less than a second. If
# there are many, so many calls for each thread that all end at about the same time.
CHUNK, MOST_CHUNK, CALLS_PER_THREAD = 2048, 32768, 16


def thread_count():
    """Return on how many threads to run: what Numba is set to."""
    if numba.config.DISABLE_JIT:
        return 1
    # To ask Numba for `get_num_threads` starts its own threads, if they don't run yet.
    from numba.np.ufunc import parallel

    is_running = getattr(parallel, "_is_initialized", False)
    return numba.get_num_threads() if is_running else numba.config.NUMBA_NUM_THREADS


@contextmanager
def thread_pool(threads=None) -> Iterator[Callable]:
    """Give a parallel for loop, whose threads end with the context.

    Parameters
    ----------
    threads : int, optional
        Their number, the caller's own included; what Numba is set to if left out.

    Yields
    ------
    callable
        ``parallel_for(kernel, task, count, chunk)`` calls ``kernel(task, start, stop)`` for chunks
        of so many items that cover 0 .. count, and returns when all are done. Without `chunk` their
        size depends on the number of threads. The chunks run at the same time, in any order, so a
        kernel must not write what it reads, or may read, in another chunk.
    """
    threads = thread_count() if threads is None else threads
    # Threads start with the first work that they get.
    with ThreadPoolExecutor(max(threads - 1, 1)) as pool:

        def parallel_for(kernel, task, count, chunk=None):
            if chunk is None:
                chunk = min(max(CHUNK, count // (CALLS_PER_THREAD * threads)), MOST_CHUNK)
            # Taken one by one by each thread; an exception, such as an interrupt, leaves none.
            starts = iter(range(0, count, chunk))

            def work():
                try:
                    for start in starts:
                        kernel(task, start, min(start + chunk, count))
                finally:
                    for _ in starts:
                        pass

            helpers = min(threads - 1, (count - 1) // chunk)
            others = [pool.submit(work) for _ in range(helpers)]
            try:
                work()
            finally:
                for other in others:
                    other.result()

        yield parallel_for
