"""Which kernels Python code calls.

A process that finds all in the cache loads only these: what they call is in their machine code.
"""

import importlib
import pkgutil
import types

import meshlab_willmore
from meshlab_willmore.mesh import jit
from meshlab_willmore.search.compiled import KERNELS, PLACED_KERNELS, TILT_KERNELS


def called_from_python():
    """A dictionary of the kernels that plain functions name, and those of the searches, by name."""
    named = [value for function in _plain_functions() for value in _named_in(function)]
    # Now that all modules are imported.
    cached = {id(kernel): kernel for kernel in jit.KERNELS}
    rows = (*KERNELS.values(), *PLACED_KERNELS.values(), TILT_KERNELS)
    listed = [kernel for row in rows for kernel in row]
    used = {id(value) for value in [*named, *listed]}
    return {_name(kernel): kernel for key, kernel in cached.items() if key in used}


def _name(kernel):
    return f"{kernel.py_func.__module__}.{kernel.py_func.__name__}"


def _plain_functions():
    """All functions of the package's modules that are not compiled, nor templates of kernels."""
    templates = {kernel.py_func.__code__ for kernel in jit.KERNELS}
    for found in pkgutil.walk_packages(meshlab_willmore.__path__, f"{meshlab_willmore.__name__}."):
        # The accessor needs PyVista, and calls no kernel itself.
        if found.name.endswith(("__main__", "pyvista_accessor")):
            continue
        module = importlib.import_module(found.name)
        for name, value in vars(module).items():
            is_ours = isinstance(value, types.FunctionType) and value.__module__ == module.__name__
            # Beside some there is a compiled version, which kernels call.
            is_python = is_ours and f"_compiled_{name}" not in vars(module)
            if is_python and value.__code__ not in templates:
                yield value


def _named_in(function):
    """The values of the names in a function, also of those in modules that it names."""
    names = {name for code in _codes(function.__code__) for name in code.co_names}
    values = [function.__globals__.get(name) for name in names]
    modules = [value for value in values if isinstance(value, types.ModuleType)]
    return values + [vars(module).get(name) for module in modules for name in names]


def _codes(code):
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _codes(constant)
