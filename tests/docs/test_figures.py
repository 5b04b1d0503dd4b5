"""Figures that the pages quote are what the package computes today."""

import json
import re
import shlex

import pytest
from click.testing import CliRunner

from meshlab_willmore import optimize_flips
from meshlab_willmore.cli import main
from meshlab_willmore.demo.experiments import run_demo
from meshlab_willmore.report.stages import significant

from .pages import DOCS, blocks
from .tables import table_with, tables

studies = pytest.importorskip("studies")
pytestmark = [pytest.mark.nightly, pytest.mark.heavy, pytest.mark.timeout(3600)]
WILLMORE, CHAINS = {"energy": "willmore"}, {"energy": "willmore", "search": "variable depth"}
# What the settings in the cells of docs/settings.md are.
SETTINGS = {
    "(default)": [{}],
    "`virtualpoint=0.05`": [{"virtualpoint": 0.05}],
    "`energy='willmore'`": [WILLMORE],
    "`energy='uniform virtual willmore'`": [{"energy": "uniform virtual willmore"}],
    "`energy='delaunay'` or `'area'`": [{"energy": "area"}, {"energy": "delaunay"}],
    "`energy='willmore', search='variable depth'`": [CHAINS],
    "and `depth=3`": [{**CHAINS, "depth": 3}],
    "`energy='willmore', search='thorough'`": [{**WILLMORE, "search": "thorough"}],
    "`energy='mean curvature'`": [{"energy": "mean curvature"}],
}
PAGE = DOCS / "settings.md"
# Of docs/guide/compare.md.
COLUMNS = {
    "name": str,
    "flips": str,
    "willmore_energy": significant,
    "area": significant,
    "absolute_gaussian_curvature": significant,
    "absolute_mean_curvature": significant,
    "worst_shape": "{:.3f}".format,
    "mean_shape": "{:.3f}".format,
    "self_intersecting": str,
    "normal_error": "{:.2f}".format,
    "distance": "{:.3g}".format,
}
GUARDED = {"`featuredeg=30` with any of these", "`checkintersections=True` with any of these"}


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo") / "willmore-demo"
    return folder, run_demo(folder, lambda line: None)


def test_table_of_the_method(demo):
    model, rows = "", []
    for stage in demo[1].stages:
        cells = [stage.name, str(stage.faces), "" if stage.flips is None else str(stage.flips)]
        numbers = map(significant, (stage.willmore, stage.area, stage.mean_curvature))
        if (stage.model, stage.name) != ("scan", "as scanned"):
            rows.append([stage.model if stage.model != model else "", *cells, *numbers])
            model = stage.model
    assert [row[:-1] for row in table_with(DOCS / "method.md", "model", "stage")] == rows


def test_table_of_the_comparison(demo, monkeypatch):
    page = DOCS / "guide" / "compare.md"
    (command,) = blocks(page)
    monkeypatch.chdir(demo[0].parent)
    done = CliRunner().invoke(main, [*shlex.split(command.text)[1:], "--json"])
    assert done.exit_code == 0, done.output
    rows = [
        [format_(row[key]) for key, format_ in COLUMNS.items()] for row in json.loads(done.stdout)
    ]
    assert rows == table_with(page, "row", "flips")


@pytest.fixture(scope="module")
def surfaces():
    from studies.settings import surfaces

    return [(vertices, faces) for _, vertices, faces in surfaces()]


@pytest.mark.parametrize("cell", SETTINGS)
def test_row_of_the_settings(cell, surfaces):
    (row,) = (row for row in table_with(PAGE, "you want", "settings") if row[1] == cell)
    for shown, (vertices, faces) in zip(row[2:6], surfaces, strict=True):
        found = sorted(
            optimize_flips(vertices, faces, **options).willmore_after for options in SETTINGS[cell]
        )
        assert_shown(shown, found)


def test_no_row_of_the_settings_is_left_out():
    rows = table_with(PAGE, "you want", "settings")
    assert {row[1] for row in rows} == {"", *SETTINGS, *GUARDED}


def test_energies_that_annealing_reaches(surfaces):
    text = PAGE.read_text(encoding="utf-8")
    shown = re.search(r"it reaches W ([\d., ]+) and (\d+) in", text)
    found = [
        optimize_flips(*surface, **WILLMORE, search="annealing").willmore_after
        for surface in surfaces
    ]
    for cell, value in zip([*shown[1].split(", "), shown[2]], found, strict=True):
        assert_shown(cell, [value])


def test_scrambled_starts():
    from studies.settings import starts

    rows = list(starts())
    page = table_with(PAGE, "", "jittered torus, W")
    for number, row in enumerate(page):
        for shown, found in zip(row[1:], (rows[number], rows[number + len(page)]), strict=True):
            _, least, _, most = map(float, found[2:])
            assert_shown(shown.removesuffix(", all"), sorted({least, most}))


def assert_shown(shown, found):
    """A cell shows a value, or the least and the most of several, in its digits."""
    cells = shown.split(" to ")
    digits = len(cells[0].partition(".")[2])
    texts = sorted({f"{value:.{digits}f}" for value in (found[0], found[-1])}, key=float)
    assert texts == cells


# What the study starts from, and the place of its table on the page.
@pytest.mark.parametrize(("options", "place"), [([], 0), (["--decimated"], 1)], ids=str)
def test_presets_in_the_study(options, place):
    from studies import faithful, tools

    results = faithful.measured(faithful.options_of(options), list(tools.presets()))
    page = [rows for rows in tables(DOCS / "presets.md") if rows[0][1] == "normal error"][place]
    shown = {row[0]: row[1:-1] for row in page}
    found = {row[0]: row[1:-1] for row in results.means()}
    assert found == {tool: shown[tool] for tool in found}
