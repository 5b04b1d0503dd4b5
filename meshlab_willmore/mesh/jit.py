"""The two spellings of Numba's decorator that this package uses.

``jit`` is for kernels that take arrays and numbers: compiled once, kept on disk. ``generic`` is
for kernels that take another kernel as a parameter. Numba can never find these in its disk cache
and would write a new file in every process, so they are not cached; a thin ``jit`` entry that
fixes the parameter is (see `meshlab_willmore.search.entries`).
"""

from numba import njit

# Division by zero gives inf or nan, as in NumPy: kernels test for finite results where it matters.
jit = njit(cache=True, error_model="numpy")
generic = njit(error_model="numpy")
