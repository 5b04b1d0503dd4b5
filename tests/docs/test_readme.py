"""README is short, its links work anywhere, and CITATION.cff says the same."""

import re

import pytest

from meshlab_willmore import __version__

from .pages import DOCS, README, ROOT, blocks, name_of, pages
from .tables import table_with

MOST_CHARACTERS = 8000
TEXT = README.read_text(encoding="utf-8")
PYPROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
ADDRESSES = dict(re.findall(r'^(\w+) = "(https://[^"]+)"$', PYPROJECT, re.MULTILINE))
LINKS = re.findall(r"\]\(([^)]+)\)", TEXT)
OTHERS = {"https://github.com/cnr-isti-vclab/PyMeshLab"}


def slugs(page):
    """The anchors of a page's headings."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_readme_is_short():
    assert len(TEXT) <= MOST_CHARACTERS


def test_readme_links_to_many_pages():
    assert len(LINKS) > 8
    assert not re.search(r"<(a|img) |^\[[^\]]+\]: ", TEXT, re.MULTILINE)


@pytest.mark.parametrize("link", LINKS)
def test_a_link_of_readme_is_absolute_and_leads_to_a_page(link):
    if link in OTHERS:
        return
    home = ADDRESSES["Documentation"]
    assert link.startswith(home)
    path, _, anchor = link.removeprefix(home).partition("#")
    if path.startswith("_images/"):
        # Sphinx puts pictures of all folders into one.
        assert (DOCS / "pictures" / path.removeprefix("_images/")).exists()
        return
    page = (DOCS / (path or "index.html")).with_suffix(".md")
    assert page.exists()
    assert not anchor or anchor in slugs(page)


@pytest.mark.parametrize("name", ["demo", "test"])
def test_readme_has_the_command(name):
    (block,) = (block for block in blocks(README) if block.note == f"command: {name}")
    assert block.text.count("\n") == 1
    assert f"pip install '.[{name}]'" in block.text


def test_readme_names_scripts_that_there_are():
    for name in re.findall(r"filter_scripts/\S+", TEXT):
        assert (ROOT / name).exists()


def test_the_citation_has_version_and_addresses():
    lines = (ROOT / "CITATION.cff").read_text(encoding="utf-8").splitlines()
    assert f"version: {__version__}" in lines
    assert f"url: {ADDRESSES['Documentation']}" in lines
    assert f"repository-code: {ADDRESSES['Repository']}" in lines


def test_readme_has_the_figures_of_the_study():
    """Normal error, mean shape and cut faces, as in docs/presets.md."""
    study = {row[0]: row for row in table_with(DOCS / "presets.md", "tool", "normal error")}
    rows = table_with(README, "you want", "`preset`")
    assert len(rows) == 6
    for want, preset, normals, shape, cuts in rows:
        if preset:
            name = re.search(r"`'(\w+)'`", preset)[1]
            row = study[f"**{name}**"]
        else:
            row = study["(scrambled)" if "scrambled" in want else "MeshLab curvature, mean"]
        found = [float(row[1]), float(row[3]), float(row[5])]
        assert [normals, shape, cuts] == [f"{found[0]:.2f}°", f"{found[1]:.3f}", f"{found[2]:.1f}"]


def test_the_start_page_says_where_the_sources_are():
    start = (DOCS / "start.md").read_text(encoding="utf-8")
    address = ADDRESSES["Repository"]
    assert f"]({address})" in start
    assert f"git clone {address}\ncd {address.rpartition('/')[2]}\n" in start


def test_addresses_of_the_package_lead_to_the_site_and_the_repository():
    assert ADDRESSES["Issues"] == f"{ADDRESSES['Repository']}/issues"
    page = ADDRESSES["Changelog"].removeprefix(ADDRESSES["Documentation"])
    assert (DOCS / page).with_suffix(".md").exists()


@pytest.mark.parametrize("page", pages(), ids=name_of)
def test_pages_install_from_the_sources(page):
    assert "pip install 'meshlab-willmore" not in page.read_text(encoding="utf-8")
