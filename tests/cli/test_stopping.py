"""SIGTERM, SIGKILL and Ctrl-C in the middle."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from meshlab_willmore.cli import saving

from .conftest import call, cube_file, listing, script_file

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")

# Stands still at the worst moment: the mesh is written and not yet renamed.
SLOW = """
import sys, time
from pathlib import Path
from meshlab_willmore.cli import main, saving
def stand_still(source, target):
    Path("ready").touch()
    time.sleep(60)
saving._check_whole = stand_still
main(sys.argv[1:], prog_name="meshlab-willmore")
"""
PATIENCE = 60
STEP = 0.05


def stopped_by(number, *arguments):
    """Exit code and standard error of a run that gets a signal just before its output is there."""
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    end = time.monotonic() + PATIENCE
    while not Path("ready").exists() and time.monotonic() < end:
        time.sleep(STEP)
    assert any(name.startswith(".out.") for name in listing())
    process.send_signal(number)
    out, err = process.communicate(timeout=PATIENCE)
    assert out == ""
    Path("ready").unlink()
    return process.returncode, err


@pytest.fixture
def run():
    return ["run", script_file(("Select None", {})), "-i", cube_file(), "-o", "out.ply"]


@pytest.mark.parametrize(
    ("number", "code", "said"),
    [
        (signal.SIGTERM, 143, "Error: terminated by SIGTERM\n"),
        (signal.SIGINT, 1, "\nAborted!\n"),
    ],
)
def test_a_signal_leaves_nothing(run, number, code, said):
    assert stopped_by(number, *run) == (code, said)
    assert listing() == ["cube.ply", "script.mlx"]


def test_a_kill_leaves_no_file_of_the_outputs_name(run):
    code, _ = stopped_by(signal.SIGKILL, *run)
    assert code == -signal.SIGKILL
    (left,) = set(listing()) - {"cube.ply", "script.mlx"}
    assert left.startswith(".out.")


def test_an_older_output_stays_when_a_run_is_stopped(run):
    Path("out.ply").write_text("older")
    assert stopped_by(signal.SIGTERM, *run, "--force")[0] == 143
    assert Path("out.ply").read_text() == "older"


def test_sigterm_goes_the_way_of_ctrl_c(run, monkeypatch):
    def stop(*_arguments):
        os.kill(os.getpid(), signal.SIGTERM)

    before = signal.getsignal(signal.SIGTERM)
    monkeypatch.setattr(saving, "_check_whole", stop)
    result = call(*run)
    assert (result.exit_code, result.stderr) == (143, "Error: terminated by SIGTERM\n")
    assert signal.getsignal(signal.SIGTERM) is before
    assert listing() == ["cube.ply", "script.mlx"]
