"""The meshes that a command is given: which files they are, and loading them."""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import wrong_use

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
    files = [path for name in names for path in _matches(name)]
    for path in files:
        _check(path)
    return files


def _matches(name: str) -> list[Path]:
    if Path(name).exists() or not glob.has_magic(name):
        return [Path(name)]
    # Hidden files are temporary ones of other programs, or of this one.
    found = [Path(match) for match in sorted(glob.glob(name, recursive=True))]
    meshes = [path for path in found if path.is_file()]
    if not meshes:
        raise wrong_use(f"no file matches {name!r}")
    return meshes


def _check(path: Path) -> None:
    if path.is_dir():
        raise wrong_use(f"{path} is a folder; name the meshes in it, such as '{path / '*.ply'}'")
    if not path.exists():
        raise wrong_use(f"there is no file {path}{_beside(path)}")
    if not os.access(path, os.R_OK):
        raise wrong_use(f"{path} can't be read: permission denied")
    if path.stat().st_size == 0:
        raise wrong_use(f"{path} is empty (0 bytes)")


def _beside(path: Path) -> str:
    """The names in the folder that look like the missing one."""
    import difflib

    if not path.parent.is_dir():
        return f": there is no folder {path.parent}"
    names = [p.name for p in path.parent.iterdir() if p.is_file()]
    close = difflib.get_close_matches(path.name, names, n=_SHOWN)
    return f"; there is {', '.join(close)}" if close else ""


def load(ms: pymeshlab.MeshSet, path: Path) -> None:
    """Load a mesh file as new layers of `ms`.

    Raises
    ------
    OSError
        In one line: which file, and why it can't be read.
    """
    from pymeshlab import PyMeshLabException

    from ..meshset import native

    native.forget_failures()
    try:
        with native.muted():
            native.load(ms, path)
    except (PyMeshLabException, RuntimeError) as error:
        raise OSError(f"cannot read {path}: {_reason(str(error), path)}") from error
    if ms.current_mesh().vertex_number() == 0:
        raise OSError(f"cannot read {path}: there is no mesh in it (no vertices)")


def _reason(text: str, path: Path) -> str:
    """What PyMeshLab says, without what is known: that it failed, and the file."""
    if "Unknown format" in text:
        return f"PyMeshLab knows no mesh format {path.suffix!r}"
    details = re.split(r"Error details:|Unable to open file:[^\n]*\n", text)[-1]
    return " ".join(details.split()).rstrip(".") or "it is no mesh of that format"
