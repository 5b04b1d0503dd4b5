"""References: distances and normals against closed forms and a slow search."""

import math

import numpy as np
import pytest

from meshlab_willmore.compare.reference import ReferenceMesh, Sphere, Torus, deviation
from tests import meshes

TORUS = Torus(3.0, 1.0)
PLANE = ReferenceMesh(
    np.array([(-9, -9, 0), (29, -9, 0), (-9, 29, 0)], float), np.array([(0, 1, 2)])
)


def unit(rows):
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def closest_on_triangle(p, a, b, c):
    """The slow way: the foot on the plane if it lies inside, else the nearest of the sides."""
    normal = np.cross(b - a, c - a)
    foot = p - normal * ((p - a) @ normal) / (normal @ normal)
    sides = ((a, b), (b, c), (c, a))
    if all(np.cross(t - s, foot - s) @ normal >= 0.0 for s, t in sides):
        return foot
    feet = [s + (t - s) * np.clip((p - s) @ (t - s) / ((t - s) @ (t - s)), 0, 1) for s, t in sides]
    return min(feet, key=lambda foot: np.linalg.norm(p - foot))


def test_points_beside_a_torus():
    rng = np.random.default_rng(5)
    u, v = rng.uniform(0.0, 2 * np.pi, (2, 50))
    offset = rng.uniform(-0.9, 1.9, 50)
    normals = np.column_stack([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)])
    ring = 3.0 * np.column_stack([np.cos(u), np.sin(u), np.zeros(50)])
    distances, found = TORUS.nearest(ring + (1.0 + offset)[:, None] * normals)
    np.testing.assert_allclose(distances, np.abs(offset), atol=1e-14)
    np.testing.assert_allclose(unit(found), normals, atol=1e-13)


def test_points_beside_a_sphere():
    points = np.random.default_rng(5).normal(size=(50, 3))
    distances, normals = Sphere(2.0).nearest(points)
    np.testing.assert_allclose(distances, np.abs(np.linalg.norm(points, axis=1) - 2.0))
    np.testing.assert_allclose(unit(normals), unit(points))
    assert np.isnan(Sphere().nearest(points)[0]).all()


def test_points_beside_a_mesh():
    vertices, faces = meshes.bumpy_sphere(30)
    points = np.random.default_rng(5).normal(size=(40, 3))
    distances, normals = ReferenceMesh(vertices, faces).nearest(points)
    corners = vertices[faces]
    for point, distance, normal in zip(points, distances, unit(normals), strict=True):
        feet = np.array([closest_on_triangle(point, *triangle) for triangle in corners])
        each = np.linalg.norm(feet - point, axis=1)
        assert distance == pytest.approx(each.min(), abs=1e-12)
        # On an edge either of its faces is a right answer.
        a, b, c = corners[each <= each.min() + 1e-9].transpose(1, 0, 2)
        assert (unit(np.cross(b - a, c - a)) @ normal).max() == pytest.approx(1.0, abs=1e-12)


def test_a_point_far_away_has_a_nearest_one_too():
    distances, _ = ReferenceMesh(*meshes.cube(push=0.0)).nearest(np.array([[0.5, 0.5, 1e4]]))
    assert distances == pytest.approx([1e4 - 1.0])


def test_the_normal_error_of_the_paper_s_torus():
    # The figure was found independently.
    assert deviation(*meshes.torus(2000, 0.3, 8), TORUS).normal_error == pytest.approx(
        9.63, abs=5e-3
    )


def test_the_distance_is_exact_where_it_is_linear():
    vertices, faces = meshes.grid(3, 5)
    slope = 0.3
    vertices[:, 2] = slope * vertices[:, 0]
    found = deviation(vertices, faces, PLANE)
    assert found.distance == pytest.approx(slope * 5.0 / math.sqrt(3.0), rel=1e-12)
    assert found.normal_error == pytest.approx(math.degrees(math.atan(slope)), rel=1e-12)


def test_larger_faces_count_for_more_in_the_distance():
    # Two squares beside each other, one of them with sides of 3: 9 times the area.
    squares = [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    squares += [(1, 0, 2), (4, 0, 2), (4, 3, 2), (1, 3, 2)]
    faces = np.array([(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
    found = deviation(np.array(squares, float), faces, PLANE)
    assert found.distance == pytest.approx(math.sqrt((1 * 1 + 9 * 4) / 10), rel=1e-12)


def test_a_mesh_that_looks_to_the_other_side_is_wrong_by_half_a_turn():
    vertices, faces = meshes.sphere_hull(50)
    right = deviation(vertices, faces, Sphere(1.0))
    wrong = deviation(vertices, faces[:, ::-1], Sphere(1.0))
    assert wrong.normal_error == pytest.approx(180.0 - right.normal_error)
    assert wrong.distance == right.distance


def test_faces_without_a_normal_do_not_count():
    vertices, faces = meshes.bumpy_sphere(40)
    sliver = np.vstack([faces, [(0, 1, 1)]])
    assert deviation(vertices, sliver, Sphere(1.0)) == pytest.approx(
        deviation(vertices, faces, Sphere(1.0)), rel=1e-13
    )
    assert np.isnan(deviation(vertices, sliver[-1:], Sphere(1.0))).all()


@pytest.mark.parametrize("scale", [1e-60, 1e60])
def test_the_angles_have_no_scale(scale):
    vertices, faces = meshes.bumpy_sphere(40)
    wanted = deviation(vertices, faces, Sphere(1.0)).normal_error
    found = deviation(vertices * scale, faces, Sphere(scale)).normal_error
    assert found == pytest.approx(wanted, rel=1e-12)
