"""`meshlab-willmore flip`: the flips on one mesh, with the filter's parameters as options."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..options import FILTER, OPTIONS, Option
from . import loading, progress
from .arguments import SeveralParts, force_option, mask_option
from .errors import WrongUse, debug_option, reason
from .paths import check_output, only_input
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


class FlipCommand(SeveralParts):
    """A command with the filter's parameters as options."""

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        """The command's own parameters, and the filter's before its options."""
        own = super().get_params(ctx)
        arguments = [p for p in own if isinstance(p, click.Argument)]
        return [*arguments, *filter_options(), *(p for p in own if p not in arguments)]


@cache
def filter_options() -> tuple[click.Option, ...]:
    """An option for each parameter of the filter, in their order."""
    return tuple(map(_click_option, OPTIONS))


def _click_option(option: Option) -> click.Option:
    """An option without a default of its own: the filter knows what is best for the mesh."""
    name = f"--{option.name}"
    if option.type is bool:
        return click.Option([f"{name}/--no-{option.name}"], default=None, help=_help(option))
    type_: Any = click.Choice(option.choices) if option.is_choice else option.type
    return click.Option([name], type=type_, help=_help(option))


def _help(option: Option) -> str:
    if option.default is None:
        return option.help
    value = option.default
    if option.type is bool:
        value = option.name if value else f"no-{option.name}"
    elif option.type is float:
        value = f"{value:g}"
    return f"{option.help}  [default: {value}]"


@click.command("flip", cls=FlipCommand, short_help="Flip the edges of a mesh.", epilog=EXAMPLES)
@click.argument("source", metavar="IN")
@click.argument("target", metavar="OUT", type=click.Path(path_type=Path))
@mask_option()
@force_option
@debug_option
def command(source: str, target: Path, parts: tuple[str, ...], force: bool, **given: Any) -> None:
    """Flip edges of the mesh IN as long as an energy falls, and save it as OUT.

    Vertices never move. The ending of OUT determines the format. OUT is written atomically. Notes
    say what was lost in loading or saving.
    """
    from .saving import SaveOptions, save

    chosen = {name: value for name, value in given.items() if value is not None}
    check_options(chosen)
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


def check_options(given: dict[str, Any]) -> None:
    """Raise `WrongUse` for the first option that the filter can't take, each checked by itself."""
    from ..meshset.filters import BY_NAME
    from ..meshset.native import ERRORS

    for parameter in BY_NAME[FILTER].parameters:
        if parameter.name in given:
            try:
                value = parameter.read(given[parameter.name])
                if parameter.check is not None:
                    parameter.check(value)
            except ERRORS as error:
                raise WrongUse(f"--{parameter.name}: {reason(error)}") from error
            except ValueError as error:
                raise WrongUse(f"--{parameter.name}: {error}") from error


def _flipped(ms: pymeshlab.MeshSet, path: Path, given: dict[str, Any]) -> dict[str, Any]:
    from ..meshset.native import ERRORS

    try:
        return ms.apply_filter(FILTER, **given)
    except ERRORS as error:
        raise type(error)(f"{path}: {reason(error)}") from error
