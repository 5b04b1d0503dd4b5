"""The steps of a script on loaded meshes, with a log, and a bar on a terminal."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager, ExitStack, nullcontext
from typing import TYPE_CHECKING, Any

import click

from . import stopping

if TYPE_CHECKING:
    import pymeshlab

    from ..meshset.check import Call
    from ..meshset.play import Played
    from .runlog import Log


def play(
    ms: pymeshlab.MeshSet, calls: Sequence[Call], source: str, label: str, log: Log
) -> list[Played]:
    """Run the steps; the filters themselves print nothing.

    Parameters
    ----------
    source, label : str
        What errors call the script, and what stands before the bar.
    """
    from ..meshset import play as steps
    from ..meshset.native import muted

    # Whatever ends a step, the streams are there again before anyone says so.
    with bar(len(calls), label) as shown, ExitStack() as quiet:

        def before(call: Call) -> None:
            log.begin(call, len(calls))
            if shown is not None:
                shown.current_item = call.known.name
                shown.render_progress()
            sys.stdout.flush()
            if not call.known.ours:
                # No output is begun before the last step has ended.
                quiet.enter_context(stopping.at_once())
            quiet.enter_context(muted())

        def after(played: Played) -> None:
            quiet.close()
            log.end(played)
            if shown is not None:
                shown.update(1)

        return steps.play(ms, calls, source, before, after)


def tell_of_compiling() -> None:
    """Say on a terminal why flips may begin late."""
    if sys.stderr.isatty():
        click.echo("flipping (the first run compiles before, which takes a while)", err=True)


def bar(length: int, label: str) -> AbstractContextManager[Any]:
    """A progress bar; in a pipe nothing."""
    if not sys.stderr.isatty():
        return nullcontext()
    return click.progressbar(
        length=length, label=label, file=sys.stderr, item_show_func=lambda item: item or ""
    )
