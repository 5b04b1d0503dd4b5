"""`measure`: a table, or JSON."""

import json
from pathlib import Path

import pytest

from meshlab_willmore import measures
from meshlab_willmore.batch.steplog import for_json
from tests import meshes

from .conftest import SAMPLES, call, cube_file, spawn


@pytest.mark.usefixtures("workers_here")
def test_table_layout():
    cube_file()
    result = call("measure", "cube.ply", SAMPLES / "bone.ply")
    assert (result.exit_code, result.stderr) == (0, "")
    header, rule, cube, bone, *_ = result.stdout.splitlines()
    assert header.split() == ["file", "vertices", "faces", "W", "area", "K", "|K|", "M"]
    assert set(rule) == {"-"}
    assert cube.split()[:5] == ["cube.ply", "14", "24", "45.7570", "6.22709"]
    assert bone.split()[1:3] == ["1872", "3022"]
    # Figures end below each other.
    assert header.index("faces") + len("faces") == cube.index(" 24 ") + len(" 24")
    assert "W: Willmore energy." in result.stdout


@pytest.mark.slow
def test_json_is_the_whole_output():
    cube_file()
    done = spawn("measure", "cube.ply", "--json")
    assert (done.returncode, done.stderr) == (0, "")
    (row,) = json.loads(done.stdout)
    totals = measures(*meshes.cube())._asdict()
    assert row == {"file": "cube.ply", "vertices": 14, "faces": 24, **totals}


@pytest.mark.usefixtures("workers_here")
def test_file_that_cannot_be_measured_does_not_stop_the_others():
    cube_file()
    Path("bad.ply").write_text("no mesh")
    Path("points.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n")
    result = call("measure", "bad.ply", "cube.ply", "points.xyz", "--json")
    assert result.exit_code == 1
    assert [row["file"] for row in json.loads(result.stdout)] == ["cube.ply"]
    *errors, last = result.stderr.splitlines()
    first, second = sorted(errors)
    assert last == "Error: 2 of 3 inputs failed; the others are done"
    assert first == "Error: cannot read bad.ply: Header not found"
    assert second.startswith("Error: points.xyz: The current mesh has no faces")


def test_infinite_numbers_are_null_in_json():
    row = {"file": "a", "faces": 1, "area": float("inf"), "W": float("nan"), "K": 1.5}
    shown = {"file": "a", "faces": 1, "area": None, "W": None, "K": 1.5}
    assert for_json(row) == shown


@pytest.mark.usefixtures("workers_here")
def test_missing_file_does_not_stop_the_others():
    cube_file()
    Path("empty.ply").touch()
    result = call("measure", "cube.ply", "*.ply", "no.ply", "*.off", "--json")
    assert result.exit_code == 1
    assert [row["file"] for row in json.loads(result.stdout)] == ["cube.ply", "cube.ply"]
    assert result.stderr == (
        "Error: empty.ply is empty (0 bytes)\n"
        "Error: there is no file no.ply\n"
        "Error: no file matches '*.off'\n"
        "Error: 3 of 5 inputs failed; the others are done\n"
    )


@pytest.mark.parametrize(("size", "area"), [("1e200", "inf"), ("1e60", "2.36603e+120")])
def test_huge_and_infinite_totals_fit_into_the_table(size, area):
    points = f"0 0 0\n{size} 0 0\n0 {size} 0\n0 0 {size}\n"
    Path("big.off").write_text(f"OFF\n4 4 0\n{points}3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")
    result = call("measure", "big.off")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.splitlines()[2].split()[4] == area


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ([], "Missing argument 'IN...'."),
        (["no.ply"], "there is no file no.ply"),
        (["no.ply", "*.off"], "there is no file no.ply; no"),
    ],
)
def test_wrong_usage(arguments, line):
    result = call("measure", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"Error: {line}")
