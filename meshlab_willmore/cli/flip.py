"""`meshlab-willmore flip`: the flips on one mesh, with the filter's parameters as options."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..mesh_files import loading
from ..mesh_files.paths import check_output, only_input
from ..messages import reason
from ..options import FILTER
from . import progress
from .arguments import SeveralParts, check_flip_options, flip_options, force_option, mask_option
from .errors import debug_option
from .text import flip_results

if TYPE_CHECKING:
    import pymeshlab

EXAMPLES = """\b
Examples:
  meshlab-willmore flip scan.ply flipped.ply
  meshlab-willmore flip part.stl flipped.stl --featuredeg 30
  meshlab-willmore flip scan.ply flipped.ply --energy willmore --search "variable depth"
  meshlab-willmore flip scan.obj flipped.ply -m vc wt --force
"""


@click.command("flip", cls=SeveralParts, short_help="Flip the edges of a mesh.", epilog=EXAMPLES)
@click.argument("source", metavar="IN")
@click.argument("target", metavar="OUT", type=click.Path(path_type=Path))
@flip_options()
@mask_option()
@force_option
@debug_option
def command(source: str, target: Path, parts: tuple[str, ...], force: bool, **given: Any) -> None:
    """Flip edges of the mesh IN as long as an energy falls, and save it as OUT.

    Vertices never move. The ending of OUT determines the format. OUT is written atomically. Notes
    say what was lost in loading or saving.
    """
    from ..mesh_files.saving import SaveOptions, save

    chosen = {name: value for name, value in given.items() if value is not None}
    check_flip_options(chosen)
    path = only_input(source, "flip takes one, run takes all")
    check_output(target, force)
    with progress.shown(path.name) as status:
        status.begin("reading")
        ms = loading.loaded(path)
        status.begin("flipping")
        with progress.with_details(status):
            returned = _flipped(ms, path, chosen)
        status.begin(f"saving {target}")
        save(ms, target, SaveOptions(parts, force, path.parent))
    click.echo(f"{path} -> {target}: {flip_results(returned)}, {returned['seconds']:.1f} s")


def _flipped(ms: pymeshlab.MeshSet, path: Path, given: dict[str, Any]) -> dict[str, Any]:
    from ..meshset.native import ERRORS

    try:
        return ms.apply_filter(FILTER, **given)
    except ERRORS as error:
        raise type(error)(f"{path}: {reason(error)}") from error
