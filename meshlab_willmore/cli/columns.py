"""Rows of text in columns, and numbers of things."""

from __future__ import annotations

import shutil
import unicodedata
from collections.abc import Sequence

GAP = "  "
# Where there is no window.
WIDTH = 80
_ELLIPSIS = "..."
# Less of a name is no help.
_SHORTEST = 12


def in_columns(rows: Sequence[Sequence[str]], left: int = 1) -> str:
    """Lay rows out under each other; the first `left` columns begin, the others end together."""
    shown = [[printable(cell) for cell in row] for row in rows]
    widths = [max(map(width, column)) for column in zip(*shown, strict=True)]
    lines = []
    for row in shown:
        cells = [
            _padded(cell, wide, place < left)
            for place, (cell, wide) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append(GAP.join(cells).rstrip())
    return "\n".join(lines)


def _padded(cell: str, wide: int, begins: bool) -> str:
    blanks = " " * (wide - width(cell))
    return cell + blanks if begins else blanks + cell


def fitted(rows: Sequence[Sequence[str]]) -> list[tuple[str, ...]]:
    """The rows with first cells so short that the columns fit into the window."""
    window = shutil.get_terminal_size((WIDTH, 24)).columns
    others = [max(map(width, column)) for column in list(zip(*rows, strict=True))[1:]]
    room = max(window - sum(others) - len(GAP) * len(others), _SHORTEST)
    return [(shortened(printable(first), room), *rest) for first, *rest in rows]


def shortened(name: str, room: int) -> str:
    """A name with its beginning and, above all, its end, in so much room."""
    if width(name) <= room:
        return name
    begin = (room - len(_ELLIPSIS)) // 3
    end = room - len(_ELLIPSIS) - begin
    return _cut(name, begin) + _ELLIPSIS + _cut(name[::-1], end)[::-1]


def _cut(text: str, room: int) -> str:
    while width(text) > room:
        text = text[:-1]
    return text


def width(text: str) -> int:
    """How many columns of a window a text takes."""
    return sum(_width_of(letter) for letter in text)


def _width_of(letter: str) -> int:
    if unicodedata.combining(letter):
        return 0
    return 2 if unicodedata.east_asian_width(letter) in "WF" else 1


def printable(text: str) -> str:
    """The text with what is no letter, a line break say, as an escape."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def counted(number: int, thing: str) -> str:
    """One step, two steps."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"
