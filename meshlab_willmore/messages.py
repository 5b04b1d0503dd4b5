"""Messages for people: errors in one line, wrong usage, and notes on what was lost."""

from __future__ import annotations

import re
import sys
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from .markup import plain

# How messages of PyMeshLab begin: that it failed, at what, and in which file.
_PRELUDE = re.compile(r"(?:Error d|D)etails:|Unable to (?:open|save) file:[^\n]*\n")


class WrongUse(ValueError):  # noqa: N818 - it is one word for one thing
    """Arguments that can't be right, in one line; a command ends with exit code 2."""


def one_line(error: BaseException) -> str:
    """The message of an error in one line; its type if it has none."""
    return " ".join(str(error).split()) or type(error).__name__


def reason(error: BaseException) -> str:
    """The message in one line, without what PyMeshLab puts before it, and without markup."""
    text = plain(_PRELUDE.split(str(error))[-1])
    return " ".join(text.split()) or type(error).__name__


def wrapped(text: str, width: int, indent: str = "") -> list[str]:
    """The text in lines of at most `width` columns; a word that is longer stays whole."""
    return textwrap.wrap(
        text,
        width,
        initial_indent=indent,
        subsequent_indent=indent,
        break_long_words=False,
        break_on_hyphens=False,
    )


def counted(number: int, thing: str) -> str:
    """A number with its noun: 1 step, 2 steps."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


def _print(text: str) -> None:
    print(f"Note: {text}", file=sys.stderr)


_take: ContextVar[Callable[[str], None]] = ContextVar("take", default=_print)


def note(text: str) -> None:
    """Print a note on the standard error, or give it to the function of `notes_taken_by`."""
    _take.get()(text)


@contextmanager
def notes_kept() -> Iterator[list[str]]:
    """Give a list that gets the notes inside, which also go where they went before."""
    take, kept = _take.get(), list[str]()

    def keep(text: str) -> None:
        kept.append(text)
        take(text)

    token = _take.set(keep)
    try:
        yield kept
    finally:
        _take.reset(token)


@contextmanager
def notes_taken_by(take: Callable[[str], None]) -> Iterator[None]:
    """Inside, `take` gets the notes, each text only once."""
    seen: set[str] = set()

    def once(text: str) -> None:
        if text not in seen:
            seen.add(text)
            take(text)

    token = _take.set(once)
    try:
        yield
    finally:
        _take.reset(token)
