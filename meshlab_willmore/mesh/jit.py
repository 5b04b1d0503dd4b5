"""The decorators that compile this package's kernels with Numba.

``jit`` is for kernels that take arrays and numbers, and that Python code calls: compiled once, kept
on disk. ``inner`` is for those that only other kernels call. ``generic`` is for kernels that take
another kernel as a parameter. Numba can never find these in its disk cache and would write a new
file in every process, so they are not cached; a ``jit`` kernel that fixes the parameter is.
``inlined`` is for the arithmetic in loops that the compiler should turn into vector instructions,
which a call in the loop prevents, and for what takes a mesh or another tuple of many arrays for
each edge: a call passes each array.

All but the first are compiled without the code that unpacks the arguments of a call from Python. It
would take longer to compile than most kernels: it has a part for each array of their tuples.

None of them counts references to arrays. Numba would count each array of each tuple at each call,
which takes longer than most of what kernels do with them. It is not needed: the caller keeps what
it passes until the call returns. So no kernel may create an array or copy a slice to another (Numba
refuses to compile one that does), but for those with the decorators ``allocating_jit`` and
``allocating_inner``, which count.
"""

import contextlib
from collections.abc import Callable
from typing import Any

import numpy as np
from numba import config, njit, types
from numba.core.registry import CPUDispatcher

from . import compiling  # noqa: F401 - it announces what is compiled
from .kernel_cache import KernelCache, damaged_files

# Division by zero gives inf or nan, as in NumPy: kernels test for finite results where it matters.
# Kernels touch no Python object, so other threads may run meanwhile. No C code calls them.
_OUTER: dict[str, Any] = {"error_model": "numpy", "no_cfunc_wrapper": True, "nogil": True}
_INNER: dict[str, Any] = {
    "error_model": "numpy",
    "no_cfunc_wrapper": True,
    "no_cpython_wrapper": True,
}
# Numba's option to count references. Both say it, or a kernel would do as the one that calls it.
_COUNTED: dict[str, Any] = {"_nrt": True}
_UNCOUNTED: dict[str, Any] = {"_nrt": False}

# All that `jit` and `inner` have returned in this process.
KERNELS: list[Callable] = []


class _Inner(CPUDispatcher):
    """A kernel for other kernels; a call from Python compiles it once more, for this process.

    Without that, Numba would call a function that is not there.

    It is compiled for integers of 64 bits only. Numba would compile it, and what it calls, again
    for each combination of int32 (from an array), int64 and constants.
    """

    _outer = None

    def get_call_template(self, args, kws):
        """Return what a call with arguments of these types calls."""
        return super().get_call_template(tuple(map(_widened, args)), kws)

    def __call__(self, *args, **given):
        if self._outer is None:
            self._outer = _compiled(self.py_func)
        return self._outer(*args, **given)


def _widened(kind):
    """Return the type that a kernel for other kernels gets an argument as."""
    kind = types.unliteral(kind)
    return types.int64 if kind == types.int32 else kind


def _compiled(function, options=_COUNTED):
    return njit(**_OUTER, **options)(function)


def _compiled_inside(function, options=_COUNTED):
    kernel = njit(**_INNER, **options)(function)
    # With the JIT off it is the function.
    if isinstance(kernel, CPUDispatcher):
        kernel.__class__ = _Inner
    return kernel


def _compiled_outside(function):
    return _compiled_inside(function, {**_UNCOUNTED, "forceinline": False})


def _kept(compiled, function):
    kernel = compiled(function)
    if isinstance(kernel, CPUDispatcher):
        with contextlib.suppress(RuntimeError):
            # Instead of ``cache=True``, which knows one cache only.
            kernel._cache = KernelCache(function)
    KERNELS.append(kernel)
    return kernel


def _compiled_uncounted(function):
    return _compiled(function, _UNCOUNTED)


def _compiled_inside_uncounted(function):
    return _compiled_inside(function, _UNCOUNTED)


def jit(function):
    """Return `function` compiled, with a cache on disk where one can be written.

    For the folder and its key see `meshlab_willmore.mesh.kernel_cache`. Without a folder that can
    be written (a read-only installation and no home) each process compiles for itself.
    """
    return _kept(_compiled_uncounted, function)


def allocating_jit(function):
    """Return `function`, which creates or returns arrays, compiled as by `jit`."""
    return _kept(_compiled, function)


def inner(function):
    """Return `function` compiled for other kernels, with a cache on disk as `jit` has one.

    No function can be compiled in both ways: the cache does not distinguish them, and what `inner`
    left there crashes when Python calls it.
    """
    return _kept(_compiled_inside_uncounted, function)


def allocating_inner(function):
    """Return `function`, which creates arrays, compiled as by `inner`."""
    return _kept(_compiled_inside, function)


def outlined(function):
    """Return `function` compiled as by `inner`, for what is large and may be called by `inlined`.

    Numba would compile it and all that it calls to be inlined, too, which takes many times as long.
    """
    return _kept(_compiled_outside, function)


def generic(function):
    """Return `function`, which takes kernels, compiled for other kernels, without a cache."""
    return _compiled_inside_uncounted(function)


def inlined(function):
    """Return `function` compiled for other kernels, without a cache, and always inlined."""
    return _compiled_inside(function, {**_UNCOUNTED, "forceinline": True})


@inlined
def at(index):
    """Return `index`, which must not be negative, as an unsigned number.

    Numba counts a negative index from the end, as Python does. The test for that takes time at each
    access, and keeps loops from becoming vector instructions.
    """
    return np.uint64(index)


def is_off():
    """Whether the compiler is switched off."""
    return bool(config.DISABLE_JIT)


def cache_folder():
    """Return the folder where kernels are kept.

    Returns
    -------
    str or None
        The one of the first kernel (each source folder has its own, side by side). None: there is
        no cache, or the compiler is switched off.
    """
    return getattr(getattr(KERNELS[0], "stats", None), "cache_path", None)


def damaged_entries():
    """Return the files in the cache of kernels that are not as they were written.

    Returns
    -------
    list of str
        Paths; the next run that needs these kernels compiles them anew and replaces the files.
    """
    folders = {getattr(getattr(kernel, "stats", None), "cache_path", None) for kernel in KERNELS}
    return [path for folder in sorted(folders - {None}) for path in damaged_files(folder)]
