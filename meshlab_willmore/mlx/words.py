"""Words of a script as a message shows them."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

SHOWN = 60
# Attributes that are never misspellings of others.
USUAL = ("name", "type", "value")


def quoted(text: str) -> str:
    """`text` in quotes, on one line, cut where it gets too long for a message."""
    return repr(shortened(text))


def shortened(text: str) -> str:
    """`text` on one line, cut where it gets too long for a message."""
    begin = " ".join(text[: 2 * SHOWN].split())
    return begin if len(begin) <= SHOWN else begin[: SHOWN - 3] + "..."


def closest(word: str, known: Iterable[str]) -> str | None:
    """The known word that `word` is most likely a misspelling of, whatever its case."""
    by_lower = {name.lower(): name for name in known}
    found = difflib.get_close_matches(word[:SHOWN].lower(), by_lower, n=1)
    return by_lower[found[0]] if found else None


def missing(needed: Iterable[str], given: Iterable[str]) -> str | None:
    """What to say if needed attributes aren't given, and which misspelt ones may be meant."""
    needed, given = tuple(needed), tuple(given)
    absent = [name for name in needed if name not in given]
    if not absent:
        return None
    what = ", ".join(map(repr, absent))
    text = f"attributes {what} are missing" if len(absent) > 1 else f"attribute {what} is missing"
    return text + meant_for(absent[0], [name for name in given if name not in needed])


def meant_for(absent: str, given: Iterable[str]) -> str:
    """A question about a given attribute that looks like the absent one, or nothing."""
    meant = closest(absent, [name for name in given if name not in USUAL])
    return f"; is {quoted(meant)} meant for it?" if meant else ""
