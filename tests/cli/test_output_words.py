"""`-o` with several names, and `-l`: a layer behind an output, a log before all of them."""

import itertools
from pathlib import Path

import pytest

from meshlab_willmore.cli.errors import WrongUse
from meshlab_willmore.cli.masks import is_part
from meshlab_willmore.cli.output_words import by_output, plain, without_empty_masks
from meshlab_willmore.cli.scripts import is_script

from .conftest import TAUBIN, call, cube_file, listing, loaded, script_file

SQUARE = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"
TRIANGLE = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"


def words(line):
    return " ".join(plain(line.split(), is_script, is_part))


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("-o a.ply -l 1", "-o a.ply --layer 1"),
        ("-o a.ply -l c -m vc vn", "-o a.ply --layer c -m vc vn"),
        ("-o a.ply -m vc vn -l x", "-o a.ply -m vc vn --layer x"),
        ("-oa.ply -l12 -i b.ply", "-o a.ply --layer 12 -i b.ply"),
        ("--output=a.ply -l 0 s.mlx", "-o a.ply --layer 0 s.mlx"),
        ("-l log.txt -o a.ply -l 1", "--log log.txt -o a.ply --layer 1"),
        ("-llog.txt -o a.ply", "--log log.txt -o a.ply"),
        ("-l - -o a.ply", "--log - -o a.ply"),
        # So it was in every meshlabserver.
        ("-i a.ply -o b.ply -s s.mlx -l log.txt", "-i a.ply -o b.ply -s s.mlx --log log.txt"),
        (
            "-o a.ply b.obj -m vc -l x -i c.ply",
            "-o a.ply -m vc --layer x -o b.obj -m vc --layer x -i c.ply",
        ),
        ("-o a.ply b.ply s.mlx c.ply", "-o a.ply -o b.ply s.mlx c.ply"),
        ("-o a.ply -", "-o a.ply -"),
        ("-o a.ply -l 1 -o b.ply -l 0", "-o a.ply --layer 1 -o b.ply --layer 0"),
        ("--layers -o a.ply --log 1", "--layers -o a.ply --log 1"),
        ("-o a.ply -- -l 1", "-o a.ply -- -l 1"),
        ("-o", "-o"),
        ("-l", "--log"),
    ],
)
def test_words(line, said):
    assert words(line) == said


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        (
            "-o a.ply -l log.txt",
            r"-l log\.txt behind -o a\.ply is no layer \(.*\); for a log, type --log log",
        ),
        ("-o a.ply -l l", "-l l behind -o a.ply is no layer"),
        ("-o a.ply -l -1", "-l behind -o a.ply wants the layer"),
        ("-o a.ply -l", "-l behind -o a.ply wants the layer"),
        ("-o a.ply -l 1 -l 2", "-o a.ply has two layers, 1 and 2"),
        (
            "-l 1 -o a.ply",
            "-l 1 before every -o is a layer or a log; .* behind -o FILE, .* --log 1",
        ),
        ("-o a.ply -s s.mlx -l 1", "-l 1 apart from its -o is a layer or a log"),
        ("-o a.ply --force -l x", "-l x apart from its -o"),
    ],
)
def test_what_can_be_meant_in_two_ways_is_an_error(line, problem):
    with pytest.raises(WrongUse, match=problem):
        words(line)


def test_layers_belong_to_the_output_before_them():
    order = ["inputs", "patterns", "layer", "parts", "patterns", "layer"]
    assert by_output(order, ["1", "x"], ["a", "b"]) == ["1", "x"]
    assert by_output(["patterns", "patterns"], [], ["a", "b"]) == ["", ""]
    with pytest.raises(WrongUse, match="-o b has no layer, but others have; add -l c"):
        by_output(["patterns", "layer", "patterns"], ["1"], ["a", "b"])
    with pytest.raises(WrongUse, match="--layer 1 stands before every -o"):
        by_output(["layer", "patterns"], ["1"], ["a"])
    with pytest.raises(WrongUse, match="--layer one: it can be"):
        by_output(["patterns", "layer"], ["one"], ["a"])


@pytest.fixture
def run():
    cube_file()
    Path("square.off").write_text(SQUARE)
    Path("triangle.off").write_text(TRIANGLE)
    inputs = ["-i", "cube.ply", "-i", "square.off", "triangle.off"]
    return ["run", *inputs, "--layers", "-s", script_file(TAUBIN)]


SIZES = {"cube": 14, "square": 4, "triangle": 3}


@pytest.mark.parametrize(
    ("layer", "mesh"),
    [("0", "cube"), ("1", "square"), ("2", "triangle"), ("x", "triangle"), ("c", "cube")],
)
def test_a_layer_is_saved(run, layer, mesh):
    before = listing()
    result = call(*run, "-o", "out.ply", "-l", layer, "-m", "vn")
    assert (result.exit_code, result.stderr) == (0, "")
    assert len(loaded("out.ply").vertices) == SIZES[mesh]
    assert listing() == sorted([*before, "out.ply"])


def test_outputs_have_layers_in_any_order(run):
    outputs = [
        "-o",
        "last.ply",
        "-l",
        "x",
        "-o",
        "one.ply",
        "one.obj",
        "-l",
        "1",
        "-o",
        "c.ply",
        "-l",
        "c",
    ]
    assert call(*run, *outputs).exit_code == 0
    names = {"last.ply": "triangle", "one.ply": "square", "one.obj": "square", "c.ply": "cube"}
    assert {name: len(loaded(name).vertices) for name in names} == {
        name: SIZES[mesh] for name, mesh in names.items()
    }


def test_several_names_are_outputs_in_the_order_of_the_layers(run):
    assert call(*run, "-o", "a.ply", "b.ply", "c.ply", "-m", "vn").exit_code == 0
    assert [len(loaded(f"{name}.ply").vertices) for name in "abc"] == list(SIZES.values())
    assert all(b"property double nx" in Path(f"{name}.ply").read_bytes() for name in "abc")


def test_a_layer_that_is_not_there_is_named_before_anything_is_saved(run):
    result = call(*run, "-o", "a.ply", "-l", "0", "-o", "b.ply", "-l", "3")
    assert result.exit_code == 1
    assert result.stderr == "Error: there is no layer 3: the script leaves 3 layers, from 0\n"
    assert not Path("a.ply").exists()


def test_a_log_before_the_outputs_or_by_its_long_name(run):
    for given in (
        ["-l", "log.txt", "-o", "a.ply", "-l", "1"],
        ["-o", "b.ply", "-l", "1", "--log", "log.txt"],
    ):
        assert call(*run, *given).exit_code == 0
    assert Path("log.txt").read_text().count(" run script.mlx\n") == 2


def test_polygons_and_text_as_meshlabserver_had_them():
    quads = ["v 0 0 0", "v 1 0 0", "v 1 1 0", "v 0 1 0", "f 1 2 3 4"]
    Path("quad.obj").write_text("\n".join(quads) + "\n")
    script = script_file(("Select None", {}))
    assert (
        call("run", "-i", "quad.obj", "-s", script, "-o", "a.obj", "-m", "mp", "vn").exit_code == 0
    )
    faces = [line for line in Path("a.obj").read_text().splitlines() if line.startswith("f ")]
    assert [len(face.split()) for face in faces] == [5]
    assert call("run", "-i", "quad.obj", "-s", script, "-o", "a.ply", "-m", "sa").exit_code == 0
    assert b"format ascii" in Path("a.ply").read_bytes()


@pytest.mark.slow
def test_every_combination_of_two_outputs(run):
    for one, two in itertools.product(("1", "x"), repeat=2):
        outputs = ["-o", "a.ply", "-l", one, "-o", "b.ply", "-l", two]
        assert call(*run, *outputs, "--force").exit_code == 0
        sizes = [SIZES["square" if layer == "1" else "triangle"] for layer in (one, two)]
        assert [len(loaded(f"{name}.ply").vertices) for name in "ab"] == sizes


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("-i a.ply -o b.ply -s s.mlx -om", "-i a.ply -o b.ply -s s.mlx"),
        ("-o b.ply -om -s s.mlx", "-o b.ply -s s.mlx"),
        ("-o b.ply -om s.mlx", "-o b.ply s.mlx"),
        ("-o b.ply -om vc s.mlx", "-o b.ply -om vc s.mlx"),
    ],
)
def test_an_old_mask_with_nothing_in_it_is_none(line, said):
    assert " ".join(without_empty_masks(line.split(), is_script)) == said


@pytest.mark.parametrize(
    ("option", "line"),
    [
        (["-i", "a.mlp"], "cannot read a.mlp: projects are not read; name their meshes after -i"),
        (["-i", "cube.ply", "-o", "b.mlp"], "b.mlp: projects are not written; each layer can have"),
    ],
)
def test_projects_are_named_as_such(option, line):
    cube_file()
    Path("a.mlp").write_text("<!DOCTYPE MeshLabDocument>\n<MeshLabProject/>\n")
    result = call("run", script_file(TAUBIN), *option)
    assert result.exit_code in (1, 2)
    assert result.stderr.startswith(f"Error: {line}")
