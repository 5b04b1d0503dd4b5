"""`lint` and `convert`: scripts without meshes."""

import os
import re
import socket
import stat
import sys
from pathlib import Path

import pytest

from meshlab_willmore import script

from .conftest import FLIP, TAUBIN, call, listing, piped, script_file

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


# lint


def test_fine_scripts():
    script_file(FLIP, TAUBIN, path="a.mlx")
    script_file(TAUBIN, path="b.mlx")
    result = call("lint", "*.mlx")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == "a.mlx: ok, 2 steps\nb.mlx: ok, 1 step\n"


@pytest.mark.parametrize("command", [("lint",), ("run", "-s"), ("convert",)])
def test_a_filter_that_nobody_knows_is_answered_with_a_command(command):
    script_file(("Qqqqq", {}), path="a.mlx")
    result = call(*command, "a.mlx", *(["b.mlx"] if command == ("convert",) else []))
    text = "a.mlx: step 1 (Qqqqq): no such filter; 'meshlab-willmore filters' lists them"
    assert text in result.output
    assert result.exit_code == 1


def test_every_fault_of_every_script_has_a_line():
    script_file(("Taubin Smoth", {}), (FLIP[0], {"mxflips": ("RichInt", 1)}), path="a.mlx")
    script_file(FLIP, path="b.mlx")
    Path("c.mlx").write_text("<FilterScript>")
    result = call("lint", "a.mlx", "b.mlx", "c.mlx", "d.mlx")
    assert (result.exit_code, result.stderr) == (1, "")
    lines = result.stdout.splitlines()
    assert [line.partition(": ")[0] for line in lines] == ["a.mlx"] * 2 + [
        "b.mlx",
        "c.mlx",
        "d.mlx",
    ]
    assert "step 1 (Taubin Smoth)" in lines[0]
    assert "Taubin Smooth" in lines[0]
    assert "'mxflips'" in lines[1]
    assert lines[2] == "b.mlx: ok, 1 step"
    assert lines[4] == "d.mlx: there is no such file"


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ([], "Missing argument 'SCRIPT...'."),
        (["."], ". is a folder; name the scripts in it, such as '*.mlx'"),
        (["*.mlx"], "no file matches '*.mlx'"),
    ],
)
def test_lint_wrong_use(arguments, line):
    result = call("lint", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"Error: {line}")


HISTORIC = """<!DOCTYPE FilterScript>
<FilterScript>
 <filter name="Surface Reconstruction: Poisson">
  <Param type="RichInt" name="OctDepth" value="7"/>
  <Param type="RichFloat" name="SamplesPerNode" value="1"/>
  <Param type="RichFloat" name="Offset" value="2"/>
 </filter>
 <filter name="Change the current layer">
  <Param type="RichMesh" name="mesh" value="1"/>
 </filter>
 <filter name="Transform: Rotate">
  <Param name="ToAll" value="true"/>
 </filter>
</FilterScript>
"""


def test_warnings_have_lines_and_are_no_faults():
    Path("a.mlx").write_text(HISTORIC)
    result = call("lint", "a.mlx")
    assert (result.exit_code, result.stderr) == (0, "")
    poisson = "a.mlx: warning: step 1 (Surface Reconstruction: Poisson)"
    rotate = "a.mlx: warning: step 3 (Transform: Rotate), parameter 'ToAll'"
    assert result.stdout.splitlines() == [
        f"{poisson}: is 'Surface Reconstruction: Screened Poisson' in today's MeshLab: the "
        "screened algorithm took its place: the surface differs",
        f"{poisson}, parameter 'OctDepth': is 'depth' today",
        f"{poisson}, parameter 'SamplesPerNode': is 'samplesPerNode' today",
        f"{poisson}, parameter 'Offset': is ignored: the filter has had none such since MeshLab "
        "2016.12",
        "a.mlx: warning: step 2 (Change the current layer): MeshLab has no such step any more",
        f"{rotate}: is 'allLayers' today",
        f"{rotate}: has no type; it is read as RichBool, the filter's own",
        "a.mlx: ok, 3 steps",
    ]


def test_faults_of_form_and_names_come_in_one_go():
    Path("a.mlx").write_text(
        "<FilterScript><filter name='Taubin Smoth'/><Filter/>"
        "<filter name='Taubin Smooth'><Param name='mue' type='RichFloat' value='x'/></filter>"
        "</FilterScript>"
    )
    result = call("lint", "a.mlx")
    assert result.exit_code == 1
    said = [line.removeprefix("a.mlx: ").split(":")[0] for line in result.stdout.splitlines()]
    assert said == [
        "<Filter> has no place in <FilterScript> (line 1); did you mean <filter>?",
        "step 1 (Taubin Smoth)",
        "step 2 (Taubin Smooth), parameter 'mue'",
        "step 2 (Taubin Smooth), parameter 'mue'",
    ]


# convert


def test_old_names_become_those_of_today():
    Path("old.mlx").write_text(HISTORIC)
    result = call("convert", "old.mlx", "new.mlx")
    assert result.exit_code == 0
    told = result.stdout.splitlines()
    assert told[0] == "old.mlx -> new.mlx: 3 of 3 steps"
    assert [line.partition(": ")[0] for line in told[1:]] == ["not as before"] * 2
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


def test_for_meshlab_steps_that_it_has_no_more_are_left_out():
    Path("old.mlx").write_text(HISTORIC)
    told = call("convert", "old.mlx", "new.mlx", "--meshlab").stdout.splitlines()
    assert told[-1] == "left out: step 2, Change the current layer"
    assert len(script.read("new.mlx")) == 2


def test_an_old_script_becomes_one_of_today():
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


def test_for_meshlab_our_steps_are_left_out_and_named():
    script_file(FLIP, TAUBIN, ("Willmore measures", {}), path="a.mlx")
    result = call("convert", "a.mlx", "b.mlx", "--meshlab")
    assert result.exit_code == 0
    assert result.stdout == (
        "a.mlx -> b.mlx: 1 of 3 steps\n"
        "left out: step 1, Willmore flipping optimization\n"
        "left out: step 3, Willmore measures\n"
    )
    assert [step.filter for step in script.read("b.mlx")] == ["Taubin Smooth"]


def test_for_meshlab_percentages_are_named():
    share = {"Threshold": ("RichAbsPerc", '5%" min="0" max="1')}
    script_file(("Simplification: Clustering Decimation", share), path="a.mlx")
    told = call("convert", "a.mlx", "b.mlx", "--meshlab").stdout.splitlines()[1]
    assert told.startswith("step 1, Simplification: Clustering Decimation: a percentage depends on")


def test_a_script_with_faults_is_not_converted():
    script_file(("Taubin Smoth", {}), path="a.mlx")
    result = call("convert", "a.mlx", "b.mlx")
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: a.mlx: step 1 (Taubin Smoth): ")
    assert listing() == ["a.mlx"]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["no.mlx", "b.mlx"], "there is no filter script no.mlx"),
        (["a.mlx", "a.mlx"], "a.mlx already exists; use --force to overwrite"),
        (["a.mlx", "."], ". is a folder; name a file in it, such as 'today.mlx'"),
        (["a.mlx", "no/b.mlx"], "cannot write no/b.mlx: the folder no does not exist"),
    ],
)
def test_convert_wrong_use(arguments, line):
    path = script_file(TAUBIN, path="a.mlx")
    before = path.read_text()
    result = call("convert", *arguments)
    assert result.exit_code == 2
    assert result.stderr == f"Error: {line}\n"
    assert path.read_text() == before


def test_comments_and_an_empty_result_are_told():
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
def test_a_script_behind_a_link_is_replaced_and_keeps_its_mode():
    script_file(TAUBIN, path="a.mlx")
    Path("real.mlx").touch()
    Path("real.mlx").chmod(0o640)
    Path("link.mlx").symlink_to("real.mlx")
    assert call("convert", "a.mlx", "link.mlx", "--force").exit_code == 0
    assert Path("link.mlx").is_symlink()
    assert stat.S_IMODE(Path("real.mlx").stat().st_mode) == 0o640
    assert [step.filter for step in script.read("real.mlx")] == ["Taubin Smooth"]
    assert listing() == ["a.mlx", "link.mlx", "real.mlx"]


# From and into pipes


def test_lint_and_convert_read_the_standard_input():
    text = script_file(TAUBIN, path="a.mlx").read_text()
    result = call("lint", "-", input=text)
    assert (result.exit_code, result.stdout) == (0, "-: ok, 1 step\n")
    result = call("convert", "-", "-", input=text)
    assert (result.exit_code, result.stderr) == (0, "standard input -> -: 1 of 1 steps\n")
    assert call("lint", "-", input=result.stdout).exit_code == 0
    assert listing() == ["a.mlx"]
    assert call("lint", "-", input="").stdout.startswith("-: is empty")


@POSIX
def test_convert_and_lint_read_a_pipe_once():
    text = script_file(TAUBIN, path="a.mlx").read_bytes()
    with piped(text) as name:
        assert call("convert", name, "b.mlx").exit_code == 0
    assert [step.filter for step in script.read("b.mlx")] == ["Taubin Smooth"]
    with piped(text) as name:
        assert call("lint", name).stdout == f"{name}: ok, 1 step\n"


@POSIX
def test_convert_writes_into_a_pipe_and_nothing_else_goes_there():
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
def test_what_is_no_file_is_not_replaced_by_a_script(name):
    script_file(TAUBIN, path="a.mlx")
    with socket.socket(socket.AF_UNIX) as made:
        made.bind("socket")
    Path("link.mlx").symlink_to("socket")
    result = call("convert", "a.mlx", name, "--force")
    assert result.exit_code == 2
    assert re.match(rf"Error: cannot write {name}: it (is|leads to) a socket, ", result.stderr)
    assert stat.S_ISSOCK(Path("socket").stat().st_mode)
    assert Path("link.mlx").is_symlink()


def test_blanks_around_a_name_are_told_of():
    path = script_file((" Remove Duplicate Vertices ", {}))
    result = call("lint", path)
    assert result.exit_code == 0
    told = "has other blanks around its name than 'Remove Duplicate Vertices' in today's MeshLab"
    assert told in result.stdout


def test_a_name_that_is_no_script_hides_no_other(tmp_path):
    path = script_file(TAUBIN)
    result = call("lint", tmp_path, "*.nothing", path)
    assert result.exit_code == 1
    assert result.stdout == f"{path}: ok, 1 step\n"
    assert f"Error: {tmp_path} is a folder" in result.stderr
    assert "Error: no file matches '*.nothing'" in result.stderr
