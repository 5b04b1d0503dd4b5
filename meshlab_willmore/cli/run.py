"""`meshlab-willmore run`: a filter script on meshes."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from ..batch import steplog
from ..batch.jobs import Job
from ..batch.steplog import log
from ..files import is_stream
from ..mesh_files.paths import PLACEHOLDERS, Output, find_inputs
from ..messages import WrongUse, counted, notes_kept, one_line
from ..signals import killable
from . import progress, runlog
from .arguments import LAYER_HELP, force_option, form_options, mask_option, take_outputs
from .batch import (
    batch_options,
    files_of_batch,
    is_batch,
    json_file_option,
    planned,
    run_batch,
)
from .completion import files, scripts
from .errors import debug_option, verbose_option
from .reports import report_option
from .scripts import Script, read_script
from .text import printable, saved_text, step_results

if TYPE_CHECKING:
    import pymeshlab

    from ..batch.pages import Layer
    from ..batch.records import Result
    from ..meshset.check import Call
    from ..meshset.play import Played
    from ..mlx.steps import Step

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
  meshlab-willmore run clean.mlx -i 'scans/*.ply' -o 'out/{name}.{ext}'
  meshlab-willmore run -i part.stl -o part.ply --ascii
  meshlab-willmore run align.mlx -p scans.mlp -w aligned.mlp
  meshlab-willmore run clean.mlx -i scan.ply -o clean.obj -m vc vn wt
  meshlab-willmore run clean.mlx -i scan.ply -o clean.ply --log log.txt
  meshlab-willmore run s.mlx -i a.ply -o b.ply --set 2.stepsmoothnum=5
  meshlab-willmore run clean.mlx -i scan.ply -o a.ply --report clean.html
  meshlab-willmore run align.mlx -i a.ply b.ply --layers -o both.ply
  meshlab-willmore run s.mlx -i *.ply --layers -o c.ply -l 1 -o d.ply -lx
  meshlab-willmore run makes-a-sphere.mlx -o sphere.ply
  meshlab-willmore run clean.mlx -i scan.ply -o clean.ply --dry-run
"""
# What messages and logs call a run without a script.
CONVERSION = "conversion"
_PLACEHOLDERS = ", ".join(f"{{{name}}} ({what})" for name, what in PLACEHOLDERS.items())


class RunOptions(NamedTuple):
    """What is the same for all inputs: the script and its name, and options."""

    source: str
    steps: tuple[Step, ...]
    force: bool
    dry_run: bool
    # The files that this run has written; changed in place.
    written: set[Path]


class RunCommand(click.Command):
    """`run`, which keeps its outputs with their masks and layers in ``ctx.obj``."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the outputs, then let click read the rest."""
        try:
            ctx.obj, rest = take_outputs(args, ctx)
        except (WrongUse, click.ClickException):
            if not ctx.resilient_parsing:
                raise
            # A shell completes a line that is not whole yet.
            ctx.obj, rest = [], args
        return super().parse_args(ctx, rest)


def _only_once(_: click.Context, option: click.Parameter, values: Sequence[str]) -> str | None:
    """The value of an option that meshlabserver accepted several times, using one of them."""
    if len(values) > 1:
        raise WrongUse(
            f"--{option.opts[-1].lstrip('-')} is given {len(values)} times; give it once"
        )
    return values[0] if values else None


@click.command(
    "run", cls=RunCommand, short_help="Run a filter script, or convert.", epilog=EXAMPLES
)
@click.argument("script", required=False, metavar="[SCRIPT.mlx]", shell_complete=scripts)
@click.option(
    "-s",
    "--script",
    "also",
    multiple=True,
    callback=_only_once,
    metavar="FILE",
    shell_complete=scripts,
    help="The script, as in meshlabserver.",
)
@click.option(
    "-i",
    "--input",
    "inputs",
    multiple=True,
    metavar="FILE...",
    shell_complete=files,
    help="Meshes, or quoted patterns such as 'scans/*.ply'.",
)
@click.option(
    "-o",
    "--output",
    "output",
    expose_value=False,
    metavar="FILE...",
    shell_complete=files,
    help="The output file; its ending determines the format. For several inputs, use a name with "
    f"placeholders: {_PLACEHOLDERS}.",
)
@click.option(
    "-p",
    "--project",
    expose_value=False,
    metavar="IN.mlp",
    shell_complete=files,
    help="A MeshLab project, whose meshes become layers; -i adds more of them.",
)
@click.option(
    "-w",
    "--write-project",
    expose_value=False,
    metavar="OUT.mlp",
    shell_complete=files,
    help="Save all layers, as OUT_0.ply, OUT_1.ply and so on, and a project that names them.",
)
@mask_option(expose_value=False)
@click.option(
    "--layer",
    expose_value=False,
    metavar="LAYER",
    help=f"The layer that the -o before it saves: {LAYER_HELP}. An -l just behind an -o means the "
    "same.",
)
@click.option(
    "--log",
    "log_file",
    multiple=True,
    callback=_only_once,
    metavar="FILE",
    shell_complete=files,
    help="Append what each step did to this file; - for the terminal. An -l before every -o means "
    "the same.",
)
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="STEP.PARAM=VALUE",
    help="Change a parameter of the script; STEP is a step's number or the filter's name.",
)
@click.option(
    "--layers",
    is_flag=True,
    help="Load all inputs as layers of one set, for filters of two meshes.",
)
@form_options
@force_option
@json_file_option
@report_option
@batch_options
@click.option("--dry-run", is_flag=True, help="Check everything, read the inputs, write nothing.")
@verbose_option
@debug_option
@click.pass_obj
def command(
    outputs: list[Output],
    script: str | None,
    also: str | None,
    inputs: Sequence[str],
    log_file: str | None,
    settings: Sequence[str],
    layers: bool,
    as_text: bool,
    single: bool,
    force: bool,
    dry_run: bool,
) -> None:
    """Run a MeshLab filter script (.mlx) on meshes, and save the results.

    Without a script, meshes are converted: they are saved in the formats of their outputs.

    The whole script is checked before its first step. It can come from a pipe; - is the standard
    input. Output files are written atomically. Notes say what was lost in loading or saving.

    Several inputs are a batch: they run in worker processes, on all cores. One that fails, crashes
    its worker or takes too long costs itself only; the others still run, and the exit code is 1.

    With --layers the first input is the current layer, as in meshlabserver. One -o saves the layer
    that is current in the end; several save the first layers in their order. An -l just behind an
    -o names its layer. Several names behind one -o are several outputs. Each -m is for the -o
    before it, or for all outputs if it comes first.

    MeshLab saves scripts in the window "Show current filter script", and PyMeshLab does too; a
    short one is shown below. 'meshlab-willmore filters' lists the names, 'lint' checks a script.
    """
    source = _script_of(script, also)
    if source is None and not (inputs and outputs):
        raise WrongUse(
            "without a script, run converts meshes, and needs -i and -o; name a script, such as: "
            "run clean.mlx -i scan.ply -o clean.ply"
        )
    if source is None and settings:
        raise WrongUse(f"--set {settings[0]}: there is no script whose steps it could change")
    name = source.name if source else CONVERSION
    steps = _steps(source, settings) if source else ()
    options = RunOptions(name, steps, force, dry_run, set())
    outputs = [output._replace(is_text=as_text, is_single=single) for output in outputs]
    jobs = planned(find_inputs(inputs, takes_projects=True), outputs, layers, force, dry_run)
    used = [Path(name)] if source else []
    used += [file for file in files_of_batch().values() if file and not is_stream(file)]
    runlog.check(log_file, [*used, *(file for job in jobs for file in job.files)])
    with runlog.opened(None if dry_run else log_file, name):
        _run_all(options, jobs)


def _script_of(script: str | None, also: str | None) -> Script | None:
    if script is not None and also is not None:
        raise WrongUse("name the script once, such as: run clean.mlx -i scan.ply -o clean.ply")
    name = also if script is None else script
    return None if name is None else read_script(name)


def _steps(source: Script, settings: Sequence[str]) -> tuple[Step, ...]:
    """The script with its settings, checked as far as that is possible without meshes."""
    from ..mlx.steps import ScriptError
    from ..script import examined
    from .settings import with_settings

    found = source.examined()
    if settings and not found.reading.faults:
        found = examined(with_settings(found.reading.steps, settings))
    if found.faults:
        raise ScriptError(source.name, found.faults)
    for warning in found.warnings:
        if warning.changes_result:
            click.echo(f"{source.name}: warning: {warning}", err=True)
    return found.reading.steps


def _run_all(options: RunOptions, jobs: Sequence[Job]) -> None:
    if is_batch(jobs):
        from ..batch.recipe import Recipe

        recipe = Recipe(options.steps, options.source, dry_run=options.dry_run)
        run_batch(recipe, jobs, partial(_line, options), options.force)
        return
    (job,) = jobs
    try:
        click.echo(_run_job(options, job))
    except Exception as error:
        # This error is more important than one of the log.
        with suppress(OSError):
            log.info("error: %s", one_line(error))
        raise


def _line(options: RunOptions, result: Result, job: Job) -> str:
    """What is printed of a mesh that is done."""
    if options.dry_run:
        return _intended(job, result.steps)
    did = _did(options, result.steps)
    line = f"{job.name} -> {saved_text(result.outputs)}: {did}, {result.seconds:.1f} s"
    return "\n".join([printable(line), *step_results(result.returned)])


def _intended(job: Job, steps: int) -> str:
    """What is printed of a mesh in a dry run."""
    files = " and ".join(output.name for output in job.outputs) or "no file"
    return printable(f"{job.name}: ok; {counted(steps, 'step')} to run, then {files} to write")


def _did(options: RunOptions, steps: int) -> str:
    return "converted" if options.source == CONVERSION else counted(steps, "step")


def _run_job(options: RunOptions, job: Job) -> str:
    """Run the script on the inputs of a job; returns the lines to print."""
    from ..batch.pages import current_layer
    from ..meshset.check import resolve

    if job.problem is not None:
        raise job.problem
    start = time.perf_counter()
    with notes_kept() as notes:
        ms = _load(job)
        calls = resolve(options.steps, options.source, [mesh.id() for mesh in ms])
        if options.dry_run:
            return _intended(job, len(calls))
        before = current_layer(ms) if job.page else None
        played = play(ms, calls, options.source, Path(job.name).name)
        saved = _save(ms, job, options)
        seconds = time.perf_counter() - start
        if job.page is not None:
            _write_page(job, before, ms, options, played, notes)
    line = f"{job.name} -> {saved}: {_did(options, len(calls))}, {seconds:.1f} s"
    return "\n".join([printable(line), *step_results(played)])


def _write_page(
    job: Job,
    before: Layer | None,
    ms: pymeshlab.MeshSet,
    options: RunOptions,
    played: Sequence[Played],
    notes: Sequence[str],
) -> None:
    from ..batch.pages import write_page
    from ..batch.records import StepResult

    results = [StepResult(p.number, p.name, p.seconds, p.returned) for p in played if p.returned]
    with progress.shown(job.name) as status:
        status.begin(f"writing {job.page}")
        seconds = sum(p.seconds for p in played)
        write_page(job, before, ms, options.steps, results, seconds, notes)


def _load(job: Job) -> pymeshlab.MeshSet:
    from ..batch import work

    with progress.shown(job.name) as status:
        status.begin("reading")
        return work.load(job)


def play(ms: pymeshlab.MeshSet, calls: Sequence[Call], source: str, label: str) -> list[Played]:
    """Run the steps; the filters themselves print nothing.

    Errors name the script `source`; the progress bar has the `label`.
    """
    from ..meshset import play as steps
    from ..meshset.native import muted

    # The streams are restored before an error of a step is printed.
    with progress.shown(label, len(calls)) as status, ExitStack() as quiet:

        def before(call: Call) -> None:
            status.hide()
            steplog.log_call(call, len(calls))
            status.next(call.known.name)
            sys.stdout.flush()
            if call.known.is_willmore:
                quiet.enter_context(progress.with_details(status, is_part=True))
            else:
                # No output is begun before the last step has ended.
                quiet.enter_context(killable())
            quiet.enter_context(muted())

        def after(played: Played) -> None:
            quiet.close()
            status.hide()
            steplog.log_result(played)

        return steps.play(ms, calls, source, before, after)


def _save(ms: pymeshlab.MeshSet, job: Job, options: RunOptions) -> str:
    """Save the layers of a job's outputs; returns which files were written."""
    from ..batch import work
    from ..mesh_files.saving import SaveOptions

    @contextmanager
    def saving(path: Path) -> Iterator[None]:
        with progress.shown(job.name) as status:
            status.begin(f"saving {path}")
            yield

    how = SaveOptions(force=options.force, written=options.written)
    return saved_text(work.save_all(ms, job, how, saving))
