"""`meshlab-willmore lint`: what is wrong with scripts, without running them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .columns import counted
from .errors import debug_option
from .inputs import matches, refuse_folder
from .scripts import STANDARD_STREAM, source_of

if TYPE_CHECKING:
    from ..mlx.steps import Step

EXAMPLES = """\b
Examples:
  meshlab-willmore lint clean.mlx
  meshlab-willmore lint scripts/*.mlx
"""


@click.command("lint", short_help="Check filter scripts.", epilog=EXAMPLES)
@click.argument("scripts", metavar="SCRIPT...", nargs=-1, required=True)
@debug_option
def command(scripts: tuple[str, ...]) -> None:
    """Check filter scripts without running them: a line for each fault.

    Unknown filters and parameters, values that can't be, and all that MeshLab would skip without a
    word. Exit code 1 if a script has faults. Scripts can come from pipes; - is the standard input.
    """
    from ..mlx.steps import ScriptError
    from ..script import check

    faulty = 0
    for path in _expanded(scripts):
        try:
            steps = _steps(path)
            faults = check(steps)
        except ScriptError as error:
            steps, faults = (), list(error.faults)
        for fault in faults:
            click.echo(f"{path}: {fault}")
        if not faults:
            click.echo(f"{path}: fine, {counted(len(steps), 'step')}")
        faulty += bool(faults)
    if faulty:
        click.get_current_context().exit(1)


def _expanded(names: tuple[str, ...]) -> list[Path]:
    paths = [path for name in names for path in matches(name)]
    for path in paths:
        refuse_folder(path, "scripts", "*.mlx")
    return paths


def _steps(path: Path) -> tuple[Step, ...]:
    from ..script import read

    return source_of(STANDARD_STREAM).steps() if str(path) == STANDARD_STREAM else read(path)
