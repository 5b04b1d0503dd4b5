"""Files that are written atomically, and never replace what is no regular file."""

from __future__ import annotations

import errno
import os
import re
import shutil
import stat
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import BinaryIO

_KINDS: tuple[tuple[Callable[[int], bool], str], ...] = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a disk"),
)
_STREAMS = ("a pipe", "a device")
# Names of this process' own descriptors. Opened again, a file behind them would be written from its
# beginning.
_OWN = re.compile(r"[/\\]dev[/\\](?:fd[/\\](?P<number>\d+)|stdout|(?P<error>stderr))")
# The standard output, on all systems.
STANDARD_OUTPUT = Path("/dev/stdout")

# Ends the names of hidden folders beside outputs: it shows what a killed process left.
draft_mark = ""
# Those that are there at the moment, for a process that has to end at once.
drafts: set[Path] = set()

# A file name takes 255 bytes; a letter up to four.
_LONGEST_STEM = 40


class UnwritableError(OSError):
    """A file can't be written; the message names it and the reason in one line."""

    def __init__(self, path: Path, reason: str | None) -> None:
        super().__init__(f"cannot write {path}: {reason}")


def special(path: Path) -> str:
    """What kind of special file `path` is or leads to: "a folder", "a pipe"; empty for other files.

    Raises
    ------
    UnwritableError
        If that can't be found out, for instance because links lead to each other.
    """
    try:
        mode = os.stat(path).st_mode
    except (FileNotFoundError, NotADirectoryError):
        return ""
    except OSError as error:
        raise UnwritableError(path, error.strerror) from error
    return next((kind for is_kind, kind in _KINDS if is_kind(mode)), "")


def is_stream(path: Path) -> bool:
    """Whether `path` is a pipe or device, which takes text and is not replaced."""
    return bool(_OWN.fullmatch(str(path))) or special(path) in _STREAMS


def place_of(path: Path) -> Path:
    """The path of the file itself: a link stays, and the file that it leads to is replaced."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def remove_drafts(folder: Path, mark: str) -> None:
    """Remove hidden folders with the mark of a process that was killed while it wrote."""
    with suppress(OSError):
        for entry in os.scandir(folder):
            if entry.name.startswith(".") and entry.name.endswith(mark):
                shutil.rmtree(entry.path, ignore_errors=True)


@contextmanager
def folder_beside(path: Path) -> Iterator[Path]:
    """A hidden folder in the folder of `path`, which is removed at the end.

    Raises
    ------
    UnwritableError
        Naming `path`.
    """
    try:
        name = tempfile.mkdtemp(draft_mark, f".{path.stem[:_LONGEST_STEM]}.", path.parent)
    except OSError as error:
        raise UnwritableError(path, error.strerror) from error
    folder = Path(name).absolute()
    drafts.add(folder)
    try:
        yield Path(name)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        drafts.discard(folder)


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """Give the path of a temporary file on the same disk, and rename it to `path` at the end.

    The temporary file has the name of `path` in another folder, since writers choose the format by
    it. After an error it is removed, and an existing file at `path` stays unchanged.

    Raises
    ------
    UnwritableError
        If `path` is a special file, or no file can be made in its folder.
    """
    refuse_special(path)
    with folder_beside(place_of(path)) as folder:
        draft = folder / path.name
        yield draft
        replace(draft, path)


def replace(source: Path, target: Path) -> None:
    """Rename a finished file to `target`.

    The mode of a file that is replaced is kept. A link stays, and the file that it leads to is
    replaced.

    Raises
    ------
    OSError
        If `target` is a special file, or the file can't be renamed.
    """
    refuse_special(target)
    place = place_of(target)
    if place.exists():
        shutil.copymode(place, source)
    if place == target:
        os.replace(source, target)
        return
    # The link may lead to another disk, where nothing can be renamed to.
    with folder_beside(place) as folder:
        draft = folder / place.name
        shutil.move(source, draft)
        os.replace(draft, place)


def refuse_special(path: Path) -> None:
    """Raise `UnwritableError` if `path` is a special file, or leads to one."""
    kind = special(path)
    if kind:
        verb = "leads to" if path.is_symlink() else "is"
        raise UnwritableError(path, f"it {verb} {kind}, and only files are replaced")


def write(path: Path, data: bytes) -> None:
    """Write a file atomically, or send the data into a pipe or device.

    Raises
    ------
    UnwritableError
        Naming `path`.
    """
    try:
        if is_stream(path):
            with opened_stream(path) as stream:
                stream.write(data)
        else:
            with atomic_write(path) as draft:
                draft.write_bytes(data)
    except (BrokenPipeError, UnwritableError):
        raise
    except OSError as error:
        raise UnwritableError(path, error.strerror) from error


def opened_stream(path: Path) -> BinaryIO:
    """Open a pipe or device for writing.

    Raises
    ------
    OSError
        Also for a pipe that nobody reads from, instead of waiting for a reader.
    """
    own = _OWN.fullmatch(str(path))
    if own:
        return os.fdopen(os.dup(int(own["number"] or (2 if own["error"] else 1))), "wb")
    flags = os.O_WRONLY | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_NONBLOCK", 0)
    try:
        descriptor = os.open(path, flags)
    except OSError as error:
        if error.errno == errno.ENXIO and special(path) == "a pipe":
            raise OSError(errno.ENXIO, "nobody reads from this pipe") from error
        raise
    if hasattr(os, "O_NONBLOCK"):
        os.set_blocking(descriptor, True)
    return os.fdopen(descriptor, "wb")


def writable_folder(folder: Path) -> Path:
    """Make the folder if it doesn't exist, and check that files can be written into it.

    Raises
    ------
    OSError
        In one line, with the folder's name and the reason.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        TemporaryFile(dir=folder).close()
    except OSError as error:
        reason = "it is a file" if folder.is_file() else error.strerror
        raise OSError(f"cannot write into {folder}: {reason}") from error
    return folder
