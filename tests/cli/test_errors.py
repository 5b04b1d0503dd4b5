"""How commands end: in one line, with an exit code, and by a signal."""

import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from meshlab_willmore.cli import compare_row
from meshlab_willmore.machine import MachineWarning, RoomError, SettingError
from meshlab_willmore.mesh_files import saving
from meshlab_willmore.meshset import flips
from meshlab_willmore.meshset.play import play as play_steps

from .conftest import FLIP, TAUBIN, call, cube_file, finished, listing, same_mesh, script_file

FULL = RoomError("no room for temporary files in /tmp: 0.1 MiB are free; fix it with: a command")
WRONG = SettingError("the variable NUMBA_OPT is wrong; fix it with: another command")


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


@pytest.mark.usefixtures("workers_here")
def test_wrong_setting_ends_a_batch_and_full_disk_does_not(fault):
    cube_file("other.ply")
    result = call(
        "run", script_file(FLIP), "-i", cube_file(), "-i", "other.ply", "-o", "{name}_out.ply"
    )
    assert result.exit_code == 1
    lines = result.stderr.splitlines()
    if fault is WRONG:
        assert lines == [f"Error: {WRONG}"]
    else:
        assert sorted(lines[:2]) == [
            f"Error: {FULL} ({name}.ply is left out)" for name in ("cube", "other")
        ]


def test_measure_blames_no_mesh(monkeypatch):
    def fail(*_):
        raise FULL

    monkeypatch.setattr("meshlab_willmore.mesh_files.loading.load", fail)
    result = call("measure", cube_file())
    assert (result.exit_code, result.stderr) == (1, f"Error: {FULL}\n")


def test_compare_blames_no_mesh(monkeypatch):
    outcome = compare_row.Outcome(error=str(FULL), of_machine=True)
    monkeypatch.setattr(compare_row, "run", lambda *_: outcome)
    result = call("compare", cube_file())
    assert (result.exit_code, result.stdout, result.stderr) == (1, "", f"Error: {FULL}\n")


def test_machine_warnings_are_notes(monkeypatch):
    def warn(*arguments):
        import warnings

        warnings.warn("the cache is nowhere; fix it with: a command", MachineWarning, stacklevel=1)
        return play_steps(*arguments)

    monkeypatch.setattr("meshlab_willmore.batch.work.play", warn)
    result = call("run", script_file(FLIP), "-i", cube_file(), "-o", "out.ply")
    assert result.exit_code == 0
    assert result.stderr == "Note: the cache is nowhere; fix it with: a command\n"
    assert Path("out.ply").exists()


# Signals in the middle

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")

# Waits at the worst moment: the mesh is written and not yet renamed.
SLOW = """
import sys, time
from pathlib import Path
from meshlab_willmore.cli import main
from meshlab_willmore.mesh_files import saving
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


@POSIX
@pytest.mark.parametrize(
    ("number", "code", "said"),
    [
        (signal.SIGTERM, 143, "Error: terminated by SIGTERM\n"),
        (signal.SIGHUP, 129, "Error: terminated by SIGHUP\n"),
        (signal.SIGINT, 1, "\nAborted!\n"),
    ],
)
@pytest.mark.slow
def test_signal_leaves_no_files(run, number, code, said):
    assert stopped_by(number, *run) == (code, said)
    assert listing() == ["cube.ply", "script.mlx"]


@POSIX
@pytest.mark.slow
def test_kill_leaves_no_file_with_the_output_name(run):
    code, _ = stopped_by(signal.SIGKILL, *run)
    assert code == -signal.SIGKILL
    (left,) = set(listing()) - {"cube.ply", "script.mlx"}
    assert left.startswith(".out.")


@POSIX
@pytest.mark.slow
def test_stopped_run_keeps_the_older_output(run):
    Path("out.ply").write_text("older")
    assert stopped_by(signal.SIGTERM, *run, "--force")[0] == 143
    assert Path("out.ply").read_text() == "older"


@POSIX
def test_sigterm_acts_as_ctrl_c(run, monkeypatch):
    def stop(*_arguments):
        os.kill(os.getpid(), signal.SIGTERM)

    before = signal.getsignal(signal.SIGTERM)
    monkeypatch.setattr(saving, "_check_complete", stop)
    result = call(*run)
    assert (result.exit_code, result.stderr) == (143, "Error: terminated by SIGTERM\n")
    assert signal.getsignal(signal.SIGTERM) is before
    assert listing() == ["cube.ply", "script.mlx"]


# Like a native filter, this runs no Python handler.
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


@POSIX
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.slow
def test_signal_ends_a_native_step_at_once(started, number):
    script = script_file(("Select All", {}))
    process = started(NATIVE, ["run", script, "-i", cube_file(), "-o", "out.ply"])
    process.send_signal(number)
    _, err = process.communicate(timeout=PATIENCE)
    assert (process.returncode, err) == (-number, "")
    assert listing() == ["cube.ply", "script.mlx"]


@POSIX
@pytest.mark.slow
def test_second_signal_ends_the_process_at_once(started, run):
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


@POSIX
def test_ignored_signal_stays_ignored(run, monkeypatch):
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


@POSIX
def test_handlers_are_restored_after_a_native_step(run, monkeypatch):
    # Which one there is while the mesh is saved.
    handlers = []
    monkeypatch.setattr(
        saving, "_check_complete", lambda *_: handlers.append(signal.getsignal(signal.SIGTERM))
    )
    assert call(*run).exit_code == 0
    assert handlers
    assert all(callable(handler) for handler in handlers)


# Closed streams


@pytest.mark.skipif(sys.platform == "win32", reason="a shell of POSIX")
@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&- >&- 2>&-"])
@pytest.mark.slow
def test_run_with_closed_streams(cube, closed):
    # It needs no kernels, which take a second.
    script = script_file(TAUBIN, TAUBIN)
    # The log would get the free descriptor.
    arguments = f"run {script} -i {cube} -o out.ply --log log.txt"
    command = f"{shlex.quote(sys.executable)} -m meshlab_willmore {arguments} {closed}"
    done = finished(["/bin/sh", "-c", command], timeout=100)
    assert (done.returncode, done.stderr) == (0, "")
    assert call("run", script, "-i", cube, "-o", "expected.ply").exit_code == 0
    assert same_mesh("out.ply", "expected.ply")
    lines = Path("log.txt").read_text().splitlines()
    assert len(lines) == 10
    assert lines[-1].startswith("done, ")


@pytest.mark.skipif(sys.platform == "win32", reason="a shell of POSIX")
@pytest.mark.slow
def test_log_on_a_closed_output(cube):
    script = script_file(TAUBIN)
    command = f"{shlex.quote(sys.executable)} -m meshlab_willmore run {script} -i {cube} -l - >&-"
    done = finished(["/bin/sh", "-c", command], timeout=100)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(sys.platform == "win32", reason="a shell of POSIX")
@pytest.mark.slow
def test_new_file_does_not_replace_a_closed_stream():
    code = (
        "import os, sys; from meshlab_willmore.cli import errors; errors.open_closed_streams(); "
        "sys.exit(os.open('new', os.O_CREAT | os.O_WRONLY))"
    )
    command = f"{shlex.quote(sys.executable)} -c {shlex.quote(code)} <&- >&- 2>&-"
    # The exit code is the new file's descriptor.
    assert subprocess.run(["/bin/sh", "-c", command], check=False, timeout=100).returncode > 2
