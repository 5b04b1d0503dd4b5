"""`meshlab-willmore warmup`: compile everything in advance."""

from __future__ import annotations

import sys

import click

from ..messages import counted
from . import progress
from .errors import debug_option

EXAMPLES = """\b
Examples:
  meshlab-willmore warmup
  meshlab-willmore warmup --debug
"""


@click.command("warmup", short_help="Compile everything in advance.", epilog=EXAMPLES)
@debug_option
def command() -> None:
    """Compile everything that the filters need, so that no later run has to wait for it.

    Numba keeps the machine code in a folder of the user, or in NUMBA_CACHE_DIR, which must then be
    set for later runs too. This takes a minute or two the first time, and seconds when everything
    is compiled. 'meshlab-willmore doctor' shows whether it is.
    """
    from ..machine import core_count
    from ..warmup import steps, warm_up

    def show(line: str) -> None:
        if sys.stderr.isatty():
            click.echo(line, err=True)

    with progress.shown("warmup", len(steps())) as status, progress.with_details(status):

        def end(name: str) -> None:
            status.count()
            status.detail(f"done with {name}")

        status.next("everything that is not compiled yet")
        done = warm_up(show, core_count(), end)
    what = f"{counted(done.compiled, 'kernel')} compiled"
    if not done.compiled:
        what = "everything was compiled already"
    click.echo(f"{what}, in {done.seconds:.1f} s: {done.folder}")
