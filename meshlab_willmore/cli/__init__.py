"""The command line: `meshlab-willmore`.

Nothing heavy is imported before a command needs it, so that help comes at once.
"""

from __future__ import annotations

import click

from .._version import __version__
from . import (
    compare,
    completion,
    convert,
    demo,
    doctor,
    filters,
    flip,
    lint,
    manual,
    measure,
    run,
    shipped,
    summary,
    warmup,
)
from .errors import OneLineErrors, debug_option

# Click fills paragraphs, but for those that begin with a backspace.
EXAMPLES = """\b
Examples:
  meshlab-willmore demo
  meshlab-willmore flip scan.ply flipped.ply
  meshlab-willmore run clean.mlx -i scan.ply -o clean.ply
  meshlab-willmore lint clean.mlx
  meshlab-willmore run --help
"""


@click.group(
    "meshlab-willmore",
    cls=OneLineErrors,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=EXAMPLES,
)
@click.version_option(__version__)
@debug_option
def main() -> None:
    """Willmore edge flips for triangle meshes, and MeshLab's filter scripts.

    Exit codes: 0 success, 1 failure while running, 2 wrong usage.
    """


for module in (
    run,
    flip,
    measure,
    summary,
    compare,
    filters,
    shipped,
    lint,
    convert,
    doctor,
    warmup,
    completion,
    manual,
    demo,
):
    main.add_command(module.command)
