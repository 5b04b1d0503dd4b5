"""`meshlab-willmore scripts`: list, print or copy the filter scripts that come with the package."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import click

from .. import files
from ..mesh_files.paths import check_place
from ..messages import WrongUse
from .arguments import force_option
from .completion import folders, shipped
from .errors import debug_option
from .scripts import shipped_of, shipped_scripts
from .text import WIDTH

EXAMPLES = """\b
Examples:
  meshlab-willmore scripts
  meshlab-willmore scripts flip.mlx
  meshlab-willmore scripts flip.mlx faithful.mlx --copy .
  meshlab-willmore scripts --copy my-scripts
"""
_COMMENT = re.compile(r"<!--(.*?)-->", re.DOTALL)
_INDENT = "    "


@click.command("scripts", short_help="List or copy the shipped scripts.", epilog=EXAMPLES)
@click.argument("names", metavar="[NAME...]", nargs=-1, shell_complete=shipped)
@click.option(
    "--copy",
    "folder",
    type=click.Path(path_type=Path),
    metavar="DIR",
    shell_complete=folders,
    help="Copy the scripts into this folder; created if it does not exist.",
)
@force_option
@debug_option
def command(names: tuple[str, ...], folder: Path | None, force: bool) -> None:
    """List the filter scripts that come with this package, or print or copy those named.

    'run' finds them by their names, where no file has that name: meshlab-willmore run flip.mlx ...
    """
    there = shipped_scripts()
    paths = [_named(name) for name in names]
    if folder is not None:
        _copy(paths or [*there.values()], folder, force)
    elif paths:
        click.echo("\n".join(path.read_text(encoding="utf-8") for path in paths), nl=False)
    else:
        click.echo("\n".join(_described(there.values())))


def _named(name: str) -> Path:
    path = shipped_of(name)
    if path is None:
        there = ", ".join(shipped_scripts())
        raise WrongUse(f"no script {name!r} comes with this package; there are {there}")
    return path


def _described(paths: Iterable[Path]) -> Iterator[str]:
    """The lines of the list: each name, and below it what the script is for."""
    for path in paths:
        yield path.name
        (text,) = _COMMENT.findall(path.read_text(encoding="utf-8"))[:1] or [""]
        yield from textwrap.wrap(
            " ".join(text.split()),
            WIDTH,
            initial_indent=_INDENT,
            subsequent_indent=_INDENT,
        )


def _copy(paths: Sequence[Path], folder: Path, force: bool) -> None:
    """Copy all scripts or, if one can't be, none."""
    targets = [folder / path.name for path in paths]
    files.writable_folder(folder)
    for target in targets:
        check_place(target, force, "flip.mlx")
    for path, target in zip(paths, targets, strict=True):
        files.write(target, path.read_bytes())
        click.echo(target)
