"""What is said where kernels can't be kept for later runs."""

from __future__ import annotations

import os
import shlex
from pathlib import Path

import click

from .. import machine


def cure() -> str:
    """The command that gives the cache a folder: in the home where there is one to write into."""
    try:
        home = Path.home()
    except RuntimeError:
        home = Path()
    if home.is_absolute() and not machine.unwritable(home):
        folder = str(home / ".cache" / "numba")
    else:
        folder = "/a/folder/of/yours"
    return f"export {machine.CACHE_DIR}={shlex.quote(folder)}"


def tell(has_compiled: bool) -> None:
    """Say in a line if what this run has compiled is lost for the next one."""
    from ..mesh.jit import cache_folder
    from ..mesh.kernel_cache import write_errors

    if machine.cache_problem() is not None:
        # That was said when Numba was imported.
        return
    if write_errors:
        error = write_errors[-1]
        why = os.strerror(error.errno) if error.errno else str(error)
        text = f"kernels can't be kept in {cache_folder()}: {why}"
        write_errors.clear()
    elif has_compiled and not cache_folder():
        text = "there is no folder to keep kernels in, and each run compiles anew"
    else:
        return
    click.echo(f"Note: {machine.Problem(text, cure())}", err=True)
