"""What Windows and macOS lack is missed by nothing: it is taken away here, and commands run."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import call, cube_file
from tests.workers import workers_here  # noqa: F401

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="it is tried on Linux")

# A module that Python imports by itself, in this process and in those that it starts.
ABSENT = """
import os
import signal
import sys

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name in ("resource", "fcntl", "grp", "pwd", "termios"):
            raise ImportError(f"No module named {name!r}")

sys.meta_path.insert(0, Finder())
for name in ("killpg", "getpgrp", "setsid", "fork", "forkpty", "waitid", "sched_getaffinity",
             "mkfifo", "set_blocking", "O_NONBLOCK", "O_NOCTTY", "O_PATH", "getuid", "geteuid",
             "register_at_fork"):
    delattr(os, name)
for name in ("SIGHUP", "SIGALRM", "SIGPIPE", "SIGCHLD", "setitimer", "alarm", "pthread_sigmask"):
    delattr(signal, name)
"""
# Libraries of others look for the platform when they are imported.
PROGRAM = """
import sys
import numba, pymeshlab
sys.platform = "freebsd14"
from meshlab_willmore.cli import main
"""
ONE = PROGRAM + 'main(prog_name="meshlab-willmore")'
SEVERAL = PROGRAM + "import json; [main(w, standalone_mode=False) for w in json.loads(sys.argv[1])]"


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run a command where all that is missing."""
    folder = tmp_path / "site"
    folder.mkdir()
    (folder / "sitecustomize.py").write_text(ABSENT)
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")
    path = os.pathsep.join([str(folder), *filter(None, sys.path)])

    def command(*arguments, program=ONE):
        return subprocess.run(
            [sys.executable, "-c", program, *map(str, arguments)],
            env={**os.environ, "PYTHONPATH": path},
            capture_output=True,
            text=True,
            check=False,
            timeout=120,
        )

    return command


@pytest.mark.slow
def test_modules_and_commands_do_without(run):
    cube_file("cube.ply")
    commands = [
        ["flip", "cube.ply", "out.ply"],
        ["run", "flip.mlx", "-i", "cube.ply", "-o", "script.ply", "--log", "log.txt"],
        ["measure", "cube.ply", "--json"],
    ]
    done = run(json.dumps(commands), program=SEVERAL)
    note = "Note: flip.mlx is the script that comes with meshlab_willmore\n"
    assert (done.stderr, done.returncode) == (note, 0)
    flipped, ran, *_ = done.stdout.splitlines()
    assert flipped.startswith("cube.ply -> out.ply: 6 flips")
    assert ran.startswith("cube.ply -> script.ply ")
    assert json.loads("[" + done.stdout.partition("\n[")[2])[0]["faces"] == 24


@pytest.mark.slow
def test_batch_with_a_limit_of_time(run):
    cube_file("cube.ply")
    cube_file("other.ply")
    Path("bad.ply").write_text("no mesh")
    done = run("flip", "*.ply", "{name}.off", "--timeout", 60, "--json", "log.jsonl")
    assert done.returncode == 1
    assert done.stdout.count("6 flips") == 2
    assert "Error: cannot read bad.ply: Header not found\n" in done.stderr
    assert done.stderr.count("\n") == 2
    late = run("flip", "cube.ply", "late.off", "--timeout", 0.001)
    assert late.returncode == 1
    assert "not finished within 0.001 s" in late.stderr


@pytest.mark.usefixtures("workers_here")
@pytest.mark.slow
def test_a_limit_of_memory_without_effect_is_noted(run):
    cube_file("cube.ply")
    done = run("flip", "cube.ply", "out.ply", "--memory", "4G")
    assert done.returncode == 0
    assert done.stderr == (
        "Note: this system can't limit the memory of a process: the limit has no effect\n"
    )
    assert call("flip", "cube.ply", "here.ply", "--memory", "4G").stderr == ""
