"""`meshlab-willmore compare`: presets, energies, searches and MeshLab's own flips side by side."""

from __future__ import annotations

import json
import math
import re
import threading
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from .. import numba_settings
from ..batch.jobs import Reports, check_apart
from ..batch.steplog import for_json
from ..files import write
from ..mesh_files.paths import check_place, only_input
from ..messages import WrongUse
from ..options import ALLOWLOSS, ENERGY, PRESET, SEARCH, SELECTION, Option
from . import compare_row, progress
from .arguments import (
    Choice,
    check_flip_options,
    flip_options,
    force_option,
    hyphened,
    json_option,
)
from .batch import check_reports, report_option
from .compare_row import Comparison, Outcome, check_reference
from .completion import files
from .errors import debug_option, is_debug
from .text import wrapped_table

if TYPE_CHECKING:
    from ..compare.rows import Row

EXAMPLES = """\b
Examples:
  meshlab-willmore compare scan.ply
  meshlab-willmore compare scan.ply --report presets.html
  meshlab-willmore compare torus.ply --reference torus:3,1
  meshlab-willmore compare scan.ply --search variable-depth --timeout 10
  meshlab-willmore compare a.ply --reference fine.ply --json > rows.json
"""
TIMEOUT = 60.0
# These choose the rows.
_ROWS = (SEARCH, ENERGY)
# No options of this command for all rows: what chooses these, and what is the same in all.
_NOT_SHARED = {option.name for option in (PRESET, *_ROWS, SELECTION, ALLOWLOSS)}


# The first one is what the other rows show.
_PRESETS = PRESET.choices[1:]


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
    "|K|: absolute Gaussian curvature.\n"
    "M: absolute mean curvature, the sum of angle times length.\n"
    "worst, mean: shape of the triangles, 1: equilateral; 1 % are below worst.\n"
    "cuts: faces that cut another, as MeshLab's filter counts them.\n"
    "seconds: the filter alone, compiled and loaded before."
)
REFERENCE_LEGEND = (
    "normal: mean angle between normals of faces and of the reference, in degrees.\n"
    "distance: root mean square of the distance to the reference."
)


def _row_option(option: Option) -> Callable[..., Any]:
    return click.option(
        f"--{option.name}",
        multiple=True,
        type=Choice(option.choices),
        metavar="NAME",
        help=f"Only rows of this {option.name}: {', '.join(map(hyphened, option.choices))}. Can be "
        "given several times.",
    )


def _time_limit(_: click.Context, __: click.Parameter, seconds: float) -> float:
    """The seconds, unless they are too many for a timer."""
    if not seconds <= threading.TIMEOUT_MAX:
        raise WrongUse(f"--timeout: {seconds:g} is no number of seconds that can be waited")
    return seconds


@click.command(
    "compare",
    short_help="Compare presets, energies, searches and MeshLab's flips.",
    epilog=EXAMPLES,
)
@click.argument("source", metavar="IN", shell_complete=files)
@_row_option(PRESET)
@_row_option(SEARCH)
@_row_option(ENERGY)
@flip_options(leave_out=_NOT_SHARED)
@click.option(
    "--reference",
    metavar="SURFACE",
    shell_complete=files,
    help="The surface that the mesh approximates: a mesh file, sphere, sphere:RADIUS or "
    "torus:RING,TUBE (radii; around the origin, the torus' axis is z). Adds the mean angle between "
    "the normals of faces and those of the reference nearest to their centroids, and the root mean "
    "square distance. Both surfaces must have the same orientation.",
)
@click.option(
    "--timeout",
    type=click.FloatRange(min=0.0, min_open=True),
    callback=_time_limit,
    default=TIMEOUT,
    show_default=True,
    metavar="SECONDS",
    help="The longest time that a filter may take.",
)
@click.option(
    "--peers/--no-peers", default=True, show_default=True, help="Rows of MeshLab's own filters."
)
@json_option
@report_option
@force_option
@debug_option
def command(
    source: str,
    reference: str | None,
    timeout: float,
    peers: bool,
    as_json: bool,
    force: bool,
    **given: Any,
) -> None:
    """Flip the edges of IN with all presets, energies and searches, and with MeshLab's own filters.

    The result is a table; no mesh is saved. Each row runs in a process of its own, one after
    another: a filter that takes too long is stopped, one that crashes does not stop the others. If
    a row fails, its error is printed, and the exit code is 1.
    """
    path = only_input(source, "compare takes one")
    if reference is not None:
        check_reference(reference)
    rows = _rows(given, peers)
    # With wrong variables each row would fail, without a clear reason.
    numba_settings.import_numba()
    reports = check_reports(is_several=True, force=force)
    comparison = Comparison(str(path), reference, timeout, reports.table is not None)
    pages = _pages_of(reports, path, rows, force)
    outcomes = _outcomes(comparison, rows, pages)
    if reports.table is not None:
        _write_table(reports.table, comparison, rows, outcomes, pages)
    if as_json:
        pairs = zip(rows, outcomes, strict=True)
        click.echo(json.dumps([_json_row(*pair) for pair in pairs], indent=2))
    else:
        click.echo(_table(comparison, rows, outcomes))
    if any(outcome.error for outcome in outcomes):
        click.get_current_context().exit(1)


def _rows(given: dict[str, Any], peers: bool) -> list[Row]:
    from ..compare.rows import INITIAL, PEERS, own_rows, preset_rows

    presets = dict.fromkeys(given.pop(PRESET.name))
    chosen = [dict.fromkeys(given.pop(option.name)) for option in _ROWS]
    shared = {name: value for name, value in given.items() if value is not None}
    check_flip_options(shared)
    rows = [INITIAL]
    # What is not asked for is left out, unless nothing is.
    if not any(chosen):
        rows += preset_rows(presets or _PRESETS, shared)
    elif presets:
        rows += preset_rows(presets, shared)
    if any(chosen) or not presets:
        searches, energies = (
            wanted or option.choices for wanted, option in zip(chosen, _ROWS, strict=True)
        )
        rows += own_rows(searches, energies, shared)
    return [*rows, *(PEERS if peers else ())]


def _pages_of(
    reports: Reports, source: Path, rows: Sequence[Row], force: bool
) -> list[Path | None]:
    """The pages of the rows; raises `WrongUse` if one can't be written, or has another's name."""
    found: list[Path | None] = []
    uses = [(reports.table, "the table")]
    for number, row in enumerate(rows):
        page = None
        if reports.page is not None and row.filter:
            name = re.sub(r"\W+", "-", row.name).strip("-")
            page = reports.page.of(source.with_name(name + source.suffix), number).path
            check_place(page, force, "{name}.html")
        found.append(page)
        uses.append((page, f"the page of {row.name}"))
    check_apart(reversed(uses), "use another name, with {name} for pages")
    return found


def _write_table(
    path: Path,
    comparison: Comparison,
    rows: Sequence[Row],
    outcomes: Sequence[Outcome],
    pages: Sequence[Path | None],
) -> None:
    """Write the report page of the comparison."""
    from ..report.table import Entry, link, table_page

    columns = _columns(comparison)
    entries = []
    for row, outcome, page in zip(rows, outcomes, pages, strict=True):
        values = {column.head: _numbers(outcome)[column.key] for column in columns}
        too_long = f"not finished within {comparison.timeout:g} s" if outcome.timed_out else ""
        problem = outcome.error or too_long
        entries.append(
            Entry(
                row.name,
                "failed" if outcome.error else "too long" if too_long else "done",
                not problem,
                (problem,) if problem else (),
                outcome.picture,
                link(path, page),
                {**values, "seconds": outcome.seconds},
            )
        )
    heads = (*(column.head for column in columns), "seconds")
    title = Path(comparison.source).name
    text = table_page(title, "Comparison of flips", heads, entries, _legend(comparison))
    write(path, text.encode())


def _outcomes(
    comparison: Comparison, rows: Sequence[Row], pages: Sequence[Path | None]
) -> list[Outcome]:
    """Compute the rows one by one, and print the errors of those that failed.

    Raises `ClickException` if not even the initial mesh can be measured.
    """
    outcomes: list[Outcome] = []
    with progress.shown(Path(comparison.source).name, len(rows)) as status:
        for row, page in zip(rows, pages, strict=True):
            status.next(f"{row.name}: {compare_row.READING}")
            say = partial(_show_phase, status, row.name)
            outcomes.append(compare_row.run(comparison, row, say, page))
            if outcomes[0].error:
                break
    for row, outcome in zip(rows, outcomes, strict=False):
        if outcome.trace and is_debug():
            click.echo(outcome.trace, err=True)
        if outcome.error and not outcomes[0].error:
            click.echo(f"Error: {row.name}: {outcome.error}", err=True)
    if error := outcomes[0].error:
        names = (comparison.source, comparison.reference or comparison.source)
        is_named = outcomes[0].of_machine or any(name in error for name in names)
        raise click.ClickException(error if is_named else f"{comparison.source}: {error}")
    return outcomes


def _show_phase(status: progress.Status, name: str, phase: str) -> None:
    status.begin(f"{name}: {phase}")


def _json_row(row: Row, outcome: Outcome) -> dict[str, Any]:
    """One row, with null for what is unknown."""
    ending = {"seconds": outcome.seconds, "timed_out": outcome.timed_out, "error": outcome.error}
    return for_json({**row._asdict(), **_numbers(outcome), **ending})


def _numbers(outcome: Outcome) -> dict[str, Any]:
    """The number of each column."""
    return {
        column.key: (outcome.quality or {}).get(column.key) for column in (*COLUMNS, *REFERENCED)
    }


def _table(comparison: Comparison, rows: Sequence[Row], outcomes: Sequence[Outcome]) -> str:
    columns = _columns(comparison)
    header = ("", *(column.head for column in columns), "seconds")
    cells = [
        (
            row.name,
            *(_cell(column, outcome) for column in columns),
            _time(comparison, outcome),
        )
        for row, outcome in zip(rows, outcomes, strict=True)
    ]
    return wrapped_table([header, *cells], _legend(comparison))


def _columns(comparison: Comparison) -> tuple[Column, ...]:
    return (*COLUMNS, *REFERENCED) if comparison.reference else COLUMNS


def _legend(comparison: Comparison) -> str:
    return f"{LEGEND}\n{REFERENCE_LEGEND}" if comparison.reference else LEGEND


def _cell(column: Column, outcome: Outcome) -> str:
    """A number; empty if it is unknown."""
    from ..report.stages import significant

    value = _numbers(outcome)[column.key]
    if value is None or math.isnan(value):
        return ""
    return format(value, column.written) if column.written else significant(value)


def _time(comparison: Comparison, outcome: Outcome) -> str:
    if outcome.error:
        return "failed"
    if outcome.timed_out:
        return f"> {comparison.timeout:g}"
    return "" if outcome.seconds is None else f"{outcome.seconds:.2f}"
