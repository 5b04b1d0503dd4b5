"""The tables in docs are what the studies compute."""

from pathlib import Path

import pytest

from studies import cube, models, virtual_points

DOCS = Path(__file__).parents[1] / "docs"
# Of these pushes, docs/cube.md leaves the descents out.
LEFT_OUT = {"0.3", "0.4"}

pytestmark = [pytest.mark.nightly, pytest.mark.heavy, pytest.mark.timeout(3600)]


def missing(rows, page):
    """The rows that are in no table of a page of docs."""
    lines = (DOCS / page).read_text(encoding="utf-8").splitlines()
    known = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines]
    return [row for row in rows if row not in known]


def agreements():
    """A row for each place of the virtual points, with the numbers of both tori."""
    found = {}
    for _, place, agreement in virtual_points.agreement():
        found.setdefault(place, [place]).append(agreement)
    return found.values()


@pytest.mark.parametrize(
    "rows",
    [
        lambda: virtual_points.searched(models.all_models()),
        lambda: virtual_points.searched(models.all_models(), monotone=False),
        lambda: virtual_points.searched(models.tori(), search="variable depth", depth=3),
        virtual_points.both_at_once,
        agreements,
    ],
    ids=["monotone", "literal", "variable depth", "both", "agreement"],
)
def test_tables_of_virtual_points(rows):
    rows = [row for row in rows() if row[0] != "cube"]
    assert missing(rows, "virtual_points.md") == []


@pytest.mark.parametrize(
    "rows",
    [
        lambda: (row for row in cube.descents() if row[0] not in LEFT_OUT),
        cube.enumerated,
        cube.where_it_changes,
        cube.where_fans_stop,
    ],
    ids=["descents", "enumerated", "changes", "fans"],
)
def test_tables_of_the_cube(rows):
    assert missing(rows(), "cube.md") == []
