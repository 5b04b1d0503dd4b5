"""The quality of a mesh: against the functions on arrays, and the slow reference."""

import numpy as np
import pymeshlab
import pytest

import meshlab_willmore
from meshlab_willmore.compare.quality import quality_of
from meshlab_willmore.compare.reference import Sphere, deviation
from meshlab_willmore.measure import triangle_shapes
from meshlab_willmore.mesh.build import changed_edges
from tests import meshes, reference


def set_of(vertices, faces):
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(vertices, faces))
    return ms


def test_measures_are_those_of_the_functions():
    vertices, faces = meshes.bumpy_sphere(200)
    before = faces[::-1]
    flipped = meshlab_willmore.optimize_flips(vertices, faces, maxflips=9).faces
    found = quality_of(set_of(vertices, flipped), before, Sphere(1.0))
    totals = meshlab_willmore.measures(vertices, flipped)
    for name in ("willmore_energy", "area", "absolute_gaussian_curvature"):
        assert getattr(found, name) == getattr(totals, name)
    assert found.absolute_mean_curvature == totals.absolute_mean_curvature
    shapes = triangle_shapes(vertices, flipped)
    assert (found.worst_shape, found.mean_shape) == (np.quantile(shapes, 0.01), shapes.mean())
    assert (found.normal_error, found.distance) == deviation(vertices, flipped, Sphere(1.0))
    assert found.flips == len(reference.edge_set(flipped) - reference.edge_set(faces)) == 9


def test_without_a_reference_there_is_no_deviation():
    vertices, faces = meshes.cube()
    found = quality_of(set_of(vertices, faces), faces, None)
    assert (found.normal_error, found.distance, found.flips) == (None, None, 0)


def test_faces_that_intersect_others_are_counted():
    vertices, faces = meshes.cube()
    both = np.vstack([vertices, vertices + (0.5, 0.3, 0.2)])
    cut = quality_of(set_of(both, np.vstack([faces, faces + len(vertices)])), faces, None)
    assert cut.self_intersecting > 2
    assert quality_of(set_of(vertices, faces), faces, None).self_intersecting == 0


def test_the_transformation_counts():
    vertices, faces = meshes.cube()
    ms = set_of(vertices, faces)
    ms.compute_matrix_from_scaling_or_normalization(axisx=2.0, uniformflag=True, freeze=False)
    assert quality_of(ms, faces, None).area == pytest.approx(4.0 * 6.22709, abs=1e-4)


@pytest.mark.parametrize("steps", [1, 5, 40])
def test_edges_that_are_new(steps):
    _, faces = meshes.torus(120, 0.3, 3)
    rng = np.random.default_rng(steps)
    after = list(map(tuple, faces.tolist()))
    for _ in range(steps):
        i, j, k, l = rng.permutation(reference.diamonds(after))[0]
        if (min(k, l), max(k, l)) not in reference.edge_set(after):
            after = reference.flipped(after, i, j)
    wanted = len(reference.edge_set(after) - reference.edge_set(faces))
    assert changed_edges(faces, np.array(after, np.int32)) == wanted
    assert changed_edges(faces, rng.permutation(np.roll(faces, 1, axis=1))) == 0
