"""Signals that end a process, beside Ctrl-C: SIGTERM and SIGHUP."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

# Windows has no SIGHUP.
ENDING = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))


@contextmanager
def killable() -> Iterator[None]:
    """Inside, SIGTERM and SIGHUP end the process at once: no handler runs during native code.

    Only for times in which no output file is half written.
    """
    with handled_by(signal.SIG_DFL, callable):
        yield


@contextmanager
def handled_by(handler: object, is_replaced: Callable[[object], bool]) -> Iterator[None]:
    """Replace the handlers of these signals inside, where `is_replaced` is true of the old one."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: old for number in ENDING if is_replaced(old := signal.getsignal(number))}
    for number in before:
        signal.signal(number, handler)  # type: ignore[arg-type]
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)
