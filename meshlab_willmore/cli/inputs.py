"""The meshes that a command is given: which files they are, and loading them."""

from __future__ import annotations

import glob
import os
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ..files import special
from . import corners, formats, isolation, notes, stopping, unread
from .errors import WrongUse, reason, wrong_use

if TYPE_CHECKING:
    import pymeshlab

# How many files of a folder an error names.
_SHOWN = 3


class Input(NamedTuple):
    """A file that was asked for.

    Attributes
    ----------
    path : Path
        The file, or the pattern that no file matches.
    refusal : WrongUse or None
        Why it can't be a mesh, as far as that is known without reading it.
    """

    path: Path
    refusal: WrongUse | None


class NoMatchError(WrongUse):
    """A pattern that stands for no file."""


def asked_for(names: Iterable[str]) -> list[Input]:
    """The files that `names` stand for, in their order, and what is wrong with each.

    A name that no file has is taken for a pattern if it has wildcards, also where the shell does
    not expand them; ``**`` goes through folders.
    """
    return [found for name in names for found in _asked_for(name)]


def _asked_for(name: str) -> list[Input]:
    try:
        paths = matches(name)
    except NoMatchError as error:
        return [Input(Path(name), error)]
    return [Input(path, _refusal(path)) for path in paths]


def _refusal(path: Path) -> WrongUse | None:
    try:
        check(path)
    except WrongUse as error:
        return error
    return None


def expand(names: Iterable[str]) -> list[Path]:
    """The files that `names` stand for, as `asked_for`.

    Raises
    ------
    WrongUse
        For a name or pattern without a readable, non-empty file.
    """
    found = asked_for(names)
    for _, refusal in found:
        if refusal is not None:
            raise refusal
    return [path for path, _ in found]


def matches(name: str) -> list[Path]:
    """The files that a name or pattern stands for; a plain name is one file, there or not.

    A folder counts only where the pattern has the ending of a file.

    Raises
    ------
    NoMatchError
        For a pattern that no file matches.
    """
    if os.path.lexists(name) or not glob.has_magic(name):
        return [Path(name)]
    # Hidden files are temporary ones of other programs, or of this one.
    found = [Path(match) for match in sorted(glob.glob(name, recursive=True))]
    files = [path for path in found if Path(name).suffix or not path.is_dir()]
    if not files:
        raise NoMatchError(f"no file matches {name!r}")
    return files


def refuse_folder(path: Path, things: str, ending: str) -> None:
    """Raise `WrongUse` for a folder where one of the files in it is wanted."""
    if os.path.isdir(path):
        raise wrong_use(f"{path} is a folder; name the {things} in it, such as '{path / ending}'")


def check(path: Path) -> None:
    """Raise `WrongUse` if there is no readable, non-empty file."""
    refuse_folder(path, "meshes", "*.ply")
    try:
        os.stat(path)
    except PermissionError as error:
        raise wrong_use(f"{path} can't be read: permission denied") from error
    except OSError as error:
        raise wrong_use(f"there is no file {path}{_beside(path)}") from error
    kind = special(path)
    if kind:
        raise wrong_use(f"{path} is {kind}; meshes are read from files")
    if not os.access(path, os.R_OK):
        raise wrong_use(f"{path} can't be read: permission denied")
    if os.path.getsize(path) == 0:
        raise wrong_use(f"{path} is empty (0 bytes)")
    check_name(path)


def check_name(path: Path) -> None:
    """Raise `WrongUse` if PyMeshLab can't know the file by its name."""
    try:
        str(path.absolute()).encode()
    except UnicodeEncodeError as error:
        raise wrong_use(f"{path}: PyMeshLab takes names in UTF-8 only; rename it") from error


def _beside(path: Path) -> str:
    """The names in the folder that look like the missing one."""
    import difflib

    if os.path.islink(path):
        return f": it is a link to {os.readlink(path)}"
    if not os.path.isdir(path.parent):
        return f": there is no folder {path.parent}"
    try:
        names = [entry.name for entry in os.scandir(path.parent) if entry.is_file()]
    except OSError:
        return ""
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
    """Load a mesh file as new layers of `ms`, and tell what of it is left out.

    Raises
    ------
    OSError
        In one line: which file, and why it can't be read.
    """
    from ..meshset import native

    errors: tuple[type[Exception], ...] = (*native.ERRORS, OSError)
    before = ms.mesh_number()
    native.forget_failures()
    try:
        with stopping.at_once(), native.muted():
            corners.check_text(path)
            isolation.check(path, partial(_try, path), partial(_why, path))
        with stopping.at_once(), native.overheard(ms) as printed:
            _load_sound(ms, path)
    except errors as error:
        raise OSError(f"cannot read {path}: {_why(path, error)}") from error
    if ms.current_mesh().vertex_number() == 0:
        raise OSError(f"cannot read {path}: there is no mesh in it (no vertices)")
    count = ms.mesh_number() - before
    if count > 1:
        notes.tell(f"{path}: it holds {count} meshes; the last one is taken, others are layers")
    for loss in unread.losses(path, printed, ms.current_mesh()):
        notes.tell(f"{path}: {loss}")


def _try(path: Path) -> None:
    import pymeshlab

    _load_sound(pymeshlab.MeshSet(), path)


def _load_sound(ms: pymeshlab.MeshSet, path: Path) -> None:
    """Load a mesh whose corners are all there; filters would read and write anywhere in memory."""
    from ..meshset import native

    native.load(ms, path)
    corners.check_loaded(ms.current_mesh())


def _why(path: Path, error: Exception) -> str:
    if path.suffix.lower() in formats.PROJECTS:
        return "projects are not read; name their meshes after -i, with --layers"
    if not path.suffix:
        return "it has no ending that tells its format"
    if "Unknown format" in str(error):
        return f"PyMeshLab knows no mesh format {path.suffix!r}"
    # Without details nothing but the names of file and class is left.
    details = reason(error).rstrip(".")
    return "it is no mesh of that format" if details in ("", type(error).__name__) else details


def how_many_failed(failed: int, count: int) -> str:
    """The last word on several inputs, of which some failed."""
    rest = "" if failed == count else "; the others are done"
    return f"{failed} of {count} inputs failed{rest}"
