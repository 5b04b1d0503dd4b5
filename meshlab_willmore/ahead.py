"""A second process that compiles half of what the first default run compiles.

Numba compiles in one thread at a time. So where nothing is compiled yet, the kernels that make the
flips are compiled in a process of their own, while this one compiles those that measure and score,
which it needs before. It finds the others in the cache, waits for what is not ready, and compiles
for itself whatever the second process fails to.
"""

import atexit
import contextlib
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np

from .guards.bvh import inactive_bvh, specialized
from .guards.fold import fold_limits
from .mesh.halfedge import Mesh
from .mesh.jit import is_off
from .mesh.kernel_cache import KernelCache
from .mesh.parallel import thread_count
from .search import parallel_greedy, rounds
from .search.rules import Rules

# In the order in which they are compiled.
KERNELS = (parallel_greedy.find_maxima, parallel_greedy.flip_settled, rounds.mark_changed)

# Between two looks whether a kernel is ready, in seconds.
PAUSE = 0.01

# With the path of this process, and not with whatever lies in its working folder.
_COMMAND = (
    "import sys; sys.path[:] = {}; from meshlab_willmore import ahead; ahead.compile_kernels()"
)
_is_wanted = True


def compile_kernels() -> None:
    """Compile the `KERNELS` by calling them on a mesh without faces, with nothing to do."""
    none = np.empty(0, np.int32)
    flags = np.empty(0, np.bool_)
    mesh = Mesh(
        np.empty((0, 3)), none, none, flags, none, flags, np.empty((0, 0)), deviation=np.empty(0)
    )
    state = rounds.initial_state(mesh, Rules(fold_limits(0.0)), specialized(inactive_bvh()))
    candidates = rounds.Candidates(state, none, np.empty(0, np.int8))
    settled = parallel_greedy.Settled(mesh, state.gain, state.done, none, 0, np.empty(1))
    for kernel, task in zip(KERNELS, (candidates, settled, state), strict=True):
        kernel(task, 0, 0)


@contextlib.contextmanager
def prevented():
    """Compile all in this process; for what compiles in several processes already."""
    global _is_wanted
    before, _is_wanted = _is_wanted, False
    try:
        yield
    finally:
        _is_wanted = before


def start() -> None:
    """Start the second process where that helps; at most once.

    That is, if nothing is kept of the `KERNELS`, they can be kept, and there is a second core.
    """
    global _is_wanted
    if not _is_wanted:
        return
    _is_wanted = False
    is_python = Path(sys.executable or "").name.startswith("python")
    if is_off() or not is_python or thread_count() < 2:
        return
    caches = [kernel._cache for kernel in KERNELS if not kernel.signatures]
    caches = [cache for cache in caches if isinstance(cache, KernelCache) and cache.is_empty()]
    if len(caches) < len(KERNELS):
        return
    try:
        process = subprocess.Popen(
            [sys.executable, "-c", _COMMAND.format(sys.path)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
    except OSError:
        return
    for cache in caches:
        cache.wait = partial(_wait, process, cache)
    atexit.register(_end, process)


def _wait(process, cache):
    """Wait until the second process has compiled a kernel, or has ended."""
    while process.poll() is None and cache.is_empty():
        time.sleep(PAUSE)


def _end(process):
    """End the second process, if it still runs."""
    process.kill()
    process.wait()
