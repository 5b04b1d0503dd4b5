"""The subprocesses of a comparison: they end in time, alone, and leave nothing."""

import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from meshlab_willmore.batch import process
from meshlab_willmore.cli import compare_row
from meshlab_willmore.cli.compare_row import Comparison, Outcome
from meshlab_willmore.compare import rows
from meshlab_willmore.compare.rows import Row, own_rows

from .conftest import cube_file, listing

PATIENCE = 60
STEP = 0.05
# Native, and endless.
ENDLESS = Row("endless", "apply_coord_laplacian_smoothing", {"stepsmoothnum": 10**9})
# PyMeshLab crashes.
DEADLY = Row(
    "deadly", "meshing_decimation_quadric_edge_collapse", {"targetfacenum": -5, "targetperc": 0.0}
)
FAULTY = Row("faulty", "apply_coord_laplacian_smoothing", {"nonsense": 1})
(OWN,) = own_rows(["greedy"], ["willmore"], {})


@pytest.fixture
def task():
    return Comparison(str(cube_file()), None, 300.0)


@pytest.fixture(autouse=True)
def temporary(tmp_path_factory, monkeypatch):
    """The folder for temporary files, of this process and of those that it starts."""
    folder = tmp_path_factory.mktemp("temporary")
    monkeypatch.setenv("TMPDIR", str(folder))
    monkeypatch.setattr(tempfile, "tempdir", None)
    yield folder
    assert listing(folder) == []


@pytest.mark.slow
def test_phases_of_a_row(task):
    said = []
    outcome = compare_row.run(task, OWN, said.append)
    assert said == [compare_row.WARMING, compare_row.RUNNING, compare_row.MEASURING]
    assert outcome.seconds > 0.0
    assert outcome.quality["flips"] == 10


@pytest.mark.slow
def test_slow_filter_is_stopped(task):
    said = []
    start = time.perf_counter()
    outcome = compare_row.run(task._replace(timeout=0.5), ENDLESS, said.append)
    assert outcome == Outcome(timed_out=True)
    assert said[-1] == compare_row.RUNNING
    assert time.perf_counter() - start < PATIENCE


@pytest.mark.slow
def test_crash_and_error_are_reported(task):
    assert compare_row.run(task, DEADLY, print).error.startswith("crashed (SIG")
    outcome = compare_row.run(task, FAULTY, print)
    assert "nonsense" in outcome.error
    assert "\n" not in outcome.error
    assert outcome.trace.startswith("Traceback")
    assert (outcome.quality, outcome.timed_out) == (None, False)


def test_filter_that_exits_is_not_called_too_slow(task, monkeypatch):
    program = (
        "import sys; sys.path[:] = {path!r}; from meshlab_willmore.cli import compare_row\n"
        "compare_row.compute = lambda *_: sys.exit(1)\n"
        "from {module} import main; main()"
    )
    monkeypatch.setattr(process, "_PROGRAM", program)
    assert compare_row.run(task, OWN, print).error == "the process ended with exit code 1"


def test_filter_is_warmed_up_before_timing(task, monkeypatch):
    events = []
    monkeypatch.setattr(rows, "warm_up", lambda *given: events.append(given))
    compare_row.compute(compare_row.Computation(task, OWN), events.append)
    warming, warmed, running, measuring = events
    assert warmed == (OWN.filter, OWN.given)
    assert warming.name == compare_row.WARMING
    assert running[:2] == (compare_row.RUNNING, task.timeout)
    assert measuring[:2] == (compare_row.MEASURING, None)


@pytest.mark.slow
def test_files_of_the_working_folder_do_not_hide_modules(task):
    Path("json.py").write_text("raise ImportError('a file of the user')")
    Path("click.py").write_text("raise ImportError('a file of the user')")
    initial = Row("initial", "", {})
    assert compare_row.run(task, initial, print).quality["area"] == pytest.approx(6.22709, abs=1e-5)


@pytest.mark.slow
def test_time_limit_is_for_the_filter_alone(task, monkeypatch):
    slow = (
        "import sys, time; sys.path[:] = {path!r}; from {module} import main\n"
        "from meshlab_willmore.compare import rows\n"
        "rows.warm_up = lambda *_: time.sleep(1.5)\n"
        "main()"
    )
    monkeypatch.setattr(process, "_PROGRAM", slow)
    native = Row("quick", "set_selection_all", {})
    outcome = compare_row.run(task._replace(timeout=1.0), native, print)
    assert (outcome.timed_out, outcome.error) == (False, None)


# --- signals -----------------------------------------------------------------------------------

# Writes down the process that it starts, and when the filter runs in it.
SLOW = f"""
import subprocess, sys
from pathlib import Path
from meshlab_willmore.cli import compare, main
from meshlab_willmore.compare import rows
compare._rows = lambda *_: [rows.{ENDLESS}]
class Noted(subprocess.Popen):
    def __init__(self, *arguments, **given):
        super().__init__(*arguments, **given)
        Path("child").write_text(str(self.pid))
subprocess.Popen = Noted
def show(bar, name, word):
    if (name, word) == ("endless", "running"):
        Path("ready").touch()
compare._show_phase = show
main(sys.argv[1:], prog_name="meshlab-willmore")
"""


def is_running(pid):
    """Whether there is a process, and not a zombie."""
    if Path("/proc/self/stat").exists():
        try:
            # After the name, which may have any characters.
            return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
        except (FileNotFoundError, ProcessLookupError):
            return False
    done = subprocess.run(
        ["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True, check=False
    )
    return done.stdout.strip()[:1] not in ("", "Z")


def wait_for(condition):
    end = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < end:
        time.sleep(STEP)
    assert condition()


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize(
    ("number", "code", "said"),
    [
        (signal.SIGINT, 1, "\nAborted!\n"),
        (signal.SIGTERM, 143, "Error: terminated by SIGTERM\n"),
        (signal.SIGKILL, -9, ""),
    ],
)
@pytest.mark.slow
def test_no_process_outlives_the_command(task, temporary, number, code, said):
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW, "compare", task.source],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    wait_for(Path("ready").exists)
    child = int(Path("child").read_text())
    assert is_running(child)
    process.send_signal(number)
    output, errors = process.communicate(timeout=PATIENCE)
    # On a slow machine there may be a line on how far it is.
    assert (output, errors[len(errors) - len(said) :]) == ("", said)
    assert process.returncode == code
    wait_for(lambda: not is_running(child))
    if number == signal.SIGKILL:
        # Nobody is left to remove the folder.
        for folder in temporary.iterdir():
            folder.rmdir()
