"""The checks find what is broken: each is shown a result that is right, and some that are wrong."""

import numpy as np
import pytest

from tests import meshes, reference

from . import energies, promise

VERTICES, FACES = meshes.octahedron()
RING = meshes.bipyramid(8)[1]


def flipped(faces, i, j):
    """The faces after a flip of which nobody asked whether it is allowed."""
    return np.array(reference.flipped(faces.tolist(), i, j), np.int32)


def test_a_flip_is_no_fault():
    promise.check_connectivity(RING, flipped(RING, 0, 1))


def test_an_edge_that_is_made_twice():
    twice = flipped(flipped(RING, 0, 1), 4, 5)
    with pytest.raises(AssertionError, match="non-manifold edges differ"):
        promise.check_connectivity(RING, twice)


def test_a_face_that_is_turned_over():
    wrong = RING.copy()
    wrong[3] = wrong[3, ::-1]
    with pytest.raises(AssertionError, match="non-manifold edges differ"):
        promise.check_connectivity(RING, wrong)


def test_a_face_with_a_vertex_twice():
    wrong = RING.copy()
    wrong[3, 0] = wrong[3, 1]
    with pytest.raises(AssertionError, match="a face has a vertex twice"):
        promise.check_connectivity(RING, wrong)


def test_a_vertex_that_is_torn():
    """Two closed surfaces that come to meet at a vertex: every edge still has two faces."""
    # Before, another pair meets at vertex 12: so no number of vertices or edges shows it.
    first, second, third, fourth = (FACES + shift for shift in (0, 6, 12, 18))
    before = np.vstack([first, second, third, np.where(FACES == 0, 12, fourth)])
    torn = np.vstack(
        [first, np.where(FACES == 0, 0, second), third, np.where(FACES == 0, 6, fourth)]
    )
    promise.check_connectivity(before, before)
    with pytest.raises(AssertionError, match=r"new non-manifold vertices \[0\]"):
        promise.check_connectivity(before, torn)


def test_a_vertex_without_faces():
    apart = np.vstack([FACES, FACES + 6])
    with pytest.raises(AssertionError, match="lost all of its faces"):
        promise.check_connectivity(apart, np.vstack([FACES, np.where(FACES == 0, 0, FACES + 6)]))


def test_a_corner_that_is_left_with_two_edges():
    faces = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4)])
    with pytest.raises(AssertionError, match=r"vertices \[2\] are left with less than three edges"):
        promise.check_connectivity(faces, flipped(faces, 0, 2))


def test_a_lost_edge():
    with pytest.raises(AssertionError, match=r"gone: \[\(0, 1\)\]"):
        promise.check_kept(flipped(RING, 0, 1), {(0, 1), (1, 2)})
    promise.check_kept(RING, {(0, 1), (1, 2)})


def test_corners_of_the_other_side_of_a_locked_edge():
    vertices, faces = meshes.grid(2, 2)
    corners = np.arange(faces.size).reshape(-1, 3)
    middle = {(1, 4), (4, 7)}
    promise.check_corners(faces, faces, corners, middle)
    at_four = np.flatnonzero(faces.ravel() == 4)
    x = vertices[faces].mean(axis=1)[at_four // 3, 0]
    left, right = at_four[x < 1.0], at_four[x > 1.0]
    wrong = corners.copy()
    wrong.flat[left[0]] = left[1]
    promise.check_corners(faces, faces, wrong, middle)
    wrong.flat[left[0]] = right[0]
    promise.check_corners(faces, faces, wrong, set())
    with pytest.raises(AssertionError, match="other side of a locked edge"):
        promise.check_corners(faces, faces, wrong, middle)
    wrong.flat[left[0]] = 0
    with pytest.raises(AssertionError):
        promise.check_corners(faces, faces, wrong, middle)


def test_a_texture_triangle_that_is_turned_over():
    vertices, faces = meshes.grid(2, 2)
    uv = vertices[faces][:, :, :2]
    promise.check_mapping(uv, np.roll(uv, 1, axis=1))
    assert promise.signs(uv) == {1: 8}
    for other, message in ((uv[:, ::-1], "turned over"), (np.zeros_like(uv), "turned over")):
        with pytest.raises(AssertionError, match=message):
            promise.check_mapping(uv, other)
    assert promise.seams(faces, uv) == set()
    uv = uv.copy()
    uv[0] += 1.0
    assert promise.seams(faces, uv) == {(0, 4), (1, 4)}


@pytest.mark.parametrize(
    ("energy", "other"),
    [
        ("willmore", reference.objective),
        ("uniform virtual willmore", reference.uniform_objective),
        ("area", reference.area),
        ("mean curvature", reference.mean_curvature),
        ("gaussian curvature", reference.absolute_gaussian_curvature),
        ("delaunay", reference.cotangents),
    ],
)
@pytest.mark.parametrize("mesh", [meshes.bumpy_sphere(30), meshes.patch(20)])
def test_the_energies_are_the_usual_ones(energy, other, mesh):
    found, error = energies.ENERGIES[energy](*mesh)
    assert float(found) == pytest.approx(other(*mesh), rel=1e-12)
    assert error < 1e-9


def test_progress_that_rises_to_1():
    promise.check_progress([0.0, 0.3, 0.3, 1.0])


@pytest.mark.parametrize(
    ("fractions", "match"),
    [
        ([0.1, 1.0], "begins at 0.1"),
        ([0.0, 0.3, 0.2, 1.0], "falls"),
        ([0.0, 0.99], "ends at 0.99"),
        ([0.0, 1.0, 1.0], "is 1 before the end"),
    ],
)
def test_progress_that_does_not(fractions, match):
    with pytest.raises(AssertionError, match=match):
        promise.check_progress(fractions)
