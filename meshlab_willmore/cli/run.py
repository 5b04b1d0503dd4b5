"""`meshlab-willmore run`: a filter script on meshes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..files import is_stream
from ..mesh_files.paths import PLACEHOLDERS, Output, find_inputs
from ..messages import WrongUse, counted
from . import runlog
from .arguments import LAYER_HELP, force_option, form_options, mask_option, take_outputs
from .batch import batch_options, json_file_option, planned, report_option, run_jobs
from .completion import files, scripts
from .errors import debug_option
from .progress import verbose_option
from .scripts import Script, read_script
from .text import printable, saved_text, step_results

if TYPE_CHECKING:
    from ..batch.jobs import Job
    from ..batch.recipe import Recipe
    from ..batch.records import Result
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
    from ..batch.recipe import Recipe

    source = _script_of(script, also)
    if source is None and not (inputs and outputs):
        raise WrongUse(
            "without a script, run converts meshes, and needs -i and -o; name a script, such as: "
            "run clean.mlx -i scan.ply -o clean.ply"
        )
    if source is None and settings:
        raise WrongUse(f"--set {settings[0]}: there is no script whose steps it could change")
    name = source.name if source else CONVERSION
    recipe = Recipe(_steps(source, settings) if source else (), name, dry_run=dry_run)
    outputs = [output._replace(is_text=as_text, is_single=single) for output in outputs]
    plan = planned(find_inputs(inputs, takes_projects=True), outputs, layers, force, dry_run)
    used = [Path(name)] if source else []
    used += [file for file, _ in plan.own_files() if file and not is_stream(file)]
    runlog.check(log_file, [*used, *(file for job in plan.jobs for file in job.files)])
    with runlog.opened(None if dry_run else log_file, name):
        run_jobs(recipe, plan, partial(_line, recipe), force, has_script=True)


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


def _line(recipe: Recipe, result: Result, job: Job) -> str:
    """What is printed of a mesh that is done."""
    steps = counted(result.steps, "step")
    if recipe.dry_run:
        files = " and ".join(output.name for output in job.outputs) or "no file"
        return printable(f"{job.name}: ok; {steps} to run, then {files} to write")
    did = "converted" if recipe.source == CONVERSION else steps
    line = f"{job.name} -> {saved_text(result.outputs)}: {did}, {result.seconds:.1f} s"
    return "\n".join([printable(line), *step_results(result.returned)])
