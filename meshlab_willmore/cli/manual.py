"""`meshlab-willmore manual`: a man page, made from the commands."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator

import click

from .._version import __version__
from .errors import debug_option

EXAMPLES = """\b
Examples:
  meshlab-willmore manual | man -l -
  meshlab-willmore manual > ~/.local/share/man/man1/meshlab-willmore.1
"""
_NAME = "meshlab-willmore"
_TITLE = "Willmore edge flips and filter scripts for triangle meshes"
# Where help keeps the lines as they are.
_AS_IT_IS = "\b\n"


@click.command("manual", short_help="Print the man page.", epilog=EXAMPLES)
@debug_option
def command() -> None:
    """Print a man page with all commands and options, for man -l or a folder of man pages."""
    group = click.get_current_context().find_root().command
    assert isinstance(group, click.Group)
    click.echo("\n".join(_page(group)))


def _page(group: click.Group) -> Iterator[str]:
    date = time.strftime("%Y-%m-%d")
    yield f'.TH "{_NAME.upper()}" "1" "{date}" "{_NAME} {__version__}" "User Commands"'
    # Names with hyphens stay in one line.
    yield from (".nh", ".ad l")
    yield from (".SH NAME", _escaped(f"{_NAME} - {_TITLE}"))
    yield from (".SH SYNOPSIS", f".B {_escaped(_NAME)}", "COMMAND [OPTIONS] ...")
    with click.Context(group, info_name=_NAME, **group.context_settings) as ctx:
        yield ".SH DESCRIPTION"
        yield from _paragraphs(group.help or "")
        yield ".SH OPTIONS"
        yield from _options(group, ctx)
        yield ".SH COMMANDS"
        for name, sub in group.commands.items():
            with click.Context(sub, parent=ctx, info_name=name) as inner:
                usage = " ".join(sub.collect_usage_pieces(inner))
                yield from (f'.SS "{name}"', f".B {_escaped(f'{_NAME} {name}')}", _escaped(usage))
                yield from _paragraphs(sub.help or "")
                yield from _options(sub, inner)
                yield from _paragraphs(sub.epilog or "")


def _options(command: click.Command, ctx: click.Context) -> Iterator[str]:
    records = (param.get_help_record(ctx) for param in command.get_params(ctx))
    for record in records:
        # Arguments are in the usage.
        if record is not None and record[1]:
            names, text = record
            yield from (".TP", f".B {_escaped(names)}", _escaped(" ".join(text.split())))


def _paragraphs(text: str) -> Iterator[str]:
    """Paragraphs that man fills, and those whose lines help keeps."""
    for paragraph in re.split(r"\n\s*\n", text.strip("\n")):
        is_kept = paragraph.lstrip(" ").startswith(_AS_IT_IS)
        lines = paragraph.replace(_AS_IT_IS, "", 1).split("\n")
        yield ".PP"
        if is_kept:
            yield from (".nf", *map(_escaped, filter(None, lines)), ".fi")
        else:
            yield _escaped(" ".join(line.strip() for line in lines))


def _escaped(text: str) -> str:
    """The text without meaning for roff; hyphens stay as they can be typed."""
    shown = text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq")
    return rf"\&{shown}" if shown.startswith(".") else shown
