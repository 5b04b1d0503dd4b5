"""Reports of what a search is doing and how far it is, for a listener that shows them.

Only reports of the listener's own thread arrive: of a search that works in several threads, those
of one are enough.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple


class _Listener(NamedTuple):
    thread: int
    call: Callable[[str], object]


_listeners: list[_Listener] = []
_stages: list[str] = []


@contextmanager
def listening(call: Callable[[str], object]) -> Iterator[None]:
    """Call `call` with the text of each report inside."""
    _listeners.append(_Listener(threading.get_ident(), call))
    try:
        yield
    finally:
        _listeners.pop()


@contextmanager
def stage(name: str) -> Iterator[None]:
    """Put the name of a stage before the reports inside."""
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
    """Report how far the work is."""
    if _is_heard():
        _listeners[-1].call(", ".join(filter(None, (*_stages, text))))


def _is_heard() -> bool:
    return bool(_listeners) and _listeners[-1].thread == threading.get_ident()
