"""The numbers of the page: measures before and after, with what changed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from html import escape
from typing import Any, NamedTuple

import numpy as np

from ..results import FlipResult
from .examine import NOISE, Examined, between, meaningful

Value = Callable[[Examined], float | None]

WORST_SHARE = 0.01
PERCENT = 100.0
# Digits of a number, and from where on numbers have an exponent.
DIGITS = 5
LARGE, SMALL = 1e9, 1e-4
MINUS, DASH = "\N{MINUS SIGN}", "\N{EN DASH}"


class Row(NamedTuple):
    """A measure before and after; None where there is none."""

    name: str
    help: str
    before: float | None
    after: float | None
    unit: str = ""
    # -1 if lower is better, 1 if higher is, 0 if neither.
    better: int = 0
    # What to say in place of the change.
    note: str = ""


def rows(before: Examined, after: Examined, flips: int | None) -> list[Row]:
    """Return all measures of two meshes, of which the second one has so many new edges.

    `flips` is None if the vertices differ. Only of as many faces of the same vertices, as edge
    flips leave them, it is said what is better.
    """
    is_judged = flips is not None and len(before.faces) == len(after.faces)
    found = [*_rows(before, after, flips)]
    return found if is_judged else [row._replace(better=0) for row in found]


def _rows(before: Examined, after: Examined, flips: int | None) -> Iterator[Row]:
    def row(
        name: str,
        help: str,
        value: Callable[[Examined], float | None],
        unit: str = "",
        better: int = 0,
    ) -> Row:
        return Row(name, help, value(before), value(after), unit, better)

    yield row("Vertices", "", lambda mesh: len(mesh.vertices))
    yield row("Faces", "", lambda mesh: len(mesh.faces))
    if flips is not None:
        edges = len(after.edges)
        share = f"{PERCENT * flips / max(edges, 1):.3g} % of {written(edges)}"
        what = (
            "Edges that the mesh before does not have. The flips made may be more: an edge can be "
            "flipped several times, and back."
        )
        yield Row("Edges that differ", what, None, flips, note=share)
        what = "Mean angle between the normals of the vertices before and after."
        yield Row("Normal change", what, None, normal_change(before, after), "°")
    yield row(
        "Willmore energy W",
        "Sum over the vertices; 0 on spheres and planes.",
        lambda mesh: meaningful(mesh.totals.willmore_energy),
        better=-1,
    )
    yield row("Area", "In squared units of the coordinates.", lambda mesh: mesh.totals.area)
    yield row(
        "Absolute Gaussian curvature |K|",
        "Sum over the vertices of how far the angles are from 360°, in radians.",
        lambda mesh: meaningful(mesh.totals.absolute_gaussian_curvature),
        better=-1,
    )
    yield row(
        "Absolute mean curvature M",
        "Sum of dihedral angle times length over the edges.",
        lambda mesh: meaningful(mesh.totals.absolute_mean_curvature, math.sqrt(mesh.totals.area)),
        better=-1,
    )
    yield row("Mean shape", "1 is equilateral.", _mean, better=1)
    what = "So many triangles have a lower shape."
    yield row("Shape of the worst 1 %", what, _worst_shape, better=1)
    yield row("Smallest angle", "", _least, "°", better=1)
    yield row("Largest dihedral angle", "0° is flat.", _fold, "°", better=-1)
    yield row(
        "Faces that cut or touch others",
        "Counted exactly: faces with a point in common beside their common vertices and edges. "
        "MeshLab's filter rounds and leaves out neighbours, and may count fewer.",
        lambda mesh: mesh.cuts,
        better=-1,
    )


def normal_change(before: Examined, after: Examined) -> float:
    """The mean angle in degrees between the normals of vertices before and after."""
    used = before.valences > 0
    angles = between(before.normals[used], after.normals[used])
    return meaningful(float(np.nanmean(angles))) if np.isfinite(angles).any() else 0.0


def _mean(mesh: Examined) -> float | None:
    return float(mesh.shapes.mean()) if len(mesh.shapes) else None


def _worst_shape(mesh: Examined) -> float | None:
    return float(np.quantile(mesh.shapes, WORST_SHARE)) if len(mesh.shapes) else None


def _least(mesh: Examined) -> float | None:
    return meaningful(np.nanmin(mesh.angles)) if np.isfinite(mesh.angles).any() else None


def _fold(mesh: Examined) -> float | None:
    return meaningful(np.nanmax(mesh.dihedral)) if np.isfinite(mesh.dihedral).any() else None


# --- as HTML -------------------------------------------------------------------------------------


def table_rows(found: list[Row]) -> str:
    """The rows of a table, as HTML."""
    return "\n".join(_table_row(row) for row in found)


def _table_row(row: Row) -> str:
    name = escape(row.name)
    if row.help:
        name += f"<small>{escape(row.help)}</small>"
    cells = "".join(f"<td>{written(value, row.unit)}</td>" for value in (row.before, row.after))
    return f'<tr><th scope="row">{name}</th>{cells}<td>{change(row)}</td></tr>'


def change(row: Row) -> str:
    """How much a measure changed, as HTML; good or bad is said in words, too."""
    if row.note:
        return escape(row.note)
    if row.before is None or row.after is None:
        return ""
    difference = row.after - row.before
    if not math.isfinite(difference):
        return ""
    if abs(difference) <= NOISE * max(abs(row.before), abs(row.after)):
        return "same"
    sign = "+" if difference > 0.0 else MINUS
    if (row.before and not float(row.before).is_integer()) or abs(row.before) > PERCENT:
        text = f"{sign}{PERCENT * abs(difference / row.before):.3g} %"
    else:
        text = f"{sign}{written(abs(difference), row.unit)}"
    if not row.better:
        return text
    is_good = difference * row.better > 0.0
    kind, word = ("good", "better") if is_good else ("bad", "worse")
    return f'<span class="{kind}">{text} {word}</span>'


def written(value: Any, unit: str = "") -> str:
    """A number as people read it; a dash for None."""
    if value is None:
        return DASH
    if value < 0.0:
        return f"{MINUS}{written(-value, unit)}"
    if float(value).is_integer() and abs(value) < LARGE:
        return f"{int(value):,}{unit}"
    if not math.isfinite(value):
        return str(value)
    if not SMALL <= abs(value) < LARGE:
        return f"{value:.{DIGITS - 1}e}{unit}"
    before_point = len(str(int(abs(value)))) if abs(value) >= 1.0 else 0
    return f"{value:,.{max(DIGITS - before_point, 0)}f}{unit}"


def of_result(result: FlipResult) -> list[tuple[str, str]]:
    """What a result of flips says beside its mesh: names and texts."""
    passes = "; ".join(
        f"{one.energy} by {one.search}: {one.flips:,} flips" for one in result.passes
    )
    return [
        ("Passes", passes),
        ("Flips made", f"{result.flips:,}"),
        ("Deviation at most", f"{result.deviation:.4g}"),
        ("Ended", result.reason),
    ]
