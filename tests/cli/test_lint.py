"""`lint`: scripts are checked without meshes."""

import sys
from pathlib import Path

import pytest

from meshlab_willmore import script

from .conftest import FLIP, HISTORIC, TAUBIN, call, listing, piped, script_file

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="modes and links of POSIX")


def test_scripts_without_errors():
    script_file(FLIP, TAUBIN, path="a.mlx")
    script_file(TAUBIN, path="b.mlx")
    result = call("lint", "*.mlx")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == "a.mlx: ok, 2 steps\nb.mlx: ok, 1 step\n"


@pytest.mark.parametrize("command", [("lint",), ("run", "-s"), ("convert",)])
def test_unknown_filter_points_to_the_command_filters(command):
    script_file(("Qqqqq", {}), path="a.mlx")
    result = call(*command, "a.mlx", *(["b.mlx"] if command == ("convert",) else []))
    text = "a.mlx: step 1 (Qqqqq): no such filter; 'meshlab-willmore filters' lists them"
    assert text in result.output
    assert result.exit_code == 1


def test_every_error_of_every_script_has_a_line():
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
def test_wrong_usage(arguments, line):
    result = call("lint", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"Error: {line}")


def test_warnings_are_no_errors():
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


def test_errors_of_structure_and_names_are_found_together():
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


def test_blanks_around_a_name_are_a_warning():
    path = script_file((" Remove Duplicate Vertices ", {}))
    result = call("lint", path)
    assert result.exit_code == 0
    printed = "has other blanks around its name than 'Remove Duplicate Vertices' in today's MeshLab"
    assert printed in result.stdout


def test_wrong_name_does_not_hide_other_scripts(tmp_path):
    path = script_file(TAUBIN)
    result = call("lint", tmp_path, "*.nothing", path)
    assert result.exit_code == 1
    assert result.stdout == f"{path}: ok, 1 step\n"
    assert f"Error: {tmp_path} is a folder" in result.stderr
    assert "Error: no file matches '*.nothing'" in result.stderr


def test_faults_of_parameters_show_how_they_are_written():
    params = {
        "energy": ("RichEnum", "willmore"),
        "depth": ("RichInt", 700),
        "maxdeviation": ("RichAbsPerc", 0.1),
        "maxflip": ("RichInt", 7),
    }
    script_file((FLIP[0], params), path="a.mlx")
    lines = {line.split("'")[1]: line for line in call("lint", "a.mlx").stdout.splitlines()}
    assert (
        '; for example: <Param name="energy" type="RichEnum" value="0" enum_car' in lines["energy"]
    )
    assert 'enum_val1="willmore"' in lines["energy"]
    assert lines["depth"].endswith(' <Param name="depth" type="RichInt" value="5"/>')
    assert lines["maxdeviation"].endswith('type="RichAbsPerc" value="100%"/>')
    command = "meshlab-willmore filters meshing_edge_flip_by_willmore_optimization --mlx"
    assert lines["maxflip"].endswith(f"'maxflips'? '{command}' shows how they are written")
