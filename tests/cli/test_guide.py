"""The guide to the command line: its commands are there, and its examples run as printed."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from meshlab_willmore.cli import main

from .conftest import SAMPLES, TAUBIN, call, cube_file, listing, script_file

GUIDE = (Path(__file__).parents[2] / "docs" / "guide" / "command_line.md").read_text(
    encoding="utf-8"
)


def example(name):
    """The lines of an example."""
    found = re.search(rf"<!-- example: {name} -->\n```sh\n(.*?)```", GUIDE, re.DOTALL)
    return found[1].splitlines()


def run_all(name):
    """Run the lines of an example in a shell."""
    program = f'meshlab-willmore() {{ "{sys.executable}" -m meshlab_willmore "$@"; }}\n'
    done = subprocess.run(
        ["bash", "-c", program + "set -e\n" + "\n".join(example(name))],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done


def test_table_has_every_command():
    table = GUIDE.partition("|---|---|\n")[2].partition("\n\n")[0]
    names = {word for cell in re.findall("`(.*?)`", table) for word in cell.split()[:1]}
    assert names == set(main.commands)


@pytest.mark.skipif(sys.platform == "win32", reason="examples for a POSIX shell")
@pytest.mark.slow
class TestExamples:
    def test_conversion(self):
        Path("scans").mkdir()
        Path("out").mkdir()
        call("run", "-i", SAMPLES / "bone.ply", "-o", "scan.obj")
        call("run", "-i", "scan.obj", "-o", "scans/one.stl")
        run_all("convert")
        assert listing("out") == ["one.ply"]

    def test_projects(self):
        script_file(TAUBIN, path="align.mlx")
        call("run", "-i", cube_file(), SAMPLES / "bone.ply", "--layers", "-w", "scans.mlp")
        run_all("projects")
        assert {"aligned.mlp", "aligned_0.ply", "aligned_1.ply", "second.ply"} < {*listing()}

    def test_scripts_and_steps(self):
        cube_file("scan.ply")
        assert "6 flips" in run_all("scripts").stdout
        assert "flip.mlx" in listing("my-scripts")
        assert run_all("step").stdout.startswith("<!DOCTYPE FilterScript>\n")
        shown = re.search(r"```xml\n(.*?)```", GUIDE, re.DOTALL)[1]
        result = call("run", "-", "-i", "scan.ply", "-o", "out.ply", input=shown)
        assert (result.exit_code, result.stderr) == (0, "")
        call("flip", "scan.ply", "expected.ply", "--preset", "faithful")
        assert Path("out.ply").read_bytes() == Path("expected.ply").read_bytes()
