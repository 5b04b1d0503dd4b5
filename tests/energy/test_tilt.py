"""The mean curvature with the tilts of faces against the normals of vertices."""

import functools

import numpy as np
import pytest

from meshlab_willmore.energy import mean_curvature, tilt
from meshlab_willmore.mesh.build import build
from tests import reference
from tests.connectivity import can_flip
from tests.meshes import SMALL as MESHES

each_mesh = pytest.mark.parametrize("name", MESHES)


def with_normals(name, seed=3):
    """A mesh with unit normals that have nothing to do with its faces, and these."""
    vertices, faces = MESHES[name]
    normals = np.random.default_rng(seed).normal(size=vertices.shape)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return build(np.hstack([vertices, normals]), faces), normals


def tilts(normals, vertices, faces):
    """The sum over the faces of perimeter times angle, by arccos."""
    a, b, c = np.asarray(vertices, np.longdouble)[np.asarray(faces)].transpose(1, 0, 2)
    across, wanted = np.cross(b - a, c - a), normals[np.asarray(faces)].sum(axis=1)
    sizes = np.linalg.norm(across, axis=1) * np.linalg.norm(wanted, axis=1)
    angles = np.arccos(np.einsum("nd,nd->n", across, wanted) / sizes)
    sides = np.linalg.norm(np.stack([b - a, c - b, a - c]), axis=2)
    return float((sides.sum(axis=0) * angles).sum())


def objective(normals, vertices, faces):
    return reference.mean_curvature(vertices, faces) + 2.0 * tilts(normals, vertices, faces)


@each_mesh
def test_total_is_that_of_the_reference(name):
    mesh, normals = with_normals(name)
    assert tilt.total(mesh) == pytest.approx(objective(normals, *MESHES[name]), rel=1e-13)


@each_mesh
def test_cost_reduction_is_the_brute_force_difference(name):
    vertices, faces = MESHES[name]
    mesh, normals = with_normals(name)
    edges = [h for h in range(len(mesh.origin)) if h < mesh.twin[h] and can_flip(mesh, h)]
    assert edges
    for h in edges[:40]:
        ends = int(mesh.origin[h]), int(mesh.origin[mesh.twin[h]])
        wanted = reference.reduction(functools.partial(objective, normals), vertices, faces, *ends)
        for half_edge in (h, mesh.twin[h]):
            found = tilt.cost_reduction(mesh, half_edge)
            if np.isfinite(found):
                assert found == pytest.approx(wanted, abs=1e-11)
            else:
                assert mean_curvature.cost_reduction(mesh, half_edge) == found == -np.inf


def test_normals_and_faces_of_length_zero_have_no_angle():
    vertices = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (1, 1, 0)], float)
    mesh = build(
        np.hstack([vertices, np.zeros((4, 3))]), np.array([(0, 1, 2), (0, 2, 3)], np.int32)
    )
    assert tilt.total(mesh) == mean_curvature.total(mesh) == 0.0
