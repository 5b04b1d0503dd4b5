"""SIGTERM and SIGHUP end a command as Ctrl-C does: what was begun is tidied away."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType

import click

# What a shell reports for a process that a signal ended.
SIGNAL_EXIT = 128

# Windows has no SIGHUP.
_WATCHED = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))


@contextmanager
def watched(ctx: click.Context) -> Iterator[None]:
    """Inside, a signal leads to the exit code 128 + its number, by way of who handles Ctrl-C.

    Only that way comes at the right moment: filters defer a Ctrl-C to the end of a change, and
    Numba's compiler would swallow another exception. A second signal ends the process at once.
    """
    caught: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:
        caught.append(number)
        for watched_number in _WATCHED:
            if signal.getsignal(watched_number) is stop:
                signal.signal(watched_number, signal.SIG_DFL)
        handle = signal.getsignal(signal.SIGINT)
        if not callable(handle):
            raise KeyboardInterrupt
        handle(signal.SIGINT, frame)

    # What is ignored stays so: nohup does that to SIGHUP.
    with _handled_by(stop, lambda handler: handler not in (signal.SIG_IGN, None)):
        try:
            yield
        except (KeyboardInterrupt, click.Abort):
            if not caught:
                raise
            # The terminal may be what is gone.
            with suppress(OSError):
                name = signal.Signals(caught[0]).name
                click.echo(f"Error: terminated by {name}", err=True)
            ctx.exit(SIGNAL_EXIT + caught[0])


@contextmanager
def at_once() -> Iterator[None]:
    """Inside, the signals end the process at once: while native code runs, no handler would.

    For a while in which no file of ours is half written.
    """
    with _handled_by(signal.SIG_DFL, callable):
        yield


@contextmanager
def _handled_by(handler: object, is_replaced: Callable[[object], bool]) -> Iterator[None]:
    """Inside, the signals have another handler where the old one is to be replaced."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: old for number in _WATCHED if is_replaced(old := signal.getsignal(number))}
    for number in before:
        signal.signal(number, handler)  # type: ignore[arg-type]
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)
