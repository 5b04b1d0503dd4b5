"""`meshlab-willmore demo`: the paper's experiments."""

from __future__ import annotations

from pathlib import Path

import click

from . import progress
from .completion import folders
from .errors import debug_option
from .text import table

EXAMPLES = """\b
Examples:
  meshlab-willmore demo
  meshlab-willmore demo --output pictures
  meshlab-willmore demo > table.txt
"""


@click.command("demo", short_help="Flip the paper's models and a technical part.", epilog=EXAMPLES)
@click.option(
    "--output",
    "-o",
    type=click.Path(path_type=Path),
    default=Path("willmore-demo"),
    show_default=True,
    metavar="DIR",
    shell_complete=folders,
    help="Folder for the meshes and pictures; created if it does not exist.",
)
@debug_option
def command(output: Path) -> None:
    """Show the method on the paper's three models, a cube, a torus and a scanned face, and a part.

    The technical part and the face are flipped as in the paper, and by the preset 'faithful'.

    PyMeshLab filters, the Willmore flips among them, process the meshes. A table of the results
    goes to the standard output, meshes (PLY) and pictures of before and after (PNG) into the
    folder. It needs no network and no files.
    """
    from ..demo.experiments import run_demo
    from ..report.stages import LEGEND, table_rows

    with progress.shown("demo") as status, progress.with_details(status):

        def notify(line: str) -> None:
            click.echo(line, err=True)
            status.begin(line)

        result = run_demo(output, notify)
    click.echo(table(table_rows(result.stages), LEGEND))
    click.echo(f"Written to {output.resolve()}:")
    click.echo("  " + " ".join(file.name for file in result.files))
