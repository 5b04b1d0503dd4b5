"""`meshlab-willmore convert`: an old script in today's form."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .errors import debug_option, wrong_use
from .outputs import check_place

if TYPE_CHECKING:
    from ..meshset.catalogue import KnownParam
    from ..meshset.check import Call
    from ..mlx.steps import Step

EXAMPLES = """\b
Examples:
  meshlab-willmore convert old.mlx today.mlx
  meshlab-willmore convert clean.mlx for-the-window.mlx --meshlab
"""

# Attributes of the time of meshlabserver, without a meaning today.
OLD = frozenset({"isxmlparam"})


@click.command("convert", short_help="Rewrite a script in today's form.", epilog=EXAMPLES)
@click.argument("source", metavar="SCRIPT")
@click.argument("target", metavar="OUT", type=click.Path(path_type=Path))
@click.option(
    "--meshlab", is_flag=True, help="Leave out the steps that MeshLab's window does not know."
)
@click.option("--force", is_flag=True, help="Replace a file that is there already.")
@debug_option
def command(source: str, target: Path, meshlab: bool, force: bool) -> None:
    """Rewrite a filter script with today's names of filters, parameters and types.

    Old forms, from the time of meshlabserver, and PyMeshLab's names become what MeshLab writes
    today. A script with faults is not converted.
    """
    from ..mlx.write import write
    from ..script import calls, read

    if not Path(source).is_file():
        raise wrong_use(f"there is no filter script {source}")
    check_place(target, force)
    steps = read(source)
    checked = calls(source)
    kept = [call for call in checked if not (meshlab and call.known.ours)]
    write(target, [_today(call, steps[call.number - 1]) for call in kept])
    click.echo(f"{source} -> {target}: {len(kept)} of {len(checked)} steps")
    for call in checked:
        if call not in kept:
            click.echo(f"left out: step {call.number}, {call.known.meshlab_name}")
        elif meshlab and _shares(call):
            click.echo(
                f"step {call.number}, {call.known.meshlab_name}: a percentage depends on the mesh; "
                f"MeshLab's window wants another value for {', '.join(_shares(call))}"
            )


def _today(call: Call, step: Step) -> Step:
    """The step with MeshLab's names and types; descriptions and ranges stay."""
    from ..mlx.steps import Param

    details = {}
    for old in step.params:
        known = call.known.param(old.name)
        if known is not None:
            details[known.keyword] = tuple(pair for pair in old.details if pair[0] not in OLD)
    params = []
    for keyword, value in call.given.items():
        known = call.known.param(keyword)
        if known is not None:
            extra = _with_choices(known, details.get(keyword, ()))
            params.append(Param(known.name, known.type, value, extra))
    # The MeshLab name of a plugin that the user brought is not known.
    return step._replace(filter=call.known.meshlab_name or step.filter, params=tuple(params))


def _with_choices(
    known: KnownParam, details: tuple[tuple[str, str], ...]
) -> tuple[tuple[str, str], ...]:
    """The details, with the names of an enum's choices as they are today."""
    if not known.choices:
        return details
    kept = tuple(pair for pair in details if not pair[0].startswith(("enum_val", "enum_card")))
    names = tuple((f"enum_val{i}", choice) for i, choice in enumerate(known.choices))
    return (*kept, ("enum_cardinality", str(len(known.choices))), *names)


def _shares(call: Call) -> list[str]:
    from ..mlx.steps import Percentage

    return [key for key, value in call.given.items() if isinstance(value, Percentage)]
