"""Progress of a command: one line on a terminal that is redrawn, or whole lines in a log.

A thread shows it while native filters, searches and the compiler work. On a terminal the line is
redrawn each second, and removed in the end. Elsewhere only what takes long is shown, in a line
every few seconds; a batch of quick files prints none.
"""

from __future__ import annotations

import io
import logging
import math
import os
import shutil
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import Any, TextIO

from ..batch.lost_kernels import note_lost_kernels
from .arguments import kept_option, kept_options
from .text import beginning_of, end_of, printable, terminal_width, width

SECONDS_ON_A_TERMINAL = 1.0
SECONDS_IN_A_LOG = 8.0

_PACKAGE = __name__.partition(".")[0]
# By how often --verbose was given.
_LEVELS = (logging.WARNING, logging.INFO, logging.DEBUG)

verbose_option = kept_option(
    "-v",
    "--verbose",
    count=True,
    help="Print the log of passes and steps on the standard error; -vv: the progress too. Not of a "
    "batch.",
)

_BAR = 16
# Narrower windows have no room for the label.
_ROOM_FOR_LABEL = 40
_LEAST_SHOWN = 10


class Status:
    """What is being done, since when, and how many of the `total` parts are done.

    The `label` is a command or a file.
    """

    def __init__(self, label: str, total: int = 0, clock: Callable[[], float] = time.monotonic):
        self._label = printable(label)
        self._total = total
        self._clock = clock
        self._done = self._begun = 0
        self._fraction = 0.0
        self._what = self._detail = ""
        self._since = clock()
        self._screen: _Screen | None = None

    def begin(self, what: str) -> None:
        """Begin something else."""
        self._what, self._detail, self._since = printable(what), "", self._clock()
        self._fraction = 0.0

    def next(self, what: str, detail: str = "") -> None:
        """Begin the next part; the one before is done."""
        self.begin(what)
        self.detail(detail)
        self.count()

    def count(self) -> None:
        """Begin the next part of what is being done, by the same clock."""
        self._done = self._begun
        self._begun += 1
        if self._screen is not None:
            self._screen.draw()

    def end(self) -> None:
        """Show that all is done."""
        self._done = self._total
        if self._screen is not None and self._total:
            self._screen.draw()

    def detail(self, text: str, fraction: float = 0.0) -> None:
        """Say more about what is being done, and which fraction of this part is done."""
        self._detail, self._fraction = printable(text), fraction

    def hide(self) -> None:
        """Remove the line from the terminal until it is drawn again: something else is printed."""
        if self._screen is not None:
            self._screen.hide()

    def line(self, columns: int) -> str:
        """The line for a terminal, always shorter than so many columns."""
        room = columns - 1
        seconds = f", {self._seconds()} s" if self._what else ""
        head = ""
        if room >= _ROOM_FOR_LABEL:
            head = f"{end_of(self._label, room // 3)}{self._bar()}  "
        text = self._text_in(room - width(head) - len(seconds))
        return beginning_of(f"{head}{text}{seconds}", room)

    def sentence(self) -> str:
        """The whole line for a log."""
        part = f" ({self._percent()} %)" if self._fraction else ""
        if self._total > 1 and self._done < self._begun:
            part = f" ({self._done + 1} of {self._total})"
        return f"{self._label}: {self._text()}{part}, {self._seconds()} s so far"

    def _text_in(self, columns: int) -> str:
        """The text in so many columns; the detail, which changes, is cut last."""
        left = columns - width(self._detail) - 2
        if not self._detail or width(self._what) <= left:
            return beginning_of(self._text(), columns)
        if left < _LEAST_SHOWN:
            return beginning_of(self._detail, columns)
        return f"{beginning_of(self._what, left)}: {self._detail}"

    def _text(self) -> str:
        return ": ".join(filter(None, (self._what, self._detail)))

    def _seconds(self) -> int:
        return int(self._clock() - self._since)

    def _bar(self) -> str:
        if not self._total:
            return ""
        full = math.floor(_BAR * self._share())
        return f"  [{'#' * full}{'-' * (_BAR - full)}] {self._percent():3d}%"

    def _percent(self) -> int:
        return math.floor(100.0 * self._share())

    def _share(self) -> float:
        """Which share of all parts is done."""
        return min((self._done + self._fraction) / max(self._total, 1), 1.0)


@contextmanager
def shown(label: str, total: int = 0) -> Iterator[Status]:
    """Show progress inside, as the `Status` has it."""
    status = Status(label, total)
    stream = sys.stderr
    with ExitStack() as stack:
        own = stack.enter_context(_duplicate(stream))
        stack.enter_context(_logged(own, status))
        if stream.isatty():
            screen = status._screen = _Screen(own, lambda: status.line(_columns(own)))
            stack.callback(screen.hide)
            for name in ("stdout", "stderr"):
                stack.callback(setattr, sys, name, getattr(sys, name))
                setattr(sys, name, _Above(getattr(sys, name), screen))
            stack.enter_context(repeated(screen.draw, SECONDS_ON_A_TERMINAL))
            if total:
                screen.draw()
        else:
            stack.enter_context(
                repeated(lambda: print(status.sentence(), file=own, flush=True), SECONDS_IN_A_LOG)
            )
        yield status
        status.end()


@contextmanager
def _logged(stream: TextIO, status: Status) -> Iterator[None]:
    """Print the package's log inside, as far as --verbose asks for it."""

    class Printer(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            status.hide()
            # The terminal may be closed.
            with suppress(OSError, ValueError):
                print(printable(self.format(record)), file=stream, flush=True)

    level = _LEVELS[min(kept_options().get("verbose", 0), len(_LEVELS) - 1)]
    log, printer = logging.getLogger(_PACKAGE), Printer(level)
    before = log.level
    if level != logging.WARNING:
        log.setLevel(level)
        log.addHandler(printer)
    try:
        yield
    finally:
        log.removeHandler(printer)
        log.setLevel(before)


@contextmanager
def with_details(status: Status, is_part: bool = False) -> Iterator[None]:
    """Show what searches and the compiler report inside as details of what is being done.

    Where that `is_part`, one of those that are counted, also which fraction of it is done.
    """
    from ..mesh import compiling
    from ..progress import listening

    has_compiled = False

    def follow(name: str) -> None:
        nonlocal has_compiled
        has_compiled = True
        status.detail(f"compiling {name}" if name else "")

    def hear(fraction: float, text: str) -> None:
        status.detail(text, fraction if is_part else 0.0)

    with listening(hear), compiling.followed(follow):
        yield
    note_lost_kernels(has_compiled)


class _Screen:
    """One line at the bottom of a terminal."""

    def __init__(self, stream: TextIO, line: Callable[[], str]) -> None:
        self._stream = stream
        self._line = line
        self._drawn = 0
        self._lock = threading.RLock()

    def draw(self) -> None:
        with self._lock:
            line = self._line()
            drawn = width(line)
            self._put(f"\r{line}{' ' * max(0, self._drawn - drawn)}")
            self._drawn = drawn

    def hide(self) -> None:
        with self._lock:
            if self._drawn:
                self._put(f"\r{' ' * self._drawn}\r")
                self._drawn = 0

    def _put(self, text: str) -> None:
        # The terminal may be closed.
        with suppress(OSError, ValueError):
            self._stream.write(text)
            self._stream.flush()


class _Above:
    """A standard stream whose text is printed above the line of a screen."""

    def __init__(self, stream: Any, screen: _Screen) -> None:
        self._stream = stream
        self._screen = screen

    def write(self, text: Any) -> Any:
        self._screen.hide()
        return self._stream.write(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def _duplicate(stream: Any) -> Iterator[TextIO]:
    """The stream by another descriptor: its own is redirected while native filters run."""
    try:
        number = os.dup(stream.fileno())
    except (OSError, io.UnsupportedOperation):
        yield stream
        return
    with open(number, "w", encoding=stream.encoding, errors="replace") as own:
        yield own


@contextmanager
def repeated(action: Callable[[], object], seconds: float) -> Iterator[None]:
    """Call `action` every so many seconds inside, in a thread."""
    ended = threading.Event()

    def repeat() -> None:
        while not ended.wait(seconds):
            with suppress(OSError, ValueError):
                action()

    thread = threading.Thread(target=repeat, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def _columns(stream: TextIO) -> int:
    return terminal_width(stream) or shutil.get_terminal_size().columns
