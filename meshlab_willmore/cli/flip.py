"""`meshlab-willmore flip`: the flips on meshes, with the filter's parameters as options."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ..mesh_files.paths import Output, find_inputs
from ..messages import WrongUse, note
from ..options import FILTER
from .arguments import (
    SeveralParts,
    check_flip_options,
    flip_options,
    force_option,
    form_options,
    mask_option,
    overruled_defaults,
)
from .batch import batch_options, json_file_option, planned, report_option, run_jobs
from .completion import files
from .errors import debug_option
from .progress import verbose_option
from .text import flip_results, printable

if TYPE_CHECKING:
    from ..batch.jobs import Job
    from ..batch.records import Result

EXAMPLES = """\b
Examples:
  meshlab-willmore flip scan.ply flipped.ply
  meshlab-willmore flip part.stl flipped.stl --featuredeg 30
  meshlab-willmore flip scan.ply flipped.ply --search variable-depth
  meshlab-willmore flip scan.obj flipped.ply -m vc wt --force
  meshlab-willmore flip scan.ply flipped.ply --report flips.html
  meshlab-willmore flip 'scans/*.ply' 'out/{name}.ply' --json log.jsonl
"""


@click.command("flip", cls=SeveralParts, short_help="Flip the edges of meshes.", epilog=EXAMPLES)
@click.argument("sources", metavar="IN...", nargs=-1, required=True, shell_complete=files)
@click.argument("target", metavar="OUT", shell_complete=files)
@flip_options()
@mask_option()
@form_options
@force_option
@json_file_option
@report_option
@batch_options
@verbose_option
@debug_option
def command(
    sources: tuple[str, ...],
    target: str,
    parts: tuple[str, ...],
    as_text: bool,
    single: bool,
    force: bool,
    **given: Any,
) -> None:
    """Flip edges of the mesh IN as long as an energy falls, and save it as OUT.

    Vertices never move. The ending of OUT determines the format. OUT is written atomically. Notes
    say what was lost in loading or saving.

    Several meshes are a batch, as in 'run'; then OUT needs a placeholder, such as
    'out/{name}_flipped.ply'.
    """
    from ..batch.recipe import Recipe
    from ..mlx.steps import Param, Step

    chosen = {name: value for name, value in given.items() if value is not None}
    check_flip_options(chosen)
    for text in overruled_defaults(chosen):
        note(text)
    inputs = find_inputs(sources)
    output = Output(target, parts, is_text=as_text, is_single=single)
    if len(inputs) > 1 and not output.has_placeholder:
        example = "'{name}_flipped.ply'"
        raise WrongUse(f"{len(inputs)} inputs need an output with a placeholder, such as {example}")
    if output.is_project:
        raise WrongUse(f"{target} would be a project; only run writes projects")
    plan = planned(inputs, [output], False, force)
    params = tuple(Param(name, "", value) for name, value in chosen.items())
    run_jobs(Recipe((Step(FILTER, params),), "flip"), plan, _line, force)


def _line(result: Result, job: Job) -> str:
    (returned,) = (step.returned for step in result.returned)
    target = job.outputs[0].path
    line = f"{job.name} -> {target}: {flip_results(returned)}, {returned['seconds']:.1f} s"
    return printable(line)
