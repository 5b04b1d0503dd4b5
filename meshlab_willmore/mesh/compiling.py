"""What Numba compiles while it does: to tell of it, to count it, or to allow none of it.

Numba broadcasts an event when it begins to compile a function (`numba.core.event`), and none when
it finds the machine code in its cache. Compiling a kernel compiles those that it calls: only the
outermost count here.
"""

import contextlib
import sys
import threading
import time
from typing import NamedTuple

from .. import quick_start

quick_start.import_numba()
try:
    from numba.core.event import Listener, install_listener, register
except ImportError:
    # In a Numba that is made otherwise, nothing is told.
    CAN_TELL = False
    Listener = object  # type: ignore[misc,assignment]

    def register(kind, listener):
        """Do nothing."""

    def install_listener(kind, listener):
        """Do nothing."""
        return contextlib.nullcontext()
else:
    CAN_TELL = True

COMPILE = "numba:compile"
SECONDS_BETWEEN_LINES = 5.0
_PACKAGE = __name__.partition(".")[0]


class NotCompiledError(Exception):
    """Something would have to be compiled that must not."""


class Compiled(NamedTuple):
    """A kernel that was compiled: its name with the module's, and the seconds that took."""

    name: str
    seconds: float


class _Listener(Listener):
    """Follows the kernels of this package."""

    def __init__(self):
        self._depth = 0

    def on_start(self, event):
        """A compilation begins; inside another one, or not."""
        if _is_ours(event):
            self._depth += 1
            if self._depth == 1:
                self.begin(_name(event))

    def on_end(self, event):
        """It is over."""
        # Where another listener has raised at the beginning, this one never heard of it.
        if _is_ours(event) and self._depth:
            self._depth -= 1
            if self._depth == 0:
                self.end(_name(event))

    def begin(self, name):
        """The outermost begins."""

    def end(self, name):
        """The outermost is over."""


class _Teller(_Listener):
    """Prints a line when the first compilation of a run begins, and how far it is after that."""

    def __init__(self):
        super().__init__()
        self.what = _PACKAGE
        self.is_silent = False
        self._name = ""
        self._since = None
        self._ticker = None

    def begin(self, name):
        self._name = name
        if self.is_silent:
            return
        if self._since is None:
            self._since = time.monotonic()
            _say(f"Compiling {self.what} once; this takes some seconds ...")
        # It does not live on in a process that was forked.
        if _is_terminal() and not (self._ticker and self._ticker.is_alive()):
            self._ticker = threading.Thread(target=self._tick, daemon=True)
            self._ticker.start()

    def end(self, name):
        self._name = ""

    def tell_how_far(self):
        """Print what is compiled right now; returns whether anything is."""
        name, since = self._name, self._since
        if name and since is not None and not self.is_silent:
            _say(f"  compiling {_short(name)}, {time.monotonic() - since:.0f} s so far")
        return bool(name)

    def _tick(self):
        while True:
            time.sleep(SECONDS_BETWEEN_LINES)
            if not self.tell_how_far():
                return

    def for_a_run(self, what, is_silent):
        """Begin anew, and return what brings the teller back to where it was."""
        before = self.what, self.is_silent, self._since
        self.what, self.is_silent, self._since = what, is_silent, None
        return before

    def back_to(self, before):
        self.what, self.is_silent, self._since = before


class _Follower(_Listener):
    def __init__(self, follow):
        super().__init__()
        self._follow = follow

    def begin(self, name):
        self._follow(_short(name))

    def end(self, name):
        self._follow("")


class _Forbidder(_Listener):
    def begin(self, name):
        raise NotCompiledError(name)


class _Counter(_Listener):
    def __init__(self):
        super().__init__()
        self.found = []
        self._start = 0.0

    def begin(self, name):
        self._start = time.perf_counter()

    def end(self, name):
        self.found.append(Compiled(name, time.perf_counter() - self._start))


def _is_terminal():
    return sys.stderr is not None and sys.stderr.isatty()


def _say(line):
    if _is_terminal():
        print(line, file=sys.stderr, flush=True)


def _short(name):
    return name.removeprefix(f"{_PACKAGE}.")


def _is_ours(event):
    return _name(event).startswith(f"{_PACKAGE}.")


def _name(event):
    function = event.data["dispatcher"].py_func
    return f"{function.__module__}.{function.__qualname__}"


# In the whole process; what is called on arrays alone is told of once.
_teller = _Teller()
_followers: list[_Follower] = []
register(COMPILE, _teller)


@contextlib.contextmanager
def announced(what, *, silent=False):
    """If anything is compiled inside, say so on the standard error, if it is a terminal.

    What is compiled is told every few seconds until that is over.

    Parameters
    ----------
    what : str
        What is compiled, for that line.
    silent : bool
        Say nothing.
    """
    before = _teller.for_a_run(what, silent or bool(_followers))
    try:
        yield
    finally:
        _teller.back_to(before)


@contextlib.contextmanager
def followed(follow):
    """Call `follow` with the name of each kernel that is compiled inside, and with "" after it.

    The name is that in this package.

    Nothing is printed then: who follows tells.
    """
    follower = _Follower(follow)
    _followers.append(follower)
    try:
        with announced("", silent=True), install_listener(COMPILE, follower):
            yield
    finally:
        _followers.remove(follower)


@contextlib.contextmanager
def counted():
    """Give a list to which each `Compiled` of what is compiled inside is added."""
    counter = _Counter()
    with install_listener(COMPILE, counter):
        yield counter.found


@contextlib.contextmanager
def forbidden():
    """Raise `NotCompiledError` where something would be compiled."""
    with announced("", silent=True), install_listener(COMPILE, _Forbidder()):
        yield
