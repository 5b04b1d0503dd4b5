"""`meshlab-willmore measure`: the totals of meshes."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from . import progress
from .columns import fitted, in_columns, width
from .errors import WrongUse, debug_option, one_line, reason, stops_all, told_of
from .inputs import asked_for, how_many_failed, loaded

if TYPE_CHECKING:
    import pymeshlab

EXAMPLES = """\b
Examples:
  meshlab-willmore measure scan.ply
  meshlab-willmore measure before.ply after.ply
  meshlab-willmore measure 'out/*.ply' --json > measures.json
"""
HEADER = ("file", "vertices", "faces", "W", "area", "K", "|K|", "M")
MEASURES = (
    "willmore_energy",
    "area",
    "gaussian_curvature",
    "absolute_gaussian_curvature",
    "absolute_mean_curvature",
)
LEGEND = (
    "W: Willmore energy. K and |K|: Gaussian curvature and the sum of its absolute values.\n"
    "M: absolute mean curvature, the sum of angle times length. Angles are in radians."
)


@click.command("measure", short_help="Print the totals of meshes.", epilog=EXAMPLES)
@click.argument("files", metavar="IN...", nargs=-1, required=True)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON list for machines.")
@debug_option
def command(files: tuple[str, ...], as_json: bool) -> None:
    """Print Willmore energy, area and curvatures of meshes as a table.

    A file that can't be measured is named on the standard error, and so is what loading leaves out;
    the others are measured, and the exit code is 1 in the end.
    """
    paths, count = _checked(files)
    measured = _measure_all(paths)
    if as_json:
        click.echo(json.dumps([_for_json(row) for row in measured], indent=2))
    elif measured:
        click.echo(_table(measured))
    if not measured and count == 1:
        click.get_current_context().exit(1)
    if len(measured) < count:
        raise click.ClickException(how_many_failed(count - len(measured), count))


def _checked(names: Iterable[str]) -> tuple[list[Path], int]:
    """The files that can be tried, and how many were asked for; what is wrong with others is said.

    Raises
    ------
    WrongUse
        If there is nothing to try.
    """
    found = asked_for(names)
    paths = [path for path, refusal in found if refusal is None]
    wrong = [one_line(refusal) for _, refusal in found if refusal is not None]
    if not paths:
        raise WrongUse("; ".join(wrong))
    for text in wrong:
        click.echo(f"Error: {text}", err=True)
    return paths, len(found)


def _measure_all(paths: Sequence[Path]) -> list[dict[str, Any]]:
    with progress.shown("measure", len(paths)) as status:
        rows = []
        for path in paths:
            status.next(str(path))
            rows.append(_measured_or_told(path, status))
    return [row for row in rows if row]


def _measured_or_told(path: Path, status: progress.Status) -> dict[str, Any]:
    """The totals of one file; nothing if it can't be measured, which is said."""
    try:
        ms = loaded(path)
        with progress.with_details(status):
            return _measured(ms, path)
    except Exception as error:
        if stops_all(error) or click.get_current_context().meta.get("debug"):
            raise
        click.echo(f"Error: {told_of(str(path), error, reason)}", err=True)
        return {}


def _measured(ms: pymeshlab.MeshSet, path: Path) -> dict[str, Any]:
    totals = ms.apply_filter("get_willmore_measures")
    mesh = ms.current_mesh()
    sizes = {"vertices": mesh.vertex_number(), "faces": mesh.face_number()}
    return {"file": str(path), **sizes, **totals}


def _for_json(row: dict[str, Any]) -> dict[str, Any]:
    """JSON has no word for what is not a finite number."""
    return {
        key: None if isinstance(value, float) and not math.isfinite(value) else value
        for key, value in row.items()
    }


def _table(measured: Iterable[dict[str, Any]]) -> str:
    from ..report.table import significant

    rows: list[tuple[str, ...]] = [HEADER]
    for row in measured:
        sizes = (row["file"], str(row["vertices"]), str(row["faces"]))
        rows.append((*sizes, *(significant(row[name]) for name in MEASURES)))
    lines = in_columns(fitted(rows)).splitlines()
    rule = "-" * max(map(width, lines))
    return "\n".join([lines[0], rule, *lines[1:], rule, LEGEND])
