"""The arguments of `run`: outputs with their masks and layers, inputs, logs."""

import itertools
from pathlib import Path

import click
import pytest

from meshlab_willmore.cli import flip, main
from meshlab_willmore.cli import run as run_module
from meshlab_willmore.cli.arguments import REMOVED, take_outputs
from meshlab_willmore.messages import WrongUse

from .conftest import TAUBIN, call, cube_file, listing, loaded, script_file

SQUARE = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"
TRIANGLE = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"


def taken(line):
    """The outputs as words, and the rest of a command line."""
    context = click.Context(run_module.command, info_name="run")
    outputs, rest = take_outputs(line.split(), context)
    shown = [
        " ".join([o.name, *o.parts, *([f"layer={o.layer}"] if o.layer else [])]) for o in outputs
    ]
    return shown, " ".join(rest)


@pytest.mark.parametrize(
    ("line", "outputs", "rest"),
    [
        ("", [], ""),
        ("s.mlx -i a", [], "s.mlx -i a"),
        ("-i a b c -o x y", ["x", "y"], "-i a -i b -i c"),
        ("-i a -i b c", [], "-i a -i b -i c"),
        ("-i a s.mlx b", [], "-i a s.mlx b"),
        ("-i s.mlx", [], "-i s.mlx"),
        ("-i a - b", [], "-i a - b"),
        ("-i a -- b c", [], "-i a -- b c"),
        ("-ia b --input=c", [], "-i a -i b -i c"),
        ("-o a.ply -l 1", ["a.ply layer=1"], ""),
        ("-o a.ply -l c -m vc vn", ["a.ply vc vn layer=c"], ""),
        ("-o a.ply -m vc vn -l x", ["a.ply vc vn layer=x"], ""),
        ("-oa.ply -l12 -i b.ply", ["a.ply layer=12"], "-i b.ply"),
        ("-omesh.ply -mmp", ["mesh.ply mp"], ""),
        ("--output=a.ply -l 0 s.mlx", ["a.ply layer=0"], "s.mlx"),
        ("-l log.txt -o a.ply -l 1", ["a.ply layer=1"], "--log log.txt"),
        ("-llog.txt -o a.ply", ["a.ply"], "--log log.txt"),
        ("-l - -o a.ply", ["a.ply"], "--log -"),
        # So it was in every meshlabserver.
        ("-i a -o b.ply -s s.mlx -l log.txt", ["b.ply"], "-i a -s s.mlx --log log.txt"),
        ("-o a b -m vc -l x -i c", ["a vc layer=x", "b vc layer=x"], "-i c"),
        ("-o a.ply b.ply s.mlx c.ply", ["a.ply", "b.ply"], "s.mlx c.ply"),
        ("-o a.ply -", ["a.ply"], "-"),
        ("-o a -l 1 -o b -l 0", ["a layer=1", "b layer=0"], ""),
        ("-o a --force --layer=2", ["a layer=2"], "--force"),
        ("--layers -o a.ply --log 1", ["a.ply"], "--layers --log 1"),
        ("-o a.ply -- -l 1", ["a.ply"], "-- -l 1"),
        ("-l", [], "--log"),
        ("-m vc vn fq s.mlx", [], "s.mlx"),
        ("-m vc -o a -m vn -o b", ["a vc vn", "b vc"], ""),
        ("-o a -m vc -o b", ["a vc", "b"], ""),
        ("-m vc -o a -m vn -o b -m vq fc", ["a vc vn", "b vc vq fc"], ""),
        ("-o a --force --mask=vq", ["a vq"], "--force"),
        ("-o a -om vc vn s.mlx", ["a vc vn"], "s.mlx"),
        # meshlabserver took an empty mask.
        ("-o a -s s.mlx -om", ["a"], "-s s.mlx"),
        ("-o a -om -s s.mlx", ["a"], "-s s.mlx"),
        ("-o a -om s.mlx", ["a"], "s.mlx"),
        ("-i a -- -om -p", [], "-i a -- -om -p"),
        ("-p a.mlp -i b", [], "-i a.mlp --layers -i b"),
        ("s.mlx --project=a.MLP", [], "s.mlx -i a.MLP --layers"),
        ("-w b.mlp -o c -l 1", ["b.mlp", "c layer=1"], ""),
        ("-m vc -wb.mlp -m vn", ["b.mlp vc vn"], ""),
        ("--write-project b.mlp c.ply", ["b.mlp"], "c.ply"),
    ],
)
def test_outputs_with_their_masks_and_layers(line, outputs, rest):
    assert taken(line) == (outputs, rest)


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        (
            "-o a.ply -l log.txt",
            r"-l log\.txt behind -o a\.ply is no layer \(.*\); for a log, write --log log",
        ),
        ("-o a.ply -l l", "-l l behind -o a.ply is no layer"),
        ("-o a.ply -l -1", "-l behind -o a.ply needs the layer"),
        ("-o a.ply -l", "-l behind -o a.ply needs the layer"),
        ("-o a.ply -l 1 -l 2", "-o a.ply has two layers, 1 and 2"),
        (
            "-l 1 -o a.ply",
            "-l 1 before every -o can be a layer or a log; .* behind -o FILE, .* --log 1",
        ),
        ("-o a.ply -s s.mlx -l 1", "-l 1 apart from its -o can be a layer or a log"),
        ("-o a.ply --force -l x", "-l x apart from its -o"),
        ("-o a -l 1 -o b", "-o b has no layer, but others have; add -l c"),
        ("-o a -o b -l 1", "-o a has no layer, but others have; add -l c"),
        ("--layer 1 -o a", "--layer 1 comes before every -o"),
        ("-o a --layer one", "--layer one: it must be"),
        ("-o a --layer", "--layer needs the layer to save: an index from 0, c "),
        ("-o a --layer -1", "--layer needs the layer to save: an index from 0, c "),
        ("-o", "Option '-o' requires an argument"),
        ("-p", "Option '-p' requires an argument"),
        ("-w -o a", "Option '-w' requires an argument"),
        ("-w a.mlp -l 1", "a.mlp is a project, which has all layers; leave -l out"),
        ("-o -i a", "Option '-o' requires an argument"),
        ("-i -o a --force", "Option '-i' requires an argument"),
        ("-o a -m", "Option '-m' requires an argument"),
        # The first word is the option's even if it is wrong.
        ("-m xx vc", "'xx' is not one of 'vc'"),
        *((f"s.mlx {word}", f"^{word} of meshlabserver is gone: ") for word in REMOVED),
    ],
)
def test_wrong_and_ambiguous_words_are_errors(line, problem):
    with pytest.raises((WrongUse, click.ClickException), match=problem):
        taken(line)


@pytest.mark.parametrize(
    ("written", "parts"),
    [
        ("-m vc vn fq", ["vc", "vn", "fq"]),
        ("-mvc vn", ["vc", "vn"]),
        ("--mask vc -m mp", ["vc", "mp"]),
    ],
)
def test_masks_of_flip_take_several_values(written, parts):
    # Click keeps the help option that a command has in its first context.
    parent = click.Context(main, **main.context_settings)
    words = ["in.ply", *written.split(), "--", "out.ply"]
    context = flip.command.make_context("flip", words, parent=parent)
    assert list(context.params["parts"]) == parts
    assert context.params["target"] == "out.ply"


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
def test_chosen_layer_is_saved(run, layer, mesh):
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


def test_several_names_are_outputs_of_the_first_layers(run):
    assert call(*run, "-o", "a.ply", "b.ply", "c.ply", "-m", "vn").exit_code == 0
    assert [len(loaded(f"{name}.ply").vertices) for name in "abc"] == list(SIZES.values())
    assert all(b"property double nx" in Path(f"{name}.ply").read_bytes() for name in "abc")


def test_missing_layer_is_reported_before_saving(run):
    result = call(*run, "-o", "a.ply", "-l", "0", "-o", "b.ply", "-l", "3")
    assert result.exit_code == 1
    assert result.stderr == "Error: there is no layer 3: the script leaves 3 layers, from 0\n"
    assert not Path("a.ply").exists()


def test_log_before_the_outputs_or_by_its_long_name(run):
    for given in (
        ["-l", "log.txt", "-o", "a.ply", "-l", "1"],
        ["-o", "b.ply", "-l", "1", "--log", "log.txt"],
    ):
        assert call(*run, *given).exit_code == 0
    assert Path("log.txt").read_text().count(" run script.mlx\n") == 2


def test_polygons_and_text_files():
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
