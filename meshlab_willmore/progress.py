"""How far work is, for a callable that shows it and may stop it.

Whatever takes long calls `report` with the fraction of it that is done, and surrounds each part by
a `stage`: the fractions inside are those of the part. So each function knows of its own work only,
and the listener gets the fraction of the whole. It never falls.

Only reports of the listener's own thread arrive: of a search that works in several threads, those
of one are enough.
"""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Listen = Callable[[float, str], object]

# Between two calls of a listener, at least.
SECONDS_BETWEEN_CALLS = 0.1
SECONDS_BETWEEN_LINES = 1.0
# The text of the last call, with fraction 1.
DONE = "done"

_log = logging.getLogger(__name__)
_here = threading.local()


class Cancelled(Exception):  # noqa: N818 - no error: it was asked for
    """A callable given as `progress` has returned False, and the work has ended there."""


class _Stage:
    """A part of the work: its name, its place in the stage around it, and how far it is itself."""

    def __init__(self, name: str, begin: float, end: float) -> None:
        self.name, self.begin, self.end, self.reached = name, begin, end, 0.0


class Listener:
    """A callable that hears how far the work is, and may stop it.

    Parameters
    ----------
    call : callable
        Called with a fraction that never falls and a text.
    seconds : float
        Between two calls, at least; before the last one, less.

    Raises
    ------
    TypeError
        It can't be called.
    """

    def __init__(self, call: Listen, seconds: float = SECONDS_BETWEEN_CALLS) -> None:
        if not callable(call):
            raise TypeError(
                "progress must be None or a callable that takes a fraction and a text, not "
                f"{type(call).__name__}"
            )
        self.raised: BaseException | None = None
        self.outer: Listener | None = current()
        self.stages = [_Stage("", 0.0, 1.0)]
        self._call = call
        self._seconds = seconds
        self._due = -math.inf

    def report(self, fraction: float, text: str) -> None:
        """Report how far the innermost stage is, also to the listener around this one."""
        inner = self.stages[-1]
        inner.reached = whole = max(inner.reached, min(fraction, 1.0))
        for each in reversed(self.stages):
            whole = each.begin + whole * (each.end - each.begin)
        text = ", ".join(filter(None, (*(each.name for each in self.stages), text)))
        if self.outer is not None:
            self.outer.report(whole, text)
        self.hear(whole, text)

    def hear(self, fraction: float, text: str) -> None:
        """Call the callable unless it was called a moment ago; raise `Cancelled` if it says so."""
        # The call with fraction 1 is the last one.
        if fraction >= 1.0 or time.monotonic() < self._due:
            return
        if _is_false(self._answer(fraction, text)):
            self.raised = Cancelled(f"cancelled at {math.floor(100 * fraction)} % ({text})")
            raise self.raised
        self._due = time.monotonic() + self._seconds

    def end(self) -> None:
        """Make the last call."""
        self._answer(1.0, DONE)

    def _answer(self, fraction: float, text: str) -> object:
        """Call the callable, in which nothing is heard; note what it raises."""
        listener, _here.listener = current(), None
        try:
            return self._call(fraction, text)
        except BaseException as error:
            self.raised = error
            raise
        finally:
            _here.listener = listener


def current() -> Listener | None:
    """The innermost listener of this thread."""
    return getattr(_here, "listener", None)


def _is_false(answer: object) -> bool:
    """Whether it is False, NumPy's included; other values that count as false are none."""
    return type(answer).__name__ in ("bool", "bool_") and not answer


@contextmanager
def listening(call: Listen | None, seconds: float = SECONDS_BETWEEN_CALLS) -> Iterator[None]:
    """Let a callable hear how far the work inside is.

    Parameters
    ----------
    call : callable or None
        Called with a fraction that never falls and a text: at the first report, then at most once
        in so many seconds, and with exactly 1 once at the end, unless that is an exception. If it
        returns False before the end, the work stops. A listener around this one hears the same as
        a part of its own work. None: nothing but that.
    seconds : float

    Raises
    ------
    Cancelled
        The callable has returned False.
    TypeError
        It can't be called.
    """
    if call is None:
        yield
        return
    listener = Listener(call, seconds)
    _here.listener = listener
    try:
        yield
        listener.end()
    finally:
        _here.listener = listener.outer


@contextmanager
def logged() -> Iterator[None]:
    """Let the package's log have what is reported inside, if it takes lines of level DEBUG."""
    if not _log.isEnabledFor(logging.DEBUG):
        yield
        return
    with listening(_write, SECONDS_BETWEEN_LINES):
        yield


def _write(fraction: float, text: str) -> None:
    _log.debug("%d %%: %s", math.floor(100 * fraction), text)


@contextmanager
def stage(part: float = 1.0, name: str = "") -> Iterator[None]:
    """Let reports inside be those of a part of the work.

    Parameters
    ----------
    part : float
        The share of what is left of the stage around this one, in (0, 1]. Where it is unknown how
        many stages follow, none takes all that is left.
    name : str
        What comes before the text of the reports inside, and is reported when the stage begins.
    """
    listener = current()
    if listener is None:
        yield
        return
    around = listener.stages[-1]
    end = around.reached + part * (1.0 - around.reached)
    listener.stages.append(_Stage(name, around.reached, end))
    try:
        if name:
            listener.report(0.0, "")
        yield
        around.reached = max(around.reached, end)
    finally:
        listener.stages.pop()


def report(fraction: float, text: str) -> None:
    """Report the fraction of the innermost stage that is done, and what is being done."""
    listener = current()
    if listener is not None:
        listener.report(fraction, text)


def was_raised_by_listener(error: BaseException) -> bool:
    """Whether an exception comes from a callable that listens, or from its wish to stop."""
    listener = current()
    while listener is not None:
        if listener.raised is error:
            return True
        listener = listener.outer
    return False
