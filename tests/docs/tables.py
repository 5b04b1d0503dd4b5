"""The tables of a page, as cells."""

import re


def tables(page):
    """The tables of a page: lists of rows, each a list of cells; the first row is the head."""
    found = [[]]
    for line in page.read_text(encoding="utf-8").splitlines():
        line = line.strip()
        if not line.startswith("|"):
            found.append([])
        elif not re.fullmatch(r"[|: -]+", line):
            found[-1].append([cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]])
    return [table for table in found if table]


def table_with(page, *head):
    """The rows of the first table whose head begins with these cells."""
    return next(table[1:] for table in tables(page) if table[0][: len(head)] == list(head))
