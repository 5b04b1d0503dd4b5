"""Folders for temporary files, and errors that name them where they have no room."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .machine import Problem, RoomError, fault_of, unset, unwritable, write_a_little

TEMPORARY = "TMPDIR"
MIB = 2**20
_STEP = 1024
_PREFIX = "meshlab_willmore_"
# A folder on a disk takes longer to make and remove than a small mesh takes to save.
_IN_MEMORY = Path("/dev/shm")
_USUAL_FOLDER = "/tmp"
_CHOICES = (TEMPORARY, "TEMP", "TMP")
_MOST_IN_MEMORY = MIB
_LEAST_FREE_MEMORY = 16 * MIB
_OTHER_FOLDER = f"export {TEMPORARY}=/a/folder/with/room"


@contextmanager
def temporary_folder(needed: int | None = None, mark: str = "") -> Iterator[Path]:
    """Create a folder among the temporary files, and remove it in the end.

    Parameters
    ----------
    needed : int, optional
        How many bytes will be written into it, about. A small folder is in memory, where the
        system has a place for it and the user has chosen no other.
    mark : str
        Ends the name of the folder.

    Raises
    ------
    RoomError
        There is no such folder, it has less room than that, or it was full in the end. In one line:
        which folder, how much is needed and how much is free.
    """
    folder = _new_folder(needed, mark)
    needed = needed or 0
    try:
        if shutil.disk_usage(folder).free < needed:
            raise RoomError(str(_no_room(folder, needed)))
        yield folder
    except Exception as error:
        if fault_of(error) or not _is_full(folder):
            raise
        raise RoomError(str(_no_room(folder, needed))) from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _new_folder(needed: int | None, mark: str) -> Path:
    if needed is not None and needed <= _MOST_IN_MEMORY and _may_be_in_memory():
        with suppress(OSError):
            return Path(tempfile.mkdtemp(mark, _PREFIX, _IN_MEMORY))
    try:
        return Path(tempfile.mkdtemp(mark, _PREFIX))
    except OSError as error:
        raise RoomError(str(_no_folder(error))) from error


def _may_be_in_memory() -> bool:
    """Whether the user has chosen no folder for temporary files, and memory has room for them."""
    try:
        is_chosen = any(map(os.environ.get, _CHOICES)) or tempfile.gettempdir() != _USUAL_FOLDER
        return not is_chosen and shutil.disk_usage(_IN_MEMORY).free >= _LEAST_FREE_MEMORY
    except OSError:
        return False


def _is_full(folder: Path) -> bool:
    """Whether not even a small file can be written; a native writer need not have reported it."""
    try:
        write_a_little(folder)
    except OSError:
        return True
    return False


def temporary_problem(wanted: int) -> Problem | None:
    """What is wrong with the folder for temporary files, where `wanted` bytes should be free."""
    try:
        folder = Path(tempfile.gettempdir())
    except OSError as error:
        return _no_folder(error)
    problem = unwritable(folder)
    if problem:
        return Problem(f"no temporary file can be written into {folder}: {problem}", _OTHER_FOLDER)
    free = shutil.disk_usage(folder).free
    if free < wanted:
        text = f"the folder for temporary files, {folder}, has only {_size(free)} free"
        return Problem(text, _OTHER_FOLDER)
    given = os.environ.get(TEMPORARY)
    if given and Path(os.path.abspath(given)) != folder:
        why = unwritable(Path(given)) or "there is no such folder"
        text = f"{TEMPORARY} names {given}, where no file can be written: {why}; {folder} is used"
        return Problem(text, unset(TEMPORARY))
    return None


def _no_folder(error: OSError) -> Problem:
    return Problem(f"no folder for temporary files: {error.strerror}", _OTHER_FOLDER)


def _no_room(folder: Path, needed: int) -> Problem:
    what = f"about {_size(needed)} are needed, " if needed else ""
    free = _size(shutil.disk_usage(folder).free)
    text = f"no room for temporary files in {folder.parent}: {what}{free} are free"
    return Problem(text, _OTHER_FOLDER)


def _size(count: int) -> str:
    size, unit = float(count), "bytes"
    for larger in ("KiB", "MiB", "GiB"):
        if size < _STEP:
            break
        size, unit = size / _STEP, larger
    return f"{size:.0f} {unit}" if unit in ("bytes", "KiB") else f"{size:.1f} {unit}"
