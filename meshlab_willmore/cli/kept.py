"""Options whose values are kept for whatever asks for them, and not passed to the command."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

_KEPT = "kept options"


def kept_option(*names: str, **attributes: Any) -> Callable[..., Any]:
    """An option of click whose value, if it is given, is one of `kept_options`.

    A group and its commands share these: the option can be before or behind the command's name.
    """

    def keep(ctx: click.Context, option: click.Parameter, value: Any) -> None:
        if value:
            ctx.meta.setdefault(_KEPT, {})[option.name] = value

    return click.option(*names, expose_value=False, callback=keep, **attributes)


def kept_options() -> dict[str, Any]:
    """The values that were given, by the options' names; none outside of a command."""
    ctx = click.get_current_context(silent=True)
    kept: dict[str, Any] = {} if ctx is None else ctx.meta.setdefault(_KEPT, {})
    return kept
