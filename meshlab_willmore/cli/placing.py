"""Finished files into their places."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..files import written_whole

# A file name takes 255 bytes; a letter up to four.
_LONGEST_STEM = 40


@contextmanager
def beside(path: Path) -> Iterator[Path]:
    """A hidden folder in the folder of `path`, which is removed in the end.

    Raises
    ------
    OSError
        In one line, naming `path`.
    """
    try:
        name = tempfile.mkdtemp(prefix=f".{path.stem[:_LONGEST_STEM]}.", dir=path.parent)
    except OSError as error:
        raise OSError(f"cannot write {path}: {error.strerror}") from error
    try:
        yield Path(name)
    finally:
        shutil.rmtree(name, ignore_errors=True)


def put(source: Path, target: Path) -> None:
    """Rename a file to `target`.

    A file that is replaced hands on its mode. A link stays, and the file that it leads to is
    replaced.
    """
    if target.exists():
        shutil.copymode(target, source)
    if not target.is_symlink():
        os.replace(source, target)
        return
    # That file may be on another disk, where nothing can be renamed to.
    with written_whole(Path(os.path.realpath(target))) as draft:
        shutil.move(source, draft)
