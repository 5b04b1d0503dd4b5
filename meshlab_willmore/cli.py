"""The command line: `meshlab-willmore`.

Nothing heavy is imported before a command needs it, so that help comes at once.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from . import __version__

# Click fills paragraphs, but for those that begin with a backspace.
EXAMPLES = """\b
Examples:
  meshlab-willmore demo
  meshlab-willmore demo --output pictures
  meshlab-willmore demo --help
"""
DEMO_EXAMPLES = """\b
Examples:
  meshlab-willmore demo
  meshlab-willmore demo --output pictures
  meshlab-willmore demo > table.txt
"""


class OneLineErrors(click.Group):
    """A group whose commands end with one line and exit code 1 when something fails."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; what click itself says stays, other errors become one line."""
        try:
            return super().invoke(ctx)
        except (click.ClickException, click.exceptions.Exit, click.Abort, BrokenPipeError):
            raise
        except Exception as error:
            if ctx.meta.get("debug"):
                raise
            text = " ".join(str(error).split()) or type(error).__name__
            raise click.ClickException(text) from error


def _remember_debug(ctx: click.Context, _option: click.Parameter, value: bool) -> None:
    # meta is shared by a group and its commands: the option works before and after the name.
    ctx.meta["debug"] = ctx.meta.get("debug", False) or value


debug_option = click.option(
    "--debug",
    is_flag=True,
    expose_value=False,
    callback=_remember_debug,
    help="Show the whole traceback of an error.",
)


@click.group(
    "meshlab-willmore",
    cls=OneLineErrors,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=EXAMPLES,
)
@click.version_option(__version__)
@debug_option
def main() -> None:
    """Willmore edge flips for triangle meshes, as a step of a PyMeshLab chain.

    Exit codes: 0 done, 1 failed while running, 2 wrong use.
    """


@main.command(short_help="Run the three experiments of the paper.", epilog=DEMO_EXAMPLES)
@click.option(
    "--output",
    "-o",
    type=click.Path(path_type=Path),
    default=Path("willmore-demo"),
    show_default=True,
    metavar="DIR",
    help="Folder for the meshes and pictures; made if it isn't there.",
)
@debug_option
def demo(output: Path) -> None:
    """Show the method on the paper's three models: a cube, a torus and a scanned face.

    The meshes go through PyMeshLab filters, the Willmore flips among them. A table of what
    happened goes to the standard output, meshes (PLY) and pictures of before and after (PNG) into
    the folder. It needs no network and no file of yours.
    """
    from .demo.story import tell
    from .report.table import format_table

    story = tell(output, say=lambda line: click.echo(line, err=True))
    click.echo(format_table(story.stages))
    click.echo(f"Written to {output.resolve()}:")
    click.echo("  " + " ".join(file.name for file in story.files))
