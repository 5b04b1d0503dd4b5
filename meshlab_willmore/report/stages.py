"""The table of a chain of filters, in plain ASCII."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

DIGITS = 6
# A double has no more exact digits.
HUGE = 1e15
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


def table_rows(stages: Sequence[Stage]) -> list[tuple[str, ...]]:
    """The rows of a table: its header, then the stages below the name of their model.

    Parameters
    ----------
    stages
        Stages of one model follow each other.
    """
    rows: list[tuple[str, ...]] = [HEADER]
    for model, group in groupby(stages, key=lambda stage: stage.model):
        rows.append((model, *[""] * (len(HEADER) - 1)))
        rows.extend(_cells(stage) for stage in group)
    return rows


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
