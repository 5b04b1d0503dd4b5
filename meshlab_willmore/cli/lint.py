"""`meshlab-willmore lint`: what is wrong with scripts, without running them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .columns import counted
from .errors import WrongUse, debug_option
from .inputs import matches, refuse_folder
from .scripts import STANDARD_STREAM, source_of

if TYPE_CHECKING:
    from ..meshset.check import Findings

EXAMPLES = """\b
Examples:
  meshlab-willmore lint clean.mlx
  meshlab-willmore lint scripts/*.mlx
"""


@click.command("lint", short_help="Check filter scripts.", epilog=EXAMPLES)
@click.argument("scripts", metavar="SCRIPT...", nargs=-1, required=True)
@debug_option
def command(scripts: tuple[str, ...]) -> None:
    """Check filter scripts without running them: a line for each fault, and for each warning.

    Faults are unknown filters and parameters, values that can't be, and all that MeshLab would
    skip without a word; all of a script are told at once. Warnings are names of older versions
    with what they are today, parameters without a type, and defaults that have changed. Exit code
    1 if a script has faults. Scripts can come from pipes; - is the standard input.
    """
    paths, refusals = _expanded(scripts)
    if refusals and not paths:
        raise refusals[0]
    for refusal in refusals:
        refusal.show()
    faulty = len(refusals)
    for path in paths:
        found = _examined(path)
        for fault in found.faults:
            click.echo(f"{path}: {fault}")
        for warning in found.warnings:
            click.echo(f"{path}: warning: {warning}")
        if not found.faults:
            click.echo(f"{path}: fine, {counted(len(found.calls), 'step')}")
        faulty += bool(found.faults)
    if faulty:
        click.get_current_context().exit(1)


def _expanded(names: tuple[str, ...]) -> tuple[list[Path], list[WrongUse]]:
    """The scripts that names and patterns stand for, and what is wrong with the others."""
    found = [_found(name) for name in names]
    refusals = [refusal for _, refusal in found if refusal is not None]
    return [path for paths, _ in found for path in paths], refusals


def _found(name: str) -> tuple[list[Path], WrongUse | None]:
    try:
        paths = matches(name)
        for path in paths:
            refuse_folder(path, "scripts", "*.mlx")
    except WrongUse as refusal:
        return [], refusal
    return paths, None


def _examined(path: Path) -> Findings:
    from ..script import examined

    return source_of(STANDARD_STREAM).examined() if str(path) == STANDARD_STREAM else examined(path)
