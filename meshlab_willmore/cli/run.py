"""`meshlab-willmore run`: a filter script on meshes."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import click

from . import inputs, output_words, outputs, playing, results, told
from .columns import counted
from .errors import debug_option, one_line, stops_all, told_of, wrong_use
from .masks import by_output, is_part, mask_option
from .scripts import Source, is_script, source_of
from .spelling import SeveralValues, of_today, spelled_out

if TYPE_CHECKING:
    from ..mlx.steps import Step
    from .jobs import Job
    from .runlog import Log

EXAMPLES = """\b
A script:
  <!DOCTYPE FilterScript>
  <FilterScript>
   <filter name="Remove Duplicate Vertices"/>
   <filter name="Willmore flipping optimization"/>
  </FilterScript>

\b
Examples:
  meshlab-willmore run clean.mlx -i scan.ply -o clean.ply
  meshlab-willmore run clean.mlx -i 'scans/*.ply' -o 'out/{name}_clean.{ext}'
  meshlab-willmore run clean.mlx -i scan.ply -o clean.obj -m vc vn wt --log log.txt
  meshlab-willmore run clean.mlx -i scan.ply -o clean.ply --set 2.stepsmoothnum=5
  meshlab-willmore run align.mlx -i a.ply b.ply --layers -o both.ply
  meshlab-willmore run align.mlx -i a.ply b.ply --layers -o second.ply -l 1 -o last.obj -l x
  meshlab-willmore run makes-a-sphere.mlx -o sphere.ply
  meshlab-willmore run clean.mlx -i scan.ply -o clean.ply --dry-run
"""


# The key in click's own notes on a call.
_ORDER = "order of options"


class Orders(NamedTuple):
    """What the command line asks for."""

    source: str
    steps: tuple[Step, ...]
    parts: tuple[tuple[str, ...], ...]
    layers: tuple[str, ...]
    force: bool
    placed: set[Path]
    stop: bool
    dry_run: bool


class RunCommand(SeveralValues):
    """`run`, with several values after -i and -m; a script's name is never an input."""

    several: ClassVar = {
        "-i": lambda word: not is_script(word),
        "--input": lambda word: not is_script(word),
        "-m": is_part,
        "--mask": is_part,
    }

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Take meshlabserver's spelling too, and note which -m stands behind which -o."""
        words = of_today(output_words.without_empty_masks(args, is_script))
        words = output_words.plain(words, is_script, is_part)
        parser = self.make_parser(ctx)
        *_, order = parser.parse_args(spelled_out(words, self.several))
        ctx.meta[_ORDER] = [option.name for option in order]
        return super().parse_args(ctx, words)


def _only_once(_: click.Context, option: click.Parameter, values: Sequence[str]) -> str | None:
    """The value of an option that meshlabserver took several times, and of which one would win."""
    if len(values) > 1:
        raise wrong_use(
            f"--{option.opts[-1].lstrip('-')} is given {len(values)} times; give it once"
        )
    return values[0] if values else None


def _placeholders() -> str:
    return ", ".join(f"{{{name}}} ({what})" for name, what in outputs.PLACEHOLDERS.items())


@click.command("run", cls=RunCommand, short_help="Run a filter script.", epilog=EXAMPLES)
@click.argument("script", required=False, metavar="SCRIPT.mlx")
@click.option(
    "-s",
    "--script",
    "also",
    multiple=True,
    callback=_only_once,
    metavar="FILE",
    help="The script, as meshlabserver had it.",
)
@click.option(
    "-i",
    "--input",
    "inputs",
    multiple=True,
    metavar="FILE...",
    help="Meshes, or quoted patterns such as 'scans/*.ply'.",
)
@click.option(
    "-o",
    "--output",
    "patterns",
    multiple=True,
    metavar="FILE",
    help=f"Where the result goes; its ending tells the format. With {_placeholders()} in it, "
    "several inputs have an output each.",
)
@mask_option
@click.option(
    "--layer",
    multiple=True,
    metavar="LAYER",
    help=f"The layer that the -o before it saves: {output_words.MEANING}. -l just behind an -o is "
    "the same.",
)
@click.option(
    "--log",
    multiple=True,
    callback=_only_once,
    metavar="FILE",
    help="Add what each step did to this file; - for the terminal. -l before every -o is the same.",
)
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="STEP.PARAM=VALUE",
    help="Another value for a parameter; STEP is its number, or the filter's name.",
)
@click.option(
    "--layers", is_flag=True, help="All inputs are layers of one set, for filters of two meshes."
)
@click.option("--force", is_flag=True, help="Replace files that are there already.")
@click.option("--stop", is_flag=True, help="End with the first input that fails.")
@click.option("--dry-run", is_flag=True, help="Check all, read the inputs, and say what would be.")
@debug_option
def command(script: str | None, also: str | None, **given: Any) -> None:
    """Run a MeshLab filter script (.mlx) on meshes, and save what comes out.

    The whole script is checked before its first step; it can come from a pipe, and - is the
    standard input. An output is there when it is whole, not before. Several inputs are run one
    after the other; if one fails or can't be read, the others go on, and the exit code is 1 in the
    end. What loading or saving leaves out is told in a note.

    With --layers the first input is the current layer, as in meshlabserver. One -o saves the mesh
    that is current in the end; several save the first layers, in their order. An -l just behind
    an -o names its layer. Several names behind one -o are outputs. Each -m is for the -o before
    it; one before all of them is for all.

    MeshLab's window saves scripts ("Show current filter script"), and so does PyMeshLab; a short
    one stands below. 'meshlab-willmore filters' has the names, 'lint' finds what is wrong.
    """
    from . import jobs, runlog

    source = _script_of(script, also)
    order = click.get_current_context().meta[_ORDER]
    orders = Orders(
        source.name,
        _steps(source, given["settings"]),
        tuple(by_output(order, given["parts"])),
        tuple(output_words.by_output(order, given["layer"], given["patterns"])),
        given["force"],
        set(),
        given["stop"],
        given["dry_run"],
    )
    todo = jobs.plan(
        inputs.asked_for(given["inputs"]), given["patterns"], given["layers"], orders.force
    )
    runlog.check(given["log"], [Path(source.name), *(file for job in todo for file in job.files)])
    with (
        runlog.opened(None if orders.dry_run else given["log"]) as log,
        log.run_of(orders.source),
    ):
        _run_all(orders, todo, log)


def _script_of(script: str | None, also: str | None) -> Source:
    if (script is None) == (also is None):
        raise wrong_use(
            "name the script once, such as: run clean.mlx -i scan.ply -o clean.ply"
            if script
            else "there is no script; name one, such as: run clean.mlx -i scan.ply -o clean.ply"
        )
    return source_of(script or also or "")


def _steps(source: Source, settings: Sequence[str]) -> tuple[Step, ...]:
    """The script, changed and checked as far as that is possible without meshes."""
    from ..mlx.steps import ScriptError
    from ..script import examined
    from .settings import with_settings

    found = source.examined()
    if not found.reading.faults:
        steps = with_settings(found.reading.steps, settings)
        found = examined(steps) if settings else found
    if found.faults:
        raise ScriptError(source.name, found.faults)
    for warning in found.warnings:
        if warning.changes_result:
            click.echo(f"{source.name}: warning: {warning}", err=True)
    return found.reading.steps


def _run_all(orders: Orders, todo: Sequence[Job], log: Log) -> None:
    debug = click.get_current_context().meta.get("debug", False)
    ends_at_once = len(todo) == 1 or orders.stop or debug
    failed = sum(not _succeeds(orders, job, log, ends_at_once) for job in todo)
    if failed:
        raise click.ClickException(inputs.how_many_failed(failed, len(todo)))


def _succeeds(orders: Orders, job: Job, log: Log, ends_at_once: bool) -> bool:
    try:
        click.echo(_run_one(orders, job, log))
    except Exception as error:
        # A log that can't be written is no news beside what went wrong before.
        with suppress(OSError):
            log.say(f"error: {one_line(error)}")
        if ends_at_once or stops_all(error):
            raise
        click.echo(f"Error: {told_of(job.name, error)}", err=True)
        return False
    return True


def _run_one(orders: Orders, job: Job, log: Log) -> str:
    """Run the script on one set of meshes; returns lines that say what was done."""
    from ..meshset.check import resolve

    if job.refusal is not None:
        raise job.refusal
    start = time.perf_counter()
    ms = results.loaded(job, log)
    calls = resolve(orders.steps, orders.source, [mesh.id() for mesh in ms])
    if orders.dry_run:
        there = " and ".join(map(str, job.outputs)) or "no file"
        return f"{job.name}: fine; {counted(len(calls), 'step')} to run, then {there} to write"
    played = playing.play(ms, calls, orders.source, Path(job.name).name, log)
    saved = results.save(
        ms, job, results.Wishes(orders.parts, orders.layers, orders.force, orders.placed), log
    )
    seconds = time.perf_counter() - start
    line = f"{job.name} -> {saved}: {counted(len(calls), 'step')}, {seconds:.1f} s"
    return "\n".join([line, *told.steps(played)])
