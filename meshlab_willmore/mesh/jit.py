"""The spellings of Numba's decorator that this package uses.

``jit`` is for kernels that take arrays and numbers: compiled once, kept on disk. ``generic`` is
for kernels that take another kernel as a parameter. Numba can never find these in its disk cache
and would write a new file in every process, so they are not cached; a thin ``jit`` entry that
fixes the parameter is (see `meshlab_willmore.search.entries`). ``inlined`` is for the arithmetic
in loops that the compiler should turn into vector instructions, which a call in the loop prevents.
"""

from collections.abc import Callable

import numpy as np

from .. import quick_start

quick_start.import_numba()
from numba import njit  # noqa: E402

from . import compiling  # noqa: E402, F401 (it tells of what is compiled)

quick_start.load_numba()

# Division by zero gives inf or nan, as in NumPy: kernels test for finite results where it matters.
# Kernels touch no Python object, so other threads may run meanwhile.
generic = njit(error_model="numpy", nogil=True)
inlined = njit(error_model="numpy", forceinline=True)
_cached = njit(cache=True, error_model="numpy", nogil=True)

# All that `jit` has returned in this process.
KERNELS: list[Callable] = []


def jit(function):
    """Return `function` compiled, with a cache on disk where one can be written.

    Numba looks for a writable folder when it decorates: ``NUMBA_CACHE_DIR``, ``__pycache__`` next
    to the source, the user's own cache folder. Without any of them (a read-only installation and no
    home) each process compiles for itself. A shared temporary folder would be no way out: a cache
    is code, and others could put theirs there.
    """
    try:
        kernel = _cached(function)
    except RuntimeError:
        kernel = generic(function)
    KERNELS.append(kernel)
    return kernel


@inlined
def at(index):
    """Return `index`, which must not be negative, as an unsigned number.

    Numba counts a signed index that is negative from the end, as Python does. To find out whether
    it is takes time at each access, and keeps loops from becoming vector instructions.
    """
    return np.uint64(index)


def cache_folder():
    """Return the folder where kernels are kept.

    Returns
    -------
    str or None
        The one of the first kernel (each source folder has its own, side by side). None: there is
        no cache, or the compiler is switched off.
    """
    return getattr(getattr(KERNELS[0], "stats", None), "cache_path", None)
