"""Exact signs against the determinants in fractions."""

from fractions import Fraction

import numpy as np
import pytest

from meshlab_willmore.guards import predicates
from meshlab_willmore.mesh.points import Point
from tests import solids


def nearly_flat(rng, scale):
    """Four points near a plane, shifted by a few units in the last place of their coordinates."""
    base = rng.normal(size=(3, 3))
    weights = rng.random(3)
    points = np.vstack([base, weights / weights.sum() @ base]) + scale
    return points + np.spacing(points) * rng.integers(-2, 3, points.shape)


def nearly_in_line(rng, scale):
    a, b = rng.normal(size=(2, 3)) + scale
    points = np.array([a, b, a + rng.random() * (b - a), a + rng.random() * (b - a)])
    return points + np.spacing(points) * rng.integers(-1, 2, points.shape)


FAMILIES = {
    "random": lambda rng: rng.normal(size=(4, 3)),
    "integers": lambda rng: rng.integers(-2, 3, (4, 3)).astype(float),
    "tilted plane": lambda rng: rng.integers(-9, 10, (4, 2)) @ rng.normal(size=(2, 3)),
    "nearly flat": lambda rng: nearly_flat(rng, 0.0),
    "nearly flat, far away": lambda rng: nearly_flat(rng, 1e6),
    "nearly in line": lambda rng: nearly_in_line(rng, 0.0),
    "nearly in line, far away": lambda rng: nearly_in_line(rng, 1e3),
    "coincident": lambda rng: rng.normal(size=(4, 3))[rng.integers(0, 3, 4)],
    "of all sizes": lambda rng: rng.normal(size=(4, 3)) * 10.0 ** rng.integers(-40, 1, (4, 3)),
    "single precision": lambda rng: rng.random((4, 3)).astype(np.float32).astype(float),
    "far and near": lambda rng: np.ldexp(rng.integers(-3, 4, (4, 3)), rng.integers(-60, 1, (4, 3))),
}


def sign(number):
    return (number > 0) - (number < 0)


@pytest.mark.parametrize("name", FAMILIES)
@pytest.mark.slow
def test_signs_are_those_of_fractions(name):
    rng = np.random.default_rng(0)
    seen = set()
    for _ in range(400):
        points = FAMILIES[name](rng)
        exact = [tuple(map(Fraction, point)) for point in points.tolist()]
        a, b, c, d = (Point(*point) for point in points.tolist())
        wanted = sign(solids.volume(*exact))
        assert predicates.orient3d(a, b, c, d) == wanted
        seen.add(wanted)
        for axis in range(3):
            wanted = sign(solids.projected_area(*exact[:3], axis))
            assert predicates.projected_orient2d(a, b, c, axis) == wanted
    assert len(seen) > 1 or name == "coincident"


def test_signs_change_with_each_swap():
    rng = np.random.default_rng(1)
    for _ in range(100):
        a, b, c, d = (Point(*point) for point in nearly_flat(rng, 1.0).tolist())
        wanted = predicates.orient3d(a, b, c, d)
        for other in ((b, a, c, d), (a, c, b, d), (a, b, d, c), (d, b, c, a)):
            assert predicates.orient3d(*other) == -wanted


def test_expansions_hold_every_bit():
    """Products of floats of very different size, added up and taken away again."""
    rng = np.random.default_rng(2)
    expansion = np.empty(predicates.ROOM_3D)
    for _ in range(50):
        triples = rng.normal(size=(12, 3)) * 2.0 ** rng.integers(-40, 40, (12, 3))
        count, total = 0, Fraction(0)
        for a, b, c in triples.tolist():
            count = predicates._add_triple(expansion, count, a, b, c)
            total += Fraction(a) * Fraction(b) * Fraction(c)
            floats = expansion[:count].tolist()
            assert sum(map(Fraction, floats)) == total
            assert all(floats)
            assert floats == sorted(floats, key=abs)
            assert predicates._sign_of(expansion, count) == sign(total)
        for a, b, c in triples.tolist():
            count = predicates._add_triple(expansion, count, -a, b, c)
        assert count == 0
