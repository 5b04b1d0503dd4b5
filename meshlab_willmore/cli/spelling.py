"""Options that take several values after one name, as `meshlabserver` had them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import ClassVar

import click

from .errors import wrong_use

# Whether a word still belongs to the option before it.
Belongs = Callable[[str], bool]


class SeveralValues(click.Command):
    """A command that reads ``-i a b`` as ``-i a -i b``, for the options in `several`."""

    several: ClassVar[Mapping[str, Belongs]] = {}

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Spell the arguments out, then read them as click does."""
        return super().parse_args(ctx, spelled_out(args, self.several))


# What meshlabserver had, and what does that now.
GONE = {
    "-p": "projects are not read; name their meshes after -i, with --layers",
    "-w": "projects are not written; each layer can have an -o of its own",
    "-x": "--force replaces files that are there",
    "-d": "'meshlab-willmore filters' lists the filters and their parameters",
}
RENAMED = {"-om": "-m"}


def of_today(args: Sequence[str]) -> list[str]:
    """The arguments with today's names of options.

    Raises
    ------
    WrongUse
        For an option of `meshlabserver` that is gone, naming what does its work.
    """
    end = list(args).index("--") if "--" in args else len(args)
    for word in args[:end]:
        if word in GONE:
            raise wrong_use(f"{word} of meshlabserver is gone: {GONE[word]}")
    return [*(RENAMED.get(word, word) for word in args[:end]), *args[end:]]


def spelled_out(args: Sequence[str], several: Mapping[str, Belongs]) -> list[str]:
    """The arguments with the option's name before each of its values.

    Parameters
    ----------
    several : mapping of str to callable
        For each option that takes several values, what tells whether a word is one of them. The
        first word after the option always is; an option or ``--`` ends the row.
    """
    result: list[str] = []
    option, count = "", 0
    for place, word in enumerate(args):
        if word == "--":
            return [*result, *args[place:]]
        if word.startswith("-") and len(word) > 1:
            option, count = word if word in several else "", 0
        elif option:
            if count and not several[option](word):
                option = ""
            elif count:
                result.append(option)
            count += 1
        result.append(word)
    return result
