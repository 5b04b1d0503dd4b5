"""Normals of vertices against a plain sum; what MeshLab makes of them is with the filters."""

import numpy as np
import pytest

from meshlab_willmore.mesh.normals import vertex_normals
from tests import meshes, reference


@pytest.mark.parametrize("mesh", [meshes.cube(), meshes.patch(60), meshes.fin()])
def test_normals_are_those_of_the_reference(mesh):
    vertices, faces = mesh[:2]
    faces = faces.astype(np.int32)
    expected = reference.vertex_normals(vertices, faces)
    normals = vertex_normals(vertices, faces, np.zeros_like(vertices))
    np.testing.assert_allclose(normals, expected, atol=1e-14)
    turned = vertex_normals(vertices, faces[:, ::-1].copy(), np.zeros_like(vertices))
    np.testing.assert_allclose(turned, -expected, atol=1e-14)


def test_large_faces_weigh_more():
    vertices = np.array([[0.0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 1]])
    faces = np.array([[0, 1, 2], [0, 3, 1]], np.int32)
    normals = vertex_normals(vertices, faces, np.zeros((4, 3)))
    np.testing.assert_allclose(normals[0], np.array([0, 9, 81]) / np.hypot(9, 81), atol=1e-14)


def test_vertices_without_faces_keep_their_own():
    vertices = np.arange(18.0).reshape(6, 3)
    vertices[:3] = np.eye(3)
    others = np.full((6, 3), 7.0)
    others[4] = [0, 0, -5]
    others[5] = 0
    normals = vertex_normals(vertices, np.array([[0, 1, 2]], np.int32), others)
    third = np.sqrt(1 / 3)
    expected = [[third] * 3] * 4 + [[0, 0, -1], [0, 0, 0]]
    np.testing.assert_allclose(normals, expected, atol=1e-14)


def test_faces_without_area_leave_zeros():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    faces = np.array([[0, 1, 2]], np.int32)
    assert not vertex_normals(vertices, faces, np.ones((3, 3))).any()


@pytest.mark.parametrize("exponent", [-500, -300, 250, 480])
def test_the_size_of_the_mesh_does_not_matter(exponent):
    vertices, faces = meshes.bumpy_sphere(30)
    others = np.zeros_like(vertices)
    wanted = vertex_normals(vertices, faces, others)
    found = vertex_normals(np.ldexp(vertices, exponent), faces, others)
    np.testing.assert_allclose(found, wanted, rtol=1e-14, atol=1e-15)
