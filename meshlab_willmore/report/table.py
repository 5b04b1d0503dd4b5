"""A page with a table of many meshes, which sorts: failures first, with a picture of each."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from string import Template
from typing import NamedTuple
from urllib.parse import quote

from .. import thumbnail
from .._version import __version__
from .document import assembled, part
from .rows import DASH, MINUS, PERCENT

# Of the pictures, in pixels: twice as many as on the page, for screens with fine ones.
PICTURE = (224, 168)
# Digits of numbers; from where on they are whole ones, and from where on they have an exponent.
DIGITS = 4
SHORT, LARGE = 1e3, 1e12
# Of percent; more are rounding errors.
_DECIMALS = 6
# Attributes of heads: rows come sorted by their status.
_ATTRIBUTES = {"Name": ' class="name"', "Status": ' aria-sort="ascending"'}


class Entry(NamedTuple):
    """A row of the table: a mesh, how it ended in a word, and whether that is well."""

    name: str
    status: str
    is_done: bool
    # Why it failed, and notes.
    messages: tuple[str, ...] = ()
    # A PNG file; empty if there is none.
    picture: bytes = b""
    # The address of its own page, from this one; empty if it has none.
    link: str = ""
    # By the head of the column; None where there is none.
    numbers: Mapping[str, float | None] = {}


def table_page(
    title: str, kind: str, columns: Sequence[str], entries: Iterable[Entry], legend: str = ""
) -> str:
    """Return the page.

    Parameters
    ----------
    title, kind : str
        The heading, and above it what kind of page this is.
    columns : sequence of str
        The heads of the columns of numbers.
    entries : iterable of Entry
        Those that failed come first; else they stay in their order.
    legend : str, optional
        What the columns are.
    """
    rows = sorted(entries, key=lambda entry: entry.is_done)
    failed = sum(not entry.is_done for entry in rows)
    heads = ["Name", "Status", *columns]
    body = Template(part("table.html")).substitute(
        kind=escape(kind),
        title=escape(title),
        made=f"meshlab_willmore {__version__}, {time.strftime('%d %B %Y, %H:%M')}",
        count=len(rows),
        done=len(rows) - failed,
        failed=failed,
        bad="bad" if failed else "",
        heads="".join(
            f'<th scope="col"{_ATTRIBUTES.get(head, "")}>'
            f'<button type="button">{escape(head)}</button></th>'
            for head in heads
        ),
        rows="\n".join(_row(entry, columns) for entry in rows),
        legend=escape(legend),
        version=__version__,
    )
    return assembled(title, body, "", part("table.js"))


def _row(entry: Entry, columns: Sequence[str]) -> str:
    picture = ""
    if entry.picture:
        uri = thumbnail.data_uri(entry.picture)
        picture = f'<img src="{uri}" alt="{escape(entry.name)}, shaded" loading="lazy">'
    name = escape(entry.name)
    if entry.link:
        name = f'<a href="{escape(quote(entry.link))}">{name}</a>'
    name += "".join(f"<small>{escape(text)}</small>" for text in entry.messages)
    status = "done" if entry.is_done else "failed"
    cells = "".join(_cell(entry.numbers.get(column)) for column in columns)
    return (
        f"<tr><td>{picture}</td>"
        f'<td class="name" data-value="{escape(entry.name)}">{name}</td>'
        f'<td data-value="{int(entry.is_done)} {escape(entry.status)}">'
        f'<span class="status {status}">{escape(entry.status)}</span></td>{cells}</tr>'
    )


def _cell(value: float | None) -> str:
    if value is None or math.isnan(value):
        return f"<td>{DASH}</td>"
    return f'<td data-number="{float(value)!r}">{_short(value)}</td>'


def _short(value: float) -> str:
    """A number with at most so many digits that columns are narrow."""
    if value < 0.0:
        return f"{MINUS}{_short(-value)}"
    is_whole = float(value).is_integer() or SHORT <= abs(value) < LARGE
    return f"{round(value):,}" if is_whole else f"{value:.{DIGITS}g}"


def link(path: Path, page: Path | None) -> str:
    """The address of a page from the one at `path`; empty if it is not there."""
    if page is None or not page.exists():
        return ""
    return Path(os.path.relpath(page, path.parent)).as_posix()


def percent(before: float | None, after: float | None) -> float | None:
    """By how much a number changed, in percent; None if that is not known."""
    if before is None or after is None or not before:
        return None
    # Adding zero makes that of a tiny decrease 0, not -0.
    return round(PERCENT * (after - before) / before, _DECIMALS) + 0.0
