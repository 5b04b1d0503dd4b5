"""Presets and lengths in the flip filter, in scripts and in what PyMeshLab prints."""

import numpy as np
import pymeshlab
import pytest
from pymeshlab import PercentageValue, PureValue

from meshlab_willmore import optimize_flips, script
from meshlab_willmore.mlx.read import read_bytes
from tests import meshes
from tests.cli.conftest import call
from tests.meshset.conftest import FLIP, script_of, set_of
from tests.workers import workers_here  # noqa: F401

# With the JIT off, the guard against intersections alone takes minutes.
pytestmark = pytest.mark.heavy

MESH = meshes.bumpy_sphere(150, 2, bump=0.6)
DIAGONAL = float(np.linalg.norm(np.ptp(MESH[0], axis=0)))


def flipped(**given):
    ms = set_of(*MESH)
    returned = ms.apply_filter(FLIP, **given)
    return ms.current_mesh().face_matrix(), returned, ms


def step(*params):
    """A script with one step of ours, and these parameters: name, type, value."""
    listed = "".join(f'<Param name="{n}" type="{t}" value="{v}"/>' for n, t, v in params)
    name = "Willmore flipping optimization"
    return f'<FilterScript><filter name="{name}">{listed}</filter></FilterScript>'


@pytest.mark.parametrize("preset", ["faithful", "smooth", "shape"])
def test_a_preset_flips_what_it_flips_on_arrays(preset):
    faces, returned, _ = flipped(preset=preset)
    expected = optimize_flips(*MESH, preset=preset)
    np.testing.assert_array_equal(faces, expected.faces)
    assert returned["deviation"] == pytest.approx(expected.deviation)
    for name in ("absolute_mean_curvature", "mean_shape", "worst_shape", "willmore"):
        for when in ("before", "after"):
            assert returned[f"{name}_{when}"] == getattr(expected, f"{name}_{when}")
    assert not np.array_equal(faces, optimize_flips(*MESH).faces)


@pytest.mark.parametrize(
    ("limit", "length"),
    [
        (PercentageValue(0.5), 0.005 * DIAGONAL),
        (PureValue(0.005 * DIAGONAL), 0.005 * DIAGONAL),
        (PercentageValue(100), None),
        (PercentageValue(0), 0.0),
    ],
)
def test_a_deviation_is_a_percentage_or_a_length(limit, length):
    faces, _, _ = flipped(energy="area", maxdeviation=limit)
    expected = optimize_flips(*MESH, energy="area", maxdeviation=length)
    np.testing.assert_array_equal(faces, expected.faces)


@pytest.mark.parametrize("limit", [PercentageValue(100), PureValue(2.0 * DIAGONAL)])
@pytest.mark.parametrize("preset", ["faithful", "shape"])
def test_the_whole_diagonal_is_no_limit_for_a_preset_either(preset, limit):
    faces, returned, _ = flipped(preset=preset, maxdeviation=limit)
    free = optimize_flips(*MESH, preset=preset, maxdeviation=np.inf)
    np.testing.assert_array_equal(faces, free.faces)
    assert returned["flips"] > optimize_flips(*MESH, preset=preset).flips


def test_the_diagonal_of_the_largest_floats_is_infinite():
    scale = 1.6e308 / np.abs(MESH[0]).max()
    returned = set_of(MESH[0] * scale, MESH[1]).apply_filter(FLIP, preset="shape")
    assert returned["flips"] == optimize_flips(MESH[0] * scale, MESH[1], preset="shape").flips


@pytest.mark.parametrize("value", [0.1, 1, "1%", True])
def test_a_plain_number_is_no_deviation_as_in_pymeshlab(value):
    ms = set_of(*MESH)
    with pytest.raises(pymeshlab.PyMeshLabException):
        ms.meshing_merge_close_vertices(threshold=value)
    with pytest.raises(
        pymeshlab.PyMeshLabException, match="a pymeshlab.PercentageValue, or a pymeshlab.PureValue"
    ):
        ms.apply_filter(FLIP, maxdeviation=value)


@pytest.mark.usefixtures("workers_here")
@pytest.mark.parametrize("share", ["0.5%", "0.02"])
def test_the_command_line_takes_both_alone_in_a_batch_and_for_comparisons(
    share, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    set_of(*MESH).save_current_mesh("in.ply")
    set_of(*MESH).save_current_mesh("in2.ply")
    options = ("--energy", "area", "--maxdeviation", share)
    alone = call("flip", "in.ply", "out.ply", *options)
    batch = call("flip", "in.ply", "in2.ply", "{name}_out.ply", *options, "--workers", "1")
    compared = call("compare", "in.ply", "--no-peers", "--search", "parallel greedy", *options)
    assert (alone.exit_code, batch.exit_code, compared.exit_code) == (0, 0, 0)
    limit = PercentageValue(0.5) if share == "0.5%" else PureValue(0.02)
    _, returned, _ = flipped(energy="area", maxdeviation=limit)
    assert f": {returned['flips']} flips" in alone.stdout
    assert batch.stdout.count(f": {returned['flips']} flips") == 2
    row = next(line for line in compared.stdout.splitlines() if line.startswith("parallel"))
    assert f" {returned['flips']} " in row
    assert returned["flips"] < flipped(energy="area")[1]["flips"]


def test_a_length_below_zero_is_refused():
    with pytest.raises(pymeshlab.PyMeshLabException, match="maxdeviation must be a length of 0"):
        flipped(maxdeviation=PureValue(-1.0))


@pytest.mark.parametrize("option", ["energy", "search", "depth", "seed", "monotone"])
def test_what_the_preset_decides_is_refused_beside_it(option):
    value = {"energy": "willmore", "search": 0, "depth": 5, "seed": 0, "monotone": True}[option]
    ms = set_of(*MESH)
    with pytest.raises(pymeshlab.PyMeshLabException) as error:
        ms.apply_filter(FLIP, preset="faithful", **{option: value})
    assert f"{option} can't be given beside preset='faithful'" in str(error.value)
    np.testing.assert_array_equal(ms.current_mesh().face_matrix(), MESH[1])
    assert ms.apply_filter(FLIP, preset="paper", **{option: value})["flips"] > 0


def test_the_defaults_are_those_of_the_preset():
    ms = set_of(*MESH)
    diagonal = ms.current_mesh().bounding_box().diagonal()
    for preset, percent in (("paper", 100), ("faithful", 0.03), ("smooth", 100), ("shape", 0.03)):
        values = ms.filter_parameter_values(FLIP, preset=preset)
        assert values["maxdeviation"] == pytest.approx(percent / 100 * diagonal)
    values = ms.filter_parameter_values(FLIP, maxdeviation=PureValue(0.25))
    assert values["maxdeviation"] == 0.25


def test_parameters_are_listed_as_pymeshlab_lists_its_own(capfd):
    pymeshlab.print_filter_parameter_list(FLIP)
    text = capfd.readouterr().out
    assert "\tpreset : str = 'paper'\n" in text
    assert "\tmaxdeviation : PercentageValue = 100%\n" in text


# --- scripts -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given",
    [
        {"preset": "faithful"},
        {"preset": "shape", "maxdeviation": PercentageValue(0.5), "featuredeg": 30.0},
        {"energy": "area", "maxdeviation": PureValue(0.02)},
    ],
)
def test_a_recorded_step_does_the_same_again(given):
    faces, _, ms = flipped(**given)
    text = script_of(ms)
    again = set_of(*MESH)
    script.run(read_bytes(text.encode(), "saved.mlx"), again)
    np.testing.assert_array_equal(again.current_mesh().face_matrix(), faces)
    assert ('name="energy"' in text) == ("preset" not in given)


def test_a_recorded_percentage_stays_one():
    _, _, ms = flipped(preset="faithful")
    assert 'value="0.03%"' in script_of(ms)


def test_a_script_may_give_all_parameters_at_their_defaults():
    text = step(
        ("preset", "RichEnum", '1" enum_cardinality="4'),
        ("energy", "RichEnum", '0" enum_cardinality="7'),
        ("depth", "RichInt", "5"),
    )
    ms = set_of(*MESH)
    script.run(read_bytes(text.encode(), "all.mlx"), ms)
    np.testing.assert_array_equal(ms.current_mesh().face_matrix(), flipped(preset=1)[0])


def test_what_contradicts_the_preset_is_a_fault_of_the_script():
    text = step(
        ("preset", "RichEnum", '1" enum_cardinality="4'),
        ("energy", "RichEnum", '1" enum_cardinality="7'),
        ("depth", "RichInt", "7"),
    )
    found = [str(fault) for fault in script.check(read_bytes(text.encode(), "wrong.mlx"))]
    assert len(found) == 2
    assert "energy can't be given beside preset='faithful'" in found[0]
    assert "depth can't be given beside preset='faithful'" in found[1]
