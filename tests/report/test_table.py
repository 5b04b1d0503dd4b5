"""The table of a batch in a browser: its order, and that it can be sorted."""

import pytest

from meshlab_willmore.report.table import Entry, link, percent, table_page
from meshlab_willmore.thumbnail import picture
from tests import meshes

COLUMNS = ("Faces", "W")


@pytest.fixture
def path(tmp_path):
    png = picture(*meshes.octahedron(), 40, 30)
    entries = [
        Entry("scan10", "done", True, ("a note",), png, "pages/a b#?.html", {"Faces": 9, "W": 2.5}),
        Entry("scan9", "done", True, (), png, "", {"Faces": 1000, "W": None}),
        Entry("bad", "bad file", False, ("no mesh",)),
        Entry("scan11", "done", True, (), b"", "", {"Faces": 30, "W": 1e-7}),
    ]
    page = tmp_path / "all.html"
    page.write_text(table_page("<b>", "Batch", COLUMNS, entries, "W: energy"), encoding="utf-8")
    return page


@pytest.mark.slow
def test_table_sorts_and_keeps_what_is_unknown_last(browse, path):
    with browse(path) as opened:
        page = opened.page

        def names():
            return page.eval_on_selector_all("td.name", "all => all.map(td => td.dataset.value)")

        def sort(head):
            page.click(f"th button:text-is('{head}')")
            heads = page.locator("th[aria-sort]")
            assert heads.count() == 1
            assert heads.inner_text().startswith(head)
            return names()

        assert names() == ["bad", "scan10", "scan9", "scan11"]
        assert sort("Faces") == ["scan10", "scan11", "scan9", "bad"]
        assert sort("Faces") == ["scan9", "scan11", "scan10", "bad"]
        assert sort("W") == ["scan11", "scan10", "scan9", "bad"]
        assert sort("Name") == ["bad", "scan9", "scan10", "scan11"]
        page.focus("th button:text-is('Name')")
        page.keyboard.press("Enter")
        assert names() == ["scan11", "scan10", "scan9", "bad"]
        assert sort("Status")[0] == "bad"
        assert opened.complaints == []
        assert opened.requests == [path.as_uri()]


@pytest.mark.slow
@pytest.mark.parametrize("width", [1280, 390])
def test_table_fits_the_screen(browse, path, width):
    with browse(path, width) as opened:
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
        assert opened.page.locator("img").count() == 2
        assert opened.page.get_attribute("td a", "href") == "pages/a%20b%23%3F.html"
        assert opened.page.locator(".status.failed").is_visible()
        assert opened.page.locator(".narrow").is_visible() == (width == 390)
        # Nothing of the title is an element.
        assert opened.page.inner_text("h1") == "<b>"


def test_link_is_from_page_to_page(tmp_path):
    (tmp_path / "pages").mkdir()
    page = tmp_path / "pages" / "one.html"
    assert link(tmp_path / "all.html", page) == ""
    page.touch()
    assert link(tmp_path / "all.html", page) == "pages/one.html"
    assert link(tmp_path / "pages" / "all.html", page) == "one.html"
    assert link(tmp_path / "all.html", None) == ""


@pytest.mark.parametrize(
    ("before", "after", "share"),
    [(200.0, 150.0, -25.0), (0.0, 1.0, None), (None, 1.0, None), (1.0, None, None)],
)
def test_percent_of_what_is_known(before, after, share):
    assert percent(before, after) == share
