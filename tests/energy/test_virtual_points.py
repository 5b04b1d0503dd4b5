"""Virtual points elsewhere than in the middle: brute force, symmetries, degenerate diagonals."""

import itertools
import math

import numpy as np
import pytest

from meshlab_willmore.energy import virtual, virtual_at, virtual_closest
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import Diamond, diamond, flip
from meshlab_willmore.mesh.points import Point
from tests import meshes, reference
from tests.connectivity import can_flip
from tests.meshes import SMALL as MESHES

ROUNDING = 2e-13
MARGIN = virtual_closest.MARGIN

each_mesh = pytest.mark.parametrize("name", MESHES)


def at(t):
    return lambda mesh, h: virtual_at.cost_reduction(mesh, h, t)


PLACES = {"closest": virtual_closest.cost_reduction, "a third": at(1 / 3), "a hundredth": at(0.01)}
each_place = pytest.mark.parametrize("place", PLACES)


def flippable(mesh):
    return [h for h in range(len(mesh.origin)) if can_flip(mesh, h)]


def ends(mesh, h):
    return int(mesh.origin[h]), int(mesh.origin[mesh.twin[h]])


def after_flips(name, count):
    """The mesh after random flips: folded diamonds, slivers, large fans."""
    mesh = build(*MESHES[name])
    rng = np.random.default_rng(1)
    for _ in range(count):
        flip(mesh, rng.choice(flippable(mesh)))
    return mesh


@pytest.mark.parametrize("flips", [0, 30])
@pytest.mark.parametrize("t", [0.02, 0.3, 0.5, 0.75])
@each_mesh
def test_at_a_place_it_is_the_brute_force_difference(name, t, flips):
    mesh = after_flips(name, flips)
    vertices, faces = mesh.vertices, mesh.origin.reshape(-1, 3)
    edges = [h for h in flippable(mesh) if h < mesh.twin[h]]
    assert edges
    for h in edges[:: 1 + len(edges) // 20]:
        wanted = reference.virtual_reduction_at(vertices, faces, *ends(mesh, h), t)
        for half_edge in (h, mesh.twin[h]):
            found = virtual_at.cost_reduction(mesh, half_edge, t)
            assert found == pytest.approx(float(wanted), abs=ROUNDING)


@pytest.mark.parametrize("flips", [0, 30])
@each_mesh
def test_at_the_closest_points_it_is_the_brute_force_difference(name, flips):
    mesh = after_flips(name, flips)
    vertices, faces = mesh.vertices, mesh.origin.reshape(-1, 3)
    edges = [h for h in flippable(mesh) if h < mesh.twin[h]]
    assert edges
    for h in edges:
        wanted = reference.virtual_reduction_closest(vertices, faces, *ends(mesh, h), MARGIN)
        for half_edge in (h, mesh.twin[h]):
            found = virtual_closest.cost_reduction(mesh, half_edge)
            # Diagonals at a small angle decide less sharply where they are closest.
            assert found == pytest.approx(float(wanted), abs=10 * ROUNDING)


@each_mesh
def test_in_the_middle_it_is_the_paper_s_cost_bit_for_bit(name):
    mesh = build(*MESHES[name])
    for h in flippable(mesh):
        assert virtual_at.cost_reduction(mesh, h, 0.5) == virtual.cost_reduction(mesh, h)


@pytest.mark.parametrize("t", [1e-9, 0.1, 0.25, 0.4])
@each_mesh
def test_from_which_end_the_place_counts_does_not_matter(name, t):
    mesh = build(*MESHES[name])
    for h in flippable(mesh):
        here, there = at(t)(mesh, h), at(1.0 - t)(mesh, h)
        assert here == pytest.approx(there, abs=ROUNDING)


@each_place
@each_mesh
def test_neither_numbers_nor_orientation_matter(name, place):
    vertices, faces = MESHES[name]
    cost_reduction = PLACES[place]
    rng = np.random.default_rng(2)
    number = rng.permutation(len(vertices))
    moved = np.empty_like(vertices)
    moved[number] = vertices
    renamed = np.array([np.roll(number[face], rng.integers(3)) for face in faces])[:, ::-1]
    here, there = build(vertices, faces), build(moved, rng.permutation(renamed).astype(np.int32))
    gains = {frozenset(ends(there, h)): cost_reduction(there, h) for h in flippable(there)}
    edges = flippable(here)
    assert len({frozenset(ends(here, h)) for h in edges}) == len(gains) > 0
    for h in edges:
        wanted = gains[frozenset(int(number[v]) for v in ends(here, h))]
        assert cost_reduction(here, h) == pytest.approx(wanted, abs=10 * ROUNDING)


@each_place
def test_flipping_back_costs_what_flipping_gained(place):
    cost_reduction = PLACES[place]
    mesh = build(*MESHES["closed"])
    for h in flippable(mesh):
        gain = cost_reduction(mesh, h)
        flip(mesh, h)
        assert cost_reduction(mesh, h) == pytest.approx(-gain, abs=10 * ROUNDING)
        for _ in range(3):
            flip(mesh, h)


@each_place
def test_similarities_change_nothing(place):
    cost_reduction = PLACES[place]
    vertices, faces = MESHES["closed"]
    rotation, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    here, there = build(vertices, faces), build(7.0 * vertices @ rotation, faces)
    for h in flippable(here):
        wanted = cost_reduction(here, h)
        assert cost_reduction(there, h) == pytest.approx(wanted, abs=100 * ROUNDING)


@each_place
def test_far_from_the_origin_no_digit_is_lost(place):
    cost_reduction = PLACES[place]
    vertices, faces = MESHES["closed"]
    here, there = (build(moved, faces) for moved in meshes.near_and_far(vertices))
    for h in flippable(here):
        assert cost_reduction(there, h) == cost_reduction(here, h)


@each_place
def test_coincident_points_are_never_worth_a_flip(place):
    vertices, faces, coincident = meshes.with_coincident_ends()
    mesh = build(vertices, faces)
    gains = {frozenset(ends(mesh, h)): PLACES[place](mesh, h) for h in flippable(mesh)}
    assert gains[frozenset(coincident)] == -math.inf
    assert all(gain == -math.inf or math.isfinite(gain) for gain in gains.values())


@each_place
def test_points_on_one_line_are_worth_a_number_or_nothing(place):
    """All quads of four points out of five equal steps, coincident ones among them."""
    for xs in itertools.product(range(5), repeat=4):
        vertices = np.outer(xs, (0.3, -0.2, 0.7))
        mesh = build(vertices, np.array([(0, 1, 2), (1, 0, 3)], np.int32))
        gain = PLACES[place](mesh, 0)
        assert gain == -math.inf or math.isfinite(gain)
        if xs[0] == xs[1] or xs[2] == xs[3]:
            assert gain == -math.inf


def test_where_diagonals_cross_the_flip_of_a_flat_quad_is_worth_nothing():
    mesh = build(*meshes.patch(80, height=0.0))
    paper = []
    for h in flippable(mesh):
        places = virtual_closest.closest(diamond(mesh, h))
        if min(places) > MARGIN and max(places) < 1.0 - MARGIN:
            assert virtual_closest.cost_reduction(mesh, h) == pytest.approx(0.0, abs=1e-14)
            paper.append(abs(virtual.cost_reduction(mesh, h)))
    assert len(paper) > 50
    assert max(paper) > 0.1


def places_of(*corners):
    return virtual_closest.closest(Diamond(*(Point(*map(float, corner)) for corner in corners)))


def test_the_closest_points_are_those_of_all_segments():
    """In space, in a plane, and in a plane but for a small height, with ends cut off or not."""
    rng = np.random.default_rng(3)
    clamped = 0
    for height in (1.0, 1e-3, 0.0):
        for _ in range(300):
            corners = rng.normal(size=(4, 3)) * (1.0, 1.0, height)
            i, j, k, l = corners.astype(np.longdouble)
            wanted = [float(x) for x in reference.closest_places(i, j, k, l, MARGIN)]
            assert places_of(*corners) == pytest.approx(wanted, abs=1e-12)
            clamped += not set(wanted).isdisjoint((MARGIN, 1 - MARGIN))
            # The same points whatever they are called.
            a, b = places_of(*corners)
            assert places_of(*corners[[1, 0, 3, 2]]) == pytest.approx((1 - a, 1 - b), abs=1e-12)
            assert places_of(*corners[[0, 1, 3, 2]]) == pytest.approx((a, 1 - b), abs=1e-12)
            assert places_of(*corners[[2, 3, 0, 1]]) == pytest.approx((b, a), abs=1e-12)
    assert 200 < clamped < 800


@pytest.mark.parametrize("height", [0.0, 1.0])
@pytest.mark.parametrize(
    ("start", "stop", "a", "b"),
    [
        (0, 1, 0.5, 0.5),
        (1, 0, 0.5, 0.5),
        (0.5, 2.5, 0.8, 0.15),
        (2.5, 0.5, 0.8, 0.85),
        (-1, 4, 0.5, 0.3),
        (2, 4, 0.9, 0.1),
        (4, 2, 0.9, 0.9),
        (-3, -5, 0.1, 0.1),
    ],
)
def test_parallel_diagonals_have_the_middle_of_their_shared_stretch(start, stop, a, b, height):
    rotation, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    corners = np.array([(0, 0, 0), (1, 0, 0), (start, height, 0), (stop, height, 0)])
    assert MARGIN == 0.1
    assert places_of(*corners) == pytest.approx((a, b), abs=1e-15)
    assert places_of(*corners @ rotation) == pytest.approx((a, b), abs=1e-12)
    assert places_of(*corners[[2, 3, 0, 1]]) == pytest.approx((b, a), abs=1e-15)
    assert places_of(*corners[[1, 0, 2, 3]]) == pytest.approx((1 - a, b), abs=1e-15)
