"""The spellings of Numba's decorator that this package uses.

``jit`` is for kernels that take arrays and numbers: compiled once, kept on disk. ``generic`` is
for kernels that take another kernel as a parameter. Numba can never find these in its disk cache
and would write a new file in every process, so they are not cached; a thin ``jit`` entry that
fixes the parameter is (see `meshlab_willmore.search.entries`). ``inlined`` is for the arithmetic
in loops that the compiler should turn into vector instructions, which a call in the loop prevents.
"""

import numpy as np
from numba import njit

# Division by zero gives inf or nan, as in NumPy: kernels test for finite results where it matters.
# Kernels touch no Python object, so other threads may run meanwhile.
generic = njit(error_model="numpy", nogil=True)
inlined = njit(error_model="numpy", forceinline=True)
_cached = njit(cache=True, error_model="numpy", nogil=True)


def jit(function):
    """Return `function` compiled, with a cache on disk where one can be written.

    Numba looks for a writable folder when it decorates: ``NUMBA_CACHE_DIR``, ``__pycache__`` next
    to the source, the user's own cache folder. Without any of them (a read-only installation and no
    home) each process compiles for itself. A shared temporary folder would be no way out: a cache
    is code, and others could put theirs there.
    """
    try:
        return _cached(function)
    except RuntimeError:
        return generic(function)


@inlined
def at(index):
    """Return `index`, which must not be negative, as an unsigned number.

    Numba counts a signed index that is negative from the end, as Python does. To find out whether
    it is takes time at each access, and keeps loops from becoming vector instructions.
    """
    return np.uint64(index)
