"""Compilation of this package's kernels: announced, followed, counted or forbidden.

Numba broadcasts an event when it begins to compile a function, and none when it finds the machine
code in its cache. To compile a kernel includes those that it calls: only the outermost events count
here.
"""

import contextlib
import sys
import time
from typing import NamedTuple

from numba.core.event import Listener, install_listener, register

COMPILE = "numba:compile"
_PACKAGE = __name__.partition(".")[0]


class NotCompiledError(Exception):
    """Something would have to be compiled where that is forbidden."""


class Compiled(NamedTuple):
    """A kernel that was compiled: its name with the module's, and the seconds that took."""

    name: str
    seconds: float


class _CompileListener(Listener):
    """Calls functions with the name of a kernel before and after its compilation."""

    def __init__(self, begin, end=lambda name: None):
        self._begin = begin
        self._end = end
        self._depth = 0

    def on_start(self, event):
        """Note the beginning of a compilation, inside another one or not."""
        if _is_ours(event):
            self._depth += 1
            if self._depth == 1:
                self._begin(_name(event))

    def on_end(self, event):
        """Note its end."""
        # There was no beginning if an earlier listener raised an error there.
        if _is_ours(event) and self._depth:
            self._depth -= 1
            if self._depth == 0:
                self._end(_name(event))


def _is_ours(event):
    return _name(event).startswith(f"{_PACKAGE}.")


def _name(event):
    function = event.data["dispatcher"].py_func
    return f"{function.__module__}.{function.__qualname__}"


class _Run:
    """What may be compiled, and whether that is announced already, or never."""

    def __init__(self, what, is_silent):
        self.what = what
        self.is_silent = is_silent
        self.is_announced = False


# The first one is the whole process, for functions on arrays; those of others are inside it.
_runs = [_Run(_PACKAGE, False)]


def _announce(name):
    run = _runs[-1]
    if not (run.is_silent or run.is_announced) and sys.stderr is not None and sys.stderr.isatty():
        line = f"Compiling {run.what} on first use, this can take a minute ..."
        print(line, file=sys.stderr, flush=True)
        run.is_announced = True


register(COMPILE, _CompileListener(_announce))


@contextlib.contextmanager
def announced(what, *, silent=False):
    """If anything is compiled inside, say so on the standard error once, if it is a terminal.

    Parameters
    ----------
    what : str
        What is compiled, for that line.
    silent : bool
        Say nothing, nor where anything is announced inside.
    """
    _runs.append(_Run(what, silent or _runs[-1].is_silent))
    try:
        yield
    finally:
        _runs.pop()


@contextlib.contextmanager
def followed(follow):
    """Call `follow` with the name of each kernel that is compiled inside, and with "" after it.

    The name is that in this package. Nothing is announced.
    """
    listener = _CompileListener(
        lambda name: follow(name.removeprefix(f"{_PACKAGE}.")), lambda name: follow("")
    )
    with announced("", silent=True), install_listener(COMPILE, listener):
        yield


@contextlib.contextmanager
def counted():
    """Give a list to which each `Compiled` of what is compiled inside is added."""
    found, starts = [], []

    def end(name):
        found.append(Compiled(name, time.perf_counter() - starts.pop()))

    with install_listener(
        COMPILE, _CompileListener(lambda name: starts.append(time.perf_counter()), end)
    ):
        yield found


@contextlib.contextmanager
def forbidden():
    """Raise `NotCompiledError` where something would be compiled."""

    def refuse(name):
        raise NotCompiledError(name)

    with announced("", silent=True), install_listener(COMPILE, _CompileListener(refuse)):
        yield
