"""`meshlab-willmore measure`: the totals of meshes."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..mesh_files.paths import find_inputs
from ..messages import WrongUse, one_line
from .arguments import kept_options
from .batch import RECORDS, Plan, batch_options, planned, run_jobs
from .completion import files
from .errors import debug_option
from .scripts import STANDARD_STREAM
from .text import fitted, table

if TYPE_CHECKING:
    from ..batch.jobs import Job
    from ..batch.records import Result

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
    "W: Willmore energy. K: Gaussian curvature, |K|: the sum of its absolute values.\n"
    "M: absolute mean curvature, the sum of angle times length. Angles in radians."
)


class _OptionalFile(click.Command):
    """A command whose ``--json`` has a value only if that is a file of records."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Give ``--json`` its value."""
        end = args.index("--") if "--" in args else len(args)
        rest: list[str] = []
        for place, word in enumerate(args[:end]):
            before, following = ["", *args][place], [*args, ""][place + 1]
            if word == "--json" and not following.endswith(RECORDS):
                rest.append(f"--json={STANDARD_STREAM}")
            elif (before, word) != ("--json", STANDARD_STREAM):
                rest.append(word)
        return super().parse_args(ctx, [*rest, *args[end:]])


@click.command(
    "measure", cls=_OptionalFile, short_help="Print the totals of meshes.", epilog=EXAMPLES
)
@click.argument("files", metavar="IN...", nargs=-1, required=True, shell_complete=files)
@click.option(
    "--json",
    "json_file",
    metavar="[FILE.jsonl]",
    shell_complete=files,
    help="Print JSON; or write a line of it into the file for each mesh as it ends.",
)
@batch_options
@debug_option
def command(files: tuple[str, ...], json_file: str | None) -> None:
    """Print Willmore energy, area and curvatures of meshes as a table.

    Several meshes are a batch, as in 'run'. If a file can't be measured, the error is printed, the
    others are still measured, and the exit code is 1. Notes say what was lost in loading.
    """
    inputs = find_inputs(files)
    problems = [one_line(problem) for _, problem in inputs if problem is not None]
    if len(problems) == len(inputs):
        raise WrongUse("; ".join(problems))
    as_json = json_file == STANDARD_STREAM
    if json_file is not None and not as_json:
        kept_options()["log"] = Path(json_file)
    measured: list[dict[str, Any]] = []
    try:
        _measure(planned(inputs, (), False, False), measured)
    finally:
        if as_json:
            click.echo(json.dumps(measured, indent=2))
        elif measured:
            click.echo(_table(measured))


def _measure(plan: Plan, measured: list[dict[str, Any]]) -> None:
    """Measure meshes, and add a row for each to a list, in the order of the jobs."""
    from ..batch.recipe import Recipe

    def keep(result: Result, job: Job) -> str:
        measured.append({"file": job.name, **(result.before or {})})
        return ""

    try:
        run_jobs(Recipe((), "measure", must_be_measured=True), plan, keep, is_listed=True)
    finally:
        order = {job.name: place for place, job in enumerate(plan.jobs)}
        measured.sort(key=lambda row: order[row["file"]])


def _table(measured: Iterable[dict[str, Any]]) -> str:
    from ..report.stages import significant

    rows: list[tuple[str, ...]] = [HEADER]
    for row in measured:
        sizes = (row["file"], str(row["vertices"]), str(row["faces"]))
        # Records have null for infinity.
        values = (math.inf if row[name] is None else row[name] for name in MEASURES)
        rows.append((*sizes, *map(significant, values)))
    return table(fitted(rows), LEGEND)
