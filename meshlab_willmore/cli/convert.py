"""`meshlab-willmore convert`: an old script in today's form."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..files import is_stream, write
from .errors import debug_option
from .outputs import check_place
from .scripts import STANDARD_STREAM, source_of

if TYPE_CHECKING:
    from ..meshset.check import Call

EXAMPLES = """\b
Examples:
  meshlab-willmore convert old.mlx today.mlx
  meshlab-willmore convert clean.mlx for-the-window.mlx --meshlab
  meshlab-willmore convert old.mlx - > today.mlx
"""


@click.command("convert", short_help="Rewrite a script in today's form.", epilog=EXAMPLES)
@click.argument("source", metavar="SCRIPT")
@click.argument("target", metavar="OUT", type=click.Path(path_type=Path))
@click.option(
    "--meshlab", is_flag=True, help="Leave out the steps that MeshLab's window does not know."
)
@click.option("--force", is_flag=True, help="Replace a file that is there already.")
@debug_option
def command(source: str, target: Path, meshlab: bool, force: bool) -> None:
    """Rewrite a filter script with today's names of filters, parameters and types.

    Old forms, from the time of meshlabserver, and PyMeshLab's names become what MeshLab writes
    today. What does not do the same as before is said. A script with faults is not converted. For
    SCRIPT and OUT, - is the standard input and output; pipes will do as well.
    """
    from ..meshset.document import is_step
    from ..meshset.modern import in_todays_form
    from ..mlx.steps import ScriptError
    from ..mlx.write import to_xml

    is_output = str(target) == STANDARD_STREAM
    if not is_output:
        check_place(target, force, "today.mlx", takes_streams=True)
    script = source_of(source)
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
    # What comes out of the script must be nothing but a script.
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
    """What is left out, and what depends on the mesh, in a line each."""
    for call in checked:
        if call not in kept:
            yield f"left out: step {call.number}, {call.known.meshlab_name}"
        elif meshlab and _shares(call):
            yield (
                f"step {call.number}, {call.known.meshlab_name}: a percentage depends on the mesh; "
                f"MeshLab's window wants another value for {', '.join(_shares(call))}"
            )


def _shares(call: Call) -> list[str]:
    from ..mlx.steps import Percentage

    return [key for key, value in call.given.items() if isinstance(value, Percentage)]
