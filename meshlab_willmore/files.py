"""Files that are there completely or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Give a temporary name beside `path`, and rename that file to `path` in the end.

    The temporary file keeps the ending of `path`, since writers choose the format by it. After an
    error it is removed and an older file at `path` is as it was.
    """
    beside = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        yield beside
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


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
