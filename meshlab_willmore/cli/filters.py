"""`meshlab-willmore filters`: list the filters, or explain the parameters of one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ..messages import WrongUse, wrapped
from .completion import filters
from .errors import debug_option
from .step_text import defaults, script_with
from .text import WIDTH

if TYPE_CHECKING:
    from ..meshset.catalogue import FilterInfo, ParamInfo

EXAMPLES = """\b
Examples:
  meshlab-willmore filters
  meshlab-willmore filters smooth
  meshlab-willmore filters apply_coord_taubin_smoothing
  meshlab-willmore filters "Taubin Smooth"
  meshlab-willmore filters "Willmore flipping optimization" --mlx
"""
# Most names in PyMeshLab are shorter.
_NAME_WIDTH = 42


@click.command("filters", short_help="List filters, or explain one.", epilog=EXAMPLES)
@click.argument("name", required=False, nargs=-1, shell_complete=filters)
@click.option("--mlx", is_flag=True, help="Print the filter NAME as a step of a script.")
@debug_option
def command(name: tuple[str, ...], mlx: bool) -> None:
    """List all filters, or those with the words NAME in their names, or explain the filter NAME.

    Names are those of PyMeshLab and those of MeshLab and its scripts. Scripts may use either.

    With --mlx the filter is printed as a script to copy from, with all parameters and their
    defaults. A step needs only those that it changes.
    """
    from ..meshset.catalogue import closest, everything, find

    wanted = " ".join(name)
    known = find(wanted) if wanted else None
    if known is not None:
        click.echo(script_with(known) if mlx else _explained(known))
        return
    found = [k for k in everything() if _matches(k, wanted)]
    if not found:
        close = ", ".join(closest(wanted))
        hint = f"; the closest are {close}" if close else ""
        raise WrongUse(f"there is no filter {wanted!r}{hint}")
    if mlx:
        example = f'meshlab-willmore filters "{found[0].meshlab_name}" --mlx'
        raise WrongUse(f"--mlx needs the whole name of one filter, such as: {example}")
    for known in sorted(found, key=lambda k: not k.is_willmore):
        click.echo(_listed(known))


def _listed(known: FilterInfo) -> str:
    """Both names: in one line, or the second below where they are too long for that."""
    line = f"{known.name:{_NAME_WIDTH}}  {known.meshlab_name}"
    return line if len(line) <= WIDTH else f"{known.name}\n    {known.meshlab_name}"


def _matches(known: FilterInfo, words: str) -> bool:
    text = f"{known.name} {known.meshlab_name}".lower()
    return all(word in text for word in words.lower().split())


def _explained(known: FilterInfo) -> str:
    from ..meshset.filters import BY_NAME

    own = BY_NAME.get(known.name)
    lines = [known.name, f"  in MeshLab: {known.meshlab_name}"]
    lines += wrapped(known.summary, WIDTH, "  ")
    lines += ["", "Parameters: none"] if not known.params else ["", "Parameters:"]
    values = defaults(known)
    tooltips = {p.name: p.tooltip for p in own.parameters} if own else {}
    for param in known.params:
        lines += _parameter(param, values)
        lines += wrapped(tooltips.get(param.keyword, ""), WIDTH, "      ")
    returns = own.returns if own else ()
    lines += ["", "Returns:"] if returns else []
    for name, kind, text in returns:
        lines += [f"  {name} ({kind})", *wrapped(text, WIDTH, "      ")]
    return "\n".join(lines)


def _parameter(param: ParamInfo, values: dict[str, Any]) -> list[str]:
    other = f" (keyword {param.keyword})" if param.keyword != param.name else ""
    line = f"  {param.name}{other}: {param.type}"
    if param.required:
        line += ", required"
    elif param.keyword in values:
        line += f", default {_shown(values[param.keyword], param)}"
    choices = [f"      {i}: {choice}" for i, choice in enumerate(param.choices)]
    return [line, *choices]


def _shown(value: Any, param: ParamInfo) -> str:
    if param.choices and isinstance(value, int) and 0 <= value < len(param.choices):
        return repr(param.choices[value])
    plain = value.tolist() if hasattr(value, "tolist") else value
    return f"{plain:g}" if isinstance(plain, float) else repr(plain)
