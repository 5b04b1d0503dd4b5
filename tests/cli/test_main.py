"""The command line as a whole: help, exit codes, errors."""

import errno
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

import meshlab_willmore
from meshlab_willmore.cli import main

COMMANDS = sorted(main.commands)
RUN_DEMO = "meshlab_willmore.demo.experiments.run_demo"
WHOLE_RUN = """
import sys
from meshlab_willmore.cli import main
from meshlab_willmore.demo import experiments
experiments.FULL_SIZE = experiments.Sizes(
    torus_points=200, part_edge_percent=6.0, keep_one_of=60
)
main(["demo", "--output", sys.argv[1]])
"""
LIGHT_RUN = """
import sys
import meshlab_willmore
assert "numba" not in sys.modules
package = set(sys.modules)
from meshlab_willmore.cli import main
for name in sys.argv[1:]:
    try:
        main([name, "--help"])
    except SystemExit as end:
        assert end.code == 0
added = {name.partition(".")[0] for name in set(sys.modules) - package}
print(sorted(added & {"numba", "llvmlite", "pymeshlab", "matplotlib", "scipy", "numpy"}))
"""


def run(*arguments):
    return CliRunner().invoke(main, arguments)


def fail_with(monkeypatch, error):
    def fail(*_arguments, **_named):
        raise error

    monkeypatch.setattr(RUN_DEMO, fail)


def examples(text):
    """The lines below "Examples:", each of its own: click would run a paragraph together."""
    return [line.strip() for line in text.partition("  Examples:\n")[2].splitlines()]


@pytest.mark.parametrize("flag", ["--help", "-h"])
@pytest.mark.parametrize("name", ["", *COMMANDS])
def test_help_shows_examples(name, flag):
    result = run(*filter(None, [name, flag]))
    assert result.exit_code == 0
    lines = examples(result.stdout)
    assert len(lines) > 1
    assert all(line.startswith(f"meshlab-willmore {name}") for line in lines)
    assert result.stdout.isascii()


@pytest.mark.parametrize("name", ["", *COMMANDS])
def test_help_fits_80_columns(name):
    # Wider windows change nothing: click fills 80 columns at most.
    text = run(*filter(None, [name, "--help"])).stdout
    assert [line for line in text.splitlines() if len(line) > 80] == []


@pytest.mark.parametrize("name", COMMANDS)
def test_examples_are_valid_commands(name):
    for line in examples(run(name, "--help").stdout):
        words = shlex.split(re.split("[>|]", line)[0])[2:]
        if "--help" not in words:
            command = main.commands[name]
            command.make_context(name, words, parent=click.Context(main, **main.context_settings))


def test_every_command_is_in_the_help():
    text = run("--help").stdout
    assert all(f"\n  {name} " in text for name in COMMANDS)


def test_help_names_the_exit_codes():
    assert "Exit codes: 0 success, 1 failure while running, 2 wrong usage." in run("--help").stdout


def test_version():
    result = run("--version")
    assert result.exit_code == 0
    assert result.stdout == f"meshlab-willmore, version {meshlab_willmore.__version__}\n"


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["dmeo"], "No such command 'dmeo'"),
        (
            ["-i", "a.ply", "-s", "clean.mlx"],
            "-i belongs to the command run: meshlab-willmore run -i",
        ),
        (["clean.MLX", "-i", "a.ply"], "clean.MLX belongs to the command run"),
        (["demo", "--outptu", "x"], "No such option"),
        (["demo", "--output"], "requires an argument"),
        (["demo", "surplus"], "unexpected extra argument"),
    ],
)
def test_wrong_usage_is_exit_code_2(arguments, reason):
    result = run(*arguments)
    assert result.exit_code == 2
    assert reason in result.stderr
    assert result.stdout == ""


def test_demo_into_a_file_is_an_error(tmp_path):
    path = tmp_path / "taken"
    path.write_text("mine")
    result = run("demo", "--output", str(path))
    assert result.exit_code == 1
    assert result.stderr == f"Error: cannot write into {path}: it is a file\n"
    assert result.stdout == ""
    assert path.read_text() == "mine"


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (ValueError("first\n  second"), "Error: first second\n"),
        (RuntimeError(), "Error: RuntimeError\n"),
        (OSError(28, "No space left on device"), "Error: [Errno 28] No space left on device\n"),
    ],
)
def test_errors_are_one_line_with_exit_code_1(monkeypatch, error, line):
    fail_with(monkeypatch, error)
    result = run("demo")
    assert (result.exit_code, result.stderr, result.stdout) == (1, line, "")


@pytest.mark.parametrize("arguments", [["--debug", "demo"], ["demo", "--debug"]])
def test_debug_raises_the_error(monkeypatch, arguments):
    error = ValueError("why")
    fail_with(monkeypatch, error)
    assert run(*arguments).exception is error


@pytest.mark.parametrize("error", [KeyboardInterrupt(), click.Abort()])
def test_ctrl_c_ends_without_a_traceback(monkeypatch, error):
    fail_with(monkeypatch, error)
    result = run("demo")
    assert result.exit_code == 1
    assert result.stderr.strip() == "Aborted!"


def test_broken_pipe_prints_nothing(monkeypatch):
    fail_with(monkeypatch, BrokenPipeError(errno.EPIPE, "Broken pipe"))
    result = run("demo")
    assert (result.exit_code, result.stderr) == (1, "")


def test_help_imports_nothing_heavy():
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", LIGHT_RUN, *COMMANDS],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.splitlines()[-1] == "[]"
    assert done.stderr == ""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="for Linux only")
@pytest.mark.parametrize("locale", ["C", "POSIX"])
def test_file_names_in_the_c_locale(tmp_path, locale):
    name = str(tmp_path / "ü日.off")
    Path(name).write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    done = subprocess.run(
        [sys.executable, "-m", "meshlab_willmore", "run", "-i", name, "-o", f"{name}.ply"],
        env={**os.environ, "LC_ALL": locale},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert f"{name} -> {name}.ply (3 vertices, 1 faces)" in done.stdout


@pytest.mark.heavy
@pytest.mark.slow
def test_demo_in_a_subprocess(tmp_path):
    pytest.importorskip("matplotlib")
    folder = tmp_path / "pictures"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", WHOLE_RUN, str(folder)],
        capture_output=True,
        encoding="ascii",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    table, written = done.stdout.split(f"Written to {folder}:\n")
    header = table.splitlines()[0].split()
    assert header == ["faces", "flips", "W", "area", "M", "shape", "seconds"]
    assert "  Willmore flips" in table
    assert " 45.7570 " in table
    assert " 29.9173 " in table
    assert "\x1b" not in done.stdout
    files = [folder / name for name in written.split()]
    assert sorted(files) == sorted(folder.iterdir())
    assert {path.suffix for path in files} == {".ply", ".png"}
    assert all(path.stat().st_size > 0 for path in files)
    # Progress has a line for each stage, and nothing else is said: no warning of any library.
    # Something may be compiled, or not; on a slow machine there are lines on how far it is.
    stages = {line.partition(":")[0] for line in done.stderr.splitlines()}
    stages -= {"compiling (the first run only)", "demo"}
    assert stages == {"cube", "torus", "part", "scan", "face", "picture"}


def test_default_output_of_demo(monkeypatch, tmp_path):
    from meshlab_willmore.demo.experiments import DemoResult

    folders = []
    monkeypatch.setattr(
        RUN_DEMO, lambda folder, notify: folders.append(folder) or DemoResult([], [])
    )
    monkeypatch.chdir(tmp_path)
    result = run("demo")
    assert result.exit_code == 0
    assert folders == [Path("willmore-demo")]
    assert f"Written to {tmp_path / 'willmore-demo'}:" in result.stdout


@pytest.mark.parametrize("arguments", [["--nope"], ["nope"], ["demo", "--nope"]])
def test_wrong_usage_is_one_line(arguments):
    result = run(*arguments)
    assert result.exit_code == 2
    assert result.stderr.startswith("Error: ")
    assert result.stderr.count("\n") == 1
    assert "--help)" in result.stderr


def test_help_without_a_command():
    result = run()
    assert result.exit_code == 2
    assert "Commands:" in result.output


def test_missing_library_points_to_doctor(monkeypatch):
    fail_with(monkeypatch, ImportError("libGL.so.1: cannot open shared object file"))
    result = run("demo")
    assert result.exit_code == 1
    assert result.stderr == (
        "Error: PyMeshLab could not be loaded: libGL.so.1: cannot open shared object file. On "
        "Debian and Ubuntu its system libraries come with: apt-get install libgl1 libopengl0 "
        "('meshlab-willmore doctor' shows what is missing)\n"
    )


def test_runs_as_a_module():
    done = subprocess.run(
        [sys.executable, "-m", "meshlab_willmore", "--version"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == f"meshlab-willmore, version {meshlab_willmore.__version__}\n"
