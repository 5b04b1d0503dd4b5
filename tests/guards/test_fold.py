"""The fold guard."""

import math

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import flip
from meshlab_willmore.mesh.points import Point
from tests import meshes
from tests.connectivity import can_flip

ON = guards.fold_limits(90.0)
OFF = guards.fold_limits(180.0, 0.0)


def hinge(degrees, width=1.0):
    """Two faces at the edge 0-1, folded by an angle; `width` is the height of both."""
    angle = math.radians(degrees)
    wing = (0.5, -width * math.cos(angle), width * math.sin(angle))
    return build(
        np.array([(0, 0, 0), (1, 0, 0), (0.5, width, 0), wing], float),
        np.array([(0, 1, 2), (1, 0, 3)], np.int32),
    )


@pytest.mark.parametrize("degrees", [0.0, 1e-6, 30.0, 90.0, 150.0, 179.0])
def test_dihedral_angle_of_a_hinge(degrees):
    mesh = hinge(degrees)
    assert guards.dihedral_angle(mesh, 0) == pytest.approx(math.radians(degrees), abs=1e-15)


def test_dihedral_angle_next_to_a_degenerate_face_is_zero():
    assert guards.dihedral_angle(hinge(90.0, width=0.0), 0) == 0.0


def test_shapes():
    a, b = Point(0.0, 0.0, 0.0), Point(1.0, 0.0, 0.0)
    assert guards.triangle_shape(a, b, Point(0.5, math.sqrt(0.75), 0.0)) == pytest.approx(1.0)
    assert guards.triangle_shape(a, b, Point(0.5, 0.0, 0.0)) == 0.0
    assert guards.triangle_shape(a, a, a) == 0.0
    right = 2.0 * math.sqrt(3.0) / 4.0
    assert guards.triangle_shape(a, b, Point(0.0, 1.0, 0.0)) == pytest.approx(right)


def test_a_flip_to_a_sharper_edge_is_a_fold():
    """The quad of a flat hinge with i outside the triangle j, k, l: its flip folds over."""
    mesh = hinge(0.0)
    mesh.vertices[0] = (0.9, 0.0, 0.0)
    mesh.vertices[1] = (3.0, 0.0, 0.0)
    assert guards.folds(mesh, 0, ON)
    assert not guards.folds(mesh, 0, OFF)
    assert guards.folds(mesh, 0, guards.fold_limits(179.9))


@pytest.mark.parametrize("limit", [20.0, 90.0, 120.0])
def test_a_new_edge_may_be_as_sharp_as_the_old_one_and_as_the_limit(limit):
    mesh = build(*meshes.bumpy_sphere(60, bump=0.6))
    limits = guards.fold_limits(limit)
    for h in range(len(mesh.origin)):
        if not can_flip(mesh, h):
            continue
        before = guards.dihedral_angle(mesh, h)
        flip(mesh, h)
        after = guards.dihedral_angle(mesh, h)
        for _ in range(3):
            flip(mesh, h)
        no_shape = limits._replace(shape=0.0)
        assert guards.folds(mesh, h, no_shape) == (after > max(before, limits.angle))
        assert not guards.folds(mesh, h, no_shape._replace(angle=after - 1e-12))


def test_a_flip_to_a_sliver_is_refused_unless_there_was_a_worse_one():
    """A kite: the flip makes two faces with a needle-like angle at i."""
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0.5, 1, 0), (0.5, -1, 0)], float)
    faces = np.array([(0, 1, 2), (1, 0, 3)], np.int32)
    vertices[0, 0] = 0.49
    mesh = build(vertices, faces)
    assert guards.folds(mesh, 0, ON)
    assert not guards.folds(mesh, 0, ON._replace(shape=0.005))
    vertices[2:] = (0.745, 1e-3, 0), (0.745, -1e-3, 0)
    assert not guards.folds(build(vertices, faces), 0, ON)
