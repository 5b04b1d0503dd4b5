"""`meshlab-willmore convert`: an old script in today's form."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .errors import debug_option, wrong_use
from .outputs import check_place
from .placing import beside, put

if TYPE_CHECKING:
    from ..meshset.check import Call

EXAMPLES = """\b
Examples:
  meshlab-willmore convert old.mlx today.mlx
  meshlab-willmore convert clean.mlx for-the-window.mlx --meshlab
"""

_DRAFT = "script.mlx"
_COMMENT = b"<!--"


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
    today. A script with faults is not converted.
    """
    from ..meshset.modern import in_todays_form
    from ..mlx.write import write
    from ..script import calls, read

    if not os.path.isfile(source):
        raise wrong_use(f"there is no filter script {source}")
    check_place(target, force, "today.mlx")
    steps = read(source)
    checked = calls(source)
    kept = [call for call in checked if not (meshlab and call.known.ours)]
    with beside(target) as folder:
        draft = folder / _DRAFT
        write(draft, [in_todays_form(call, steps[call.number - 1]) for call in kept])
        put(draft, target)
    click.echo(f"{source} -> {target}: {len(kept)} of {len(checked)} steps")
    if not kept:
        click.echo(f"nothing is left: {target} has no steps")
    if _COMMENT in Path(source).read_bytes():
        click.echo("left out: the comments")
    for call in checked:
        if call not in kept:
            click.echo(f"left out: step {call.number}, {call.known.meshlab_name}")
        elif meshlab and _shares(call):
            click.echo(
                f"step {call.number}, {call.known.meshlab_name}: a percentage depends on the mesh; "
                f"MeshLab's window wants another value for {', '.join(_shares(call))}"
            )


def _shares(call: Call) -> list[str]:
    from ..mlx.steps import Percentage

    return [key for key, value in call.given.items() if isinstance(value, Percentage)]
