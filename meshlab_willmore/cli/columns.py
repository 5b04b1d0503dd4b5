"""Rows of text in columns, and numbers of things."""

from __future__ import annotations

from collections.abc import Sequence

GAP = "  "


def in_columns(rows: Sequence[Sequence[str]], left: int = 1) -> str:
    """Lay rows out under each other; the first `left` columns begin, the others end together."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = [
            cell.ljust(width) if place < left else cell.rjust(width)
            for place, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append(GAP.join(cells).rstrip())
    return "\n".join(lines)


def counted(number: int, thing: str) -> str:
    """One step, two steps."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"
