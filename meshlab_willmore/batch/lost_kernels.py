"""Notes on compiled kernels that can't be kept, so that each process compiles them again."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .. import machine, numba_settings
from ..messages import note

# Names of what this process has compiled.
_compiled: list[str] = []


@contextmanager
def noted() -> Iterator[None]:
    """Note it in the end if what was compiled inside, or inside before, can't be kept."""
    with followed():
        yield
    note_lost_kernels(any(_compiled))


@contextmanager
def followed() -> Iterator[None]:
    """Remember what is compiled inside."""
    from ..mesh import compiling

    with compiling.followed(_compiled.append):
        yield


def note_lost_kernels(has_compiled: bool) -> None:
    """Note it if what this process compiled can't be kept for the next one."""
    from ..mesh.jit import cache_folder
    from ..mesh.kernel_cache import write_errors

    if numba_settings.cache_problem() is not None:
        # That was printed when Numba was imported.
        return
    if write_errors:
        error = write_errors[-1]
        why = os.strerror(error.errno) if error.errno else str(error)
        text = f"compiled kernels can't be saved in {cache_folder()}: {why}"
        write_errors.clear()
    elif has_compiled and not cache_folder():
        text = "there is no folder to keep compiled kernels in, so each run compiles again"
    else:
        return
    note(str(machine.Problem(text, cache_cure())))


def cache_cure() -> str:
    """The command that gives the cache a folder: in the home directory if it is writable."""
    try:
        home = Path.home()
    except RuntimeError:
        home = Path()
    is_usable = home.is_absolute() and not machine.unwritable(home)
    folder = str(home / ".cache" / "numba") if is_usable else "/a/folder/of/yours"
    return f"export {numba_settings.CACHE_DIR}={shlex.quote(folder)}"
