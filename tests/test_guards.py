"""Locks and the fold guard."""

import math

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import NONE, can_flip, flip
from meshlab_willmore.mesh.points import Point
from tests import meshes

ON = guards.fold_limits(90.0)
OFF = guards.fold_limits(180.0)


def hinge(degrees, width=1.0):
    """Two faces at the edge 0-1, folded by an angle; `width` is the height of both."""
    angle = math.radians(degrees)
    wing = (0.5, -width * math.cos(angle), width * math.sin(angle))
    return build(
        np.array([(0, 0, 0), (1, 0, 0), (0.5, width, 0), wing], float),
        np.array([(0, 1, 2), (1, 0, 3)], np.int32),
    )


def locked_pairs(mesh):
    ahead = mesh.origin.reshape(-1, 3)[:, [1, 2, 0]].ravel()
    pairs = np.sort(np.column_stack([mesh.origin, ahead])[mesh.locked], axis=1)
    return set(map(tuple, pairs.tolist()))


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


def test_a_new_edge_may_be_as_sharp_as_the_old_one_and_as_the_limit():
    mesh = build(*meshes.bumpy_sphere(60, bump=0.6))
    for h in range(len(mesh.origin)):
        if not can_flip(mesh, h):
            continue
        before = guards.dihedral_angle(mesh, h)
        flip(mesh, h)
        after = guards.dihedral_angle(mesh, h)
        for _ in range(3):
            flip(mesh, h)
        no_shape = ON._replace(shape=0.0)
        assert guards.folds(mesh, h, no_shape) == (after > max(before, math.pi / 2))
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


def test_only_edges_between_two_selected_faces_stay_free():
    vertices, faces = meshes.bumpy_sphere(40)
    mesh = build(vertices, faces)
    selected = np.random.default_rng(0).random(len(faces)) < 0.7
    guards.lock_unselected(mesh, selected)
    own, other = np.arange(len(mesh.twin)) // 3, mesh.twin // 3
    np.testing.assert_array_equal(mesh.locked, ~(selected[own] & selected[other]))


def test_creases_are_the_edges_sharper_than_the_limit():
    mesh = build(*meshes.cube(push=0.0))
    guards.lock_creases(mesh, math.radians(45.0))
    cube_edges = {(a, b) for a in range(8) for b in range(8) if a < b and (a ^ b) in (1, 2, 4)}
    assert locked_pairs(mesh) == cube_edges


def test_right_angles_are_no_creases_at_ninety_degrees():
    mesh = build(*meshes.cube(push=0.0))
    guards.lock_creases(mesh, math.radians(90.0))
    assert not mesh.locked.any()


def test_caller_locks_edges_in_either_direction():
    vertices, faces = meshes.cube()
    mesh = build(vertices, faces)
    guards.lock_edges(mesh, np.array([(faces[0, 1], faces[0, 0]), faces[5, :2]], np.int64))
    wanted = {tuple(sorted(faces[0, :2].tolist())), tuple(sorted(faces[5, :2].tolist()))}
    assert locked_pairs(mesh) == wanted
    assert (mesh.locked[mesh.twin] == mesh.locked).all()


def test_caller_locks_boundary_and_non_manifold_edges():
    vertices, faces, other = meshes.fin()
    mesh = build(vertices, faces)
    guards.lock_edges(mesh, np.array([(0, other), faces[-1, 1:]], np.int64))
    assert mesh.locked.sum() == 4
    assert (mesh.twin[mesh.locked] == NONE).all()


@pytest.mark.parametrize("pair", [(0, 7), (3, 3), (0, 14), (-1, 0), (2**62, 1)])
def test_a_locked_pair_that_is_no_edge_is_named(pair):
    mesh = build(*meshes.cube())
    with pytest.raises(ValueError, match=rf"locked_edges\[1\] = \({pair[0]}, {pair[1]}\)"):
        guards.lock_edges(mesh, np.array([(0, 1), pair], np.int64))


def test_locking_no_edges_locks_none():
    mesh = build(*meshes.cube())
    guards.lock_edges(mesh, np.empty((0, 2), np.int64))
    assert not mesh.locked.any()
