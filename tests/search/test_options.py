"""The options of annealing and of the thorough search, by way of the main function."""

import numpy as np
import pytest

from meshlab_willmore import optimize_flips
from tests import meshes

MESH = meshes.bumpy_sphere(40, 1, bump=0.6)

FREE = {"foldangle": 180.0, "minshape": 0.0}


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"seed": -1}, ValueError, "seed must not be negative"),
        ({"seed": 1.0}, TypeError, "seed must be an integer"),
        ({"seed": True}, TypeError, "seed must be an integer"),
        ({"sweeps": 0}, ValueError, "sweeps must lie in 1"),
        ({"sweeps": 2.5}, TypeError, "sweeps must be an integer"),
    ],
)
def test_wrong_options_are_refused(options, error, message):
    with pytest.raises(error, match=message):
        optimize_flips(*MESH, search="annealing", **options)


@pytest.mark.heavy
def test_seed_and_sweeps_reach_the_annealing():
    def anneal(seed, sweeps):
        return optimize_flips(
            *MESH, energy="willmore", search="annealing", seed=seed, sweeps=sweeps, **FREE
        )

    results = [anneal(*pair) for pair in ((0, 20), (0, 20), (1, 20), (0, 40))]
    np.testing.assert_array_equal(results[0].faces, results[1].faces)
    one, other = (result._replace(faces=None, corners=None) for result in results[:2])
    assert one == other
    assert len({result.flips for result in results}) > 1
    for result in results:
        assert result.gain == pytest.approx(result.willmore_before - result.willmore_after)
        assert type(result.gain) is float


@pytest.mark.heavy
def test_thorough_is_no_worse_than_chains_by_depth_and_breadth():
    def search(name, depth):
        return optimize_flips(*MESH, energy="willmore", search=name, depth=depth, breadth=1)

    for depth in (1, 3):
        alone, thorough = search("variable depth", depth), search("thorough", depth)
        assert thorough.willmore_after <= alone.willmore_after + 1e-9
    assert thorough.converged
    assert "chain" in thorough.reason
