"""Rows of text in columns, what fits into some, and numbers of things."""

from __future__ import annotations

import os
import shutil
import sys
import unicodedata
from collections.abc import Sequence
from typing import Any

GAP = "  "
_DOTS = "..."
# In a window that is too narrow for that, lines wrap.
_LEAST_OF_NAME = 12


def in_columns(rows: Sequence[Sequence[str]], left: int = 1) -> str:
    """Lay rows out under each other; the first `left` columns begin, the others end together."""
    widths = [max(map(width, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = [
            cell + blanks if place < left else blanks + cell
            for place, cell in enumerate(row)
            for blanks in [" " * (widths[place] - width(cell))]
        ]
        lines.append(GAP.join(cells).rstrip())
    return "\n".join(lines)


def fitted(rows: Sequence[Sequence[str]]) -> list[tuple[str, ...]]:
    """The rows with so much of the ends of their first cells that the columns fit into the window.

    Who reads from a pipe wants whole names, unless the variable ``COLUMNS`` says how wide it is.
    """
    if not (columns_of(sys.stdout) or "COLUMNS" in os.environ):
        return [(printable(name), *rest) for name, *rest in rows]
    window = shutil.get_terminal_size().columns
    others = [max(map(width, column)) for column in list(zip(*rows, strict=True))[1:]]
    room = max(window - sum(others) - len(GAP) * len(others), _LEAST_OF_NAME)
    return [(end_of(printable(name), room), *rest) for name, *rest in rows]


def counted(number: int, thing: str) -> str:
    """One step, two steps."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


def columns_of(stream: Any) -> int:
    """How many columns the terminal of a stream has; 0 if it is none."""
    try:
        return os.get_terminal_size(stream.fileno()).columns if stream.isatty() else 0
    except (OSError, ValueError):
        return 0


def width(text: str) -> int:
    """How many columns a text takes on a terminal."""
    return sum(map(_width_of, text))


def _width_of(letter: str) -> int:
    if unicodedata.combining(letter):
        return 0
    return 2 if unicodedata.east_asian_width(letter) in "WF" else 1


def printable(text: str) -> str:
    """The text without letters that move the cursor."""
    return "".join(letter if letter.isprintable() else "?" for letter in text)


def beginning_of(text: str, columns: int) -> str:
    """The text, or its beginning and dots, in at most so many columns."""
    if width(text) <= columns:
        return text
    if columns < len(_DOTS):
        return _DOTS[: max(columns, 0)]
    room = columns - len(_DOTS)
    kept = ""
    for letter in text:
        room -= _width_of(letter)
        if room < 0:
            break
        kept += letter
    return f"{kept}{_DOTS}"


def end_of(text: str, columns: int) -> str:
    """The text, or dots and its end, in at most so many columns: in a path that tells most."""
    return beginning_of(text[::-1], columns)[::-1]
