"""`--log`: what a run did, step by step, readable up to the moment where it ended."""

from __future__ import annotations

import io
import logging
import os
import re
import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TextIO

from ..batch.steplog import log
from ..files import is_stream, opened_stream, place_of, refuse_special, writable_folder
from ..messages import WrongUse
from .scripts import STANDARD_STREAM
from .text import printable

# How a log begins, and how many bytes of a file show whether it is one.
_BEGINNING = re.compile(rb"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d run ")
_ENOUGH = 64


class _Handler(logging.StreamHandler):
    """Writes each line at once, and raises errors instead of printing them."""

    def __init__(self, stream: TextIO, name: str) -> None:
        super().__init__(stream)
        self._log_name = name
        self._is_standard = stream is sys.stdout

    def emit(self, record: logging.LogRecord) -> None:
        """Write a line; on the standard output it comes above the line of the progress."""
        if self._is_standard:
            self.setStream(sys.stdout)
        super().emit(record)

    def format(self, record: logging.LogRecord) -> str:
        # A line of the log stays one whatever a file is called.
        return printable(super().format(record))

    def handleError(self, record: logging.LogRecord) -> None:  # noqa: N802
        error = sys.exc_info()[1]
        if isinstance(error, OSError) and not isinstance(error, BrokenPipeError):
            raise OSError(f"cannot write the log {self._log_name}: {error.strerror}") from error
        raise


@contextmanager
def opened(path: str | None, script: str) -> Iterator[None]:
    """Write the log of a run inside, after what the file holds already, as `meshlabserver` did.

    ``-`` is the standard output, None no log. Raises `OSError` in one line if it can't be written.
    """
    if path is None:
        yield
        return
    is_standard = path == STANDARD_STREAM
    try:
        stream = sys.stdout if is_standard else _appending(Path(path))
    except OSError as error:
        raise OSError(f"cannot write the log {path}: {error.strerror}") from error
    handler = _Handler(stream, "on the standard output" if is_standard else path)
    log.addHandler(handler)
    try:
        with _timed(script):
            yield
    finally:
        log.removeHandler(handler)
        if not is_standard:
            # A full disk was reported before, or the run's own error is more important.
            with suppress(OSError):
                stream.close()


@contextmanager
def _timed(script: str) -> Iterator[None]:
    log.info("%s run %s", time.strftime("%Y-%m-%d %H:%M:%S"), script)
    start = time.perf_counter()
    try:
        yield
    except BaseException:
        # The error of the run is more important than one of the log.
        with suppress(OSError):
            log.info("failed, %.3f s", time.perf_counter() - start)
        raise
    log.info("done, %.3f s", time.perf_counter() - start)


def _appending(path: Path) -> TextIO:
    """The file, pipe or device, ready for more text."""
    if is_stream(path):
        return io.TextIOWrapper(opened_stream(path), "utf-8", "backslashreplace")
    return path.open("a", encoding="utf-8", errors="backslashreplace")


def check(path: str | None, others: Iterable[Path]) -> None:
    """Raise before anything is computed if no log can be written at `path`.

    `WrongUse` if it is one of the `others`, which the run reads or writes, or any file that is no
    log; `OSError` if nothing can be written there.
    """
    if path is None or path == STANDARD_STREAM:
        return
    file = Path(path)
    for other in others:
        if _is_same(file, other):
            raise WrongUse(f"--log {path}: the log would be written into {other}; use a new name")
    if os.path.isdir(file):
        raise WrongUse(f"--log {path} is a folder; name a file in it, such as '{file / 'log.txt'}'")
    if is_stream(file):
        return
    refuse_special(file)
    folder = place_of(file).parent
    if os.path.isfile(file):
        _check_is_log(file)
    elif not os.path.isdir(folder):
        raise WrongUse(f"cannot write the log {path}: there is no folder {folder}")
    elif not os.path.exists(file):
        writable_folder(folder)


def _is_same(left: Path, right: Path) -> bool:
    if os.path.realpath(left) == os.path.realpath(right):
        return True
    return os.path.exists(left) and os.path.exists(right) and os.path.samefile(left, right)


def _check_is_log(file: Path) -> None:
    try:
        with file.open("rb") as stream:
            beginning = stream.read(_ENOUGH)
        file.open("ab").close()
    except OSError as error:
        raise OSError(f"cannot write the log {file}: {error.strerror}") from error
    if beginning and not _BEGINNING.match(beginning):
        raise WrongUse(f"--log {file}: this file is no log of a run; use a new name")
