"""What Numba compiles while it does: to tell of it, to count it, or to allow none of it.

Numba broadcasts an event when it begins to compile a function (`numba.core.event`), and none when
it finds the machine code in its cache. Compiling a kernel compiles those that it calls: only the
outermost count here.
"""

import contextlib
import sys
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
    """Prints a line before the first compilation of a run."""

    def __init__(self):
        super().__init__()
        self.what = _PACKAGE
        self.has_told = False

    def begin(self, name):
        if self.has_told:
            return
        self.has_told = True
        if sys.stderr is not None and sys.stderr.isatty():
            print(
                f"Compiling {self.what} once; this takes some seconds ...",
                file=sys.stderr,
                flush=True,
            )


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


def _is_ours(event):
    return _name(event).startswith(f"{_PACKAGE}.")


def _name(event):
    function = event.data["dispatcher"].py_func
    return f"{function.__module__}.{function.__qualname__}"


# In the whole process; what is called on arrays alone is told of once.
_teller = _Teller()
register(COMPILE, _teller)


@contextlib.contextmanager
def announced(what, *, silent=False):
    """If anything is compiled inside, say so in a line on the standard error, if it is a terminal.

    Parameters
    ----------
    what : str
        What is compiled, for that line.
    silent : bool
        Say nothing.
    """
    before = _teller.what, _teller.has_told
    _teller.what, _teller.has_told = what, silent
    try:
        yield
    finally:
        _teller.what, _teller.has_told = before


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
