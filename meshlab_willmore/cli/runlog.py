"""`--log`: what a run did, step by step, readable up to the moment where it ended."""

from __future__ import annotations

import io
import os
import re
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from ..files import is_stream, opened_stream, place_of, refuse_special, writable_folder
from .errors import wrong_use
from .told import in_line

if TYPE_CHECKING:
    from ..meshset.catalogue import FilterInfo
    from ..meshset.check import Call
    from ..meshset.play import Played

STANDARD_OUTPUT = "-"

# How a log begins, and how many bytes of a file tell whether it is one.
_BEGINNING = re.compile(rb"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d run ")
_ENOUGH = 64


class Log:
    """Lines that are on the disk as soon as they are said; without a stream, nothing."""

    def __init__(self, stream: TextIO | None, name: str = "") -> None:
        self._stream = stream
        self._name = name

    def say(self, line: str) -> None:
        """Write one line.

        Raises
        ------
        OSError
            In one line, if it can't be written.
        """
        if self._stream is None:
            return
        try:
            self._stream.write(line + "\n")
            self._stream.flush()
        except BrokenPipeError:
            raise
        except OSError as error:
            raise OSError(f"cannot write the log {self._name}: {error.strerror}") from error

    @contextmanager
    def run_of(self, script: str) -> Iterator[None]:
        """Write when a run began, and in the end how it went and how long it took."""
        self.say(f"{time.strftime('%Y-%m-%d %H:%M:%S')} run {script}")
        start = time.perf_counter()
        try:
            yield
        except BaseException:
            # A log that can't be written is no news beside what went wrong before.
            with suppress(OSError):
                self.say(f"failed, {time.perf_counter() - start:.3f} s")
            raise
        self.say(f"done, {time.perf_counter() - start:.3f} s")

    def begin(self, call: Call, count: int) -> None:
        """Write which step comes, and its parameters."""
        name = f"{call.known.name} ({call.known.meshlab_name})"
        self.say(f"step {call.number} of {count}: {name}")
        self.say(f"  parameters: {_given(call.known, call.given) or 'all by default'}")

    def end(self, played: Played) -> None:
        """Write how long a step took, and what it returned."""
        self.say(f"  time: {played.seconds:.3f} s")
        if played.returned:
            returned = ", ".join(f"{k}={in_line(v)}" for k, v in played.returned.items())
            self.say(f"  returned: {returned}")


def check(path: str | None, others: Iterable[Path]) -> None:
    """Raise now if no log can be written at `path`, so that nothing is computed in vain.

    Parameters
    ----------
    path : str or None
        As for `opened`.
    others : iterable of Path
        Files that a log must never be written into.

    Raises
    ------
    WrongUse
        If the name can't be right: another file's, or that of a file that is no log.
    OSError
        If nothing can be written there.
    """
    if path is None or path == STANDARD_OUTPUT:
        return
    log = Path(path)
    for other in others:
        if _is_same(log, other):
            raise wrong_use(
                f"--log {path}: the log would be written into {other}; give it a new name"
            )
    if os.path.isdir(log):
        raise wrong_use(f"--log {path} is a folder; name a file in it, such as '{log / 'log.txt'}'")
    if is_stream(log):
        return
    refuse_special(log)
    folder = place_of(log).parent
    if os.path.isfile(log):
        _check_log(log)
    elif not os.path.isdir(folder):
        raise wrong_use(f"cannot write the log {path}: there is no folder {folder}")
    elif not os.path.exists(log):
        writable_folder(folder)


def _is_same(left: Path, right: Path) -> bool:
    if os.path.realpath(left) == os.path.realpath(right):
        return True
    return os.path.exists(left) and os.path.exists(right) and os.path.samefile(left, right)


def _check_log(log: Path) -> None:
    try:
        with log.open("rb") as file:
            beginning = file.read(_ENOUGH)
        log.open("ab").close()
    except OSError as error:
        raise OSError(f"cannot write the log {log}: {error.strerror}") from error
    if beginning and not _BEGINNING.match(beginning):
        raise wrong_use(f"--log {log}: this file is no log of a run; give the log a new name")


@contextmanager
def opened(path: str | None) -> Iterator[Log]:
    """The log at `path`, behind what the file holds already, as `meshlabserver` did.

    Parameters
    ----------
    path : str or None
        ``-`` is the standard output, None no log at all.

    Raises
    ------
    OSError
        In one line, if the file can't be written.
    """
    if path is None or path == STANDARD_OUTPUT:
        yield Log(sys.stdout if path else None, "on the standard output")
        return
    try:
        # Closed by hand: what is left of a full disk's log must not hide what was said of it.
        stream = _appending(Path(path))
    except OSError as error:
        raise OSError(f"cannot write the log {path}: {error.strerror}") from error
    try:
        yield Log(stream, path)
    finally:
        with suppress(OSError):
            stream.close()


def _appending(path: Path) -> TextIO:
    """The file, pipe or device, ready for more text."""
    if is_stream(path):
        return io.TextIOWrapper(opened_stream(path), "utf-8", "backslashreplace")
    return path.open("a", encoding="utf-8", errors="backslashreplace")


def _given(known: FilterInfo, given: Mapping[str, Any]) -> str:
    return ", ".join(f"{keyword}={_value(known, keyword, v)}" for keyword, v in given.items())


def _value(known: FilterInfo, keyword: str, value: Any) -> str:
    from ..mlx.steps import Percentage

    param = known.param(keyword)
    if param is not None and param.choices and isinstance(value, int):
        return repr(param.choices[value])
    if isinstance(value, Percentage):
        return f"{value.percent:g}%"
    return in_line(value)
