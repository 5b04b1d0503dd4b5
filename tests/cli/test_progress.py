"""The line with the progress of a command."""

import contextlib
import errno
import io
import logging
import os
import subprocess
import sys
from pathlib import Path

import pytest

from meshlab_willmore.batch.lost_kernels import note_lost_kernels
from meshlab_willmore.cli import main, progress
from meshlab_willmore.cli.progress import Status, shown
from meshlab_willmore.mesh import jit, kernel_cache

from .conftest import FLIP, TAUBIN, Terminal, call, script_file

LONG = "/a/very/long/path/that/nobody/would/ever/want/to/read/in/full/of/the/scan_0017.ply"
WIDE = "\u9762" * 40

# The fixture of other tests changes it.
IN_A_LOG = progress.SECONDS_IN_A_LOG


class Clock:
    now = 0.0

    def __call__(self):
        return self.now


@contextlib.contextmanager
def terminal(monkeypatch):
    """A terminal on which only what is begun is drawn, as no time passes."""
    monkeypatch.setattr(progress, "SECONDS_ON_A_TERMINAL", 3600.0)
    with contextlib.redirect_stderr(Terminal()) as stream:
        yield stream


def columns(text):
    return sum(2 if letter == "\u9762" else 1 for letter in text)


def test_line_and_sentence():
    clock = Clock()
    status = Status("scan.ply", 4, clock)
    status.next("reading")
    clock.now = 2.0
    status.next("flipping")
    clock.now = 14.9
    status.detail("round 7, 52 flips")
    line = "scan.ply  [####------------]  25%  flipping: round 7, 52 flips, 12 s"
    assert status.line(80) == line
    assert status.sentence() == "scan.ply: flipping: round 7, 52 flips (2 of 4), 12 s so far"
    status.begin("saving")
    assert status.line(80) == "scan.ply  [####------------]  25%  saving, 0 s"


def test_parts_of_one_thing_are_counted_by_one_clock():
    clock = Clock()
    status = Status("warmup", 4, clock)
    status.next("everything")
    clock.now = 2.0
    status.count()
    status.detail("done with greedy")
    clock.now = 14.9
    assert status.sentence() == "warmup: everything: done with greedy (2 of 4), 14 s so far"
    assert status.line(80).startswith("warmup  [####------------]  25%  everything: done")


def test_the_fraction_of_a_part_moves_the_bar():
    status = Status("scan.ply", 4, Clock())
    status.next("reading")
    status.next("flipping")
    status.detail("round 7", 0.5)
    assert status.line(80) == "scan.ply  [######----------]  37%  flipping: round 7, 0 s"
    status.next("smoothing")
    assert " 50%  smoothing" in status.line(80)


def test_one_part_alone_says_how_far_it_is_in_percent():
    status = Status("scan.ply", 1, Clock())
    status.begin("flipping")
    status.detail("round 7", 0.256)
    assert status.line(80) == "scan.ply  [####------------]  25%  flipping: round 7, 0 s"
    assert status.sentence() == "scan.ply: flipping: round 7 (25 %), 0 s so far"
    status.end()
    status.begin("saving")
    assert status.line(80) == "scan.ply  [################] 100%  saving, 0 s"


def test_details_are_cut_last():
    status = Status("scan.ply", 8)
    status.begin("meshing_edge_flip_by_willmore_optimization")
    status.detail("round 7, 52 flips")
    head = "scan.ply  [----------------]   0%  "
    assert status.line(80) == f"{head}meshing_edge_flip...: round 7, 52 flips, 0 s"
    status.detail("compiling search.greedy.advance_willmore")
    assert status.line(80) == f"{head}compiling search.greedy.advance_will..., 0 s"


@pytest.mark.parametrize("width", [200, 132, 80, 60, 41, 40, 39, 20, 10, 5, 3, 1])
@pytest.mark.parametrize("total", [0, 1000])
@pytest.mark.parametrize("name", ["a.ply", LONG, WIDE])
def test_the_line_never_wraps(width, total, name):
    status = Status(name, total)
    status.begin(name)
    status.detail("chains, 4711 flips, 42500 edges left, and more")
    assert columns(status.line(width)) < max(width, 1)


def test_long_path_shows_its_end():
    assert Status(LONG, 2).line(80).startswith("...ll/of/the/scan_0017.ply  [")


def test_control_characters_are_replaced():
    status = Status("a\nb\x1b[2J.ply")
    status.begin("reading")
    assert status.line(80) == "a?b?[2J.ply  reading, 0 s"


def test_line_is_removed_before_other_output_and_in_the_end(monkeypatch):
    with terminal(monkeypatch) as stream:
        with shown("it", 1) as status:
            status.next("working")
            print("Note: something", file=sys.stderr)
            assert sys.stderr is not stream
        assert sys.stderr is stream
    before, _, after = stream.getvalue().partition("Note: something\n")
    blanks = " " * len("it  [----------------]   0%  working, 0 s")
    assert before.endswith(f"working, 0 s\r{blanks}\r")
    assert "100%" in after
    assert after.endswith(" \r")


def test_standard_output_is_printed_above_the_line(monkeypatch, capsys):
    with terminal(monkeypatch) as stream, shown("it", 1) as status:
        status.next("working")
        print("result")
        assert stream.getvalue().endswith(" \r")
    assert capsys.readouterr().out == "result\n"
    assert stream.getvalue().count("it  [") == 3


def test_quick_work_prints_nothing_in_a_log(capsys):
    with shown("it", 1) as status:
        status.next("working")
        status.detail("much")
    assert capsys.readouterr() == ("", "")


def test_long_work_prints_lines_in_a_log(monkeypatch):
    actions = []
    repeated = progress.repeated

    def noted(action, seconds):
        actions.append((action, seconds))
        return repeated(action, 3600.0)

    monkeypatch.setattr(progress, "repeated", noted)
    monkeypatch.setattr(progress, "SECONDS_IN_A_LOG", IN_A_LOG)
    with contextlib.redirect_stderr(io.StringIO()) as stream, shown("it", 2) as status:
        status.next("working")
        ((action, seconds),) = actions
        action()
    assert seconds == IN_A_LOG < 10.0
    assert stream.getvalue() == "it: working (1 of 2), 0 s so far\n"


def test_progress_is_shown_while_streams_are_redirected(tmp_path, monkeypatch):
    """Native filters are muted by way of the descriptors."""
    from meshlab_willmore.meshset.native import muted

    path = tmp_path / "terminal"
    with path.open("w", encoding="utf-8") as stream:
        stream_number = stream.fileno()
        own = progress._duplicate(stream)
        with own as past, muted():
            print("still here", file=past, flush=True)
        assert stream.fileno() == stream_number
    assert path.read_text(encoding="utf-8") == "still here\n"


# Kernels that can't be kept


@pytest.fixture
def home(monkeypatch, tmp_path):
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    return tmp_path


def test_full_cache_is_noted_once(monkeypatch, capsys, home):
    monkeypatch.setattr(jit, "cache_folder", lambda: "/the/cache")
    monkeypatch.setattr(kernel_cache, "write_errors", [OSError(errno.ENOSPC, "full")])
    note_lost_kernels(True)
    note_lost_kernels(True)
    cure = f"export NUMBA_CACHE_DIR={home / '.cache' / 'numba'}"
    text = "compiled kernels can't be saved in /the/cache: No space left on device"
    assert capsys.readouterr().err == f"Note: {text}; fix it with: {cure}\n"


def test_missing_cache_folder_is_noted_after_compiling(monkeypatch, capsys, home):
    monkeypatch.setattr(jit, "cache_folder", lambda: None)
    note_lost_kernels(False)
    assert capsys.readouterr().err == ""
    note_lost_kernels(True)
    line = capsys.readouterr().err
    assert line.startswith("Note: there is no folder to keep compiled kernels in, so each run")
    assert line.count("\n") == 1


# In commands


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ((), []),
        (("-v",), ["pass 1 of 1, ", "24 faces: "]),
        (("-vv",), ["pass 1 of 1, ", "24 faces: ", "0 %: building the half-edges"]),
    ],
)
@pytest.mark.parametrize("command", [("flip",), ("run",)])
def test_verbose_prints_the_log(script, cube, command, given, words):
    arguments = ("run", script, "-i", cube) if command == ("run",) else ("flip", cube, "out.ply")
    result = call(*arguments, *given)
    assert result.exit_code == 0
    assert all(word in result.stderr for word in words)
    assert ("pass" in result.stderr) == bool(given)
    assert ("%" in result.stderr) == (given == ("-vv",))
    assert logging.getLogger("meshlab_willmore").level == logging.NOTSET


@pytest.mark.usefixtures("workers_here")
def test_verbose_in_a_batch_is_noted(cube):
    arguments = ["flip", cube, "{name}.off", "--json", "log.jsonl", "--force"]
    noted = "Note: -v has no effect in a batch"
    assert call(*arguments, "-v").stderr.startswith(noted)
    assert noted not in call(*arguments, "--resume").stderr


@pytest.mark.skipif(sys.platform == "win32", reason="needs a terminal of POSIX")
@pytest.mark.slow
def test_progress_bar_on_a_terminal(script, cube):
    try:
        reader, terminal = os.openpty()
    except OSError as error:
        pytest.skip(f"there are no pseudo-terminals here: {error}")
    with os.fdopen(terminal, "w") as stderr:
        done = subprocess.run(
            [sys.executable, "-m", "meshlab_willmore", "run", script, "-i", cube],
            stdout=subprocess.PIPE,
            stderr=stderr,
            text=True,
            check=True,
        )
    shown = os.read(reader, 65536).decode()
    os.close(reader)
    assert shown.count("cube.ply  [") > 2
    assert "apply_coord_taubin_smoothing" in shown
    assert "100%" in shown
    assert "%" not in done.stdout


def test_log_on_a_terminal_is_printed_above_the_bar(monkeypatch, script, cube):
    terminal = Terminal()
    for name in ("stdout", "stderr"):
        monkeypatch.setattr(sys, name, terminal)
    main(["run", str(script), "-i", "cube.ply", "-l", "-"], standalone_mode=False)
    lines = [line.rpartition("\r") for line in terminal.getvalue().split("\n")]
    logged = [line for _, _, line in lines if line.startswith(("input ", "step ", "  time: "))]
    assert len(logged) == 5
    assert "[" in "".join(before for before, _, _ in lines)


def test_no_progress_bar_in_a_pipe(script, cube):
    result = call("run", script, "-i", cube)
    assert "\r" not in result.output
    assert "[#" not in result.output


@pytest.mark.parametrize("step", [FLIP, TAUBIN])
def test_compiling_is_shown_only_when_something_is_compiled(monkeypatch, cube, step):
    arguments = ["run", str(script_file(step)), "-i", "cube.ply"]
    main(arguments, standalone_mode=False)
    monkeypatch.setattr(sys, "stderr", Terminal())
    main(arguments, standalone_mode=False)
    shown = sys.stderr.getvalue()
    assert "cube.ply  [" in shown
    assert "ompil" not in shown
