"""The greedy search against one that scans all edges before each flip."""

import math

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.energy import virtual, willmore
from meshlab_willmore.mesh.build import build, faces_of, validate_connectivity
from meshlab_willmore.mesh.halfedge import apex, can_flip, flip
from meshlab_willmore.search import entries, greedy
from tests import meshes

KERNELS = {
    "virtual willmore": (entries.greedy_virtual, virtual.cost_reduction),
    "willmore": (entries.greedy_willmore, willmore.cost_reduction),
}


def flippable(mesh):
    return [h for h in range(len(mesh.origin)) if can_flip(mesh, h)]


def shuffled(count, seed):
    """A bumpy sphere after random flips: far from optimal, with 3-cycles that are no faces."""
    vertices, faces = meshes.bumpy_sphere(count, seed, bump=0.6)
    mesh = build(vertices, faces)
    rng = np.random.default_rng(seed)
    for _ in range(4 * count):
        flip(mesh, rng.choice(flippable(mesh)))
    return vertices, faces_of(mesh)


MESHES = {
    "closed": meshes.bumpy_sphere(60),
    "boundary": meshes.patch(60),
    "flat boundary": meshes.patch(60, height=0.0),
    "cube": meshes.cube(0.1),
    "fin": meshes.fin()[:2],
    "bow tie": meshes.bow_tie(),
    "shuffled": shuffled(20, 1),
}
GUARDED, FREE = guards.fold_limits(90.0), guards.fold_limits(180.0)


def pair(a, b):
    return frozenset((int(a), int(b)))


def flips_by_scanning(mesh, rules, cost_reduction):
    """Make all flips of the pseudocode on `mesh`; return their number and total gain."""
    gone, gains = set(), []
    while True:
        candidates = []
        for h in range(len(mesh.origin)):
            t = mesh.twin[h]
            if h > t or not can_flip(mesh, h) or guards.folds(mesh, h, rules.fold):
                continue
            gain, drop = cost_reduction(mesh, h), willmore.cost_reduction(mesh, h)
            allowed = gain > rules.tolerance and (not rules.monotone or drop >= -rules.tie)
            stays_away = not rules.monotone or drop <= 2 * rules.tie
            if allowed and not (stays_away and pair(apex(mesh, h), apex(mesh, t)) in gone):
                candidates.append((-np.rint(gain / rules.rank_step), h, stays_away))
        if not candidates:
            return len(gains), math.fsum(gains)
        _, h, stays_away = min(candidates)
        if stays_away:
            gone.add(pair(mesh.origin[h], mesh.origin[mesh.twin[h]]))
        before = willmore.total(mesh)
        gains.append(cost_reduction(mesh, h))
        flip(mesh, h)
        validate_connectivity(mesh)
        if rules.monotone:
            assert willmore.total(mesh) <= before + 1e-11


@pytest.mark.heavy
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("monotone", [True, False])
@pytest.mark.parametrize("fold", [GUARDED, FREE])
@pytest.mark.parametrize("energy", KERNELS)
def test_the_queue_finds_what_a_scan_finds(energy, fold, monotone, name):
    kernel, cost_reduction = KERNELS[energy]
    rules = greedy.Rules(fold, monotone)
    scanned, searched = build(*MESHES[name]), build(*MESHES[name])
    flips, gain = flips_by_scanning(scanned, rules, cost_reduction)
    progress = greedy.run(kernel, searched, rules)
    validate_connectivity(searched)
    assert progress.flips == flips
    assert progress.gain == pytest.approx(gain, rel=1e-12)
    assert progress.state == greedy.CONVERGED
    np.testing.assert_array_equal(faces_of(searched), faces_of(scanned))


@pytest.mark.parametrize(("count", "seed"), [(8, 7), (8, 15), (12, 106), (20, 1), (20, 30)])
def test_an_edge_freed_by_a_flip_elsewhere_is_flipped_too(count, seed):
    """A flip that is forbidden because its edge exists becomes possible when that edge goes.

    In these meshes that edge is not among the 13 around the flip, and the gain is worth taking.
    """
    rules = greedy.Rules(FREE)
    mesh = build(*shuffled(count, seed))
    greedy.run(entries.greedy_willmore, mesh, rules)
    gains = [willmore.cost_reduction(mesh, h) for h in flippable(mesh)]
    assert max(gains) <= rules.tolerance


@pytest.mark.parametrize("energy", KERNELS)
def test_maxflips_stops_on_the_way(energy):
    kernel, _ = KERNELS[energy]
    everything = greedy.run(kernel, build(*MESHES["closed"]), greedy.Rules(GUARDED))
    gains = []
    for limit in range(everything.flips + 2):
        progress = greedy.run(kernel, build(*MESHES["closed"]), greedy.Rules(GUARDED, True, limit))
        assert progress.flips == min(limit, everything.flips)
        done = limit >= everything.flips
        assert progress.state == (greedy.CONVERGED if done else greedy.STOPPED)
        gains.append(progress.gain)
    assert (np.diff(gains[:-1]) > 0.0).all()
    assert gains[-1] == gains[-2] == everything.gain


@pytest.mark.parametrize("monotone", [True, False])
def test_the_cycle_on_a_random_torus_ends(monotone):
    """Literal descent on the virtual energy goes round a 4-cycle for ever on this mesh."""
    vertices, faces = meshes.torus(200, None, 1)
    mesh = build(vertices, faces)
    progress = greedy.run(entries.greedy_virtual, mesh, greedy.Rules(GUARDED, monotone))
    validate_connectivity(mesh)
    assert progress.state == greedy.CONVERGED


@pytest.mark.heavy
def test_literal_descent_without_memory_does_go_round_in_circles():
    mesh = build(*meshes.torus(200, None, 1))
    seen = set()
    for _ in range(2000):
        gains = [
            (virtual.cost_reduction(mesh, h), h)
            for h in np.flatnonzero(mesh.twin > np.arange(len(mesh.twin)))
            if can_flip(mesh, h)
        ]
        gain, h = max(gains)
        assert gain > 1e-7
        flip(mesh, h)
        state = frozenset(pair(*ends) for ends in _edges(mesh))
        if state in seen:
            return
        seen.add(state)
    pytest.fail("no triangulation came back")


def _edges(mesh):
    inner = mesh.twin >= 0
    return np.column_stack([mesh.origin[inner], mesh.origin[mesh.twin[inner]]])
