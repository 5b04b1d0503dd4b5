"""How far flips take the surface from the input."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshlab_willmore import optimize_flips
from meshlab_willmore.guards.deviation import (
    SLACK,
    add_deviation,
    deviates,
    diagonal_distance,
    segment_distance,
)
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import flip
from meshlab_willmore.mesh.points import Point
from meshlab_willmore.options import SEARCH
from tests import meshes
from tests.connectivity import can_flip
from tests.distances import farthest
from tests.search.ways import scramble
from tests.test_optimize_input import rotation

COORDINATES = st.integers(-3, 3).map(float)
POINTS = st.tuples(COORDINATES, COORDINATES, COORDINATES)


def brute_distance(a, b, c, d, steps=60):
    """The least distance between points of two segments on a grid, which is never too small."""
    s = np.linspace(0.0, 1.0, steps)[:, None]
    one, other = a + s * (b - a), c + s * (d - c)
    return np.sqrt(((one[:, None] - other[None]) ** 2).sum(axis=2)).min()


@given(POINTS, POINTS, POINTS, POINTS)
@settings(max_examples=300)
def test_segments_are_as_far_apart_as_their_nearest_points(a, b, c, d):
    found = segment_distance(*(Point(*p) for p in (a, b, c, d)))
    brute = brute_distance(*map(np.array, (a, b, c, d)))
    step = math.dist(a, b) + math.dist(c, d)
    assert found <= brute + 1e-12
    assert found >= brute - step / 59


def tent(height):
    """Two faces at the edge 0-1, whose other corners are below it by `height`."""
    return build(
        np.array([(0, 0, 0), (2, 0, 0), (1, 1, -height), (1, -1, -height)], float),
        np.array([(0, 1, 2), (1, 0, 3)], np.int32),
    )


def test_a_flip_counts_with_the_distance_of_the_diagonals():
    mesh = tent(0.25)
    assert diagonal_distance(mesh, 0) == pytest.approx(0.25)
    assert deviates(mesh, 0, 0.24)
    assert not deviates(mesh, 0, 0.25)
    assert not deviates(mesh, 0, math.inf)
    mesh.deviation[:] = 0.5, 0.125
    assert deviates(mesh, 0, 0.74)
    assert not deviates(mesh, 0, 0.75)
    before = diagonal_distance(mesh, 0)
    flip(mesh, 0)
    assert diagonal_distance(mesh, 0) == before
    add_deviation(mesh, 0)
    np.testing.assert_array_equal(mesh.deviation, 0.5 + before)


def test_in_a_plane_a_flip_counts_nothing_in_any_position():
    vertices, faces = meshes.patch(60, 2, height=0.0)
    faces = faces_of(scramble(build(vertices, faces), 1))
    turned = vertices @ rotation(3).T
    result = optimize_flips(turned, faces, energy="delaunay", maxdeviation=0.0)
    free = optimize_flips(turned, faces, energy="delaunay")
    assert result.flips == free.flips > 0
    assert result.deviation < SLACK


@pytest.mark.slow
def test_many_random_flips_stay_within_the_bound():
    """The theorem itself, without a search: any legal flips, thousands of them."""
    vertices, faces = meshes.bumpy_sphere(50, 5, bump=0.5)
    mesh = build(vertices, faces)
    rng = np.random.default_rng(0)
    for number in range(3000):
        h = int(rng.integers(len(mesh.origin)))
        if can_flip(mesh, h) and not deviates(mesh, h, 0.4):
            flip(mesh, h)
            add_deviation(mesh, h)
        if number % 300 == 0:
            there, back = farthest(vertices, faces, mesh.origin.reshape(-1, 3))
            assert max(there, back) <= mesh.deviation.max() <= 0.4 + SLACK
    assert there > 0.1


@pytest.mark.heavy
@pytest.mark.parametrize("search", SEARCH.choices)
@pytest.mark.parametrize("energy", ["virtual willmore", "mean curvature", "gaussian curvature"])
@pytest.mark.slow
def test_no_search_takes_the_surface_farther(energy, search):
    vertices, faces = meshes.bumpy_sphere(60, 1, bump=0.6)
    options = {"energy": energy, "search": search, "sweeps": 3, "depth": 3, "foldangle": 180.0}
    flips = []
    for limit in (0.0, 0.02, 0.2, None):
        result = optimize_flips(vertices, faces, maxdeviation=limit, **options)
        there, back = farthest(vertices, faces, result.faces)
        assert max(there, back) <= result.deviation + 1e-12
        assert limit is None or result.deviation <= limit + 1e-12
        flips.append(result.flips)
    assert flips[0] == 0 < flips[1] < flips[2]


@pytest.mark.heavy
@pytest.mark.parametrize("search", SEARCH.choices)
@pytest.mark.parametrize("maxflips", [1, 3, 10])
def test_the_bound_holds_where_the_number_of_flips_is_limited(search, maxflips):
    for seed in range(4):
        vertices, faces = meshes.bumpy_sphere(30, seed, bump=0.6)
        result = optimize_flips(
            vertices, faces, energy="mean curvature", search=search, maxflips=maxflips, sweeps=2
        )
        there, back = farthest(vertices, faces, result.faces)
        assert 0.0 < max(there, back) <= result.deviation + 1e-12


@pytest.mark.parametrize("exponent", [-300, 300])
def test_limits_are_lengths_in_the_units_of_the_input(exponent):
    vertices, faces = meshes.bumpy_sphere(60, 1, bump=0.6)
    result = optimize_flips(vertices, faces, energy="area", maxdeviation=0.05)
    scale = 2.0**exponent
    scaled = optimize_flips(vertices * scale, faces, energy="area", maxdeviation=0.05 * scale)
    np.testing.assert_array_equal(scaled.faces, result.faces)
    assert scaled.deviation == result.deviation * scale > 0.0
