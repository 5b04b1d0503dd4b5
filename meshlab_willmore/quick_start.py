"""Numba imported as quickly as it goes."""

from __future__ import annotations

import contextlib
import functools
import gc
import importlib
import importlib.util
import re
import warnings
from collections.abc import Iterator
from typing import Any

from . import machine


def import_numba() -> None:
    """Import Numba, if it can be; who needs it is told what is wrong.

    Raises
    ------
    SettingError
        A variable of Numba's is wrong. Numba itself would print a traceback and take no notice, or
        fail later.

    Warns
    -----
    MachineWarning
        The folder that ``NUMBA_CACHE_DIR`` names is of no use.
    """
    problems = machine.wrong_settings()
    if not problems:
        _unread.extend(_unread_settings())
        problems = _unread
    if problems:
        raise machine.SettingError(str(machine.join(problems)))
    _warn_of_cache()


@functools.cache
def _warn_of_cache() -> None:
    problem = machine.cache_problem()
    if problem is not None:
        warnings.warn(str(problem), machine.MachineWarning, stacklevel=4)


# Numba reads its variables once.
_unread: list[machine.Problem] = []


def _unread_settings() -> Iterator[machine.Problem]:
    """Import Numba, and give what it can't read; other warnings are shown as ever."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.filterwarnings("always", "Environment variable", RuntimeWarning)
        with paused_collector(), contextlib.suppress(Exception):
            importlib.import_module("numba")
    for warning in caught:
        found = re.match(r"Environment variable '(\w+)' is defined", str(warning.message))
        if found:
            yield machine.unread(found[1])
        else:
            warnings.showwarning(
                warning.message, warning.category, warning.filename, warning.lineno
            )


def load_numba() -> None:
    """Bring Numba to where it can load kernels, which it would do with the first one."""
    with paused_collector():
        _load_arrays()
        _load_targets()


@contextlib.contextmanager
def paused_collector() -> Iterator[None]:
    """Collect no garbage inside: looking through new modules for it takes a fifth of the time."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def _load_arrays() -> None:
    """Import Numba's functions of arrays, with its look at SciPy put off.

    Numba imports all of SciPy's linear algebra, only to see that it is there, for products of
    matrices, which no kernel here has. To see that SciPy can be found is enough: for a kernel that
    has them, Numba looks again. Without SciPy, or with a Numba that is made otherwise, nothing is
    changed.
    """
    if importlib.util.find_spec("scipy") is None:
        return
    try:
        linalg: Any = importlib.import_module("numba.np.linalg")
        look = linalg.ensure_blas
    except (ImportError, AttributeError):
        return
    linalg.ensure_blas = lambda: None
    try:
        importlib.import_module("numba.np.arraymath")
    finally:
        linalg.ensure_blas = look


def _load_targets() -> None:
    """Let Numba fill its tables of types and functions."""
    with contextlib.suppress(ImportError, AttributeError):
        registry = importlib.import_module("numba.core.registry")
        registry.cpu_target.target_context.refresh()
