"""What a search is doing and how far it is, for whoever shows it while it lasts.

Only the thread that listens is heard: of a search that works in several threads, one tells enough.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple


class _Listener(NamedTuple):
    thread: int
    hear: Callable[[str], object]


_listeners: list[_Listener] = []
_stages: list[str] = []


@contextmanager
def heard_by(hear: Callable[[str], object]) -> Iterator[None]:
    """Call `hear` with what is reported inside, a few words at a time."""
    _listeners.append(_Listener(threading.get_ident(), hear))
    try:
        yield
    finally:
        _listeners.pop()


@contextmanager
def stage(name: str) -> Iterator[None]:
    """What is reported inside belongs to a stage, which is named before it."""
    if not _is_heard():
        yield
        return
    _stages.append(name)
    report("")
    try:
        yield
    finally:
        _stages.pop()


def report(text: str) -> None:
    """Tell how far the work is."""
    if _is_heard():
        _listeners[-1].hear(", ".join(filter(None, (*_stages, text))))


def _is_heard() -> bool:
    return bool(_listeners) and _listeners[-1].thread == threading.get_ident()
