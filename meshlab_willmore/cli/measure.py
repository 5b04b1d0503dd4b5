"""`meshlab-willmore measure`: the totals of meshes."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..batch.steplog import for_json
from ..machine import stops_all
from ..mesh_files import loading
from ..mesh_files.paths import find_inputs
from ..messages import WrongUse, one_line, reason
from . import progress
from .arguments import json_option
from .errors import debug_option, failure_of, is_debug
from .text import fitted, how_many_failed, table

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
@json_option
@debug_option
def command(files: tuple[str, ...], as_json: bool) -> None:
    """Print Willmore energy, area and curvatures of meshes as a table.

    If a file can't be measured, the error is printed, the others are still measured, and the exit
    code is 1. Notes say what was lost in loading.
    """
    inputs = find_inputs(files)
    problems = [one_line(problem) for _, problem in inputs if problem is not None]
    if len(problems) == len(inputs):
        raise WrongUse("; ".join(problems))
    for text in problems:
        click.echo(f"Error: {text}", err=True)
    measured = _measure_all([path for path, problem in inputs if problem is None])
    if as_json:
        click.echo(json.dumps([for_json(row) for row in measured], indent=2))
    elif measured:
        click.echo(_table(measured))
    if not measured and len(inputs) == 1:
        click.get_current_context().exit(1)
    if len(measured) < len(inputs):
        raise click.ClickException(how_many_failed(len(inputs) - len(measured), len(inputs)))


def _measure_all(paths: list[Path]) -> list[dict[str, Any]]:
    """The totals of each file that can be measured; errors of the others are printed."""
    rows = []
    with progress.shown("measure", len(paths)) as status:
        for path in paths:
            status.next(str(path))
            try:
                ms = loading.loaded(path)
                with progress.with_details(status):
                    rows.append(_measure(ms, path))
            except Exception as error:
                if stops_all(error) or is_debug():
                    raise
                click.echo(f"Error: {failure_of(str(path), error, reason)}", err=True)
    return rows


def _measure(ms: pymeshlab.MeshSet, path: Path) -> dict[str, Any]:
    totals = ms.apply_filter("get_willmore_measures")
    mesh = ms.current_mesh()
    sizes = {"vertices": mesh.vertex_number(), "faces": mesh.face_number()}
    return {"file": str(path), **sizes, **totals}


def _table(measured: Iterable[dict[str, Any]]) -> str:
    from ..report.stages import significant

    rows: list[tuple[str, ...]] = [HEADER]
    for row in measured:
        sizes = (row["file"], str(row["vertices"]), str(row["faces"]))
        rows.append((*sizes, *(significant(row[name]) for name in MEASURES)))
    return table(fitted(rows), LEGEND)
