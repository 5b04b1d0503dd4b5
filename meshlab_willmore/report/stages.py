"""The table of a chain of filters, in plain ASCII."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

DIGITS = 6
# A double has no more exact digits.
HUGE = 1e15
GAP = "  "
INDENT = "  "
LEGEND = (
    "W: Willmore energy. M: absolute mean curvature, the sum of angle times length.\n"
    "shape: the worst 1 % of the triangles are below this; an equilateral one has 1.\n"
    "seconds: the filters of the stage, without measuring and saving."
)


class Stage(NamedTuple):
    """The state of a mesh after one stage of a chain; None where a column does not apply.

    `preset` is that of the stage's flips, or empty.
    """

    model: str
    name: str
    faces: int
    flips: int | None
    willmore: float
    area: float
    mean_curvature: float
    worst_shape: float
    seconds: float | None
    preset: str = ""


HEADER = ("", "faces", "flips", "W", "area", "M", "shape", "seconds")


def format_table(stages: Sequence[Stage]) -> str:
    """Format the stages as a table, with a heading for each model and a legend below.

    Parameters
    ----------
    stages
        Stages of one model follow each other.
    """
    rows: list[tuple[str, ...]] = [HEADER]
    for model, group in groupby(stages, key=lambda stage: stage.model):
        rows.append((model, *[""] * (len(HEADER) - 1)))
        rows.extend(_cells(stage) for stage in group)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [_line(row, widths) for row in rows]
    rule = "-" * max(map(len, lines))
    return "\n".join([lines[0], rule, *lines[1:], rule, LEGEND])


def _line(row: Sequence[str], widths: Sequence[int]) -> str:
    name, *numbers = row
    cells = [name.ljust(widths[0])]
    cells += [cell.rjust(width) for cell, width in zip(numbers, widths[1:], strict=True)]
    return GAP.join(cells).rstrip()


def _cells(stage: Stage) -> tuple[str, ...]:
    return (
        INDENT + stage.name,
        str(stage.faces),
        "" if stage.flips is None else str(stage.flips),
        significant(stage.willmore),
        significant(stage.area),
        significant(stage.mean_curvature),
        f"{stage.worst_shape:.3f}",
        "" if stage.seconds is None else f"{stage.seconds:.2f}",
    )


def significant(value: float) -> str:
    """Format a number with six digits, or all before the point; huge ones with an exponent."""
    if not math.isfinite(value):
        return str(value)
    if abs(value) >= HUGE:
        return f"{value:.{DIGITS - 1}e}"
    decimals = DIGITS - len(str(int(abs(value))))
    return f"{value:.{max(decimals, 0)}f}"
