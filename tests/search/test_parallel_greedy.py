"""The greedy search in rounds against one that scans all edges, and what makes rounds sound."""

import math

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.energy import table, willmore
from meshlab_willmore.guards.bvh import build_bvh, expand, inactive_bvh
from meshlab_willmore.measure import self_intersections
from meshlab_willmore.mesh import parallel
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import apex, flip, following, is_free, makes_new_edge, previous
from meshlab_willmore.optimize import optimize_flips
from meshlab_willmore.search import parallel_greedy, rounds
from meshlab_willmore.search.compiled import KERNELS
from meshlab_willmore.search.containers import NEVER
from meshlab_willmore.search.parallel_greedy import NO_MAXIMUM
from meshlab_willmore.search.rounds import Candidates, initial_state
from meshlab_willmore.search.rules import (
    ALLOWED,
    CONVERGED,
    EXISTS,
    INTERSECTS,
    STOPPED,
    Settings,
)
from tests import meshes, reference
from tests.combinations import BOTH_WILLMORE, ENERGIES, ENERGIES_AND_RULES
from tests.connectivity import validate_connectivity
from tests.search.ways import FREE, GUARDED, MESHES, rules_for, shuffled

HEAVY = pytest.mark.heavy
ALL_MESHES = {**MESHES, "shuffled": lambda: shuffled(20, 1)}
SCORED_IN_BATCHES = (*BOTH_WILLMORE, "area", "delaunay", "mean curvature")


def with_thin_faces():
    """A bumpy sphere on which the gains of some edges take more than plain arithmetic."""
    vertices, faces = meshes.bumpy_sphere(60)
    for a, b, c in faces[::20]:
        vertices[a] = 0.5 * (vertices[b] + vertices[c]) + 1e-6
    return build(vertices, faces)


def pair(a, b):
    return frozenset((int(a), int(b)))


def ends(mesh, h):
    return pair(mesh.origin[h], mesh.origin[mesh.twin[h]])


def flipped_ends(mesh, h):
    return pair(apex(mesh, h), apex(mesh, mesh.twin[h]))


def edges_of(mesh):
    return [h for h in range(len(mesh.origin)) if h < mesh.twin[h]]


def six_faces(mesh, h):
    """The edges of the two faces at `h` and of those outside."""
    sides = [x for a in (h, mesh.twin[h]) for x in (following(a), previous(a))]
    faces = {h // 3, mesh.twin[h] // 3, *(mesh.twin[s] // 3 for s in sides if mesh.twin[s] >= 0)}
    half_edges = [3 * f + c for f in faces for c in range(3)]
    return {ends(mesh, x) for x in half_edges if mesh.twin[x] >= 0}


def rank_of(mesh, h, rules, energy):
    """The rank of an edge and whether its flip is a tie, or None."""
    if not is_free(mesh, h):
        return None
    gain, drop = KERNELS[energy].energy.cost_reduction(mesh, h), willmore.cost_reduction(mesh, h)
    if not gain > rules.tolerance or (rules.monotone and drop < -rules.tie):
        return None
    is_tie = not rules.is_potential and (not rules.monotone or drop <= 2 * rules.tie)
    return np.rint(gain / rules.rank_step), is_tie


def rounds_by_scanning(mesh, rules, energy):
    """Make the rounds on `mesh`, all edges scored each time; return the flips and their gain."""
    gone, asleep, gains = set(), {}, []
    while True:
        ranks = {}
        for h in edges_of(mesh):
            found = rank_of(mesh, h, rules, energy)
            if found and ends(mesh, h) not in asleep:
                number = int(rounds.scrambled(h))
                ranks[ends(mesh, h)] = (-found[0], number, h, found[1])
        if not ranks:
            return len(gains), math.fsum(gains)
        chosen = []
        for entry in ranks.values():
            around = [ranks[other] for other in six_faces(mesh, entry[2]) if other in ranks]
            if min(around) == entry:
                chosen.append(entry)
        flipped, is_new = [], {h: makes_new_edge(mesh, h) for _, _, h, _ in chosen}
        for _, _, h, is_tie in sorted(chosen):
            if guards.folds(mesh, h, rules.fold) or (is_tie and flipped_ends(mesh, h) in gone):
                asleep[ends(mesh, h)] = None
            elif not (is_new[h] and makes_new_edge(mesh, h)):
                asleep[ends(mesh, h)] = flipped_ends(mesh, h)
            else:
                if is_tie:
                    gone.add(ends(mesh, h))
                gains.append(KERNELS[energy].energy.cost_reduction(mesh, h))
                flip(mesh, h)
                flipped.append(h)
        validate_connectivity(mesh)
        half_edges = range(len(mesh.origin))
        there = {pair(mesh.origin[h], mesh.origin[following(h)]) for h in half_edges}
        awake = {edge for h in flipped for edge in six_faces(mesh, h)}
        awake |= {edge for edge, wanted in asleep.items() if wanted and wanted not in there}
        asleep = {edge: wanted for edge, wanted in asleep.items() if edge not in awake}


@HEAVY
@pytest.mark.parametrize("name", ALL_MESHES)
@pytest.mark.parametrize("fold", [GUARDED, FREE])
@pytest.mark.parametrize(
    ("energy", "monotone"),
    [p for p in ENERGIES_AND_RULES if not table.ENERGIES[p.values[0]].is_wide],
)
@pytest.mark.slow
def test_the_rounds_are_those_of_a_scan(energy, fold, monotone, name):
    rules = rules_for(energy, fold)._replace(monotone=monotone)
    scanned, searched = ALL_MESHES[name](), ALL_MESHES[name]()
    flips, gain = rounds_by_scanning(scanned, rules, energy)
    progress = parallel_greedy.run(KERNELS[energy], searched, rules)
    validate_connectivity(searched)
    assert progress.flips == flips
    assert progress.gain == pytest.approx(gain, rel=1e-12)
    assert progress.state == CONVERGED
    np.testing.assert_array_equal(faces_of(searched), faces_of(scanned))


def scored(mesh, rules, energy, bvh=None):
    """The state after the first score, its candidates, and their number."""
    state = initial_state(mesh, rules, inactive_bvh() if bvh is None else bvh)
    KERNELS[energy].score(state, 0, len(state.dirty))
    return state, rounds.add_ranked(state, len(state.dirty), 0)


@pytest.mark.parametrize("energy", SCORED_IN_BATCHES)
@pytest.mark.parametrize("name", ["closed", "boundary", "fin", "locked", "shuffled", "thin"])
def test_many_edges_at_once_get_the_bits_that_each_gets_alone(energy, name):
    mesh = with_thin_faces() if name == "thin" else ALL_MESHES[name]()
    state, _ = scored(mesh, rules_for(energy, FREE), energy)
    ranked = [h for h in edges_of(mesh) if state.rank[h] > NEVER]
    assert ranked
    for h in edges_of(mesh):
        found = rank_of(mesh, h, state.rules, energy)
        assert (found is not None) == (h in ranked)
        assert state.rank[h] == state.rank[mesh.twin[h]] == (found[0] if found else NEVER)
        if found:
            assert state.gain[h] == KERNELS[energy].energy.cost_reduction(mesh, h)
            assert state.is_tie[h] == found[1]


def maxima_of(state, edges, number=1):
    """The verdict on each edge, the maxima in order, and the places where their parts begin."""
    edges = np.array(edges, np.int32)
    candidates = Candidates(state, edges, np.empty(len(edges), np.int8))
    parallel_greedy.find_maxima(candidates, 0, len(edges))
    with parallel.thread_pool(1) as parallel_for:
        return candidates.verdict, *parallel_greedy.in_order(candidates, number, 0, parallel_for)


def flip_in_order(maxima, places):
    with parallel.thread_pool(1) as parallel_for:
        return parallel_greedy._flip_all(maxima, *places, 10**6, 1, parallel_for)


def flip_all(state, edges):
    """Flip the maxima among the edges in one round; return the state, those, and what was done."""
    _, chosen, *places = maxima_of(state, edges)
    state, done = flip_in_order(chosen, places)
    return state, list(state.done[: done.flipped]), done


@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.slow
def test_the_order_of_the_flips_of_a_round_does_not_matter(energy, seed):
    mesh = build(*meshes.bumpy_sphere(120, seed, bump=0.7))
    state, count = scored(mesh, rules_for(energy, FREE), energy)
    candidates = state.ranked[:count].copy()
    verdict, *_ = maxima_of(state, candidates, 7)
    state, chosen, done = flip_all(state, candidates)
    assert len(chosen) > 1
    assert set(chosen) <= set(candidates[verdict == ALLOWED])
    assert (
        table.ENERGIES[energy].is_wide
        or len(chosen) + done.refused == (verdict != NO_MAXIMUM).sum()
    )
    other = build(*meshes.bumpy_sphere(120, seed, bump=0.7))
    gains = []
    for h in np.random.default_rng(seed).permutation(chosen):
        assert makes_new_edge(other, h)
        gains.append(KERNELS[energy].energy.cost_reduction(other, h))
        assert gains[-1] == pytest.approx(state.gain[h], rel=1e-12)
        flip(other, h)
    np.testing.assert_array_equal(other.origin, mesh.origin)
    np.testing.assert_array_equal(other.twin, mesh.twin)
    assert done.gain == pytest.approx(math.fsum(gains), rel=1e-12)


def with_ranks(mesh, ranks, bvh=None):
    """A state on which just these edges have a rank."""
    state = initial_state(mesh, rules_for("willmore", FREE), inactive_bvh() if bvh is None else bvh)
    for h, rank in ranks.items():
        state.rank[h] = state.rank[mesh.twin[h]] = rank
    return state


@pytest.mark.parametrize("larger", [0, 1])
def test_of_two_flips_to_the_same_edge_the_smaller_waits_until_it_is_gone(larger):
    mesh = build(*meshes.bipyramid(8))
    ring = [h for h in edges_of(mesh) if flipped_ends(mesh, h) == {8, 9}]
    assert len(ring) == 8
    two = ring[0], ring[4]
    one, other = two[larger], two[1 - larger]
    state = with_ranks(mesh, {one: 2.0, other: 1.0})
    verdict, *_ = maxima_of(state, two, 7)
    assert list(verdict) == [ALLOWED, ALLOWED]
    state, flipped, done = flip_all(state, two)
    assert flipped == [one]
    assert list(state.done[-done.refused :]) == [other]
    assert state.rank[other] == NEVER
    validate_connectivity(mesh)
    assert ends(mesh, one) == {8, 9}
    # In a later round the edge is there already.
    state.rank[other] = state.rank[mesh.twin[other]] = 1.0
    verdict, *_ = maxima_of(state, [other], 2)
    assert list(verdict) == [EXISTS]
    # Once it is flipped away, the edge that waits is looked at again.
    for _ in range(3):
        flip(mesh, one)
    state.done[0] = one
    with parallel.thread_pool(1) as parallel_for:
        size = rounds.list_dirty(state, 1, parallel_for)
    assert other in state.dirty[:size]


def test_edges_of_equal_gain_do_not_wait_for_the_first_of_all():
    mesh = build(*meshes.grid(12, 12))
    edges = [h for h in edges_of(mesh) if is_free(mesh, h)]
    state = with_ranks(mesh, dict.fromkeys(edges, 1.0))
    verdict, *_ = maxima_of(state, edges)
    chosen = {h for h, what in zip(edges, verdict, strict=True) if what != NO_MAXIMUM}
    assert len(chosen) > len(edges) / 26
    for h in chosen:
        around = {x for x in edges if ends(mesh, x) in six_faces(mesh, h)}
        assert chosen & around == {h}


@pytest.mark.heavy
@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("name", ["closed", "locked", "shuffled"])
def test_the_number_of_threads_changes_nothing(energy, name, monkeypatch):
    results, gains = [], []
    for threads, chunk in ((2, 2048), (1, 7), (4, 7), (3, 1), (6, 16)):
        monkeypatch.setattr(parallel, "CHUNK", chunk)
        monkeypatch.setattr(rounds, "CHUNK", 3 * chunk)
        # To look at all candidates, or at those around changes only, must be the same.
        monkeypatch.setattr(parallel_greedy, "ACTIVE_PER_CHANGE", 10 * (threads % 2))
        mesh = ALL_MESHES[name]()
        progress = parallel_greedy.run(
            KERNELS[energy], mesh, rules_for(energy), None, Settings(threads=threads)
        )
        results.append((progress.flips, mesh.origin.tobytes(), mesh.corner.tobytes()))
        gains.append(progress.gain)
    assert all(result == results[0] for result in results)
    assert results[0][0] > 0 or energy == "gaussian curvature"
    # The order of a sum may depend on the way, but not on the threads.
    assert gains[0] == gains[2] == gains[4]
    np.testing.assert_allclose(gains, gains[0], rtol=1e-13)


@HEAVY
@pytest.mark.parametrize("energy", [e for e in KERNELS if table.ENERGIES[e].is_potential])
@pytest.mark.parametrize("name", ALL_MESHES)
def test_nothing_is_left_to_gain_and_the_gain_is_the_drop(energy, name):
    mesh, rules = ALL_MESHES[name](), rules_for(energy)
    before = KERNELS[energy].total(mesh)
    progress = parallel_greedy.run(KERNELS[energy], mesh, rules)
    validate_connectivity(mesh)
    assert progress.gain == pytest.approx(before - KERNELS[energy].total(mesh), rel=1e-9, abs=1e-9)
    for h in edges_of(mesh):
        if rank_of(mesh, h, rules, energy) and makes_new_edge(mesh, h):
            assert guards.folds(mesh, h, rules.fold)


@HEAVY
@pytest.mark.parametrize("energy", KERNELS)
@pytest.mark.parametrize("model", [(2000, 0.3, 8), (2000, None, 1)])
@pytest.mark.slow
def test_rounds_end_as_low_as_the_queue(energy, model):
    vertices, faces = meshes.torus(*model)
    total = KERNELS[energy].total
    in_rounds, by_queue = [
        total(build(vertices, optimize_flips(vertices, faces, energy=energy, search=search).faces))
        for search in ("parallel greedy", "greedy")
    ]
    # In the absolute Gaussian curvature local minima are many.
    slack = 0.03 if table.ENERGIES[energy].is_wide else 0.01
    assert in_rounds <= (1.0 + slack) * by_queue


@pytest.mark.parametrize("energy", BOTH_WILLMORE)
@pytest.mark.parametrize("limit", [0, 1, 5])
def test_maxflips_stops_on_the_way(energy, limit):
    mesh = ALL_MESHES["closed"]()
    rules = rules_for(energy)._replace(maxflips=limit)
    progress = parallel_greedy.run(KERNELS[energy], mesh, rules)
    assert (progress.flips, progress.state) == (limit, STOPPED)
    validate_connectivity(mesh)


@HEAVY
@pytest.mark.parametrize("energy", KERNELS)
@pytest.mark.slow
def test_with_the_guard_edges_that_would_cut_are_tried_again(energy):
    mesh = build(*meshes.bumpy_sphere(150, bump=0.95))
    bvh = build_bvh(mesh)
    rules = rules_for(energy, FREE)
    progress = parallel_greedy.run(KERNELS[energy], mesh, rules, bvh)
    assert progress.state == CONVERGED
    assert progress.flips > 0
    for h in edges_of(mesh):
        if rules.is_potential and rank_of(mesh, h, rules, energy) and makes_new_edge(mesh, h):
            assert guards.intersections.would_intersect(mesh, bvh, h)


@pytest.mark.parametrize("gap", [1.0, 3.0])
def test_two_flips_of_a_round_do_not_cut_each_other(gap):
    """Two bent squares face each other crosswise; flipped, each has its ridge near the other."""
    low = [(-1, 0, -1), (1, 0, -1), (0, 1, 1), (0, -1, 1)]
    high = [(y, x, gap - z) for x, y, z in low]
    faces = np.array([(0, 1, 2), (1, 0, 3), (4, 5, 6), (5, 4, 7)], np.int32)
    mesh = build(np.array(low + high, float) / 4, faces)
    bvh = build_bvh(mesh)
    two = edges_of(mesh)
    assert [ends(mesh, h) for h in two] == [{0, 1}, {4, 5}]
    state = with_ranks(mesh, {two[0]: 1.0, two[1]: 2.0}, bvh)
    verdict, *_ = maxima_of(state, two, 7)
    assert list(verdict) == [ALLOWED, ALLOWED]
    state, flipped, done = flip_all(state, two)
    if gap > 2.0:
        assert sorted(flipped) == two
    else:
        assert (flipped, done.refused, state.rank[two[0]]) == ([two[1]], 1, NEVER)
        # It waits until that face changes again.
        flip(mesh, two[1])
        state.done[0] = two[1]
        with parallel.thread_pool(1) as parallel_for:
            size = rounds.list_dirty(state, 1, parallel_for)
        assert two[0] in state.dirty[:size]
    assert not self_intersections(mesh.vertices, faces_of(mesh)).any()


@HEAVY
def test_many_flips_of_a_round_are_shared_among_threads():
    results = []
    for threads in (1, 3):
        mesh = build(*meshes.torus(30_000, 0.3, 8))
        rules = rules_for("virtual willmore")
        settings = Settings(threads=threads)
        progress = parallel_greedy.run(KERNELS["virtual willmore"], mesh, rules, None, settings)
        results.append((progress, mesh.origin.tobytes(), mesh.twin.tobytes()))
    assert results[0][0].flips > 4 * parallel_greedy.FLIPS_PER_SUM
    assert results[0] == results[1]
    validate_connectivity(mesh)


@HEAVY
@pytest.mark.parametrize("seed", range(4))
def test_with_the_guard_too_the_number_of_threads_changes_nothing(seed, monkeypatch):
    vertices, faces = meshes.crumpled(11, seed, noise=1.5)
    monkeypatch.setattr(parallel, "CHUNK", 5)
    known, results = set(map(frozenset, faces.tolist())), []
    for threads in (1, 3):
        mesh = build(vertices, faces)
        rules = rules_for("willmore", FREE)
        parallel_greedy.run(
            KERNELS["willmore"],
            mesh,
            rules,
            build_bvh(mesh),
            Settings(threads=threads),
        )
        is_new = np.array([frozenset(f) not in known for f in faces_of(mesh).tolist()])
        assert is_new.any()
        assert not (self_intersections(vertices, faces_of(mesh)) & is_new).any()
        results.append(mesh.origin.tobytes())
    assert results[0] == results[1]


def freed_within_a_round():
    """A closed mesh on which one flip of a round takes away the cut that forbade another one.

    Both make the edge 3-4, which is of two faces already when the second one is freed.
    """
    vertices = np.array(
        [
            (0.41, 0.74, -0.54),
            (0.77, -0.27, -0.57),
            (0.98, 0.17, -0.13),
            (-0.48, 0.76, 0.43),
            (-0.29, 0.26, -0.92),
            (0.43, -0.57, 0.7),
        ]
    )
    faces = [(3, 1, 0), (5, 2, 3), (4, 1, 2), (1, 3, 2), (3, 0, 5), (0, 4, 5), (4, 0, 1), (2, 5, 4)]
    return vertices, np.array(faces, np.int32)


def test_what_a_cut_forbade_before_a_round_is_not_flipped_in_it():
    vertices, faces = freed_within_a_round()
    result = optimize_flips(vertices, faces, energy="area", checkintersections=True)
    assert result.flips > 1
    validate_connectivity(build(vertices, result.faces))
    assert reference.edge_set(result.faces) != reference.edge_set(faces)
    assert len(reference.edge_set(result.faces)) == len(reference.edge_set(faces)) == 12


@HEAVY
def test_what_must_not_be_flipped_waits_before_the_first_flip_of_a_round():
    mesh = build(*meshes.crumpled(11, noise=1.5))
    state, count = scored(mesh, rules_for("willmore", FREE), "willmore", build_bvh(mesh))
    _, chosen, *places = maxima_of(state, state.ranked[:count])
    is_allowed = chosen.verdict == ALLOWED
    assert INTERSECTS in chosen.verdict
    assert 0 < np.count_nonzero(~is_allowed) <= places[0] <= places[1]
    assert (np.sort(~is_allowed)[::-1] == ~is_allowed).all()
    blocked = chosen.edges[chosen.verdict == INTERSECTS]
    before = [ends(mesh, h) for h in blocked]
    state, done = flip_in_order(chosen, places)
    assert done.flipped > 0
    assert [ends(mesh, h) for h in blocked] == before
    assert (state.watch_lists.face[blocked] >= 0).all()
    assert (state.rank[blocked] == NEVER).all()


def test_a_new_state_forgets_the_rounds_of_a_run_before():
    mesh = build(*meshes.bumpy_sphere(60))
    bvh = build_bvh(mesh)
    expand(mesh, bvh, 0, 3)
    assert bvh.changed.max() == 3
    initial_state(mesh, rules_for("willmore"), bvh)
    assert not bvh.changed.any()
