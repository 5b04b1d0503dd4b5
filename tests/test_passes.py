"""Presets, and lists of passes."""

import numpy as np
import pytest

from meshlab_willmore import execution, optimize, optimize_flips
from meshlab_willmore.options import PRESET
from meshlab_willmore.passes import PASS_OPTIONS
from meshlab_willmore.presets import FULL_DIAGONAL, PRESETS, SEARCH_OPTIONS, decided_by
from tests import meshes, reference

MESH = meshes.bumpy_sphere(80, 2, bump=0.6)
DIAGONAL = float(np.linalg.norm(np.ptp(MESH[0], axis=0)))
CHOSEN = [name for name in PRESETS if PRESETS[name].passes]


def edges(faces):
    return set(reference.edge_set(faces))


def in_a_chain(passes, **shared):
    """The faces and the numbers of flips of single runs, each from the result of the last."""
    faces, flips = MESH[1], []
    for one in passes:
        result = optimize_flips(MESH[0], faces, **{**shared, **one})
        faces, flips = result.faces, [*flips, result.flips]
    return faces, flips


@pytest.mark.parametrize(
    "passes",
    [
        [{"energy": "mean curvature"}, {"energy": "delaunay", "maxdeviation": 0.05}],
        [{"energy": "delaunay"}, {"energy": "willmore", "search": "greedy"}, {}],
        [{"energy": "area", "checkintersections": True}, {"maxflips": 3}, {"energy": "willmore"}],
    ],
)
def test_passes_are_what_single_runs_are_one_after_the_other(passes):
    result = optimize_flips(*MESH, passes=passes)
    faces, flips = in_a_chain(passes)
    assert edges(result.faces) == edges(faces) != edges(MESH[1])
    assert [one.flips for one in result.passes] == flips
    assert result.flips == sum(flips)
    assert result.gain == pytest.approx(result.willmore_before - result.willmore_after)
    data = MESH[0][MESH[1]].reshape(-1, 3)
    np.testing.assert_array_equal(data[result.corners], MESH[0][result.faces])


@pytest.mark.parametrize("name", CHOSEN)
def test_a_preset_is_its_list_of_passes(name, monkeypatch):
    # Without what comes after, where faces cut others.
    monkeypatch.setattr(optimize, "run_keeping_cuts", execution.run_all)
    limit = PRESETS[name].maxdeviation / FULL_DIAGONAL * DIAGONAL
    passes = [
        {**one.defaults, **one.options, **({"maxdeviation": limit} if one.stays_near else {})}
        for one in PRESETS[name].passes
    ]
    result = optimize_flips(*MESH, preset=name)
    listed = optimize_flips(*MESH, passes=passes)
    np.testing.assert_array_equal(result.faces, listed.faces)
    assert result.passes == listed.passes
    assert [one.energy for one in result.passes] == [
        one.options["energy"] for one in PRESETS[name].passes
    ]
    assert result.converged


def test_the_default_preset_is_what_the_other_options_say():
    result = optimize_flips(*MESH, preset="paper", energy="area")
    np.testing.assert_array_equal(result.faces, optimize_flips(*MESH, energy="area").faces)
    assert result.gain == result.passes[0].gain


def test_the_limit_of_a_preset_can_be_chosen():
    free = optimize_flips(*MESH, passes=[{"energy": "delaunay"}])
    loose = optimize_flips(*MESH, preset="shape", maxdeviation=10.0 * DIAGONAL)
    tight = optimize_flips(*MESH, preset="shape", maxdeviation=0.0)
    np.testing.assert_array_equal(loose.faces, free.faces)
    assert tight.flips == 0 < optimize_flips(*MESH, preset="shape").flips < loose.flips


def test_a_limit_for_all_passes_is_counted_from_the_input():
    passes, limit = [{"energy": "area"}, {"energy": "willmore"}, {"energy": "delaunay"}], 0.05
    result = optimize_flips(*MESH, passes=passes, maxdeviation=limit)
    assert 0.5 * limit < result.deviation <= limit
    own = optimize_flips(*MESH, passes=[{**one, "maxdeviation": limit} for one in passes])
    assert limit < own.deviation <= 3.0 * limit


def test_the_largest_number_of_flips_is_for_all_passes():
    passes = [{"energy": "mean curvature"}, {"energy": "delaunay"}]
    free = [one.flips for one in optimize_flips(*MESH, passes=passes).passes]
    result = optimize_flips(*MESH, passes=passes, maxflips=free[0] + 2)
    assert [one.flips for one in result.passes] == [free[0], 2]
    assert not result.converged
    assert result.reason == "maxflips reached"
    one = optimize_flips(*MESH, passes=passes, maxflips=3)
    assert [one.flips for one in one.passes] == [3, 0]


def test_options_beside_passes_are_for_all_of_them():
    passes = [{"energy": "delaunay"}, {"energy": "area", "minshape": 0.0}]
    strict = optimize_flips(*MESH, passes=passes[:1], minshape=1.0)
    shapes = [strict.worst_shape_before, strict.worst_shape_after]
    assert shapes[1] >= shapes[0]
    locked = np.array(sorted(edges(MESH[1]))[::7])
    result = optimize_flips(*MESH, passes=passes, locked_edges=locked)
    assert set(map(tuple, locked.tolist())) <= edges(result.faces) != edges(MESH[1])


# --- what does not fit together ------------------------------------------------------------------


@pytest.mark.parametrize("name", CHOSEN)
@pytest.mark.parametrize("option", SEARCH_OPTIONS)
def test_what_a_preset_decides_can_not_be_given_beside_it(name, option):
    with pytest.raises(ValueError, match=f"{option} can't be given beside preset='{name}'"):
        optimize_flips(*MESH, preset=name, **{option: 1})
    assert option in decided_by(name)


def test_what_passes_decide_can_not_be_given_beside_them():
    with pytest.raises(ValueError, match="energy can't be given beside passes; give it in each"):
        optimize_flips(*MESH, passes=[{}], energy="area")
    with pytest.raises(ValueError, match="passes can't be given beside preset='smooth'"):
        optimize_flips(*MESH, passes=[{}], preset="smooth")


@pytest.mark.parametrize(
    ("passes", "error", "message"),
    [
        ([], ValueError, "passes is empty; give at least one pass"),
        ("faithful", TypeError, "passes must be a list of dicts, not str"),
        ({"energy": "area"}, TypeError, "passes must be a list of dicts, not dict"),
        ([{}, "area"], TypeError, r"passes\[1\] must be a dict, not str"),
        ([{"enrgy": "area"}], ValueError, r"passes\[0\]: unknown option 'enrgy'; a pass can have"),
        ([{"featuredeg": 3}], ValueError, r"passes\[0\]: unknown option 'featuredeg'"),
        ([{}, {"energy": "x"}], ValueError, r"passes\[1\]: unknown energy 'x'; choose one of"),
        ([{"maxdeviation": -1}], ValueError, r"passes\[0\]: maxdeviation must be a length"),
        ([{"depth": "5"}], TypeError, r"passes\[0\]: depth must be an integer"),
        (
            [{"energy": "area", "vertexnormals": True}],
            ValueError,
            r"passes\[0\]: vertexnormals needs the energy 'mean curvature', not 'area'",
        ),
        (
            [{"energy": "mean curvature", "vertexnormals": True, "atfolds": True}],
            ValueError,
            r"passes\[0\]: vertexnormals can't be given beside atfolds",
        ),
    ],
)
def test_wrong_passes(passes, error, message):
    with pytest.raises(error, match=message):
        optimize_flips(*MESH, passes=passes)


def test_an_unknown_preset():
    with pytest.raises(
        ValueError, match="unknown preset 'best'; choose one of 'paper', 'faithful'"
    ):
        optimize_flips(*MESH, preset="best")


def test_the_tables_name_options_that_there_are():
    assert set(SEARCH_OPTIONS) < set(PASS_OPTIONS)
    assert PRESET.choices == tuple(PRESETS)
    for preset in PRESETS.values():
        for one in preset.passes:
            assert set(one.options) <= set(PASS_OPTIONS)
        assert any(one.stays_near for one in preset.passes) == (preset.maxdeviation < 100.0)
