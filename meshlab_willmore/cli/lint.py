"""`meshlab-willmore lint`: check scripts without running them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..mesh_files.paths import matches, refuse_folder
from ..messages import WrongUse, counted
from .completion import files
from .errors import debug_option, with_commands
from .scripts import STANDARD_STREAM, read_script, shipped_scripts

if TYPE_CHECKING:
    from ..meshset.check import Findings
    from ..mlx.steps import Fault

EXAMPLES = """\b
Examples:
  meshlab-willmore lint clean.mlx
  meshlab-willmore lint scripts/*.mlx
"""


@click.command("lint", short_help="Check filter scripts.", epilog=EXAMPLES)
@click.argument("scripts", metavar="SCRIPT...", nargs=-1, required=True, shell_complete=files)
@debug_option
def command(scripts: tuple[str, ...]) -> None:
    """Check filter scripts without running them: one line for each error and each warning.

    Errors are unknown filters and parameters, impossible values, and everything that MeshLab
    would skip without a message; all errors of a script are found at once. Warnings are names from
    older versions with today's names, parameters without a type, and defaults that have changed.
    Exit code 1 if a script has errors. Scripts can come from pipes; - is the standard input.
    """
    found = [_find(name) for name in scripts]
    paths = [path for paths, _ in found for path in paths]
    problems = [problem for _, problem in found if problem is not None]
    if problems and not paths:
        raise problems[0]
    for problem in problems:
        click.echo(f"Error: {problem}", err=True)
    failed = len(problems) + sum(not _is_ok(path) for path in paths)
    if failed:
        click.get_current_context().exit(1)


def _find(name: str) -> tuple[list[Path], WrongUse | None]:
    """The scripts for a name or pattern, and what is wrong with it."""
    try:
        paths = matches(name)
        for path in paths:
            refuse_folder(path, "scripts", "*.mlx")
    except WrongUse as problem:
        return [], problem
    return paths, None


def _is_ok(path: Path) -> bool:
    """Whether a script has no errors; prints errors and warnings."""
    found = _examined(path)
    for fault in found.faults:
        click.echo(with_commands(f"{path}: {fault}{_written(fault)}"))
    for warning in found.warnings:
        click.echo(f"{path}: warning: {warning}")
    if not found.faults:
        click.echo(f"{path}: ok, {counted(len(found.calls), 'step')}")
    return not found.faults


def _written(fault: Fault) -> str:
    """How a faulty parameter is written, as the end of a message; empty for other faults."""
    from ..meshset.catalogue import find
    from .step_text import element_of

    known = find(fault.filter) if fault.param else None
    if known is None:
        return ""
    own = known.param(fault.param)
    joint = " " if fault.text.endswith("?") else "; "
    if own is not None:
        return f"{joint}for example: {element_of(known, own)}"
    return f"{joint}'meshlab-willmore filters {known.name} --mlx' shows how they are written"


def _examined(path: Path) -> Findings:
    from ..script import examined

    name = str(path)
    is_shipped = name in shipped_scripts() and not os.path.lexists(path)
    if name == STANDARD_STREAM or is_shipped:
        return read_script(name).examined()
    return examined(path)
