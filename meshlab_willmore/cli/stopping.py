"""SIGTERM ends a command as Ctrl-C does: what was begun is tidied away."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

import click

# What a shell reports for a process that a signal ended.
SIGNAL_EXIT = 128


@contextmanager
def watched(ctx: click.Context) -> Iterator[None]:
    """Inside, SIGTERM leads to the exit code 143, by way of whoever handles Ctrl-C just then.

    Only that way comes at the right moment: filters defer a Ctrl-C to the end of a change, and
    Numba's compiler would swallow another exception.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    caught: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:
        caught.append(number)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        handle = signal.getsignal(signal.SIGINT)
        if not callable(handle):
            raise KeyboardInterrupt
        handle(signal.SIGINT, frame)

    before = signal.signal(signal.SIGTERM, stop)
    try:
        yield
    except (KeyboardInterrupt, click.Abort):
        if not caught:
            raise
        click.echo("Error: terminated by SIGTERM", err=True)
        ctx.exit(SIGNAL_EXIT + caught[0])
    finally:
        signal.signal(signal.SIGTERM, before)
