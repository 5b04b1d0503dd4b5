"""The meshes that a command is given: which files they are, and loading them."""

from __future__ import annotations

import glob
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from . import stopping
from .errors import reason, wrong_use

if TYPE_CHECKING:
    import pymeshlab

# How many files of a folder an error names.
_SHOWN = 3


def expand(names: Iterable[str]) -> list[Path]:
    """The files that `names` stand for, in their order.

    A name that no file has is taken for a pattern if it has wildcards, also where the shell does
    not expand them; ``**`` goes through folders.

    Raises
    ------
    WrongUse
        For a name or pattern without a readable, non-empty file.
    """
    files = [path for name in names for path in matches(name)]
    for path in files:
        check(path)
    return files


def matches(name: str) -> list[Path]:
    """The files that a name or pattern stands for; a plain name is one file, there or not.

    Raises
    ------
    WrongUse
        For a pattern that no file matches.
    """
    if os.path.exists(name) or not glob.has_magic(name):
        return [Path(name)]
    # Hidden files are temporary ones of other programs, or of this one.
    found = [Path(match) for match in sorted(glob.glob(name, recursive=True))]
    files = [path for path in found if path.is_file()]
    if not files:
        raise wrong_use(f"no file matches {name!r}")
    return files


def refuse_folder(path: Path, things: str, ending: str) -> None:
    """Raise `WrongUse` for a folder where one of the files in it is wanted."""
    if os.path.isdir(path):
        raise wrong_use(f"{path} is a folder; name the {things} in it, such as '{path / ending}'")


def check(path: Path) -> None:
    """Raise `WrongUse` if there is no readable, non-empty file."""
    refuse_folder(path, "meshes", "*.ply")
    if not os.path.exists(path):
        raise wrong_use(f"there is no file {path}{_beside(path)}")
    if not os.access(path, os.R_OK):
        raise wrong_use(f"{path} can't be read: permission denied")
    if path.stat().st_size == 0:
        raise wrong_use(f"{path} is empty (0 bytes)")


def _beside(path: Path) -> str:
    """The names in the folder that look like the missing one."""
    import difflib

    if not os.path.isdir(path.parent):
        return f": there is no folder {path.parent}"
    names = [p.name for p in path.parent.iterdir() if p.is_file()]
    close = difflib.get_close_matches(path.name, names, n=_SHOWN)
    return f"; there is {', '.join(close)}" if close else ""


def loaded(
    *paths: Path, after: Callable[[pymeshlab.MeshSet, Path], None] | None = None
) -> pymeshlab.MeshSet:
    """A set with the meshes of files; `after` each it is the current one."""
    import pymeshlab

    ms = pymeshlab.MeshSet()
    for path in paths:
        load(ms, path)
        if after is not None:
            after(ms, path)
    return ms


def load(ms: pymeshlab.MeshSet, path: Path) -> None:
    """Load a mesh file as new layers of `ms`.

    Raises
    ------
    OSError
        In one line: which file, and why it can't be read.
    """
    from ..meshset import native

    native.forget_failures()
    try:
        with stopping.at_once(), native.muted():
            native.load(ms, path)
    except native.ERRORS as error:
        raise OSError(f"cannot read {path}: {_why(error, path)}") from error
    if ms.current_mesh().vertex_number() == 0:
        raise OSError(f"cannot read {path}: there is no mesh in it (no vertices)")


def _why(error: Exception, path: Path) -> str:
    if "Unknown format" in str(error):
        return f"PyMeshLab knows no mesh format {path.suffix!r}"
    # Without details nothing but the names of file and class is left.
    details = reason(error).rstrip(".")
    return "it is no mesh of that format" if details in ("", type(error).__name__) else details
