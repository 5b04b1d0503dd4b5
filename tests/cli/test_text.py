"""Tables that fit into the window, and results of filters as text."""

import json
from pathlib import Path

import numpy as np
import pytest

from meshlab_willmore.cli import text
from meshlab_willmore.cli.text import fitted, in_columns, width

from .conftest import call, cube_file, script_file


@pytest.mark.usefixtures("workers_here")
@pytest.mark.parametrize("columns", ["80", "100", "132", "40"])
def test_table_fits_into_the_window(monkeypatch, tmp_path, columns):
    monkeypatch.setenv("COLUMNS", columns)
    folder = tmp_path / ("long" * 20) / "日本" / "deep"
    folder.mkdir(parents=True)
    names = [cube_file(folder / "cube.ply"), cube_file("c.ply"), cube_file("a\nb.ply")]
    lines = call("measure", *names).stdout.splitlines()
    table = lines[:-2]
    assert len(table) == 6
    # The numbers alone want 63.
    assert max(map(width, table)) <= max(int(columns), 75)
    assert table[2].split()[0].endswith("cube.ply")
    assert table[3].startswith("c.ply ")
    assert table[4].startswith("a?b.ply ")


def test_names_are_whole_in_a_pipe(monkeypatch, tmp_path):
    monkeypatch.delenv("COLUMNS", raising=False)
    (tmp_path / ("long" * 30)).mkdir()
    name = cube_file(tmp_path / ("long" * 30) / "cube.ply")
    assert call("measure", name).stdout.splitlines()[2].startswith(f"{name} ")


@pytest.mark.parametrize("columns", [80, 40, None])
def test_a_summary_fits_into_the_window(monkeypatch, columns):
    monkeypatch.delenv("COLUMNS", raising=False)
    if columns:
        monkeypatch.setenv("COLUMNS", str(columns))
    names = [f"a-folder-of-scans/{n}.ply" for n in range(4)]
    records = [
        {"input": name, "status": "error", "seconds": 9.0, "reason": f"{name}: {'it failed ' * 9}"}
        for name in names
    ]
    Path("log.jsonl").write_text("\n".join(map(json.dumps, records)))
    lines = call("summary", "log.jsonl").stdout.splitlines()
    assert (max(map(width, lines)) <= (columns or 0)) == bool(columns)
    assert len([line for line in lines if not line.startswith("    ")]) == 6
    assert " ".join(" ".join(lines).split()).count(f"error: {names[0]}: it failed it") == 1


def test_columns_are_aligned_by_visible_width():
    rows = [("日本", "1"), ("ab", "22"), ("e\u0301", "3")]
    assert in_columns(rows).splitlines() == ["日本   1", "ab    22", "e\u0301      3"]
    assert fitted(rows) == rows


def test_results_of_steps(cube):
    script = script_file(
        ("Select All", {}), ("Willmore measures", {}), ("Compute Geometric Measures", {})
    )
    first, ours, native = call("run", script, "-i", cube).stdout.splitlines()
    assert first.startswith("cube.ply -> not saved (no -o): 3 steps, ")
    assert ours.startswith("  step 2, get_willmore_measures: area 6.22709, ")
    assert "willmore_energy 45.757" in ours
    assert native.startswith("  step 3, get_geometric_measures: ")
    assert "surface_area 6.22709" in native
    assert "bbox [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]], " in native


def test_long_values_are_cut():
    assert text._short(2 / 3) == "0.666667"
    assert text._short(np.array([[1 / 3, 1e-9], [1e300, np.inf]])) == (
        "[[0.333333, 1e-09], [1e+300, inf]]"
    )
    assert text._short(np.arange(3)) == "[0, 1, 2]"
    assert text._short(np.zeros(1000)) == str([0.0] * 1000)[:60] + "..."
