"""The jobs of `run`, `flip` and `measure`: options of batches and reports, and what is printed."""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from ..batch.jobs import Job, Reports, check_apart, plan, reports_of
from ..batch.shards import Shard, shard_of
from ..batch.steplog import log
from ..batch.summary import Summary, duration, failure
from ..files import STANDARD_OUTPUT
from ..messages import WrongUse, note
from . import progress
from .arguments import kept_option, kept_options
from .completion import files
from .errors import is_debug
from .one_job import run_here
from .scripts import STANDARD_STREAM
from .text import how_many_failed, in_window, printable

if TYPE_CHECKING:
    from ..batch.recipe import Recipe
    from ..batch.records import Result
    from ..batch.runner import Batch
    from ..mesh_files.paths import Input, Output

_SIZE = re.compile(r"(\d+(?:\.\d+)?)\s*([KMGT]?)(?:i?B)?", re.IGNORECASE)
_UNITS = {"": 0, "K": 1, "M": 2, "G": 3, "T": 4}
_KIB = 1024
# The ending of files of records.
RECORDS = ".jsonl"
# The endings of report pages.
_PAGES = (".html", ".htm")
# Between looks at what workers do.
_SECONDS = 0.5


def _bytes(text: str) -> int:
    from ..batch.runner import LEAST_MEMORY

    found = _SIZE.fullmatch(text.strip())
    if not found:
        raise WrongUse(f"--memory {text}: it must be a size such as 4G or 500M")
    size = int(float(found[1]) * _KIB ** _UNITS[found[2].upper()])
    if size < LEAST_MEMORY:
        raise WrongUse(f"--memory {text}: a worker needs {LEAST_MEMORY // _KIB**2}M or more")
    return size


_OPTIONS = (
    kept_option("--workers", type=click.IntRange(min=1), metavar="N", help="Meshes at a time."),
    kept_option(
        "--timeout",
        type=click.FloatRange(min=0.0, min_open=True),
        metavar="SECONDS",
        help="The longest time for a mesh; then its worker is killed.",
    ),
    kept_option(
        "--memory",
        metavar="SIZE",
        help="The most memory for a worker, such as 4G (Linux).",
    ),
    kept_option(
        "--retries", type=click.IntRange(min=0), metavar="N", help="Try a failed mesh N times more."
    ),
    kept_option(
        "--resume",
        is_flag=True,
        help="Go on with the batch in the file of --json: skip what it has.",
    ),
    kept_option(
        "--retry-failed", is_flag=True, help="As --resume, and do again what failed there."
    ),
    kept_option(
        "--stop/--keep-going",
        default=False,
        help="Stop at the first input that fails, or go on with the others (the default).",
    ),
    kept_option(
        "--shard",
        metavar="I/N",
        help="Only share I of N of the inputs; auto reads SLURM's or Kubernetes' variables.",
    ),
    kept_option(
        "--scheduler", metavar="ADDRESS", help="Run on the Dask cluster of this scheduler."
    ),
    kept_option("--summary", is_flag=True, help="Print a summary; on a terminal it comes anyway."),
)
# With any other option a single job is a batch, too.
_OF_ONE_JOB = {"debug", "reports", "stop", "verbose"}
json_file_option = kept_option(
    "--json",
    "log",
    type=click.Path(path_type=Path),
    metavar="FILE.jsonl",
    help="Write a line of JSON for each mesh as it ends: outcome, time, memory, measures. - prints "
    "these lines, and no others.",
)
report_option = kept_option(
    "--report",
    "reports",
    multiple=True,
    metavar="PAGE.html",
    shell_complete=files,
    help="Write a page for a browser: before and after in 3D and in numbers. For several meshes it "
    "is a table; with a placeholder, as in 'pages/{name}.html', each mesh has a page. Can be given "
    "twice, for both.",
)


def batch_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options of a batch, which are kept."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


class Plan(NamedTuple):
    """The jobs of a command, and the page with the table of all."""

    jobs: list[Job]
    table: Path | None

    def own_files(self) -> list[tuple[Path | None, str]]:
        """The files of the batch itself, and what they are; the standard output is none."""
        records = _records_file()
        file = None if records == STANDARD_OUTPUT else records
        return [(self.table, "the table of --report"), (file, "the records of --json")]


def _is_resumed() -> bool:
    """Whether an earlier batch goes on, whose outputs exist."""
    return bool(kept_options().keys() & {"resume", "retry_failed"})


def _records_file() -> Path | None:
    """The file of ``--json``, which may be the standard output."""
    file = kept_options().get("log")
    return STANDARD_OUTPUT if str(file) == STANDARD_STREAM else file


def check_reports(
    is_several: bool, force: bool, shard: Shard | None = None, is_continued: bool = False
) -> Reports:
    """The pages that were asked for; see `meshlab_willmore.batch.jobs.reports_of`."""
    names = kept_options().get("reports", ())
    for name in names:
        if not name.lower().endswith(_PAGES):
            raise WrongUse(f"--report {name}: a page needs a name such as report.html")
    return reports_of(names, is_several, force, shard, is_continued)


def planned(
    inputs: Sequence[Input],
    outputs: Sequence[Output],
    layers: bool,
    force: bool,
    dry_run: bool = False,
) -> Plan:
    """The jobs of a command, or those of its shard; see `meshlab_willmore.batch.jobs.plan`."""
    shard = shard_of(kept_options()["shard"]) if "shard" in kept_options() else None
    reports = check_reports(len(inputs) > 1 and not layers, force, shard, _is_resumed())
    if reports != Reports() and not inputs:
        raise WrongUse("--report shows a mesh before and after, and there is no input")
    jobs = plan(
        inputs, outputs, layers, force, shard, reports.page, not dry_run, is_continued=_is_resumed()
    )
    found = Plan(jobs, reports.table)
    check_apart([*(use for job in jobs for use in job.uses), *found.own_files()])
    return found


def run_jobs(
    recipe: Recipe,
    plan: Plan,
    line_of: Callable[[Result, Job], str],
    force: bool = False,
    is_listed: bool = False,
    has_script: bool = False,
) -> None:
    """Do jobs, one in this process or several as a batch; print a line for each mesh.

    The error of one job names its input, unless it is of a script (`has_script`). A batch prints
    errors, and the summary where it is wanted; on a terminal it leaves out the lines of meshes that
    are done, unless they are what is wanted (`is_listed`). It raises `ClickException` in the end if
    an input failed.
    """
    is_one = len(plan.jobs) == 1 and plan.table is None
    if not is_one or kept_options().keys() - _OF_ONE_JOB:
        _run_batch(recipe, plan, line_of, force, is_listed)
        return
    (job,) = plan.jobs
    if line := line_of(run_here(recipe, job, force, has_script), job):
        click.echo(line)


def _run_batch(
    recipe: Recipe,
    plan: Plan,
    line_of: Callable[[Result, Job], str],
    force: bool,
    is_listed: bool,
) -> None:
    from ..batch.runner import Batch

    given, jobs = kept_options(), plan.jobs
    if "verbose" in given:
        note(
            "-v has no effect in a batch (several meshes, or an option of a batch such as --json); "
            "for the log of a mesh, process it alone"
        )
    summary = Summary()
    prints_json = _records_file() == STANDARD_OUTPUT
    is_shown = is_listed or not (sys.stdout.isatty() or prints_json)
    with ExitStack() as stack:
        options = _options(given, force, None if recipe.dry_run else plan.table, stack)
        batch = stack.enter_context(closing(Batch(recipe, jobs, options)))
        for result in batch.earlier:
            summary.add(result)
            _report(result)
        show = stack.enter_context(_progress(batch, summary))
        for result in stack.enter_context(closing(batch.results())):
            summary.add(result)
            _log(result)
            show()
            for text in result.notes:
                note(text)
            if result.is_done:
                if is_shown and (line := line_of(result, jobs[result.place])):
                    click.echo(line)
                continue
            if result.trace and is_debug():
                click.echo(result.trace, err=True)
            if options.stop:
                raise click.ClickException(printable(failure(result)))
            _report(result)
    if "summary" in given or (sys.stdout.isatty() and not prints_json):
        # The standard output is for the records only.
        click.echo(in_window(summary.lines()), err=prints_json)
    if summary.failed == len(jobs) == 1:
        click.get_current_context().exit(1)
    if summary.failed:
        raise click.ClickException(how_many_failed(summary.failed, summary.failed + summary.done))


def _options(given: dict[str, Any], force: bool, table: Path | None, stack: ExitStack) -> Any:
    from ..batch.runner import BatchOptions

    client = None
    if "scheduler" in given:
        from ..batch.cluster import client_of

        client = stack.enter_context(closing(client_of(given["scheduler"])))
    if _is_resumed() and "log" not in given:
        raise WrongUse("--resume needs --json FILE.jsonl, which says what is done")
    return BatchOptions(
        workers=given.get("workers"),
        timeout=given.get("timeout"),
        memory=_bytes(given["memory"]) if "memory" in given else None,
        retries=given.get("retries", 0),
        force=force,
        log=_records_file(),
        resume=_is_resumed(),
        retry_failed="retry_failed" in given,
        stop="stop" in given or is_debug(),
        client=client,
        table=table,
    )


def _report(result: Result) -> None:
    if not result.is_done:
        click.echo(f"Error: {printable(failure(result))}", err=True)


def _log(result: Result) -> None:
    """Write to `--log` what the steps did."""
    for line in result.lines:
        log.info("%s", line)
    if not result.is_done:
        # This error is more important than one of the log.
        with suppress(OSError):
            log.info("error: %s", result.reason)


@contextmanager
def _progress(batch: Batch, summary: Summary) -> Iterator[Callable[[], None]]:
    """Show a line on a terminal; gives a function to call after each mesh."""
    if not sys.stderr.isatty():
        yield lambda: None
        return
    before = summary.done + summary.failed
    start = time.monotonic()

    def text() -> str:
        count = summary.done + summary.failed - before
        running = [f"{Path(name).name}: {phase}" for name, phase in batch.running]
        parts = [f"{summary.done} done, {summary.failed} failed"]
        if count:
            left = (time.monotonic() - start) / count * (batch.count - count)
            parts.append(f"about {duration(left)} left")
        if count < batch.count:
            parts.append(", ".join(running) or "starting workers")
        return "; ".join(parts)

    with progress.shown("batch", batch.count) as status:
        status.next("", text())
        with progress.repeated(lambda: status.detail(text()), _SECONDS):
            yield lambda: status.next("", text())
