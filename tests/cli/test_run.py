"""`run`: scripts on files, with outputs, logs and errors."""

import re
import sys
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.batch import work

from .conftest import (
    FLIP,
    SAMPLES,
    TAUBIN,
    call,
    cube_file,
    listing,
    loaded,
    piped,
    same_mesh,
    script_file,
    spawn,
)

FLIPPED = (
    r"  step 1, meshing_edge_flip_by_willmore_optimization: "
    r"6 flips, Willmore energy 45\.757 -> 29\.9173\n"
)


def expected(path, source="cube.ply"):
    """What the script of FLIP and TAUBIN makes, by calls in Python."""
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(source))
    ms.meshing_edge_flip_by_willmore_optimization()
    ms.apply_coord_taubin_smoothing(stepsmoothnum=2)
    ms.save_current_mesh(str(path))
    return path


def test_output_is_that_of_the_same_calls_in_python(script, cube):
    result = call("run", script, "-i", cube, "-o", "out.ply")
    assert (result.exit_code, result.stderr) == (0, "")
    assert re.fullmatch(
        r"cube\.ply -> out\.ply \(14 vertices, 24 faces\): 2 steps, \d+\.\d s\n" + FLIPPED,
        result.stdout,
    )
    assert same_mesh("out.ply", expected("expected.ply"))
    assert listing() == ["cube.ply", "expected.ply", "out.ply", "script.mlx"]


@pytest.mark.slow
def test_subprocess_prints_only_the_result(script, cube):
    done = spawn("run", script, "-i", cube, "-o", "out.ply")
    assert (done.returncode, done.stderr) == (0, "")
    assert re.fullmatch(r"cube\.ply -> out\.ply \(.*\): 2 steps, .* s\n" + FLIPPED, done.stdout)


@pytest.mark.parametrize(
    "arguments",
    [
        ["-s", "script.mlx", "-i", "cube.ply", "-o", "out.ply"],
        ["-i", "cube.ply", "script.mlx", "-o", "out.ply"],
        ["-i", "cube.ply", "-o", "out.ply", "-m", "vc", "vn", "script.mlx"],
        ["-i", "cube.ply", "-o", "out.ply", "-om", "vc", "vn", "-s", "script.mlx"],
        ["--output", "out.ply", "--input", "cube.ply", "--script", "script.mlx"],
    ],
)
def test_options_in_any_order(script, cube, arguments):
    assert call("run", *arguments).exit_code == 0
    assert same_mesh("out.ply", expected("expected.ply"))


@pytest.mark.parametrize("name", ["UPPER.MLX", "Mixed.Mlx"])
def test_script_ending_in_any_case(script, cube, name):
    Path(name).write_bytes(script.read_bytes())
    assert call("run", "-i", cube, name, "-o", "out.ply").exit_code == 0
    assert same_mesh("out.ply", expected("expected.ply"))


def test_script_on_the_standard_input(script, cube):
    text = script.read_text()
    for order in (["-", "-i", cube], ["-i", cube, "-"], ["-s", "-", "-i", cube]):
        result = call("run", *order, "-o", "out.ply", "--force", input=text)
        assert (result.exit_code, result.stderr) == (0, "")
    assert same_mesh("out.ply", expected("expected.ply"))
    result = call("run", "-", "-i", cube, input=text.replace("Taubin Smooth", "Taubin Smoth"))
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: standard input: step 2 (Taubin Smoth): ")


@pytest.mark.skipif(sys.platform == "win32", reason="pipes of POSIX")
@pytest.mark.parametrize("before", [[], ["-s"], ["-i", "cube.ply"]])
def test_script_from_a_pipe(script, cube, before):
    with piped(script.read_bytes()) as name:
        arguments = [*before, name, "-i", cube] if before[:1] != ["-i"] else [*before, name]
        assert call("run", *arguments, "-o", "out.ply").exit_code == 0
    assert same_mesh("out.ply", expected("expected.ply"))


# Several inputs


@pytest.mark.usefixtures("workers_here")
def test_several_inputs_have_an_output_each(script, cube):
    cube_file("other.ply")
    Path("out").mkdir()
    result = call("run", script, "-i", "*.ply", "-o", "out/{index:02}-{name}_flipped.{ext}")
    assert result.exit_code == 0
    assert listing("out") == ["01-cube_flipped.ply", "02-other_flipped.ply"]
    names = [line.split(" -> ")[0] for line in result.stdout.splitlines()[::2]]
    assert sorted(names) == ["cube.ply", "other.ply"]


@pytest.mark.usefixtures("workers_here")
def test_failed_input_does_not_stop_the_others(script, cube):
    Path("bad.ply").write_text("no mesh")
    cube_file("last.ply")
    arguments = ["run", script, "-i", cube, "bad.ply", "last.ply", "-o", "{name}.stl"]
    result = call(*arguments)
    assert result.exit_code == 1
    assert result.stderr == (
        "Error: cannot read bad.ply: Header not found\n"
        "Error: 1 of 3 inputs failed; the others are done\n"
    )
    assert Path("cube.stl").exists()
    assert Path("last.stl").exists()


def test_stop_at_the_first_failure(script, cube):
    Path("bad.ply").write_text("no mesh")
    result = call(
        "run", script, "-i", "bad.ply", cube, "-o", "{name}.stl", "--stop", "--workers", 1
    )
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == "Error: cannot read bad.ply: Header not found\n"
    assert not Path("cube.stl").exists()


def test_layers_are_loaded_into_one_set_and_saved_in_their_order(cube):
    other = SAMPLES / "bone.ply"
    script = script_file(FLIP, ("Transform: Translate, Center, set Origin", {}))
    result = call("run", script, "-i", cube, other, "--layers", "-o", "a.ply", "-o", "b.ply")
    assert result.exit_code == 0, result.stderr
    # The flipped first layer is a new one to PyMeshLab, but stays the first of the script.
    assert len(loaded("a.ply").faces) == 24
    assert not np.array_equal(loaded("a.ply").faces, loaded(cube).faces)
    assert np.array_equal(loaded("b.ply").faces, loaded(other).faces)


def test_more_outputs_than_layers(script, cube):
    result = call("run", script, "-i", cube, "-o", "a.ply", "-o", "b.ply")
    assert result.exit_code == 1
    assert result.stderr == "Error: 2 outputs, but the script leaves 1 layer\n"
    assert not Path("a.ply").exists()


# Scripts without input, without output, without mesh


def test_script_that_creates_a_mesh_needs_no_input():
    script = script_file(("Tetrahedron", {}), FLIP)
    result = call("run", script, "-o", "own.ply")
    assert result.exit_code == 0
    assert result.stdout.startswith("no input -> own.ply (4 vertices, 4 faces): 2 steps")
    assert len(loaded("own.ply").faces) == 4


def test_script_that_needs_a_mesh_is_refused_without_input(script):
    result = call("run", script, "-o", "own.ply")
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: script.mlx: step 1 (Willmore flipping optimization): ")
    assert listing() == ["script.mlx"]


def test_script_runs_without_output(script, cube):
    result = call("run", script, "-i", cube)
    assert result.exit_code == 0
    assert result.stdout.startswith("cube.ply -> not saved (no -o): 2 steps")
    assert listing() == ["cube.ply", "script.mlx"]


# What is found before the first step


def no_step(monkeypatch):
    def fail(*_arguments):
        raise AssertionError("a step ran")

    monkeypatch.setattr(work, "play", fail)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["-i", "cube.ply"], "without a script, run converts meshes, and needs -i and -o; name a"),
        (["-o", "a.ply"], "without a script, run converts meshes, and needs -i and -o; name a"),
        (
            ["-i", "cube.ply", "-o", "a.ply", "--set", "1.a=2"],
            "--set 1.a=2: there is no script whose steps it could change",
        ),
        (["script.mlx", "-s", "script.mlx"], "name the script once"),
        (["-s", "a.mlx", "-s", "b.mlx"], "--script is given 2 times; give it once"),
        (["script.mlx", "--log", "a", "-l", "b.txt"], "--log is given 2 times; give it once"),
        (["scrpt.mlx"], "there is no filter script scrpt.mlx"),
        (["script.mlx", "-i", "cub.ply"], "there is no file cub.ply; there is cube.ply"),
        (["script.mlx", "-i", "no/a.ply"], "there is no file no/a.ply: there is no folder no"),
        (["script.mlx", "-i", "."], ". is a folder; name the meshes in it, such as '*.ply'"),
        (["script.mlx", "-i", "*.off"], "no file matches '*.off'"),
        (["script.mlx", "-i", "empty.ply"], "empty.ply is empty (0 bytes)"),
        (["script.mlx", "-i", "cube.ply", "-o", "a"], "the format of a is unknown: it has no endi"),
        (
            ["script.mlx", "-i", "cube.ply", "-o", "a.fbx"],
            "the format of a.fbx is unknown: PyMeshLab writes no .fbx files; there are ply, obj",
        ),
        (
            # PyMeshLab keeps formats and filters in one list.
            ["script.mlx", "-i", "cube.ply", "-o", "a.create_cube"],
            "the format of a.create_cube is unknown: PyMeshLab writes no .create_cube files",
        ),
        (
            ["script.mlx", "-i", "cube.ply", "-o", "no/a.ply"],
            "cannot write no/a.ply: the folder no does not exist",
        ),
        (
            ["script.mlx", "-i", "cube.ply", "-o", "empty.ply/a.ply"],
            "cannot write empty.ply/a.ply: the folder empty.ply is a file, not a folder",
        ),
        (
            ["script.mlx", "-i", "cube.ply", "-o", "cube.ply"],
            "cube.ply already exists; use --force",
        ),
        (["script.mlx", "-i", "cube.ply", "-o", "folder"], "folder is a folder; name a file in it"),
        (["script.mlx", "-i", "cube.ply", "-o", "{nam}.ply"], "{nam} in '{nam}.ply' is no placeho"),
        (["script.mlx", "-i", "cube.ply", "-o", "{.ply"], "the output name '{.ply' can't be read"),
        (
            ["script.mlx", "-i", "cube.ply", "-o", "{name:>99999999}.ply"],
            "the output name '{name:>99999999}.ply' can't be read: only {index} takes a width",
        ),
        (["script.mlx", "-i", "cube.ply", "-o", "{index:999}.ply"], "the output name '{index:999}"),
        (["script.mlx", "-i", "cube.ply", "-o", "{index:{foo}}.ply"], "the output name '{index:{"),
        (["script.mlx", "-i", "cube.ply", "-o", "{name!r}.ply"], "the output name '{name!r}.ply'"),
        (
            ["script.mlx", "-i", "cube.ply", "-o", "n" * 300 + ".ply"],
            f"the output name {'n' * 40}... is too long",
        ),
        (["script.mlx", "-i", "n" * 300 + ".ply"], f"there is no file {'n' * 300}.ply"),
        (["s" * 300 + ".mlx"], f"there is no filter script {'s' * 300}.mlx"),
        (["script.mlx", "-p", "a.ply"], "-p a.ply: projects end in .mlp; for a mesh, use -i or"),
        (["script.mlx", "-w", "a.ply"], "-w a.ply: projects end in .mlp; for a mesh, use -i or"),
        (["script.mlx", "-p", "no.mlp"], "there is no file no.mlp"),
        (["script.mlx", "-i", "cube.ply", "-o", "a.mlb"], "a.mlb would be a project; only .mlp"),
        (["script.mlx", "-i", "cube.ply", "-x"], "-x of meshlabserver is gone: --force overwrites"),
        (["-d", "list.txt"], "-d of meshlabserver is gone: 'meshlab-willmore filters' lists"),
        (["script.mlx", "-o", "{name}.ply"], "-o {name}.ply: there is no input to take a name fro"),
        (["script.mlx", "-i", "cube.ply", "two.ply", "-o", "a.ply"], "2 inputs need one -o with a"),
        (
            ["script.mlx", "-i", "cube.ply", "two.ply", "-o", "{ext}.obj"],
            "cube.ply and two.ply would both be written to ply.obj; use {name} or {index} in",
        ),
        (
            ["script.mlx", "-i", "cube.ply", "cube.obj", "-o", "{name}.off"],
            "cube.ply and cube.obj would both be written to cube.off; use {ext} or {index} in",
        ),
        (
            ["script.mlx", "-i", "cube.ply", "*.ply", "-o", "{name}.off"],
            "cube.ply is named twice as an input; name it once, or use {index} in the output's",
        ),
        (
            ["script.mlx", "-i", "folder/../cube.ply", "-o", "no/{dir}/{name}.off"],
            "cannot write no/folder/../cube.off: the folder no does not exist",
        ),
        (
            ["script.mlx", "-i", "folder/../../*/cube.ply", "-o", "folder/{dir}/{name}.off"],
            "the result of folder/../../",
        ),
        (
            ["script.mlx", "-i", "cube.ply", "-o", "a.ply", "./a.ply"],
            "a.ply is named twice as an output; name it once",
        ),
        (
            ["script.mlx", "-i", "two.ply", "cube.ply", "--force", "-o", "{dir}/cube.ply"],
            "the result of two.ply would replace the input cube.ply",
        ),
        (["script.mlx", "-m", "vx"], "Invalid value for '--mask' / '-m': 'vx' is not one of 'vc'"),
        (["script.mlx", "--set", "1.maxflips"], "--set 1.maxflips: it must be STEP.PARAM=VALUE"),
    ],
)
def test_wrong_usage_is_one_line_before_anything_runs(monkeypatch, script, cube, arguments, line):
    no_step(monkeypatch)
    cube_file("two.ply")
    cube_file("cube.obj")
    Path("empty.ply").touch()
    Path("folder").mkdir()
    before = listing()
    result = call("run", *arguments)
    assert result.exit_code == 2
    assert result.stderr.startswith(f"Error: {line}")
    assert result.stderr.count("\n") == 1
    assert (result.stdout, listing()) == ("", before)


def test_every_error_of_the_script_has_a_line(monkeypatch, cube):
    no_step(monkeypatch)
    script = script_file(("Taubin Smoth", {}), (FLIP[0], {"mxflips": ("RichInt", 1)}))
    result = call("run", script, "-i", cube, "-o", "out.ply")
    assert result.exit_code == 1
    first, second = result.stderr.splitlines()
    assert first.startswith("Error: script.mlx: step 1 (Taubin Smoth): ")
    assert "Taubin Smooth" in first
    assert second.startswith(f"Error: script.mlx: step 2 ({FLIP[0]}), parameter 'mxflips': ")
    assert listing() == ["cube.ply", "script.mlx"]


def test_errors_of_the_script_come_before_those_of_inputs():
    Path("bad.ply").write_text("no mesh")
    result = call("run", script_file(("Taubin Smoth", {})), "-i", "bad.ply")
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: script.mlx: step 1 (Taubin Smoth): ")


def test_input_without_a_mesh(script):
    Path("none.ply").write_text("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n")
    result = call("run", script, "-i", "none.ply", "-o", "out.ply")
    assert result.exit_code == 1
    assert re.fullmatch(r"Error: cannot read none\.ply: .+\n", result.stderr)


def test_unknown_input_format(script):
    Path("a.xyzzy").write_text("hello")
    result = call("run", script, "-i", "a.xyzzy", "-o", "out.ply")
    assert result.exit_code == 1
    assert result.stderr == "Error: cannot read a.xyzzy: PyMeshLab knows no mesh format '.xyzzy'\n"


# Dry runs, logs, settings


def test_dry_run_checks_everything_and_writes_nothing(monkeypatch, script, cube):
    no_step(monkeypatch)
    result = call("run", script, "-i", cube, "-o", "out.ply", "--log", "log.txt", "--dry-run")
    assert result.exit_code == 0
    assert result.stdout == "cube.ply: ok; 2 steps to run, then out.ply to write\n"
    assert listing() == ["cube.ply", "script.mlx"]
    Path("bad.ply").write_text("no mesh")
    assert call("run", script, "-i", "bad.ply", "--dry-run").exit_code == 1


def test_log_has_parameters_times_and_results(cube):
    script = script_file((FLIP[0], {"energy": ("RichEnum", '1" enum_cardinality="2')}), TAUBIN)
    before = "2020-02-20 20:20:20 run older.mlx"
    Path("log.txt").write_text(before + "\n")
    assert call("run", script, "-i", cube, "-o", "out.ply", "--log", "log.txt").exit_code == 0
    lines = Path("log.txt").read_text().splitlines()
    # meshlabserver, too, wrote behind what was there.
    assert lines[0] == before
    assert lines[1].endswith(" run script.mlx")
    assert lines[2] == "input cube.ply (14 vertices, 24 faces)"
    assert lines[3] == (
        "step 1 of 2: meshing_edge_flip_by_willmore_optimization (Willmore flipping optimization)"
    )
    assert lines[4] == "  parameters: energy='willmore'"
    assert re.fullmatch(r"  time: \d+\.\d{3} s", lines[5])
    assert re.match(r"  returned: flips=\d+, gain=[\d.]+, willmore_before=45\.75", lines[6])
    assert lines[7:9] == [
        "step 2 of 2: apply_coord_taubin_smoothing (Taubin Smooth)",
        "  parameters: stepsmoothnum=2",
    ]
    assert lines[10] == "output out.ply (14 vertices, 24 faces)"
    assert re.fullmatch(r"done, \d+\.\d{3} s", lines[11])
    assert len(lines) == 12


def test_log_of_a_failed_step(cube):
    Path("points.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n")
    script = script_file(("Select All", {}), FLIP)
    result = call("run", script, "-i", "points.xyz", "-o", "out.ply", "--log", "log.txt")
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: script.mlx, step 2 (meshing_edge_flip_by_willmore_opt")
    assert "has no faces" in result.stderr
    assert result.stderr.count("\n") == 1
    log = Path("log.txt").read_text()
    assert "step 1 of 2: set_selection_all" in log
    assert f"error: {result.stderr.removeprefix('Error: ')}" in log
    assert re.fullmatch(r"failed, \d+\.\d{3} s", log.splitlines()[-1])
    assert not Path("out.ply").exists()


def test_log_on_the_terminal(script, cube):
    result = call("run", script, "-i", cube, "-l", "-")
    assert "step 2 of 2: apply_coord_taubin_smoothing (Taubin Smooth)\n" in result.stdout
    assert "\ncube.ply -> not saved" in result.stdout
    assert result.stdout.splitlines()[-1].startswith("done, ")


def test_changed_behaviour_of_an_old_step_is_a_warning(cube):
    script = script_file(("Box", {}), ("Convex Hull", {"reorient": ("RichBool", "true")}))
    result = call("run", script, "-i", cube, "--dry-run")
    assert (result.exit_code, result.stderr) == (
        0,
        "script.mlx: warning: step 2 (Convex Hull), parameter 'reorient': is ignored: the filter "
        "has had none such since MeshLab 2017.06\n",
    )


def test_settings_replace_values_of_the_script(script, cube):
    arguments = ["--set", "Taubin Smooth.stepsmoothnum=7", "--set", "1.maxflips=3"]
    result = call("run", script, "-i", cube, "-l", "-", *arguments)
    assert result.exit_code == 0
    assert "  parameters: maxflips=3\n" in result.stdout
    assert "  parameters: stepsmoothnum=7\n" in result.stdout
    assert "  returned: flips=3, " in result.stdout


@pytest.mark.slow
def test_native_filters_print_nothing_into_the_output(cube):
    # This one writes to the C++ streams, whatever the verbosity.
    script = script_file(("generate_alpha_shape", {}))
    done = spawn("run", script, "-i", cube)
    assert (done.returncode, done.stderr) == (0, "")
    assert len(done.stdout.splitlines()) == 1


def test_mask_belongs_to_the_output_before_it():
    cube_file("other.ply")
    script = script_file(TAUBIN)
    outputs = ["-m", "vn", "-o", "a.ply", "-m", "vc", "-o", "b.ply", "-o", "c.ply", "--mask=vq"]
    result = call("run", script, "-i", cube_file(), "other.ply", "other.ply", "--layers", *outputs)
    assert result.exit_code == 0, result.stderr
    parts = {"nx": "vn", "red": "vc", "quality": "vq"}

    def saved(path):
        words = Path(path).read_bytes().partition(b"end_header")[0].decode().split()
        return {part for word, part in parts.items() if word in words}

    assert [saved(f"{name}.ply") for name in "abc"] == [{"vn", "vc"}, {"vn"}, {"vn", "vq"}]
