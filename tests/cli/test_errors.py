"""Faults of the machine in commands: told in one line, and no mesh is blamed."""

from pathlib import Path

import pytest

from meshlab_willmore.cli import compare_row
from meshlab_willmore.machine import MachineWarning, RoomError, SettingError
from meshlab_willmore.meshset import flips
from meshlab_willmore.meshset.play import play as play_steps

from .conftest import FLIP, call, cube_file, listing, script_file

FULL = RoomError("no room for temporary files in /tmp: 0.1 MiB are free; mend it with: a command")
WRONG = SettingError("the variable NUMBA_OPT is wrong; mend it with: another command")


@pytest.fixture(params=[FULL, WRONG], ids=["room", "setting"])
def fault(request, monkeypatch):
    def fail(_):
        raise request.param

    monkeypatch.setattr(flips, "take", fail)
    return request.param


def test_flip_blames_no_mesh(fault):
    result = call("flip", cube_file(), "out.ply")
    assert (result.exit_code, result.stdout, result.stderr) == (1, "", f"Error: {fault}\n")
    assert listing() == ["cube.ply"]


def test_run_blames_no_mesh(fault):
    result = call("run", script_file(FLIP), "-i", cube_file(), "-o", "out.ply")
    assert (result.exit_code, result.stdout, result.stderr) == (1, "", f"Error: {fault}\n")


def test_what_is_set_wrong_ends_a_batch_and_a_lack_of_room_does_not(fault):
    cube_file("other.ply")
    result = call(
        "run", script_file(FLIP), "-i", cube_file(), "-i", "other.ply", "-o", "{name}_out.ply"
    )
    assert result.exit_code == 1
    lines = result.stderr.splitlines()
    if fault is WRONG:
        assert lines == [f"Error: {WRONG}"]
    else:
        assert lines[:2] == [
            f"Error: {FULL} ({name}.ply is left out)" for name in ("cube", "other")
        ]


def test_measure_blames_no_mesh(monkeypatch):
    def fail(_):
        raise FULL

    monkeypatch.setattr("meshlab_willmore.cli.loading.loaded", fail)
    result = call("measure", cube_file())
    assert (result.exit_code, result.stderr) == (1, f"Error: {FULL} (cube.ply is left out)\n")


def test_compare_blames_no_mesh(monkeypatch):
    outcome = compare_row.Outcome(error=str(FULL), of_machine=True)
    monkeypatch.setattr(compare_row, "run", lambda *_: outcome)
    result = call("compare", cube_file())
    assert (result.exit_code, result.stdout, result.stderr) == (1, "", f"Error: {FULL}\n")


def test_what_makes_work_slow_is_a_note(monkeypatch):
    def warn(*arguments):
        import warnings

        warnings.warn("the cache is nowhere; mend it with: a command", MachineWarning, stacklevel=1)
        return play_steps(*arguments)

    monkeypatch.setattr("meshlab_willmore.meshset.play.play", warn)
    result = call("run", script_file(FLIP), "-i", cube_file(), "-o", "out.ply")
    assert result.exit_code == 0
    assert result.stderr == "Note: the cache is nowhere; mend it with: a command\n"
    assert Path("out.ply").exists()
