"""Texts to print: notes, tables as wide as the window, counts, and what filters returned."""

from __future__ import annotations

import math
import os
import shutil
import sys
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..batch.steplog import in_line, plain
from ..messages import counted, wrapped

if TYPE_CHECKING:
    from ..batch.records import Saved, StepResult

# What text fits that is no table.
WIDTH = 80
GAP = "  "
_DOTS = "..."
# Before the rest of a line that was broken.
_INDENT = "    "
# In a window that is too narrow for that, lines wrap.
_LEAST_OF_NAME = 12

# Longer values are for the log.
_LONGEST_VALUE = 60
_DIGITS = 6
_FLIP_RESULTS = ("flips", "willmore_before", "willmore_after")


# --- tables ------------------------------------------------------------------------------------


def table(rows: Sequence[Sequence[str]], legend: str) -> str:
    """A table whose first row is its header, between rules, with a legend below."""
    lines = in_columns(rows).splitlines()
    rule = "-" * max(map(width, lines))
    return "\n".join([lines[0], rule, *lines[1:], rule, legend])


def wrapped_table(rows: Sequence[Sequence[str]], legend: str) -> str:
    """A table as wide as the window: columns that don't fit follow below, beside the first again.

    In a pipe the window has 80 columns, unless the variable ``COLUMNS`` gives another width.
    """
    window = shutil.get_terminal_size().columns
    names, *columns = zip(*rows, strict=True)
    room = max(window - _column_width(names), 0)
    # As few blocks as possible, with about the same number of columns each.
    for count in range(1, len(columns) + 1):
        size = math.ceil(len(columns) / count)
        blocks = [columns[start : start + size] for start in range(0, len(columns), size)]
        if all(sum(len(GAP) + _column_width(c) for c in block) <= room for block in blocks):
            break
    texts = [table([*zip(names, *block, strict=True)], "") for block in blocks]
    return "\n".join([*texts, legend])


def _column_width(column: Sequence[str]) -> int:
    return max(map(width, column))


def in_columns(rows: Sequence[Sequence[str]], left: int = 1) -> str:
    """Align rows in columns: the first `left` ones to the left, the others to the right."""
    widths = [_column_width(column) for column in zip(*rows, strict=True)]
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
    """The rows with their first cells cut so that the columns fit into the window.

    In a pipe names stay whole, unless the variable ``COLUMNS`` gives a width.
    """
    if not _has_window():
        return [(printable(name), *rest) for name, *rest in rows]
    window = shutil.get_terminal_size().columns
    others = [_column_width(column) for column in list(zip(*rows, strict=True))[1:]]
    room = max(window - sum(others) - len(GAP) * len(others), _LEAST_OF_NAME)
    return [(end_of(printable(name), room), *rest) for name, *rest in rows]


def in_window(lines: Iterable[str]) -> str:
    """The lines, those that are longer than the window's broken at blanks, and indented.

    In a pipe they stay whole, unless the variable ``COLUMNS`` gives a width.
    """
    shown = [printable(line) for line in lines]
    if not _has_window():
        return "\n".join(shown)
    columns = shutil.get_terminal_size().columns
    broken: list[str] = []
    for line in shown:
        parts = wrapped(line, max(columns - len(_INDENT), _LEAST_OF_NAME))
        broken += parts[:1] + [_INDENT + part for part in parts[1:]]
    return "\n".join(broken)


def _has_window() -> bool:
    """Whether the standard output has a width."""
    return bool(terminal_width(sys.stdout) or "COLUMNS" in os.environ)


def how_many_failed(failed: int, count: int) -> str:
    """The last line on several inputs, of which some failed."""
    rest = "" if failed == count else "; the others are done"
    return f"{failed} of {count} inputs failed{rest}"


# --- widths ------------------------------------------------------------------------------------


def terminal_width(stream: Any) -> int:
    """How many columns the terminal of a stream has; 0 if it is no terminal."""
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
    """The text with question marks for letters that would move the cursor."""
    return "".join(letter if letter.isprintable() else "?" for letter in text)


def beginning_of(text: str, columns: int) -> str:
    """The text in at most so many columns: whole, or its beginning and dots."""
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
    """The text in at most so many columns: whole, or dots and its end, which names the file."""
    return beginning_of(text[::-1], columns)[::-1]


# --- what filters returned ---------------------------------------------------------------------


def step_results(results: Iterable[StepResult]) -> list[str]:
    """An indented line for each step that returned something."""
    return [f"  step {r.number}, {r.name}: {_summary(r.returned)}" for r in results if r.returned]


def saved_text(saved: Iterable[Saved]) -> str:
    """The files that were written, each with its size."""
    texts = [f"{s.file} ({s.vertices} vertices, {s.faces} faces)" for s in saved]
    return ", ".join(texts) or "not saved (no -o)"


def flip_results(returned: Mapping[str, Any]) -> str:
    """The number of flips and the energy before and after."""
    before, after = returned["willmore_before"], returned["willmore_after"]
    return f"{counted(returned['flips'], 'flip')}, Willmore energy {before:.6g} -> {after:.6g}"


def _summary(returned: Mapping[str, Any]) -> str:
    if all(key in returned for key in _FLIP_RESULTS):
        return flip_results(returned)
    return ", ".join(f"{key} {_short(value)}" for key, value in returned.items())


def _short(value: Any) -> str:
    text = in_line(_rounded(plain(value)))
    return text if len(text) <= _LONGEST_VALUE else f"{text[:_LONGEST_VALUE]}..."


def _rounded(plain: Any) -> Any:
    if isinstance(plain, list):
        return [_rounded(item) for item in plain]
    return float(f"{plain:.{_DIGITS}g}") if isinstance(plain, float) else plain
