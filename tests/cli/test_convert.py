"""`convert`: old scripts in today's form."""

import os
import re
import socket
import stat
import sys
from pathlib import Path

import pytest

from meshlab_willmore import script

from .conftest import FLIP, HISTORIC, TAUBIN, call, listing, script_file

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="modes and links of POSIX")

OLD = """<!DOCTYPE FilterScript>
<FilterScript>
 <filter name="Depth Smooth">
  <Param type="RichInt" name="stepSmoothNum" isxmlparam="0" value="3" tooltip="Times"/>
 </filter>
 <filter name="Repair non Manifold Edges">
  <Param type="RichEnum" name="method" value="1" enum_cardinality="2" enum_val0="a" enum_val1="b"/>
 </filter>
</FilterScript>
"""


def test_old_names_become_todays():
    Path("old.mlx").write_text(HISTORIC)
    result = call("convert", "old.mlx", "new.mlx")
    assert result.exit_code == 0
    printed = result.stdout.splitlines()
    assert printed[0] == "old.mlx -> new.mlx: 3 of 3 steps"
    assert [line.partition(": ")[0] for line in printed[1:]] == ["not as before"] * 2
    new = script.read("new.mlx")
    assert [(step.filter, [(p.name, p.type, p.value) for p in step.params]) for step in new] == [
        (
            "Surface Reconstruction: Screened Poisson",
            [("depth", "RichInt", 7), ("samplesPerNode", "RichFloat", 1.0)],
        ),
        ("Change the current layer", [("mesh", "RichMesh", 1)]),
        ("Transform: Rotate", [("allLayers", "RichBool", True)]),
    ]
    assert [w.text for w in script.warnings("new.mlx")] == ["MeshLab has no such step any more"]


def test_meshlab_option_leaves_out_steps_that_are_gone():
    Path("old.mlx").write_text(HISTORIC)
    printed = call("convert", "old.mlx", "new.mlx", "--meshlab").stdout.splitlines()
    assert printed[-1] == "left out: step 2, Change the current layer"
    assert len(script.read("new.mlx")) == 2


def test_old_form_becomes_todays():
    Path("old.mlx").write_text(OLD)
    result = call("convert", "old.mlx", "new.mlx")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == "old.mlx -> new.mlx: 2 of 2 steps\n"
    text = Path("new.mlx").read_text()
    assert "isxmlparam" not in text
    assert 'tooltip="Times"' in text
    # The choices have the names that MeshLab gives them today.
    assert 'enum_val0="Remove Faces"' in text
    assert 'enum_val1="Split Vertices"' in text
    assert [(c.known.name, c.given) for c in script.calls("new.mlx")] == [
        (c.known.name, c.given) for c in script.calls("old.mlx")
    ]


def test_names_of_pymeshlab_become_those_of_meshlab():
    script_file(("apply_coord_taubin_smoothing", {"stepsmoothnum": ("RichInt", 4)}), path="a.mlx")
    assert call("convert", "a.mlx", "b.mlx").exit_code == 0
    (step,) = script.read("b.mlx")
    assert step.filter == "Taubin Smooth"
    assert [(p.name, p.type, p.value) for p in step.params] == [("stepSmoothNum", "RichInt", 4)]


def test_meshlab_option_leaves_out_our_steps():
    script_file(FLIP, TAUBIN, ("Willmore measures", {}), path="a.mlx")
    result = call("convert", "a.mlx", "b.mlx", "--meshlab")
    assert result.exit_code == 0
    assert result.stdout == (
        "a.mlx -> b.mlx: 1 of 3 steps\n"
        "left out: step 1, Willmore flipping optimization\n"
        "left out: step 3, Willmore measures\n"
    )
    assert [step.filter for step in script.read("b.mlx")] == ["Taubin Smooth"]


def test_meshlab_option_names_percentages():
    share = {"Threshold": ("RichAbsPerc", '5%" min="0" max="1')}
    script_file(("Simplification: Clustering Decimation", share), path="a.mlx")
    line = call("convert", "a.mlx", "b.mlx", "--meshlab").stdout.splitlines()[1]
    assert line.startswith("step 1, Simplification: Clustering Decimation: a percentage depends on")


def test_script_with_errors_is_not_converted():
    script_file(("Taubin Smoth", {}), path="a.mlx")
    result = call("convert", "a.mlx", "b.mlx")
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: a.mlx: step 1 (Taubin Smoth): ")
    assert listing() == ["a.mlx"]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (
            ["no.mlx", "b.mlx"],
            "there is no filter script no.mlx; 'meshlab-willmore scripts' lists the shipped ones",
        ),
        (["a.mlx", "a.mlx"], "a.mlx already exists; use --force to overwrite"),
        (["a.mlx", "."], ". is a folder; name a file in it, such as 'today.mlx'"),
        (["a.mlx", "no/b.mlx"], "cannot write no/b.mlx: the folder no does not exist"),
    ],
)
def test_wrong_usage(arguments, line):
    path = script_file(TAUBIN, path="a.mlx")
    before = path.read_text()
    result = call("convert", *arguments)
    assert result.exit_code == 2
    assert result.stderr == f"Error: {line}\n"
    assert path.read_text() == before


def test_comments_and_empty_result_are_reported():
    path = script_file(FLIP, path="a.mlx")
    path.write_text(path.read_text().replace("<FilterScript>\n", "<FilterScript>\n<!-- why -->\n"))
    result = call("convert", "a.mlx", "b.mlx", "--meshlab")
    assert (result.exit_code, result.stdout) == (
        0,
        "a.mlx -> b.mlx: 0 of 1 steps\n"
        "nothing is left: b.mlx has no steps\n"
        "left out: the comments\n"
        "left out: step 1, Willmore flipping optimization\n",
    )
    assert "<!--" not in Path("b.mlx").read_text()


@POSIX
def test_link_is_followed_and_mode_is_kept():
    script_file(TAUBIN, path="a.mlx")
    Path("real.mlx").touch()
    Path("real.mlx").chmod(0o640)
    Path("link.mlx").symlink_to("real.mlx")
    assert call("convert", "a.mlx", "link.mlx", "--force").exit_code == 0
    assert Path("link.mlx").is_symlink()
    assert stat.S_IMODE(Path("real.mlx").stat().st_mode) == 0o640
    assert [step.filter for step in script.read("real.mlx")] == ["Taubin Smooth"]
    assert listing() == ["a.mlx", "link.mlx", "real.mlx"]


@POSIX
def test_pipe_gets_only_the_script():
    script_file(TAUBIN, path="a.mlx")
    os.mkfifo("pipe")
    end = os.open("pipe", os.O_RDONLY | os.O_NONBLOCK)
    result = call("convert", "a.mlx", "pipe")
    data = os.read(end, 1 << 16)
    os.close(end)
    assert (result.exit_code, result.stdout) == (0, "")
    assert call("convert", "a.mlx", "b.mlx").exit_code == 0
    assert data == Path("b.mlx").read_bytes()
    assert stat.S_ISFIFO(Path("pipe").stat().st_mode)
    unread = call("convert", "a.mlx", "pipe")
    assert unread.exit_code == 1
    assert unread.stderr == "Error: cannot write pipe: nobody reads from this pipe\n"


@POSIX
@pytest.mark.parametrize("name", ["socket", "link.mlx"])
def test_only_files_are_replaced(name):
    script_file(TAUBIN, path="a.mlx")
    with socket.socket(socket.AF_UNIX) as made:
        made.bind("socket")
    Path("link.mlx").symlink_to("socket")
    result = call("convert", "a.mlx", name, "--force")
    assert result.exit_code == 2
    assert re.match(rf"Error: cannot write {name}: it (is|leads to) a socket, ", result.stderr)
    assert stat.S_ISSOCK(Path("socket").stat().st_mode)
    assert Path("link.mlx").is_symlink()
