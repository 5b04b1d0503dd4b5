"""`meshlab-willmore convert`: rewrite an old script in today's form."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..files import is_stream, write
from ..mesh_files.paths import check_place
from .arguments import force_option
from .completion import scripts
from .errors import debug_option
from .scripts import STANDARD_STREAM, read_script

if TYPE_CHECKING:
    from ..meshset.check import Call

EXAMPLES = """\b
Examples:
  meshlab-willmore convert old.mlx today.mlx
  meshlab-willmore convert clean.mlx for-the-window.mlx --meshlab
  meshlab-willmore convert old.mlx - > today.mlx
"""


@click.command("convert", short_help="Rewrite a script in today's form.", epilog=EXAMPLES)
@click.argument("source", metavar="SCRIPT", shell_complete=scripts)
@click.argument("target", metavar="OUT", type=click.Path(path_type=Path))
@click.option(
    "--meshlab", is_flag=True, help="Leave out the steps that MeshLab's window does not have."
)
@force_option
@debug_option
def command(source: str, target: Path, meshlab: bool, force: bool) -> None:
    """Rewrite a filter script with today's names of filters, parameters and types.

    Old forms, from the time of meshlabserver, and PyMeshLab's names become what MeshLab writes
    today. Steps that do not do the same as before are listed. A script with errors is not
    converted. For SCRIPT and OUT, - is the standard input and output; pipes work as well.
    """
    from ..meshset.check import in_todays_form
    from ..meshset.document import is_step
    from ..mlx.steps import ScriptError
    from ..mlx.write import to_xml

    is_output = str(target) == STANDARD_STREAM
    if not is_output:
        check_place(target, force, "today.mlx", takes_streams=True)
    script = read_script(source)
    found = script.examined()
    if found.faults:
        raise ScriptError(script.name, found.faults)
    steps, checked = found.reading.steps, found.calls
    unknown = [call for call in checked if call.known.is_willmore or is_step(call.known.name)]
    kept = [call for call in checked if not (meshlab and call in unknown)]
    data = to_xml(in_todays_form(call, steps[call.number - 1]) for call in kept).encode()
    if is_output:
        click.echo(data, nl=False)
    else:
        write(target, data)
    # The standard output must hold nothing but the script.
    beside = is_output or is_stream(target)
    click.echo(f"{script.name} -> {target}: {len(kept)} of {len(checked)} steps", err=beside)
    if not kept:
        click.echo(f"nothing is left: {target} has no steps", err=beside)
    if found.reading.has_comments:
        click.echo("left out: the comments", err=beside)
    for warning in found.warnings:
        if warning.changes_result:
            click.echo(f"not as before: {warning}", err=beside)
    for line in _changes(checked, kept, meshlab):
        click.echo(line, err=beside)


def _changes(checked: Sequence[Call], kept: Sequence[Call], meshlab: bool) -> Iterator[str]:
    """A line for each step that is left out or depends on the mesh."""
    for call in checked:
        if call not in kept:
            yield f"left out: step {call.number}, {call.known.meshlab_name}"
        elif meshlab and _percentages(call):
            yield (
                f"step {call.number}, {call.known.meshlab_name}: a percentage depends on the mesh; "
                f"MeshLab's window needs another value for {', '.join(_percentages(call))}"
            )


def _percentages(call: Call) -> list[str]:
    from ..mlx.steps import Percentage

    return [key for key, value in call.given.items() if isinstance(value, Percentage)]
