"""`meshlab-willmore compare`: energies, searches and MeshLab's own flips side by side."""

from __future__ import annotations

import json
import math
import threading
from collections.abc import Sequence
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from .. import quick_start
from ..options import ALLOWLOSS, ENERGY, SEARCH, SELECTION
from . import progress, references, trials
from .columns import in_columns
from .errors import debug_option, wrong_use
from .flip import check_options, filter_options, only
from .inputs import expand

if TYPE_CHECKING:
    from ..compare.contenders import Contender

EXAMPLES = """\b
Examples:
  meshlab-willmore compare scan.ply
  meshlab-willmore compare torus.ply --reference torus:3,1
  meshlab-willmore compare scan.ply --search greedy --energy willmore --timeout 10
  meshlab-willmore compare rough.ply --reference fine.ply --no-peers --json > rows.json
"""
TIMEOUT = 60.0
# These two choose the rows.
_ROWS = (SEARCH, ENERGY)
# These are the same for all rows.
_NOT_SHARED = {option.name for option in (*_ROWS, SELECTION, ALLOWLOSS)}


class Column(NamedTuple):
    """A column of numbers: its head, its key, and how a number is written."""

    head: str
    key: str
    written: str = ""


COLUMNS = (
    Column("flips", "flips", "d"),
    Column("W", "willmore_energy"),
    Column("area", "area"),
    Column("|K|", "absolute_gaussian_curvature"),
    Column("M", "absolute_mean_curvature"),
    Column("worst", "worst_shape", ".3f"),
    Column("mean", "mean_shape", ".3f"),
    Column("cuts", "self_intersecting", "d"),
)
REFERENCED = (Column("normal", "normal_error", ".2f"), Column("distance", "distance", ".3g"))
LEGEND = (
    "flips: edges that the initial mesh does not have. W: Willmore energy.\n"
    "|K|: absolute Gaussian curvature. M: absolute mean curvature, the sum of angle times length.\n"
    "worst, mean: shape of the triangles, an equilateral one has 1; 1 % of them are below worst.\n"
    "cuts: faces that cut another. seconds: the filter alone, compiled and loaded before."
)
REFERENCE_LEGEND = (
    "normal: mean angle between the normals of faces and of the reference, in degrees.\n"
    "distance: root mean square of the distance to the reference."
)


class CompareCommand(click.Command):
    """A command with the flip filter's parameters as options, for all rows with that filter."""

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        """The command's own parameters, and the filter's before its options."""
        own = super().get_params(ctx)
        arguments = [p for p in own if isinstance(p, click.Argument)]
        options = [p for p in own if p not in arguments]
        return [*arguments, *_row_options(), *_shared_options(), *options]


@cache
def _row_options() -> tuple[click.Option, ...]:
    return tuple(
        click.Option(
            [f"--{option.name}"],
            multiple=True,
            type=click.Choice(option.choices),
            help=f"Only rows of this {option.name}; can be given several times.",
        )
        for option in _ROWS
    )


def _shared_options() -> list[click.Option]:
    return [option for option in filter_options() if option.name not in _NOT_SHARED]


def _time_limit(_: click.Context, __: click.Parameter, seconds: float) -> float:
    """The seconds, unless they are none that a timer takes."""
    if not seconds <= threading.TIMEOUT_MAX:
        raise wrong_use(f"--timeout: {seconds:g} is no number of seconds that can be waited")
    return seconds


@click.command(
    "compare",
    cls=CompareCommand,
    short_help="Compare energies, searches and MeshLab's flips.",
    epilog=EXAMPLES,
)
@click.argument("source", metavar="IN")
@click.option(
    "--reference",
    metavar="SURFACE",
    help="What the mesh should be like: a file with a mesh, sphere, sphere:RADIUS or "
    "torus:RING,TUBE (radii; around the origin, the torus' axis is z). Adds the mean angle between "
    "the normals of faces and those of the reference nearest to their centroids, and the root mean "
    "square distance. Both surfaces must look to the same side.",
)
@click.option(
    "--timeout",
    type=click.FloatRange(min=0.0, min_open=True),
    callback=_time_limit,
    default=TIMEOUT,
    show_default=True,
    metavar="SECONDS",
    help="The longest that a filter may run.",
)
@click.option(
    "--peers/--no-peers", default=True, show_default=True, help="Rows of MeshLab's own filters."
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON list for machines.")
@debug_option
def command(
    source: str,
    reference: str | None,
    timeout: float,
    peers: bool,
    as_json: bool,
    **given: Any,
) -> None:
    """Flip the edges of IN with all energies and searches, and with MeshLab's own filters.

    A table tells what each made of the mesh. Nothing is saved. Each row runs in a process of its
    own, one after another: a filter that takes too long is killed, one that crashes harms no other.
    A row that fails is named on the standard error, and the exit code is 1 in the end.
    """
    path = only(expand([source]), source, "compare takes one")
    if reference is not None:
        references.check(reference)
    rows = _contenders(given, peers)
    # Each row would fail at variables that are wrong, and could not say why.
    quick_start.import_numba()
    task = trials.Task(str(path), reference, timeout)
    outcomes = _outcomes(task, rows)
    if as_json:
        pairs = zip(rows, outcomes, strict=True)
        click.echo(json.dumps([_for_json(*pair) for pair in pairs], indent=2))
    else:
        click.echo(_table(task, rows, outcomes))
    if any(outcome.error for outcome in outcomes):
        click.get_current_context().exit(1)


def _contenders(given: dict[str, Any], peers: bool) -> list[Contender]:
    from ..compare import contenders

    searches, energies = (
        dict.fromkeys(given.pop(option.name) or option.choices) for option in _ROWS
    )
    shared = {name: value for name, value in given.items() if value is not None}
    check_options(shared)
    own = contenders.ours(searches, energies, shared)
    return [contenders.INITIAL, *own, *(contenders.PEERS if peers else ())]


def _outcomes(task: trials.Task, rows: Sequence[Contender]) -> list[trials.Outcome]:
    """Run the rows one by one, with a bar on a terminal, and say which failed.

    Raises
    ------
    ClickException
        If not even the mesh as it is can be measured.
    """
    outcomes: list[trials.Outcome] = []
    with progress.shown(Path(task.source).name, len(rows)) as status:
        for contender in rows:
            status.next(f"{contender.name}: {trials.READING}")
            outcomes.append(trials.run(task, contender, partial(_show, status, contender.name)))
            if outcomes[0].error:
                break
    _tell(task, rows, outcomes)
    return outcomes


def _show(status: progress.Status, name: str, word: str) -> None:
    status.begin(f"{name}: {word}")


def _tell(task: trials.Task, rows: Sequence[Contender], outcomes: Sequence[trials.Outcome]) -> None:
    initial = outcomes[0]
    debug = click.get_current_context().meta.get("debug")
    for contender, outcome in zip(rows, outcomes, strict=False):
        if outcome.trace and debug:
            click.echo(outcome.trace, err=True)
        if outcome.error and not initial.error:
            click.echo(f"Error: {contender.name}: {outcome.error}", err=True)
    if initial.error:
        names = (task.source, task.reference or task.source)
        if initial.of_machine or any(name in initial.error for name in names):
            raise click.ClickException(initial.error)
        raise click.ClickException(f"{task.source}: {initial.error}")


def _for_json(contender: Contender, outcome: trials.Outcome) -> dict[str, Any]:
    """One row; what is unknown, or no finite number, is null."""
    told = {"seconds": outcome.seconds, "timed_out": outcome.timed_out, "error": outcome.error}
    row = {**contender._asdict(), **_numbers(outcome), **told}
    return {
        key: None if isinstance(value, float) and not math.isfinite(value) else value
        for key, value in row.items()
    }


def _numbers(outcome: trials.Outcome) -> dict[str, Any]:
    """The number of each column."""
    return {
        column.key: (outcome.figures or {}).get(column.key) for column in (*COLUMNS, *REFERENCED)
    }


def _table(task: trials.Task, rows: Sequence[Contender], outcomes: Sequence[trials.Outcome]) -> str:
    columns = (*COLUMNS, *REFERENCED) if task.reference else COLUMNS
    cells = [
        (contender.name, *(_cell(column, outcome) for column in columns), _time(task, outcome))
        for contender, outcome in zip(rows, outcomes, strict=True)
    ]
    header = ("", *(column.head for column in columns), "seconds")
    lines = in_columns([header, *cells]).splitlines()
    rule = "-" * max(map(len, lines))
    legends = (LEGEND, REFERENCE_LEGEND) if task.reference else (LEGEND,)
    return "\n".join([lines[0], rule, *lines[1:], rule, *legends])


def _cell(column: Column, outcome: trials.Outcome) -> str:
    """A number; nothing for what is unknown."""
    from ..report.table import significant

    value = _numbers(outcome)[column.key]
    if value is None or math.isnan(value):
        return ""
    return format(value, column.written) if column.written else significant(value)


def _time(task: trials.Task, outcome: trials.Outcome) -> str:
    if outcome.error:
        return "failed"
    if outcome.timed_out:
        return f"> {task.timeout:g}"
    return "" if outcome.seconds is None else f"{outcome.seconds:.2f}"
