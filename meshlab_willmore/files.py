"""Files that are written whole or not at all, and never over what is no regular file."""

from __future__ import annotations

import errno
import os
import re
import shutil
import stat
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
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
# Names of this process' own descriptors. Opened anew, a file behind them would be written from its
# beginning again.
_OWN = re.compile(r"/dev/(?:fd/(?P<number>\d+)|stdout|(?P<error>stderr))")

# A file name takes 255 bytes; a letter up to four.
_LONGEST_STEM = 40


class UnwritableError(OSError):
    """Why a file can't be written, in one line with its name."""

    def __init__(self, path: Path, reason: str | None) -> None:
        super().__init__(f"cannot write {path}: {reason}")


def special(path: Path) -> str:
    """What is at `path`, behind links, if it is no regular file: "a folder", "a pipe" or such.

    Raises
    ------
    UnwritableError
        If that can't be found out: links that lead to each other, say.
    """
    try:
        mode = os.stat(path).st_mode
    except (FileNotFoundError, NotADirectoryError):
        return ""
    except OSError as error:
        raise UnwritableError(path, error.strerror) from error
    return next((kind for is_kind, kind in _KINDS if is_kind(mode)), "")


def is_stream(path: Path) -> bool:
    """Whether text is written into what is at `path`, and nothing is replaced."""
    return bool(_OWN.fullmatch(str(path))) or special(path) in _STREAMS


def place_of(path: Path) -> Path:
    """Where the file itself is, or will be: a link stays, and what it leads to is replaced."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path


@contextmanager
def folder_beside(path: Path) -> Iterator[Path]:
    """A hidden folder in the folder of `path`, which is removed in the end.

    Raises
    ------
    UnwritableError
        Naming `path`.
    """
    try:
        name = tempfile.mkdtemp(prefix=f".{path.stem[:_LONGEST_STEM]}.", dir=path.parent)
    except OSError as error:
        raise UnwritableError(path, error.strerror) from error
    try:
        yield Path(name)
    finally:
        shutil.rmtree(name, ignore_errors=True)


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Give a temporary name on the same disk, and rename that file to `path` in the end.

    The temporary file has the name of `path` in another folder, since writers choose the format by
    it. After an error it is removed, and an older file at `path` is as it was.

    Raises
    ------
    UnwritableError
        If `path` is no regular file, or its folder takes no file.
    """
    refuse_special(path)
    with folder_beside(place_of(path)) as folder:
        draft = folder / path.name
        yield draft
        put(draft, path)


def put(source: Path, target: Path) -> None:
    """Rename a finished file to `target`.

    A file that is replaced hands on its mode. A link stays, and the file that it leads to is
    replaced.

    Raises
    ------
    OSError
        If there is something else than a regular file, or it can't be renamed.
    """
    refuse_special(target)
    place = place_of(target)
    if place.exists():
        shutil.copymode(place, source)
    if place == target:
        os.replace(source, target)
        return
    # That file may be on another disk, where nothing can be renamed to.
    with folder_beside(place) as folder:
        draft = folder / place.name
        shutil.move(source, draft)
        os.replace(draft, place)


def refuse_special(path: Path) -> None:
    """Raise `UnwritableError` if there is something else than a regular file, or a link to one."""
    kind = special(path)
    if kind:
        verb = "leads to" if path.is_symlink() else "is"
        raise UnwritableError(path, f"it {verb} {kind}, and only files are replaced")


def write(path: Path, data: bytes) -> None:
    """Write a file whole, or send the data into a pipe or device.

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
            with written_whole(path) as draft:
                draft.write_bytes(data)
    except (BrokenPipeError, UnwritableError):
        raise
    except OSError as error:
        raise UnwritableError(path, error.strerror) from error


def opened_stream(path: Path) -> BinaryIO:
    """A pipe or device, ready to be written into.

    Raises
    ------
    OSError
        Also for a pipe that nobody reads from, instead of waiting for somebody.
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
    """Make the folder if it isn't there, and find out now whether files can be written into it.

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
