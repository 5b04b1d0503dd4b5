"""The intersection angle: exact cases, a reference in long double, invariances, sums."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshlab_willmore.energy.angles import (
    CLEAR,
    NO_ANGLES,
    AngleSum,
    ComplexAngle,
    add,
    angle,
    complex_angle,
    radians,
    rough,
)
from meshlab_willmore.mesh.points import Point
from tests import reference

ROUNDING = 4e-15
RNG = np.random.default_rng(0)
QUADS = RNG.normal(size=(200, 4, 3))


def points(rows):
    return [Point(*row) for row in np.asarray(rows, float).tolist()]


def test_random_quads_against_the_inversion():
    wanted = reference.intersection_angle(*QUADS.transpose(1, 0, 2))
    found = [angle(*points(quad)) for quad in QUADS]
    np.testing.assert_allclose(found, wanted.astype(float), rtol=0, atol=ROUNDING)


@pytest.mark.parametrize(
    ("a", "b", "p", "q", "wanted"),
    [
        # Pythagorean points of the circle of radius 5 (and 25): the arithmetic is exact.
        ((5, 0, 0), (-5, 0, 0), (3, 4, 0), (3, -4, 0), 0.0),
        ((4, 3, 0), (-3, 4, 0), (0, 5, 0), (0, -5, 0), 0.0),
        ((5, 0, 0), (-5, 0, 0), (3, 4, 0), (-4, 3, 0), math.pi),
        ((5, 0, 0), (-5, 0, 0), (3, 4, 0), (3, 4, 0), math.pi),
        # A square folded by a right angle: two circles through the ends of its diagonal.
        ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, 0, 1), math.pi / 2),
        # Equilateral triangles side by side: 60 degrees at both apexes.
        ((-1, 0, 0), (1, 0, 0), (0, math.sqrt(3), 0), (0, -math.sqrt(3), 0), math.pi / 3),
        # Three points on a line are a circle too.
        ((-1, 0, 0), (1, 0, 0), (0, 0, 0), (0, -1, 0), math.pi / 2),
    ],
)
def test_known_angles(a, b, p, q, wanted):
    assert angle(*points([a, b, p, q])) == pytest.approx(wanted, abs=ROUNDING)


@pytest.mark.parametrize("delta", [1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("q", [(3.0, -4.0, 0.0), (-4.0, 3.0, 0.0)])
def test_near_zero_and_pi_no_digit_is_lost(delta, q):
    quad = np.array([(5, 0, 0), (-5, 0, 0), (3, 4, 0), q], float)
    quad[3] *= 1.0 + delta
    quad[3, 2] = delta
    wanted = float(reference.intersection_angle(*quad))
    assert min(wanted, math.pi - wanted) < 2.0 * delta
    assert angle(*points(quad)) == pytest.approx(wanted, abs=ROUNDING)


def test_the_flipped_edge_has_the_same_angle():
    for i, j, k, l in map(points, QUADS):
        assert angle(i, j, k, l) == pytest.approx(angle(l, k, i, j), abs=ROUNDING)
        assert angle(i, j, k, l) == pytest.approx(angle(j, i, l, k), abs=ROUNDING)


def test_moebius_maps_keep_the_angle():
    centre = np.array([3.0, -2.0, 4.0])
    for quad in QUADS:
        shifted = quad - centre
        mapped = shifted / np.sum(shifted**2, axis=1, keepdims=True)
        assert angle(*points(mapped)) == pytest.approx(angle(*points(quad)), abs=1e-12)


@pytest.mark.parametrize("same", [(0, 2), (0, 3), (1, 2), (1, 3)])
def test_coincident_neighbours_have_no_angle(same):
    quad = QUADS[0].copy()
    quad[same[0]] = quad[same[1]]
    assert math.isnan(angle(*points(quad)))


def test_a_complex_angle_has_a_length_that_products_bear():
    for quad in QUADS:
        a, b, p, q = 1e-12 * quad
        beta = complex_angle(*points([a - p, b - p, a - q, b - q]))
        assert math.sqrt(0.5) <= math.hypot(beta.r, beta.s) <= 1.0
        assert beta.s >= 0.0


@settings(max_examples=100)
@given(st.lists(st.floats(0.0, math.pi), max_size=40))
def test_a_sum_of_angles_is_the_sum_of_the_angles(betas):
    total = NO_ANGLES
    for beta in betas:
        total = add(total, ComplexAngle(math.cos(beta), math.sin(beta)))
    assert radians(total) == pytest.approx(math.fsum(betas), abs=1e-14 * (1 + len(betas)))


@pytest.mark.parametrize("count", [1, 2, 3, 8])
def test_half_turns_are_counted_exactly(count):
    total = NO_ANGLES
    for _ in range(count):
        total = add(total, ComplexAngle(-1.0, 0.0))
    assert radians(total) == count * math.pi


def test_an_undefined_angle_makes_the_sum_undefined():
    assert math.isnan(
        radians(add(add(NO_ANGLES, ComplexAngle(math.nan, math.nan)), ComplexAngle(0.0, 1.0)))
    )


@pytest.mark.parametrize("half_turns", [-2.0, -1.0, 0.0, 1.0])
def test_a_rough_value_compares_as_the_true_one_with_small_numbers(half_turns):
    close = [0.0, 1e-12, 3e-7, 0.9e-6, 1.1e-6, 1e-3, 0.5, 1.5, 2.0, 3.0, math.pi - 1e-9]
    for value in [*close, *(-x for x in close)]:
        total = AngleSum(0.3 * math.cos(value), 0.3 * math.sin(value), half_turns)
        true, found = radians(total), rough(total)
        assert found == true or (abs(true) > CLEAR and found * true > 0.0)
        assert [found < x for x in (-CLEAR, -1e-12, 0.0, 1e-12, CLEAR)] == [
            true < x for x in (-CLEAR, -1e-12, 0.0, 1e-12, CLEAR)
        ]


def test_an_undefined_rough_value_stays_so():
    assert math.isnan(rough(AngleSum(math.nan, math.nan, 0.0)))
    assert math.isnan(rough(AngleSum(math.nan, math.nan, 1.0)))
