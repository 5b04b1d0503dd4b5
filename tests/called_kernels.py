"""Kernels for other kernels, called by tests: kept on disk as those that Python code calls are.

The package never calls them itself, so without this each process would compile them anew.
"""

from numba.core.registry import CPUDispatcher

from meshlab_willmore.mesh import jit
from meshlab_willmore.mesh.kernel_cache import KernelCache
from meshlab_willmore.search.copies import with_globals


def keep():
    """From now on in this process. Numba would never find again what takes another kernel."""
    call = jit._Inner.__call__

    def called(kernel, *arguments, **given):
        takes_kernels = any(isinstance(each, CPUDispatcher) for each in arguments)
        function = kernel.py_func
        if kernel._outer is None and not takes_kernels and _is_of_the_package(function):
            copy = with_globals(function, f"{function.__qualname__}_called", {})
            copy.__defaults__ = function.__defaults__
            kernel._outer = jit._compiled(copy)
            kernel._outer._cache = KernelCache(copy)
        return call(kernel, *arguments, **given)

    jit._Inner.__call__ = called


def _is_of_the_package(function):
    return function.__module__.partition(".")[0] == "meshlab_willmore"
