"""Tables fit into the window, whatever the names in them."""

import pytest

from meshlab_willmore.cli.text import fitted, in_columns, width

from .conftest import call, cube_file


@pytest.mark.parametrize("columns", ["80", "100", "132", "40"])
def test_the_table_of_measures_fits(monkeypatch, tmp_path, columns):
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


def test_in_a_pipe_names_are_whole(monkeypatch, tmp_path):
    monkeypatch.delenv("COLUMNS", raising=False)
    (tmp_path / ("long" * 30)).mkdir()
    name = cube_file(tmp_path / ("long" * 30) / "cube.ply")
    assert call("measure", name).stdout.splitlines()[2].startswith(f"{name} ")


def test_columns_go_by_what_is_seen():
    rows = [("日本", "1"), ("ab", "22"), ("e\u0301", "3")]
    assert in_columns(rows).splitlines() == ["日本   1", "ab    22", "e\u0301      3"]
    assert fitted(rows) == rows
