"""The models of the demo, and planar Delaunay triangulations."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from meshlab_willmore.demo.models import (
    dented_cube,
    planar_delaunay,
    sampled_torus,
    signed_areas,
)
from meshlab_willmore.measure import measures, triangle_shapes
from tests.meshes import torus as reference_torus

from .conftest import canonical


def assert_closed_and_oriented(faces):
    """Every edge is run through exactly once in each direction."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    assert len(np.unique(edges, axis=0)) == len(edges)
    assert sorted(map(tuple, edges.tolist())) == sorted(map(tuple, edges[:, ::-1].tolist()))


def test_cube_is_the_papers():
    vertices, faces = dented_cube(0.05)
    assert (vertices.shape, faces.shape, faces.dtype) == ((14, 3), (24, 3), np.int32)
    assert_closed_and_oriented(faces)
    valence = np.bincount(faces.ravel())
    assert valence[8:].tolist() == [3] * 6
    corners = {tuple(corner) for corner in vertices[:8].tolist()}
    assert corners == {(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)}
    centres = np.sort(vertices[8:], axis=1)
    assert {tuple(centre) for centre in centres.round(12).tolist()} == {
        (0.05, 0.5, 0.5),
        (0.5, 0.5, 0.95),
    }
    signed_volume = np.linalg.det(vertices[faces]).sum() / 6
    assert signed_volume == pytest.approx(1 - 6 * (0.5 * 0.05 / 3), rel=1e-12)
    totals = measures(vertices, faces)
    assert totals.willmore_energy == pytest.approx(45.7570, abs=5e-5)
    assert totals.area == pytest.approx(6.22709, abs=5e-6)


@pytest.mark.heavy
def test_torus_is_the_reference_torus():
    vertices, faces = sampled_torus(2000, 0.3, 8.0)
    expected_vertices, expected_faces = reference_torus(2000, 0.3, 8.0)
    np.testing.assert_allclose(vertices, expected_vertices, atol=1e-14)
    assert canonical(faces) == canonical(expected_faces)
    assert_closed_and_oriented(faces)
    totals = measures(vertices, faces)
    assert len(faces) == 3850
    assert totals.willmore_energy == pytest.approx(4010.3, abs=0.05)
    assert totals.area == pytest.approx(119.624, abs=5e-4)
    assert totals.absolute_mean_curvature == pytest.approx(640.5, abs=0.05)
    assert np.quantile(triangle_shapes(vertices, faces), 0.01) == pytest.approx(0.191, abs=5e-4)


@pytest.mark.parametrize("stretch", [1.0, 7.0])
@pytest.mark.parametrize("far", [0.0, 1e4])
def test_planar_delaunay_is_scipys(stretch, far):
    points = np.random.default_rng(3).random((300, 2)) + far
    faces = planar_delaunay(points, stretch)
    assert faces.dtype == np.int32
    assert (signed_areas(points, faces) > 0).all()
    moved = (points - points.mean(axis=0)) * (stretch, 1.0)
    expected = Delaunay(moved).simplices
    clockwise = signed_areas(moved, expected) < 0
    expected[clockwise] = expected[clockwise][:, ::-1]
    assert canonical(faces) == canonical(expected)


def test_planar_delaunay_of_a_kite():
    points = np.array([(0, 0), (2, -0.5), (4, 0), (2, 0.5)], dtype=float)
    assert canonical(planar_delaunay(points)) == [(0, 1, 3), (1, 2, 3)]
    # Squeezed eight times, the kite is tall and the other diagonal is the shorter one.
    assert canonical(planar_delaunay(points, 1 / 8)) == [(0, 1, 2), (0, 2, 3)]
