"""The face scan, and its points in a stretched triangulation."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from meshlab_willmore.demo.models import (
    signed_areas,
)
from meshlab_willmore.demo.scan import (
    REACH_MM,
    ScanNotFoundError,
    scan_file,
    scanner_plane,
    stretched_triangulation,
)

from .conftest import upright


def test_the_cleaned_scan_is_one_to_one_in_the_scanners_plane(cleaned):
    assert len(cleaned.faces) > 160_000
    assert (signed_areas(scanner_plane(cleaned.vertices), cleaned.faces) > 0).all()


@pytest.fixture(scope="module")
def face(cleaned):
    return stretched_triangulation(cleaned, stretch=3.0, keep_one_of=60)


def test_vertices_of_the_face_are_points_of_the_scan(cleaned, face):
    known = {point.tobytes() for point in cleaned.vertices}
    chosen = {point.tobytes() for point in face.vertices}
    assert chosen <= known
    assert len(chosen) == len(face.vertices)
    assert len(cleaned.vertices) / 60 < len(face.vertices) < 2 * len(cleaned.vertices) / 60


def test_face_has_no_folds_and_lies_on_the_scan(cleaned, face):
    plane = scanner_plane(face.vertices)
    areas = signed_areas(plane, face.faces)
    assert (areas > 0).all()
    scanned = signed_areas(scanner_plane(cleaned.vertices), cleaned.faces).sum()
    assert 0.9 * scanned < areas.sum() < 1.05 * scanned
    # A point of a triangle is no farther from the nearest corner than the longest side / sqrt 3.
    corners = cleaned.vertices[cleaned.faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()
    centroids = face.vertices[face.faces].mean(axis=1)
    to_vertex, _ = cKDTree(cleaned.vertices).query(centroids)
    assert to_vertex.max() < REACH_MM + longest / np.sqrt(3)
    assert np.median(to_vertex) < 0.5


def test_stretch_makes_vertical_edges(cleaned, face):
    even = stretched_triangulation(cleaned, stretch=1.0, keep_one_of=60)
    np.testing.assert_array_equal(even.vertices, face.vertices)
    assert upright(even) < 0.35
    assert upright(face) > 0.55


def test_face_is_the_same_every_time(cleaned, face):
    again = stretched_triangulation(cleaned, stretch=3.0, keep_one_of=60)
    np.testing.assert_array_equal(again.vertices, face.vertices)
    np.testing.assert_array_equal(again.faces, face.faces)


def test_a_build_without_the_scan_is_named(no_scan):
    with pytest.raises(ScanNotFoundError, match=r"does not carry the face scan .*face000\.ply"):
        scan_file()
