"""The vector helpers against NumPy."""

import numpy as np
import pytest

from meshlab_willmore.mesh.points import (
    Point,
    angle_between,
    cross,
    dot,
    from_middle,
    norm,
    normal,
    point,
    subtract,
)

ROWS = np.random.default_rng(0).normal(size=(3, 3))
A, B, C = (Point(*row) for row in ROWS.tolist())


def test_helpers_agree_with_numpy():
    a, b, c = ROWS
    assert tuple(point(ROWS, 1)) == tuple(b)
    assert tuple(subtract(A, B)) == tuple(a - b)
    np.testing.assert_allclose(from_middle(A, B, C), c - 0.5 * (a + b), rtol=1e-14)
    assert dot(A, B) == pytest.approx(a @ b, rel=1e-15)
    assert norm(A) == pytest.approx(np.linalg.norm(a), rel=1e-15)
    np.testing.assert_allclose(cross(A, B), np.cross(a, b), rtol=1e-14)
    np.testing.assert_allclose(normal(A, B, C), np.cross(b - a, c - a), rtol=1e-14)


def test_a_middle_far_from_the_origin_keeps_all_digits():
    """Coordinates so far out that no float lies halfway between `a` and `b`."""
    far = 2.0**52
    a, b = Point(far, 0.0, -far), Point(far + 1.0, 0.0, -far - 1.0)
    assert tuple(from_middle(a, b, a)) == (-0.5, 0.0, 0.5)
    assert tuple(from_middle(a, b, b)) == (0.5, 0.0, -0.5)


@pytest.mark.parametrize("degrees", [0.0, 1e-7, 30.0, 90.0, 179.9999999, 180.0])
def test_angle_between_is_accurate_at_both_ends(degrees):
    wanted = np.radians(degrees)
    turned = Point(float(np.cos(wanted)), float(np.sin(wanted)), 0.0)
    assert angle_between(Point(2.0, 0.0, 0.0), turned) == pytest.approx(wanted, abs=1e-15)


def test_angle_with_a_zero_vector_is_zero():
    assert angle_between(Point(0.0, 0.0, 0.0), Point(1.0, 2.0, 3.0)) == 0.0


@pytest.mark.parametrize("a", [(-1.0, -1.0, -1.0), (1.0, -1.0, 0.0), (-0.0, 2.0, -3.0), (0.0,) * 3])
@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_there_is_no_angle_to_a_zero_vector(a, zero):
    """Products with it may be -0.0, and atan2(0.0, -0.0) is pi."""
    assert angle_between(Point(*a), Point(zero, zero, zero)) == 0.0
    assert angle_between(Point(zero, zero, zero), Point(*a)) == 0.0
