"""`flip`: one mesh, and the filter's parameters as options."""

import re
from pathlib import Path

import click
import pymeshlab
import pytest
from click.testing import CliRunner

from meshlab_willmore.cli import arguments
from meshlab_willmore.cli import flip as flip_module
from meshlab_willmore.meshset import filters
from meshlab_willmore.options import FILTER, OPTIONS, SEED

from .conftest import call, cube_file, listing, same_mesh


@pytest.mark.parametrize(
    ("words", "given"),
    [
        ([], {}),
        (["--energy", "willmore"], {"energy": "willmore"}),
        (["--no-monotone", "--maxflips", "4"], {"monotone": False, "maxflips": 4}),
        (["--featuredeg", "30"], {"featuredeg": 30.0}),
        (["--energy", "mean-curvature"], {"energy": "mean curvature"}),
        (["--energy", "mean curvature"], {"energy": "mean curvature"}),
    ],
)
def test_flips_like_the_filter(cube, words, given):
    result = call("flip", cube, "out.ply", *words)
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh("cube.ply")
    returned = ms.meshing_edge_flip_by_willmore_optimization(**given)
    ms.save_current_mesh("expected.ply")
    assert (result.exit_code, result.stderr) == (0, "")
    assert same_mesh("out.ply", "expected.ply")
    assert re.fullmatch(
        rf"cube\.ply -> out\.ply: {returned['flips']} flips, Willmore energy 45\.757 -> "
        rf"{returned['willmore_after']:.6g}, \d+\.\d s\n",
        result.stdout,
    )


def test_help_has_each_option_with_its_help_text_and_default():
    text = " ".join(call("flip", "--help").stdout.split())
    for option in OPTIONS:
        assert f"--{option.name}" in text
        # Names have hyphens here.
        assert option.help.split(".")[0].replace("-", " ") in text.replace("-", " ")
        assert all(f"'{choice.replace(' ', '-')}'" in text for choice in option.choices)
    assert "[default: virtual-willmore]" in text
    assert "--monotone / --no-monotone" in text
    assert "meshlab-willmore flip scan.ply flipped.ply" in text


def test_new_option_is_one_of_the_command(monkeypatch):
    new = SEED._replace(name="newword", help="Something new.", default=7)
    monkeypatch.setattr(arguments, "OPTIONS", (*OPTIONS, new))

    @click.command
    @arguments.flip_options(leave_out=["seed"])
    def command(**_given):
        pass

    text = CliRunner().invoke(command, ["--help"]).stdout
    assert "Something new.  [default: 7]" in text
    assert "--energy" in text
    assert "--seed" not in text


def test_each_parameter_of_the_filter_is_an_option_of_its_type():
    options = {option.name: option for option in flip_module.command.params}
    parameters = filters.BY_NAME[FILTER].parameters
    names = [parameter.name for parameter in parameters]
    assert [name for name in options if name in names] == names
    for parameter in parameters:
        option = options[parameter.name]
        choices = [option.type.convert(name, option, None) for name in parameter.choices]
        assert choices == list(parameter.choices)
        assert len(getattr(option.type, "choices", ())) == len(choices)
        assert option.is_bool_flag == (parameter.type is bool)
        # In the command line, names have hyphens.
        assert option.help.replace("-", " ").startswith(parameter.tooltip.replace("-", " "))


@pytest.mark.parametrize(
    ("arguments", "code", "line"),
    [
        (["cube.ply"], 2, "Missing argument 'IN...'."),
        (["cub.ply", "out.ply"], 2, "there is no file cub.ply; there is cube.ply"),
        (["*.ply", "out.ply"], 2, "2 inputs need an output with a placeholder, such as"),
        (["cube.ply", "two.ply"], 2, "two.ply already exists; use --force to overwrite"),
        (["cube.ply", "out.foo"], 2, "the format of out.foo is unknown: PyMeshLab writes no .foo"),
        (["cube.ply", "o.ply", "--energy", "x"], 2, "Invalid value for '--energy': 'x' is not one"),
        (["cube.ply", "o.ply", "--maxflips", "x"], 2, "Invalid value for '--maxflips': 'x' is not"),
        (["cube.ply", "o.ply", "--maxflips", "-5"], 2, "--maxflips: maxflips must be -1"),
        (["points.xyz", "o.ply"], 1, "points.xyz: The current mesh has no faces, it is a point"),
    ],
)
def test_errors_are_reported_in_one_line(cube, arguments, code, line):
    cube_file("two.ply")
    Path("points.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n")
    before = listing()
    result = call("flip", *arguments)
    assert (result.exit_code, result.stdout) == (code, "")
    assert result.stderr.startswith(f"Error: {line}")
    assert result.stderr.count("\n") == 1
    assert listing() == before


def test_force_and_mask(cube):
    Path("out.ply").write_text("mine")
    assert call("flip", cube, "out.ply", "--force", "-m", "vn", "vq").exit_code == 0
    assert b"property double nx" in Path("out.ply").read_bytes()


def test_in_place_with_force(cube):
    assert call("flip", cube, cube, "--force").exit_code == 0
    assert listing() == ["cube.ply"]
    assert call("flip", cube, "again.ply").stdout.startswith("cube.ply -> again.ply: 0 flips")


@pytest.mark.parametrize(
    ("option", "value", "line"),
    [
        ("--depth", "0", "depth must lie in 1 .. 100, not 0"),
        ("--seed", "99999999999", "is out of range, a whole number from -2147483648"),
        ("--virtualpoint", "50%", "unknown virtualpoint '50%'; choose 'midpoint', 'closest' or"),
    ],
)
def test_wrong_values_are_reported_before_loading(option, value, line):
    result = call("flip", "there-is-none.ply", "out.ply", option, value)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"Error: {option}: ")
    assert line in result.stderr


@pytest.mark.parametrize(
    ("words", "option"),
    [
        (["--foldangle", "90"], "--foldangle 90 "),
        (["--minshape", ".05"], "--minshape 0.05 "),
        (["--foldangle", "89.9"], ""),
        ([], ""),
    ],
)
def test_a_default_that_the_preset_overrules_is_noted(cube, words, option):
    result = call("flip", cube, "out.ply", "--preset", "faithful", *words)
    assert result.exit_code == 0
    notes = result.stderr.splitlines()
    assert len(notes) == bool(option)
    if option:
        assert notes[0].startswith(f"Note: {option}is the default, in place of which the preset ")
    assert call("flip", cube, "other.ply", *words).stderr == ""
