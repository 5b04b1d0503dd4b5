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
saving._check_complete = stand_still
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
        (signal.SIGHUP, 129, "Error: terminated by SIGHUP\n"),
        (signal.SIGINT, 1, "\nAborted!\n"),
    ],
)
@pytest.mark.slow
def test_a_signal_leaves_nothing(run, number, code, said):
    assert stopped_by(number, *run) == (code, said)
    assert listing() == ["cube.ply", "script.mlx"]


def test_a_kill_leaves_no_file_of_the_outputs_name(run):
    code, _ = stopped_by(signal.SIGKILL, *run)
    assert code == -signal.SIGKILL
    (left,) = set(listing()) - {"cube.ply", "script.mlx"}
    assert left.startswith(".out.")


@pytest.mark.slow
def test_an_older_output_stays_when_a_run_is_stopped(run):
    Path("out.ply").write_text("older")
    assert stopped_by(signal.SIGTERM, *run, "--force")[0] == 143
    assert Path("out.ply").read_text() == "older"


def test_sigterm_goes_the_way_of_ctrl_c(run, monkeypatch):
    def stop(*_arguments):
        os.kill(os.getpid(), signal.SIGTERM)

    before = signal.getsignal(signal.SIGTERM)
    monkeypatch.setattr(saving, "_check_complete", stop)
    result = call(*run)
    assert (result.exit_code, result.stderr) == (143, "Error: terminated by SIGTERM\n")
    assert signal.getsignal(signal.SIGTERM) is before
    assert listing() == ["cube.ply", "script.mlx"]


# As a native filter does, this lets no handler of Python run.
NATIVE = """
import ctypes, sys
from pathlib import Path
from meshlab_willmore.cli import main
from meshlab_willmore.meshset import native
apply = native.apply
def take_long(ms, name, /, **given):
    if name != "set_selection_all":
        return apply(ms, name, **given)
    Path("ready").touch()
    for _ in range(20):
        ctypes.PyDLL(None).sleep(1)
    return {}
native.apply = take_long
main(sys.argv[1:], prog_name="meshlab-willmore")
"""


@pytest.fixture
def started(tmp_path_factory):
    """Start a process, and wait until it is ready; what it leaves behind goes with the test's."""
    folder = str(tmp_path_factory.mktemp("temporary"))
    return lambda code, arguments: ready(code, arguments, {**os.environ, "TMPDIR": folder})


def ready(code, arguments, environment):
    process = subprocess.Popen(
        [sys.executable, "-c", code, *map(str, arguments)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    )
    end = time.monotonic() + PATIENCE
    while not Path("ready").exists() and time.monotonic() < end:
        time.sleep(STEP)
    Path("ready").unlink()
    return process


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.slow
def test_a_native_step_ends_at_once(started, number):
    script = script_file(("Select All", {}))
    process = started(NATIVE, ["run", script, "-i", cube_file(), "-o", "out.ply"])
    process.send_signal(number)
    _, err = process.communicate(timeout=PATIENCE)
    assert (process.returncode, err) == (-number, "")
    assert listing() == ["cube.ply", "script.mlx"]


@pytest.mark.slow
def test_a_second_signal_ends_at_once(started, run):
    deaf = SLOW.replace(
        "    time.sleep(60)",
        "    from meshlab_willmore.meshset import interrupts\n"
        "    with interrupts.deferred():\n"
        "        time.sleep(1)\n"
        "        Path('again').touch()\n"
        "        time.sleep(60)",
    )
    process = started(deaf, run)
    process.send_signal(signal.SIGTERM)
    end = time.monotonic() + PATIENCE
    while not Path("again").exists() and time.monotonic() < end:
        time.sleep(STEP)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=PATIENCE)
    assert process.returncode == -signal.SIGTERM


def test_what_is_ignored_stays_ignored(run, monkeypatch):
    # nohup does that.
    def hang_up(*_arguments):
        os.kill(os.getpid(), signal.SIGHUP)

    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        monkeypatch.setattr(saving, "_check_complete", hang_up)
        assert call(*run).exit_code == 0
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_handlers_are_there_again_after_a_native_step(run, monkeypatch):
    # Which one there is while the mesh is saved.
    handlers = []
    monkeypatch.setattr(
        saving, "_check_complete", lambda *_: handlers.append(signal.getsignal(signal.SIGTERM))
    )
    assert call(*run).exit_code == 0
    assert handlers
    assert all(callable(handler) for handler in handlers)
