"""Pairs of faces that MeshLab counts are always counted, and others seldom."""

import itertools

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.guards import triangles
from meshlab_willmore.guards.intersections import (
    Face,
    are_clearly_apart,
    face_of,
    intersect,
    meshlab_may_count,
    shared_vertices,
)
from meshlab_willmore.mesh.points import Point
from meshlab_willmore.mesh.validate import to_unit_scale
from tests import meshes
from tests.guards.test_triangles import FAMILIES, PATTERNS

PAIRS = 150
SCALES = [1.0, 1000.0, 0.01]
OFFSETS = [0.0, 10.0]


def counted(vertices, corners):
    """The number of faces that MeshLab counts."""
    ms = pymeshlab.MeshSet(verbose=False)
    ms.add_mesh(pymeshlab.Mesh(vertices, corners))
    ms.compute_selection_by_self_intersections_per_face()
    return ms.current_mesh().selected_face_number()


@pytest.mark.parametrize("sharing", PATTERNS)
@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.slow
def test_what_meshlab_counts_is_counted(family, sharing):
    rng = np.random.default_rng(1)
    corners = np.array(PATTERNS[sharing], np.int32)
    agreed = 0
    for _ in range(PAIRS):
        vertices = np.asarray(FAMILIES[family](rng), float)
        vertices = vertices * rng.choice(SCALES) + rng.choice(OFFSETS)
        scaled, exponent = to_unit_scale(vertices, corners)
        one, other = (face_of(scaled, *face) for face in corners)
        said = meshlab_may_count(one, other, shared_vertices(one, other), 4.0**exponent)
        # MeshLab looks at a pair in the order of its faces, or in both.
        wanted = counted(vertices, corners) > 0 or counted(vertices, corners[::-1]) > 0
        assert said == meshlab_may_count(other, one, shared_vertices(other, one), 4.0**exponent)
        assert said or not wanted, vertices.tolist()
        agreed += said == wanted
    assert agreed >= 0.95 * PAIRS


def round_a_vertex(rng, gap, bend):
    """Two faces with the vertex 0, a gap (radians) apart, nearly in a plane."""
    turns = np.cumsum([0.0, rng.uniform(0.01, 2.0), gap, rng.uniform(0.01, 2.0)])
    lengths = 10.0 ** rng.uniform(-2, 0, 4)
    flat = np.column_stack([np.cos(turns), np.sin(turns), bend * rng.normal(size=4)])
    turned = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return np.vstack([np.zeros(3), flat * lengths[:, None]]) @ turned + rng.normal(size=3)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3, 1e6])
@pytest.mark.parametrize("bend", [0.0, 1e-12, 1e-6, 0.1])
@pytest.mark.slow
def test_faces_clearly_apart_neither_intersect_nor_count(bend, scale):
    rng = np.random.default_rng(2)
    corners = np.array([(0, 1, 2), (0, 3, 4)], np.int32)
    for gap in (-0.5, -1e-6, -1e-12, 0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.5):
        for _ in range(40):
            vertices = scale * round_a_vertex(rng, gap, bend)
            scaled, exponent = to_unit_scale(vertices, corners)
            one, other = (face_of(scaled, *np.roll(face, rng.integers(3))) for face in corners)
            shared = shared_vertices(one, other)
            if are_clearly_apart(one, other, shared, 4.0**exponent):
                assert are_clearly_apart(other, one, shared_vertices(other, one), 4.0**exponent)
                assert not intersect(one, other, shared)
                assert not meshlab_may_count(one, other, shared, 4.0**exponent)


@pytest.mark.parametrize("sharing", PATTERNS)
@pytest.mark.parametrize("family", FAMILIES)
def test_in_no_family_are_intersecting_faces_clearly_apart(family, sharing):
    rng = np.random.default_rng(3)
    corners = np.array(PATTERNS[sharing], np.int32)
    for _ in range(300):
        vertices = np.asarray(FAMILIES[family](rng), float)
        scaled, exponent = to_unit_scale(vertices, corners)
        one, other = (face_of(scaled, *face) for face in corners)
        shared = shared_vertices(one, other)
        if are_clearly_apart(one, other, shared, 4.0**exponent):
            assert not intersect(one, other, shared)
            assert not meshlab_may_count(one, other, shared, 4.0**exponent)


def mirrored(rng):
    """Two faces with a common vertex, one on each side of a plane, hardly apart and tilted."""
    gap, bend, size = 10.0 ** -rng.uniform((5, 9, 0), (16, 17, 3))
    turns = np.array([-1.0, 0.0, 0.0, 1.0]) * rng.uniform(0.1, 1.5) + gap * np.repeat([-1, 1], 2)
    lengths = np.array([1.0, *rng.uniform(0.1, 1.0, 1).repeat(2), 1.0])
    flat = np.column_stack([lengths * np.cos(turns), lengths * np.sin(turns), np.zeros(4)])
    flat[:, 2] = bend * rng.uniform(-1.0, 1.0, 4)
    turned = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return np.vstack([np.zeros(3), size * flat]) @ turned + rng.uniform(-1.0, 1.0, 3)


@pytest.mark.slow
def test_faces_that_only_rounding_brings_together_are_not_clearly_apart():
    rng = np.random.default_rng(4)
    area_scale, by_rounding = 4.0**25, 0
    for _ in range(4000):
        s, a, b, c, d = (Point(*row) for row in mirrored(rng).tolist())
        one, other = Face(0, 1, 2, s, a, b), Face(0, 3, 4, s, c, d)
        shared = shared_vertices(one, other)
        if meshlab_may_count(one, other, shared, area_scale):
            assert not are_clearly_apart(one, other, shared, area_scale)
            by_rounding += triangles.are_separated(s, a, b, b, c, d, 0.0, 0.0)
    assert by_rounding > 0


@pytest.mark.slow
def test_nearly_all_neighbours_round_a_vertex_are_clearly_apart():
    vertices, corners = meshes.bumpy_sphere(300)
    scaled, exponent = to_unit_scale(vertices, corners)
    seen = []
    for f, g in itertools.combinations(range(len(corners)), 2):
        if len(set(corners[f]) & set(corners[g])) == 1:
            one, other = (
                face_of(scaled, *corners[f]),
                face_of(scaled, *corners[g]),
            )
            shared = shared_vertices(one, other)
            seen.append(are_clearly_apart(one, other, shared, 4.0**exponent))
    assert np.mean(seen) > 0.9
