"""Notes on the standard error: what is lost, and no error."""

from __future__ import annotations

import click

# The key in click's own notes on a call.
_TOLD = "notes"


def tell(text: str) -> None:
    """Print a note, once in a call of the command line."""
    ctx = click.get_current_context(silent=True)
    told = ctx.meta.setdefault(_TOLD, set()) if ctx else set()
    if text not in told:
        told.add(text)
        click.echo(f"Note: {text}", err=True)
