"""The greedy search against one that scans all edges before each flip."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from meshlab_willmore import guards
from meshlab_willmore.energy import virtual, willmore
from meshlab_willmore.guards.bvh import build_bvh, inactive_bvh
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import NONE, apex, flip
from meshlab_willmore.search import containers, greedy
from meshlab_willmore.search.compiled import KERNELS
from meshlab_willmore.search.rules import CONVERGED, STOPPED, Rules
from tests import meshes
from tests.connectivity import can_flip, validate_connectivity
from tests.guards import brute
from tests.search.ways import rules_for, shuffled

ENERGIES = {"virtual willmore": virtual.cost_reduction, "willmore": willmore.cost_reduction}
VIRTUAL = KERNELS["virtual willmore"]
ENERGIES_AND_RULES = [("virtual willmore", True), ("virtual willmore", False), ("willmore", True)]


def flippable(mesh):
    return [h for h in range(len(mesh.origin)) if can_flip(mesh, h)]


def arrays_of(mesh):
    return mesh.vertices, faces_of(mesh)


MESHES = {
    "closed": meshes.bumpy_sphere(60),
    "boundary": meshes.patch(60),
    "flat boundary": meshes.patch(60, height=0.0),
    "cube": meshes.cube(0.1),
    "fin": meshes.fin()[:2],
    "bow tie": meshes.bow_tie(),
    "shuffled": arrays_of(shuffled(20, 1)),
}
GUARDED, FREE = guards.fold_limits(90.0), guards.fold_limits(180.0, 0.0)
# More flips than any of these runs needs: a search that went round in circles would end too.
MANY = 20_000


def pair(a, b):
    return frozenset((int(a), int(b)))


def flips_by_scanning(mesh, rules, cost_reduction, is_blocked=lambda mesh, h: False):
    """Make all flips of the pseudocode on `mesh`; return their number and total gain."""
    gone, gains = set(), []
    for _ in range(MANY):
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
        free = (entry for entry in sorted(candidates) if not is_blocked(mesh, entry[1]))
        _, h, stays_away = next(free, (None, None, None))
        if h is None:
            return len(gains), math.fsum(gains)
        if stays_away:
            gone.add(pair(mesh.origin[h], mesh.origin[mesh.twin[h]]))
        before = willmore.total(mesh)
        gains.append(cost_reduction(mesh, h))
        flip(mesh, h)
        validate_connectivity(mesh)
        if rules.monotone:
            assert willmore.total(mesh) <= before + 1e-11
    pytest.fail("the flips do not end")


@pytest.mark.heavy
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("fold", [GUARDED, FREE])
@pytest.mark.parametrize(("energy", "monotone"), ENERGIES_AND_RULES)
@pytest.mark.slow
def test_the_queue_finds_what_a_scan_finds(energy, fold, monotone, name):
    kernels, cost_reduction = KERNELS[energy], ENERGIES[energy]
    rules = Rules(fold, monotone, MANY)
    scanned, searched = build(*MESHES[name]), build(*MESHES[name])
    flips, gain = flips_by_scanning(scanned, rules, cost_reduction)
    progress = greedy.run(kernels, searched, rules)
    validate_connectivity(searched)
    assert progress.flips == flips
    assert progress.gain == pytest.approx(gain, rel=1e-12)
    assert progress.state == CONVERGED
    np.testing.assert_array_equal(faces_of(searched), faces_of(scanned))


# Meshes on which the guard has something to do for every energy and rule.
CROWDED = {
    "crumpled sheet": meshes.crumpled(4, noise=0.7),
    # Here an edge is blocked, and freed again.
    "freed": meshes.crumpled(4, 137, noise=0.9),
    "noisy sphere": meshes.bumpy_sphere(30, bump=0.95),
    "cut by a giant face": meshes.with_giant_face(
        *meshes.bumpy_sphere(30, 3, bump=0.6), [(9, 9, 0.1), (-9, 9, 0), (0, -19, 0.2)]
    ),
}


@pytest.mark.heavy
@pytest.mark.parametrize("name", CROWDED)
@pytest.mark.parametrize(("energy", "monotone"), ENERGIES_AND_RULES)
@pytest.mark.slow
def test_blocked_edges_are_tried_again_once_a_scan_would(energy, monotone, name):
    kernels, cost_reduction = KERNELS[energy], ENERGIES[energy]
    rules = Rules(FREE, monotone, MANY)
    scanned, searched = build(*CROWDED[name]), build(*CROWDED[name])
    unguarded = build(*CROWDED[name])
    flips, _ = flips_by_scanning(
        scanned, rules, cost_reduction, lambda mesh, h: bool(brute.blockers(mesh, h))
    )
    progress = greedy.run(kernels, searched, rules, build_bvh(searched))
    validate_connectivity(searched)
    np.testing.assert_array_equal(faces_of(searched), faces_of(scanned))
    assert progress.flips == flips
    assert progress.state == CONVERGED
    greedy.run(kernels, unguarded, rules)
    assert (faces_of(unguarded) != faces_of(searched)).any()


@pytest.mark.parametrize(("count", "seed"), [(8, 7), (8, 15), (12, 106), (20, 1), (20, 30)])
def test_an_edge_freed_by_a_flip_elsewhere_is_flipped_too(count, seed):
    """A flip that is forbidden because its edge exists becomes possible when that edge goes.

    In these meshes that edge is not among the 13 around the flip, and the gain is worth taking.
    """
    rules = Rules(FREE, True, MANY)
    mesh = shuffled(count, seed)
    greedy.run(KERNELS["willmore"], mesh, rules)
    gains = [willmore.cost_reduction(mesh, h) for h in flippable(mesh)]
    assert max(gains) <= rules.tolerance


@pytest.mark.parametrize("energy", ENERGIES)
def test_maxflips_stops_on_the_way(energy):
    kernels = KERNELS[energy]
    everything = greedy.run(kernels, build(*MESHES["closed"]), Rules(GUARDED, True, MANY))
    gains = []
    for limit in range(everything.flips + 2):
        progress = greedy.run(kernels, build(*MESHES["closed"]), Rules(GUARDED, True, limit))
        assert progress.flips == min(limit, everything.flips)
        done = limit >= everything.flips
        assert progress.state == (CONVERGED if done else STOPPED)
        gains.append(progress.gain)
    assert (np.diff(gains[:-1]) > 0.0).all()
    assert gains[-1] == gains[-2] == everything.gain


@pytest.mark.parametrize("monotone", [True, False])
def test_the_cycle_on_a_random_torus_ends(monotone):
    """Literal descent on the virtual energy goes round a 4-cycle for ever on this mesh."""
    vertices, faces = meshes.torus(200, None, 1)
    mesh = build(vertices, faces)
    progress = greedy.run(VIRTUAL, mesh, Rules(GUARDED, monotone, MANY))
    validate_connectivity(mesh)
    assert progress.state == CONVERGED


@pytest.mark.heavy
def test_ties_do_not_go_round_in_circles():
    """A tie so large that every flip counts as one: what a tie flipped away stays away."""
    mesh = build(*meshes.torus(200, None, 1))
    progress = greedy.run(VIRTUAL, mesh, Rules(FREE, True, MANY, tie=100.0))
    assert progress.state == CONVERGED
    assert progress.flips > 100


def all_but(mesh, *free):
    """Lock all edges but those of the half-edges `free`."""
    mesh.locked[:] = True
    for h in free:
        mesh.locked[[h, mesh.twin[h]]] = False
    return mesh


def tuned(quantity, target):
    """A mesh and a half-edge at which `quantity` has a given value, by moving the vertex k.

    Both cost reductions change sign near there, or the virtual one is large.
    """
    vertices, faces = meshes.bumpy_sphere(24)
    mesh = build(vertices, faces)
    steps = np.linspace(0.7, 1.3, 13)
    for h in flippable(mesh):
        k = apex(mesh, h)
        place = vertices[k].copy()

        def excess(step, h=h, k=k, place=place):
            vertices[k] = step * place
            return quantity(mesh, h) - target

        signs = np.sign([excess(step) for step in steps])
        for s in np.flatnonzero(signs[1:] != signs[:-1]):
            excess(brentq(excess, steps[s], steps[s + 1], xtol=1e-15, rtol=1e-15))
            found = quantity(mesh, h)
            worth = quantity is virtual.cost_reduction or virtual.cost_reduction(mesh, h) > 0.01
            if worth and abs(found - target) < 5e-14:
                return vertices, faces, h
        vertices[k] = place
    return pytest.fail("no mesh of this family has such an edge")


@pytest.mark.parametrize(
    ("drop", "options", "flips"),
    [
        (1e-8, {}, 1),
        (-5e-13, {}, 1),
        (-2e-12, {}, 0),
        (-1e-8, {}, 0),
        (-1e-8, {"tie": 1e-7}, 1),
        (-1e-8, {"monotone": False}, 1),
    ],
)
def test_the_monotone_rule_forgives_rounding_only(drop, options, flips):
    vertices, faces, h = tuned(willmore.cost_reduction, drop)
    rules = Rules(FREE, maxflips=MANY)._replace(**options)
    mesh = all_but(build(vertices, faces), h)
    assert greedy.run(VIRTUAL, mesh, rules).flips == flips


@pytest.mark.parametrize(("gain", "flips"), [(0.9e-7, 0), (1.1e-7, 1), (-1.1e-7, 0)])
def test_a_flip_must_be_worth_more_than_the_tolerance(gain, flips):
    vertices, faces, h = tuned(virtual.cost_reduction, gain)
    mesh = all_but(build(vertices, faces), h)
    rules = Rules(FREE, False, MANY)
    assert greedy.run(VIRTUAL, mesh, rules).flips == flips


@pytest.mark.parametrize(("ahead", "first"), [(3e-10, 0), (5e-9, 1), (-5e-9, 0)])
def test_gains_that_differ_by_rounding_only_go_by_number(ahead, first):
    """Two components with one free edge each; the second has a gain larger by `ahead`."""
    one, faces, h = tuned(virtual.cost_reduction, 0.1)
    other, _, same = tuned(virtual.cost_reduction, 0.1 + ahead)
    assert same == h
    both = np.vstack([faces, faces + len(one)])
    free = h, h + faces.size
    mesh = all_but(build(np.vstack([one, other]), both), *free)
    greedy.run(VIRTUAL, mesh, Rules(FREE, False, maxflips=1))
    changed = (faces_of(mesh) != both).any(axis=1).reshape(2, -1).any(axis=1)
    assert changed.tolist() == [first == 0, first == 1]


@pytest.mark.heavy
@pytest.mark.parametrize(
    "place", [greedy.WORK_PER_CALL - 1, greedy.WORK_PER_CALL, greedy.WORK_PER_CALL + 1]
)
def test_no_half_edge_is_left_out_where_a_call_of_the_scoring_ends(place):
    """The one free edge, with a gain, is put at the end or the start of a call."""
    vertices, faces, h = tuned(virtual.cost_reduction, 0.1)
    far, filler = meshes.grid(90, 90)
    face, corner = divmod(place, 3)
    ahead = np.roll(faces, -(h // 3), axis=0)
    ahead[0] = np.roll(ahead[0], corner - h % 3)
    mesh = build(np.vstack([vertices, far]), np.vstack([filler[:face] + len(vertices), ahead]))
    all_but(mesh, place)
    assert place < mesh.twin[place]
    rules = Rules(FREE, False, MANY)
    assert greedy.run(VIRTUAL, mesh, rules).flips == 1


@pytest.mark.heavy
@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.parametrize("energy", ["willmore", "gaussian curvature"])
@pytest.mark.parametrize("more", [-1, 0, 1, 50])
def test_more_edges_than_are_scored_at_a_time_may_watch_a_face(more, energy):
    mesh, face = build(*meshes.bumpy_sphere(120, bump=0.6)), 5
    count, rules = greedy.ROOM + more, rules_for(energy)

    def state():
        heap = containers.empty_heap(len(mesh.origin))
        lists = containers.empty_watch_lists(len(mesh.origin) // 3)
        room = np.empty(greedy.ROOM, np.int32), np.empty(greedy.ROOM), np.zeros(1, np.int64)
        nothing = containers.empty_pair_set(), rules, inactive_bvh(), lists, np.zeros(1, bool)
        return greedy.GreedyState(mesh, KERNELS[energy].number, heap, *nothing, *room)

    def scorer(found):
        return greedy._Scorer(mesh, found.energy, rules, found.queue)

    watching = np.random.default_rng(0).permutation(len(mesh.origin))[:count]
    at_once, one_by_one = state(), state()
    for h in watching.tolist():
        containers.watch(at_once.watch_lists, h, face)
        greedy._score(scorer(one_by_one), np.array([h], np.int32), 1, np.empty(1))
    greedy._rescore_freed(at_once, scorer(at_once), face)
    assert at_once.watch_lists.first[face] == NONE
    assert ranked(at_once.queue) == ranked(one_by_one.queue)


def ranked(queue):
    places = range(queue.size[0])
    return {int(queue.item[place]): float(queue.priority[place]) for place in places}
