"""`meshlab-willmore lint`: what is wrong with scripts, without running them."""

from __future__ import annotations

from pathlib import Path

import click

from .columns import counted
from .errors import debug_option, wrong_use

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
    word. Exit code 1 if a script has faults.
    """
    from ..mlx.steps import ScriptError
    from ..script import check, read

    faulty = 0
    for path in _expanded(scripts):
        try:
            steps = read(path)
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
    import glob

    paths: list[Path] = []
    for name in names:
        pattern = glob.has_magic(name) and not Path(name).exists()
        found = [Path(match) for match in sorted(glob.glob(name, recursive=True))]
        if pattern and not found:
            raise wrong_use(f"no file matches {name!r}")
        if Path(name).is_dir():
            raise wrong_use(f"{name} is a folder; name the scripts, such as '{name}/*.mlx'")
        paths += found if pattern else [Path(name)]
    return paths
