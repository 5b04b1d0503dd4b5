"""The steps of a script on loaded meshes, with a log."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING

from . import progress, stopping

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
        What errors call the script, and what it works on.
    """
    from ..meshset import play as steps
    from ..meshset.native import muted

    # Whatever ends a step, the streams are there again before anyone says so.
    with progress.shown(label, len(calls)) as status, ExitStack() as quiet:

        def before(call: Call) -> None:
            status.hide()
            log.begin(call, len(calls))
            status.next(call.known.name)
            sys.stdout.flush()
            if call.known.is_willmore:
                quiet.enter_context(progress.with_details(status))
            else:
                # No output is begun before the last step has ended.
                quiet.enter_context(stopping.at_once())
            quiet.enter_context(muted())

        def after(played: Played) -> None:
            quiet.close()
            status.hide()
            log.end(played)

        return steps.play(ms, calls, source, before, after)
