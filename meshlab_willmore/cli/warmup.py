"""`meshlab-willmore warmup`: everything compiled ahead."""

from __future__ import annotations

import sys

import click

from . import progress
from .columns import counted
from .errors import debug_option

EXAMPLES = """\b
Examples:
  meshlab-willmore warmup
  meshlab-willmore warmup --debug
"""


def is_terminal() -> bool:
    """Whether somebody looks on."""
    return sys.stderr.isatty()


@click.command("warmup", short_help="Compile everything ahead, once.", epilog=EXAMPLES)
@debug_option
def command() -> None:
    """Compile all that the filters need, so that no later run has to wait for that.

    Numba keeps the machine code in a folder of the user, or in NUMBA_CACHE_DIR, which then has to
    be set for later runs too. It takes some minutes the first time, and seconds when all is there.
    'meshlab-willmore doctor' tells whether it is done.
    """
    from .. import quick_start

    quick_start.import_numba()
    from ..mesh.workers import core_count
    from ..warmup import steps, warm_up

    def say(line: str) -> None:
        if is_terminal():
            click.echo(line, err=True)

    with progress.shown("warmup", len(steps())) as status, progress.with_details(status):
        status.next("all that is not compiled yet")
        done = warm_up(say, core_count(), lambda name: status.next(f"done with {name}"))
    what = f"{counted(done.compiled, 'kernel')} compiled" if done.compiled else "all is there"
    click.echo(f"{what}, in {done.seconds:.1f} s: {done.folder}")
