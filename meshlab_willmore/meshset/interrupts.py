"""Ctrl-C (SIGINT): deferred during a change, and never lost."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

Handler = Callable[[int, FrameType | None], object]
Interrupt = tuple[int, FrameType | None]


@contextmanager
def deferred() -> Iterator[None]:
    """A Ctrl-C inside takes effect at the end."""
    with _watched(lambda _: None) as (caught, before):
        yield
    if caught:
        before(*caught[0])


@contextmanager
def preserved() -> Iterator[None]:
    """A Ctrl-C inside ends in `KeyboardInterrupt`, even if code inside drops the exception.

    Numba's compiler calls Python in places where an exception can only be printed.
    """
    with _watched(lambda handle: handle()) as (caught, _):
        try:
            yield
        except Exception as error:
            if caught:
                raise KeyboardInterrupt from error
            raise
        if caught:
            raise KeyboardInterrupt


@contextmanager
def _watched(
    react: Callable[[Callable[[], object]], object],
) -> Iterator[tuple[list[Interrupt], Handler]]:
    """Note each Ctrl-C in a list, and let `react` decide whether to handle it at once.

    Only the main thread ever gets one, and only a handler of Python's can be put back.
    """
    caught: list[Interrupt] = []
    before = signal.getsignal(signal.SIGINT)
    if not callable(before) or threading.current_thread() is not threading.main_thread():
        yield caught, lambda number, frame: None
        return
    handler: Handler = before

    def note(number: int, frame: FrameType | None) -> None:
        caught.append((number, frame))
        react(lambda: handler(number, frame))

    signal.signal(signal.SIGINT, note)
    try:
        yield caught, handler
    finally:
        signal.signal(signal.SIGINT, before)
