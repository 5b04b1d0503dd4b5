"""Numba's environment variables, checked before Numba is imported.

Of a variable that is wrong Numba would print a traceback and take no notice, or fail later.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import os
import re
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path

from .machine import MachineWarning, Problem, SettingError, join, unset, unwritable

CACHE_DIR = "NUMBA_CACHE_DIR"

_LAYERS = ("default", "safe", "threadsafe", "forksafe", "tbb", "omp", "workqueue")
_LEVELS = ("0", "1", "2", "3", "max")
_PROCESSOR = ("NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES")
# LLVM only prints of names that it does not know, and ends the process at what is no list.
_TRY_PROCESSOR = """
import sys
from llvmlite import binding
binding.initialize_native_target()
name, features = sys.argv[1:]
binding.Target.from_default_triple().create_target_machine(cpu=name, features=features)
"""
_UNKNOWN = "is not a recognized"


def import_numba() -> None:
    """Import Numba with checked variables.

    Raises
    ------
    SettingError
        A variable of Numba's is wrong.

    Warns
    -----
    MachineWarning
        The folder that ``NUMBA_CACHE_DIR`` names can't be used.
    """
    problems = wrong_settings()
    if not problems:
        _unread.extend(_unread_settings())
        problems = _unread
    if problems:
        raise SettingError(str(join(problems)))
    _warn_of_cache()


def check_variables() -> None:
    """Check what can be checked without an import of Numba, for processes that will import it.

    Raises and warns as `import_numba`.
    """
    problems = wrong_settings()
    if problems:
        raise SettingError(str(join(problems)))
    _warn_of_cache()


# Numba reads its variables once.
_unread: list[Problem] = []


def _unread_settings() -> Iterator[Problem]:
    """Import Numba, and give the variables that it can't parse; show other warnings as usual."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.filterwarnings("always", "Environment variable", RuntimeWarning)
        # Whoever imports it next gets the error.
        with contextlib.suppress(Exception):
            importlib.import_module("numba")
    for warning in caught:
        found = re.match(r"Environment variable '(\w+)' is defined", str(warning.message))
        if found:
            name = found[1]
            value = os.environ.get(name, "")
            yield Problem(f"the variable {name} is {value!r}, which Numba can't read", unset(name))
        else:
            warnings.showwarning(
                warning.message, warning.category, warning.filename, warning.lineno
            )


@functools.cache
def _warn_of_cache() -> None:
    problem = cache_problem()
    if problem is not None:
        warnings.warn(str(problem), MachineWarning, stacklevel=4)


def wrong_settings() -> list[Problem]:
    """Variables with values that Numba takes without a check, and cannot use."""
    problems = [
        Problem(f"the variable {name} is {os.environ[name]!r}, but has to be {wanted}", unset(name))
        for name, wanted, is_right in (
            ("NUMBA_NUM_THREADS", "a whole number of threads, 1 or more", _is_count),
            ("NUMBA_OPT", _one_of(_LEVELS), _LEVELS.__contains__),
            ("NUMBA_THREADING_LAYER", _one_of(_LAYERS), _LAYERS.__contains__),
            ("NUMBA_THREADING_LAYER_PRIORITY", "tbb, omp and workqueue in any order", _is_order),
        )
        if name in os.environ and not is_right(os.environ[name])
    ]
    return [*problems, *_wrong_processor()]


def _is_count(text: str) -> bool:
    try:
        return int(text) > 0
    except ValueError:
        return False


def _is_order(text: str) -> bool:
    return sorted(text.split()) == ["omp", "tbb", "workqueue"]


def _one_of(names: tuple[str, ...]) -> str:
    return f"{', '.join(names[:-1])} or {names[-1]}"


def _wrong_processor() -> list[Problem]:
    """The variables of the processor, if LLVM does not know their values."""
    given = {name: os.environ[name] for name in _PROCESSOR if os.environ.get(name)}
    if not given or _is_known(*(given.get(name, "") for name in _PROCESSOR)):
        return []
    shown = " and ".join(f"{name} is {value!r}" for name, value in given.items())
    return [Problem(f"the variable {shown}, which LLVM does not know", unset(*given))]


@functools.cache
def _is_known(name: str, features: str) -> bool:
    done = subprocess.run(
        [sys.executable, "-c", _TRY_PROCESSOR, name, features],
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    return done.returncode == 0 and _UNKNOWN not in done.stderr


def cache_problem() -> Problem | None:
    """What is wrong with the folder that ``NUMBA_CACHE_DIR`` names; None: nothing, or not set."""
    value = os.environ.get(CACHE_DIR)
    if not value:
        return None
    if not os.path.isabs(value):
        return Problem(
            f"the variable {CACHE_DIR} is {value!r}: each working folder gets a cache of its own",
            f"export {CACHE_DIR}={os.path.abspath(value)}",
        )
    problem = unwritable(Path(value))
    if problem:
        text = f"the folder of {CACHE_DIR}, {value}, can't be written: {problem}"
        return Problem(text, unset(CACHE_DIR))
    return None
