"""Where results go: names from a pattern, and whether a file can be written there."""

from __future__ import annotations

import errno
import os
import re
import string
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ..files import UnwritableError, is_stream, place_of, refuse_special, writable_folder
from . import formats
from .errors import wrong_use
from .inputs import check_name

PLACEHOLDERS = {
    "name": "the input's name without its ending",
    "ext": "the input's ending",
    "dir": "the input's folder",
    "index": "1, 2, 3, ...",
}

# A width of up to two digits, filled up with blanks or zeros.
_WIDTH = re.compile(r"0?\d{0,2}d?")
# So much of a name is enough to know it by.
_SHOWN = 40


def has_placeholder(pattern: str) -> bool:
    """Whether the name depends on the input."""
    return any(field is not None for _, field, _, _ in _parsed(pattern))


def name_for(pattern: str, source: Path, index: int) -> Path:
    """The output of one input; ``{index:03}`` and the like are understood.

    Raises
    ------
    WrongUse
        For a placeholder that is none.
    """
    values: dict[str, Any] = {
        "name": source.stem,
        "ext": source.suffix.lstrip("."),
        "dir": str(source.parent),
        "index": index,
    }
    for _, field, width, conversion in _parsed(pattern):
        if field is None:
            continue
        if field not in values:
            known = ", ".join(f"{{{name}}}" for name in PLACEHOLDERS)
            raise wrong_use(
                f"{{{field}}} in {pattern!r} is no placeholder; there are {known}, and a brace "
                "itself is written twice"
            )
        if conversion or (width and not (field == "index" and _WIDTH.fullmatch(width))):
            raise wrong_use(
                f"the output name {pattern!r} can't be read: only {{index}} takes a width, such as "
                "{index:03}"
            )
    return Path(pattern.format_map(values))


def _parsed(pattern: str) -> list[tuple[str, str | None, str | None, str | None]]:
    try:
        return list(string.Formatter().parse(pattern))
    except ValueError as error:
        raise wrong_use(
            f"the output name {pattern!r} can't be read: {error}; a brace itself is written twice"
        ) from error


def check_distinct(results: Sequence[tuple[Path, Path]], inputs: Iterable[Path]) -> None:
    """Raise if two results would get the same name, or one the name of an input yet to be read.

    Parameters
    ----------
    results : sequence of (Path, Path)
        Each output and the input that it is made of.
    inputs : iterable of Path
        The inputs; each may be replaced by its own result.

    Raises
    ------
    WrongUse
        Naming both.
    """
    readers = {_identity(path): path for path in inputs}
    writers: dict[str, Path] = {}
    for output, source in results:
        key = _identity(output)
        if key in writers:
            raise wrong_use(
                f"{writers[key]} and {source} would both be written to {output}; "
                "{index} or {dir} in the name tells them apart"
            )
        if readers.get(key, source) != source:
            raise wrong_use(f"the result of {source} would replace the input {output}")
        writers[key] = source


def _identity(path: Path) -> str:
    return os.path.normcase(os.path.realpath(path))


def check_target(path: Path, force: bool) -> None:
    """Raise now if a mesh can't be saved at `path`, so that nothing is computed in vain.

    Raises
    ------
    WrongUse
        If the name, its format or its folder can't be right, or the file is there without `force`.
    OSError
        If the folder can't be written into.
    """
    check_place(path, force)
    check_name(path)
    ending = path.suffix.lstrip(".")
    if path.suffix.lower() in formats.PROJECTS:
        raise wrong_use(f"{path}: projects are not written; each layer can have an -o of its own")
    if not ending or not formats.is_written(ending):
        told = f"PyMeshLab writes no {path.suffix} files" if ending else "it has no ending"
        raise wrong_use(
            f"the format of {path} is unknown: {told}; there are {', '.join(formats.COMMON)}"
        )
    writable_folder(path.parent)
    writable_folder(place_of(path).parent)


def check_place(
    path: Path, force: bool, example: str = "{name}.ply", takes_streams: bool = False
) -> None:
    """Raise `WrongUse` if no new file can have this name.

    Parameters
    ----------
    example : str
        A name that a file in a folder could have.
    takes_streams : bool
        Whether a pipe or device will do: nothing of it is replaced.
    """
    _check_length(path)
    if path.is_dir():
        raise wrong_use(f"{path} is a folder; name a file in it, such as '{path / example}'")
    try:
        if takes_streams and is_stream(path):
            return
        refuse_special(path)
    except UnwritableError as error:
        raise wrong_use(str(error)) from error
    folder = place_of(path).parent
    if not folder.is_dir():
        what = "is a file, no folder" if folder.exists() else "does not exist"
        raise wrong_use(f"cannot write {path}: the folder {folder} {what}")
    # A link that leads nowhere is there as well.
    if os.path.lexists(path) and not force:
        raise wrong_use(f"{path} is there already; --force replaces it")


def _check_length(path: Path) -> None:
    try:
        path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        return
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            raise wrong_use(f"the output name {str(path)[:_SHOWN]}... is too long") from error
        raise UnwritableError(path, error.strerror) from error
