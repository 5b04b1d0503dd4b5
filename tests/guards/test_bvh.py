"""The intersection guard and its BVH, against all pairs of faces."""

import numpy as np
import pytest

from meshlab_willmore.guards.bvh import (
    LEAF_FACES,
    build_bvh,
    expand,
    inactive_bvh,
    leaf_range,
    next_leaf,
    refit,
    refitted,
    skip_subtree,
    specialized,
)
from meshlab_willmore.guards.intersections import (
    ANY_ROUND,
    blocking_face,
    box_of,
    face_at,
    obstacles_in_round,
    would_intersect,
)
from meshlab_willmore.measure import self_intersections
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import NONE, flip
from meshlab_willmore.mesh.jit import jit
from meshlab_willmore.mesh.validate import to_unit_scale
from meshlab_willmore.search.snapshots import copy_of
from tests import meshes, solids
from tests.connectivity import can_flip
from tests.guards import brute

GIANT = [(9.0, 9.0, 0.1), (-9.0, 9.0, 0.0), (0.0, -19.0, 0.2)]


def on_a_line():
    vertices, faces = meshes.bumpy_sphere(20)
    return np.outer(np.random.default_rng(0).integers(0, 40, len(vertices)), (1.0, 2.0, 3.0)), faces


def tilted():
    vertices, faces = meshes.patch(60, height=0.0)
    matrix, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    return vertices @ matrix, faces


MESHES = {
    "noisy sphere": lambda: meshes.bumpy_sphere(60, bump=0.6),
    "patch": lambda: meshes.patch(60),
    "flat patch": lambda: meshes.patch(60, height=0.0),
    "tilted patch": tilted,
    "flat grid": lambda: meshes.grid(6, 6),
    "two sheets": lambda: meshes.two_sheets(40),
    "crumpled sheet": lambda: meshes.crumpled(7),
    "torus": lambda: meshes.torus(60, None, 1),
    "cut by a giant face": lambda: meshes.with_giant_face(*meshes.bumpy_sphere(40), GIANT),
    "tiny, with a giant face": lambda: meshes.with_giant_face(
        *(x * s for x, s in zip(meshes.bumpy_sphere(40), (1e-6, 1), strict=True)), GIANT
    ),
    "on a line": on_a_line,
    "coincident": lambda: (np.ones((30, 3)), meshes.bumpy_sphere(30)[1]),
    "bow tie": meshes.bow_tie,
    "fin": lambda: meshes.fin()[:2],
}


def unit_mesh(vertices, faces):
    scaled, exponent = to_unit_scale(np.asarray(vertices, float), faces)
    return build(scaled, faces), exponent


def mesh_and_bvh(name):
    mesh, exponent = unit_mesh(*MESHES[name]())
    return mesh, build_bvh(mesh, exponent)


def shuffle(mesh, bvh, count, rng, number=0):
    """Make random flips, and let the index follow, or grow in a round."""
    for h in rng.integers(0, len(mesh.origin), count):
        if mesh.twin[h] != NONE and can_flip(mesh, h):
            flip(mesh, h)
            if number:
                expand(mesh, bvh, h, number)
            else:
                refit(mesh, bvh, h)


@pytest.mark.heavy
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.slow
def test_the_bvh_finds_what_all_pairs_find(name):
    mesh, bvh = mesh_and_bvh(name)
    rng = np.random.default_rng(0)
    for flips in (0, 30, 200):
        shuffle(mesh, bvh, flips, rng)
        before = copy_of(mesh)
        for h in np.flatnonzero(mesh.twin != NONE)[::3]:
            if not can_flip(mesh, h):
                continue
            blocking = brute.blockers(mesh, h, bvh.area_scale)
            found = int(blocking_face(mesh, bvh, h, ANY_ROUND))
            assert (found in blocking) if blocking else (found == NONE)
            assert bool(would_intersect(mesh, bvh, h)) == bool(blocking)
        np.testing.assert_array_equal(mesh.origin, before.origin)


@pytest.mark.heavy
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.slow
def test_intersecting_faces_are_those_of_clipping(name):
    vertices, faces = MESHES[name]()
    mesh = build(np.asarray(vertices, float), faces)
    for flips in (0, 100):
        shuffle(mesh, inactive_bvh(), flips, np.random.default_rng(1))
        marked = self_intersections(vertices, faces_of(mesh))
        wanted = solids.cutting_faces(vertices, faces_of(mesh))
        assert set(np.flatnonzero(marked).tolist()) == wanted


@pytest.mark.parametrize("name", MESHES)
def test_boxes_are_refitted(name):
    mesh, _ = unit_mesh(*MESHES[name]())
    bvh = build_bvh(mesh)
    shuffle(mesh, bvh, 200, np.random.default_rng(2))
    np.testing.assert_array_equal(refitted(bvh, mesh).box, bvh.box)
    corners = mesh.vertices[faces_of(mesh)]
    np.testing.assert_array_equal(bvh.box[0, :3], corners.min(axis=(0, 1)))
    np.testing.assert_array_equal(bvh.box[0, 3:], corners.max(axis=(0, 1)))


def test_boxes_are_refitted_there_and_back():
    mesh, _ = unit_mesh(*meshes.bumpy_sphere(50))
    bvh = build_bvh(mesh)
    before, changes = bvh.box.copy(), 0
    for h in range(len(mesh.origin)):
        if not can_flip(mesh, h):
            continue
        flip(mesh, h)
        refit(mesh, bvh, h)
        changes += (bvh.box != before).any()
        for _ in range(3):
            flip(mesh, h)
        refit(mesh, bvh, h)
        np.testing.assert_array_equal(bvh.box, before)
    assert changes > 10


@pytest.mark.parametrize("name", MESHES)
def test_expanded_boxes_hold_what_is_below_and_what_was(name):
    mesh, _ = unit_mesh(*MESHES[name]())
    bvh = build_bvh(mesh)
    lowest, highest = bvh.box[:, :3].copy(), bvh.box[:, 3:].copy()
    rounds = np.zeros(len(bvh.order), int)
    for number in (1, 2, 5):
        for h in np.random.default_rng(number).integers(0, len(mesh.origin), 40):
            if mesh.twin[h] == NONE or not can_flip(mesh, h):
                continue
            flip(mesh, h)
            expand(mesh, bvh, h, number)
            rounds[[h // 3, mesh.twin[h] // 3]] = number
            tight = refitted(bvh, mesh).box
            lowest, highest = np.minimum(lowest, tight[:, :3]), np.maximum(highest, tight[:, 3:])
        np.testing.assert_array_equal(bvh.box[:, :3], lowest)
        np.testing.assert_array_equal(bvh.box[:, 3:], highest)
        np.testing.assert_array_equal(bvh.changed, rounds)


@pytest.mark.heavy
@pytest.mark.parametrize("name", MESHES)
def test_among_faces_that_changed_in_a_round_the_bvh_finds_what_all_pairs_find(name):
    mesh, bvh = mesh_and_bvh(name)
    rng = np.random.default_rng(3)
    for number in (1, 2):
        shuffle(mesh, bvh, 30, rng, number)
    for h in np.flatnonzero(mesh.twin != NONE)[::3]:
        if not can_flip(mesh, h):
            continue
        blocking = brute.blockers(mesh, h, bvh.area_scale)
        for since in (1, 2, 3):
            young = {f for f in blocking if bvh.changed[f] >= since and f != h // 3}
            found = int(blocking_face(mesh, bvh, h, since))
            assert (found in young) if young else (found == NONE)


@pytest.mark.heavy
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.slow
def test_obstacles_in_a_round_are_those_that_all_pairs_find(name):
    """Flips of a round: none has a face of another one's, but their new faces may cut."""
    mesh, bvh = mesh_and_bvh(name)
    to_flip = np.full(len(bvh.order), NONE, np.int32)
    for h in np.random.default_rng(4).permutation(len(mesh.origin)).tolist():
        own = [h // 3, int(mesh.twin[h]) // 3]
        if mesh.twin[h] != NONE and can_flip(mesh, h) and (to_flip[own] == NONE).all():
            to_flip[own] = h
            expand(mesh, bvh, h, 7)
    chosen = sorted(set(to_flip[to_flip >= 0].tolist()))
    # Some are not made after all.
    for h in chosen[::5]:
        to_flip[[h // 3, mesh.twin[h] // 3]] = NONE
    flipped = copy_of(mesh)
    for h in set(to_flip[to_flip >= 0].tolist()):
        flip(flipped, h)
    corners, area_scale = faces_of(flipped), bvh.area_scale
    new = set(np.flatnonzero(to_flip >= 0).tolist())
    for h in set(to_flip[to_flip >= 0].tolist()):
        own, blocking = [h // 3, int(mesh.twin[h]) // 3], brute.blockers(mesh, h, area_scale)
        found = obstacles_in_round(mesh, bvh, h, 7, to_flip)
        assert (found.face in blocking) if blocking else (found.face == NONE)
        if not blocking:
            assert bool(found.flip) == any(
                brute.are_refused(mesh.vertices, corners, f, e, area_scale)
                for f in own
                for e in new - set(own)
            )


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 8, 9, 31, 64, 65, 1000])
def test_every_face_has_a_leaf_of_few(count):
    vertices, faces = meshes.grid(25, 20)
    mesh = build(vertices, faces[:count])
    bvh = build_bvh(mesh)
    assert sorted(bvh.order.tolist()) == list(range(count))
    leaves = (len(bvh.box) + 1) // 2
    sizes = np.bincount(bvh.leaf, minlength=leaves)
    assert sizes.max() <= LEAF_FACES
    assert sizes.max() - sizes.min() <= 1
    seen = [bvh.order[slice(*leaf_range(bvh.box, count, leaves - 1 + x))] for x in range(leaves)]
    for leaf, members in enumerate(seen):
        assert (bvh.leaf[members] == leaf).all()
    assert sum(map(len, seen)) == count


def test_the_bvh_is_small_and_its_leaves_hold_neighbours():
    vertices, faces = meshes.torus(4000, 0.3, 1)
    mesh, _ = unit_mesh(vertices, faces)
    bvh = build_bvh(mesh)
    assert sum(array.nbytes for array in bvh[2:]) <= 60 * len(faces)
    # Leaves of neighbours: their boxes are small.
    leaves = bvh.box[len(bvh.box) // 2 :]
    assert np.median((leaves[:, 3:] - leaves[:, :3]).max(axis=1)) < 0.2


def test_one_huge_face_costs_little():
    """A query next to it looks at a few leaves, not at all."""
    vertices, faces = meshes.bumpy_sphere(2000)
    vertices, faces = meshes.with_giant_face(vertices * 1e-6, faces, GIANT)
    mesh, _ = unit_mesh(vertices, faces)
    bvh = build_bvh(mesh)
    visited = []
    for f in range(0, len(faces) - 1, 100):
        box = box_of(face_at(mesh.vertices, mesh.origin, f))
        node, leaves = next_leaf(bvh.box, 0, box), 0
        while node != NONE:
            leaves += 1
            node = next_leaf(bvh.box, skip_subtree(node), box)
        visited.append(leaves)
    assert min(visited) >= 1
    assert np.mean(visited) < 30


def test_a_walk_meets_every_leaf_once_in_order():
    mesh, _ = unit_mesh(*meshes.bumpy_sphere(200))
    bvh = build_bvh(mesh)
    everything = (-np.inf,) * 3 + (np.inf,) * 3
    node, walked = next_leaf(bvh.box, 0, everything), []
    while node != NONE:
        walked.append(int(node))
        node = next_leaf(bvh.box, skip_subtree(node), everything)
    leaves = (len(bvh.box) + 1) // 2
    assert walked == list(range(leaves - 1, 2 * leaves - 1))


def test_without_a_guard_nothing_is_refused():
    mesh, _ = unit_mesh(*meshes.crumpled(4))
    bvh = inactive_bvh()
    assert not any(len(array) for array in bvh[2:])
    for h in range(len(mesh.origin)):
        if can_flip(mesh, h):
            assert not would_intersect(mesh, bvh, h)
    refit(mesh, bvh, 0)
    assert blocking_face(mesh, bvh, 0, ANY_ROUND) == NONE
    assert not build_bvh(build(np.empty((0, 3)), np.empty((0, 3), np.int32))).active


@jit
def _flipped(mesh, bvh, h):
    """What a search asks and does."""
    refused = would_intersect(mesh, bvh, h) or blocking_face(mesh, bvh, h, ANY_ROUND) != NONE
    if not refused:
        flip(mesh, h)
        refit(mesh, bvh, h)
    return refused


@pytest.mark.parametrize("kind", [inactive_bvh, lambda: specialized(inactive_bvh())])
@pytest.mark.slow
def test_kernels_refuse_nothing_without_a_guard(kind):
    """Of the second kind they could not even be compiled with the guard: it lacks the arrays."""
    mesh, _ = unit_mesh(*meshes.crumpled(4))
    bvh = kind()
    assert refitted(bvh, mesh).active is False
    h = next(h for h in range(len(mesh.origin)) if can_flip(mesh, h))
    before = mesh.origin.copy()
    assert not _flipped(mesh, bvh, h)
    assert (mesh.origin != before).any()


def test_an_active_bvh_is_not_specialized_and_is_refitted_in_kernels():
    mesh, _ = unit_mesh(*meshes.bumpy_sphere(60))
    bvh = build_bvh(mesh)
    assert specialized(bvh) is bvh
    before = bvh.box.copy()
    for h in range(len(mesh.origin)):
        if can_flip(mesh, h):
            _flipped(mesh, bvh, h)
    assert (bvh.box != before).any()
    np.testing.assert_array_equal(bvh.box, refitted(bvh, mesh).box)
