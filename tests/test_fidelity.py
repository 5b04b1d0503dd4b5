"""The measures and models of the study of faithful flips."""

import numpy as np
import pytest

from meshlab_willmore.measure import measures
from studies import fidelity, originals, parts
from studies.faithful import Results
from tests import meshes


def closed_volume(vertices, faces):
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def test_a_prism_is_closed_and_looks_outside():
    vertices, faces = parts.prism([(0, 0), (4, 0), (4, 3), (0, 3)], 1.0, 3.0)
    assert closed_volume(vertices, faces) == pytest.approx(24.0)
    assert measures(vertices, faces).gaussian_curvature == pytest.approx(4.0 * np.pi)


def test_a_difference_is_the_first_solid_minus_the_second():
    block = parts.prism([(0, 0), (4, 0), (4, 3), (0, 3)], 0.0, 2.0)
    bore = parts.prism([(1, 1), (2, 1), (2, 2), (1, 2)], -1.0, 3.0)
    assert closed_volume(*parts.difference(block, bore)) == pytest.approx(22.0)


def test_a_surface_is_faithful_to_itself():
    surface = meshes.bumpy_sphere(60)
    found = fidelity.fidelity(*surface, surface)
    # PyMeshLab's normals and points are in single precision.
    assert found.normal_error == pytest.approx(0.0, abs=0.1)
    assert found.distance == pytest.approx(0.0, abs=0.1)
    assert found.cut_faces == 0


def test_distance_and_normals_are_those_of_a_plane_above_another():
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    faces = np.array([(0, 1, 2), (0, 2, 3)], np.int32)
    wide = 3.0 * (square - (0.5, 0.5, 0.0)) + (0.5, 0.5, 0.0)
    raised = fidelity.fidelity(square + (0.0, 0.0, 0.01), faces, (wide, faces))
    assert raised.distance == pytest.approx(1e5 * 0.01 / np.sqrt(18.0), rel=1e-4)
    tilted = square.copy()
    tilted[:, 2] = square[:, 0] * np.tan(np.radians(10.0))
    assert fidelity.fidelity(tilted, faces, (wide, faces)).normal_error == pytest.approx(10.0)
    turned = fidelity.fidelity(square, faces[:, ::-1], (wide, faces))
    assert turned.normal_error == pytest.approx(180.0)


def test_samples_are_spread_by_area():
    vertices = np.array([(0, 0, 0), (3, 0, 0), (0, 2, 0), (0, 0, 5), (1, 0, 5), (0, 2, 5)], float)
    points, _ = fidelity.surface_samples(vertices, np.array([(0, 1, 2), (3, 4, 5)]))
    large = points[:, 2] < 1.0
    assert large.mean() == pytest.approx(0.75, abs=0.02)
    np.testing.assert_allclose(points[large].mean(axis=0)[:2], (1.0, 2.0 / 3.0), atol=0.03)


def test_coarse_triangulations_keep_vertices_where_they_are():
    original = meshes.bumpy_sphere(400)
    start = originals.coarse("sphere", original, 100)
    assert abs(len(start.vertices) - 100) <= 2
    distance = np.abs(start.vertices[:, None] - original[0][None]).max(axis=2).min(axis=1)
    assert distance.max() < 1e-6
    scrambled = originals.scrambled(start, seed=1)
    assert scrambled.tolist() != start.faces.tolist()
    noisy = originals.noisy(start, seed=0)
    assert noisy.faces is start.faces
    assert 0.0 < np.abs(noisy.vertices - start.vertices).max() < 0.2


def test_a_mean_says_which_models_it_lacks():
    results = Results()
    results.add("one", "a", fidelity.Fidelity(1.0, 2.0, 0.5, 0.1, 3), 1.0)
    results.add("one", "b", fidelity.Fidelity(3.0, 4.0, 0.7, 0.3, 5), 3.0)
    results.add("other", "b", fidelity.Fidelity(1.0, 1.0, 1.0, 1.0, 0), np.nan)
    assert list(results.means()) == [
        ["one", "2.00", "3.0", "0.600", "0.200", "4", "2.000"],
        ["other (1 of 2 models)", "1.00", "1.0", "1.000", "1.000", "0", ""],
    ]
    assert list(results.single(4)) == [["one", "3", "5"], ["other", "", "0"]]
