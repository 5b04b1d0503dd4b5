"""The variable-depth search against plain recursion."""

import math

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.energy import area, virtual, willmore
from meshlab_willmore.guards.bvh import build_bvh, inactive_bvh, refitted
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import NONE, flip
from meshlab_willmore.mesh.jit import jit
from meshlab_willmore.search import chains, containers, greedy, snapshots, variable_depth
from meshlab_willmore.search.compiled import KERNELS
from meshlab_willmore.search.rules import (
    CONVERGED,
    STOPPED,
    WORKING,
    ChainLimits,
    Progress,
    Rules,
    Settings,
)
from tests import meshes, reference
from tests.combinations import products
from tests.connectivity import can_flip, validate_connectivity
from tests.guards import brute
from tests.search import ways
from tests.search.chain_scan import Scan
from tests.search.ways import FREE, GUARDED, ends, shuffled

# What ranks the edges; the Willmore energy judges.
ENERGIES = {"virtual willmore": virtual.cost_reduction, "willmore": willmore.cost_reduction}
LIMITS = [ChainLimits(1, 1), ChainLimits(2, 1), ChainLimits(3, 2), ChainLimits(4, 3)]


MESHES = {name: mesh for name, mesh in ways.MESHES.items() if len(mesh().origin) > 6}
MESHES["shuffled"] = lambda: shuffled(20, 1)


def search(energy, mesh, rules, limits):
    return variable_depth.run(KERNELS[energy], mesh, rules, None, Settings(limits))


@jit
def find_chain(state, h):
    """Call `chains.find_chain`, which is for kernels."""
    return chains.find_chain(state, h)


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("energy", "limits", "fold", "name"), products(ENERGIES, LIMITS, [GUARDED, FREE], MESHES)
)
@pytest.mark.slow
def test_the_search_finds_what_a_scan_finds(energy, limits, fold, name):
    """Also that to try again the edges near a change is as good as to try all again."""
    rank, judge = ENERGIES[energy], willmore.cost_reduction
    rules = Rules(fold)
    scanned, searched = MESHES[name](), MESHES[name]()
    flips = greedy.run(KERNELS[energy], scanned, rules).flips
    flips += sum(Scan(rules, limits, rank, judge).search(scanned))
    progress = search(energy, searched, rules, limits)
    validate_connectivity(searched)
    np.testing.assert_array_equal(faces_of(searched), faces_of(scanned))
    assert progress.flips == flips
    assert progress.state == CONVERGED


# Meshes on which the guard has something to do.
CROWDED = {
    "crumpled sheet": lambda: build(*meshes.crumpled(4, noise=0.7)),
    "two sheets": lambda: build(*meshes.two_sheets(24, 1, gap=0.001)),
    "noisy sphere": lambda: build(*meshes.bumpy_sphere(30, bump=0.95)),
}


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("limits", "name"),
    [
        *((ChainLimits(2, 1), name) for name in CROWDED),
        (ChainLimits(3, 2), "crumpled sheet"),
        pytest.param(ChainLimits(3, 2), "two sheets", marks=pytest.mark.nightly),
        pytest.param(ChainLimits(3, 2), "noisy sphere", marks=pytest.mark.nightly),
    ],
)
@pytest.mark.slow
def test_chains_blocked_by_cuts_are_tried_again_once_a_scan_would(limits, name):
    rank = judge = willmore.cost_reduction
    kernels, rules = KERNELS["willmore"], Rules(FREE)
    scanned, searched, unguarded = (CROWDED[name]() for _ in range(3))

    def is_blocked(mesh, h):
        return bool(brute.blockers(mesh, h))

    flips = greedy.run(kernels, scanned, rules, build_bvh(scanned)).flips
    flips += sum(Scan(rules, limits, rank, judge, is_blocked).search(scanned))
    bvh = build_bvh(searched)
    progress = variable_depth.run(kernels, searched, rules, bvh, Settings(limits))
    np.testing.assert_array_equal(faces_of(searched), faces_of(scanned))
    assert progress.flips == flips
    assert progress.state == CONVERGED
    search("willmore", unguarded, rules, limits)
    assert (faces_of(unguarded) != faces_of(searched)).any()
    # The index has followed the flips that were tried, made and taken back.
    np.testing.assert_array_equal(bvh.box, refitted(bvh, searched).box)


def find_ring(state, h):
    return chains.find_ring(state.mesh, h, state.chain.ring, state.chain.ring_size)


def new_state(mesh, rules, limits, energy="willmore"):
    """A state with every edge in the queue."""
    queue = containers.empty_fifo(len(mesh.origin))
    changed = np.zeros(len(mesh.vertices), bool)
    variable_depth.queue_marked(mesh, queue, ~changed)
    return chains.ChainState(
        mesh,
        KERNELS[energy].number,
        KERNELS[energy].judges,
        queue,
        chains.empty_chain(limits),
        changed,
        rules,
        inactive_bvh(),
        np.zeros(len(mesh.origin), bool),
        np.zeros(1, bool),
    )


@pytest.mark.heavy
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("limits", [ChainLimits(3, 1), ChainLimits(5, 3)])
@pytest.mark.slow
def test_what_a_chain_tries_leaves_no_trace(limits, name):
    """Undone flips give back all arrays bit for bit, also the corners, which a flip merges."""
    mesh = MESHES[name]()
    before = snapshots.copy_of(mesh)
    state = new_state(mesh, Rules(FREE), limits)
    worked = 0
    for h in np.flatnonzero(mesh.twin != NONE):
        best, work = find_chain(state, h)
        worked += work
        for changed, kept in zip(mesh, before, strict=True):
            np.testing.assert_array_equal(changed, kept)
        # The prefix is worth what it says.
        after = snapshots.copy_of(mesh)
        for s in range(best[0]):
            assert can_flip(after, state.chain.best[s])
            flip(after, state.chain.best[s])
        drop = willmore.total(mesh) - willmore.total(after)
        assert best[2] == pytest.approx(drop, abs=1e-9)
        assert best[1] == best[2]
        assert best[0] == 0 or drop > 0.5e-7
    assert worked > 3 * len(mesh.origin)


@pytest.mark.heavy
@pytest.mark.slow
def test_the_chains_from_one_edge_are_bounded():
    """However deep and broad they may be, and on a mesh so small that they go round and round."""
    mesh = build(*meshes.bumpy_sphere(20, seed=2))
    before = snapshots.copy_of(mesh)
    state = new_state(mesh, Rules(FREE), ChainLimits(30, 12))
    best, work = find_chain(state, 0)
    assert best[0] == 0
    # The last step that was begun is scored as a whole.
    assert chains.MOST_WORK <= work < chains.MOST_WORK + chains.RING
    # What was tried last is taken back as ever.
    for changed, kept in zip(mesh, before, strict=True):
        np.testing.assert_array_equal(changed, kept)


@pytest.mark.parametrize("name", ["closed", "boundary", "shuffled"])
def test_the_ring_is_where_cost_reductions_change(name):
    mesh = MESHES[name]()
    for h in np.flatnonzero(mesh.twin > np.arange(len(mesh.twin)))[::7]:
        if not can_flip(mesh, h):
            continue
        flipped = snapshots.copy_of(mesh)
        flip(flipped, h)
        state = new_state(flipped, Rules(FREE), ChainLimits(1, 1))
        there = {ends(flipped, x) for x in state.chain.ring[: find_ring(state, h)]}
        gains = [
            {ends(m, x): virtual.cost_reduction(m, x) for x in np.flatnonzero(m.twin != NONE)}
            for m in (mesh, flipped)
        ]
        changed = {
            edge
            for edge in gains[0].keys() & gains[1].keys()
            if gains[0][edge] != pytest.approx(gains[1][edge], rel=1e-9, abs=1e-9)
        }
        assert changed <= there
        assert ends(flipped, h) not in there


@pytest.mark.parametrize(("count", "seed"), [(12, 23), (12, 32)])
def test_two_flips_help_where_no_single_one_does(count, seed):
    vertices, faces = meshes.bumpy_sphere(count, seed)
    rules = Rules(GUARDED)
    stuck = build(vertices, faces)
    assert search("willmore", stuck, rules, ChainLimits(1, 1)).flips == 0
    mesh = build(vertices, faces)
    progress = search("willmore", mesh, rules, ChainLimits(2, 1))
    assert progress.flips == 2
    assert progress.state == CONVERGED
    drop = reference.objective(vertices, faces) - reference.objective(vertices, faces_of(mesh))
    assert drop > 1e-3
    assert progress.gain == pytest.approx(drop, rel=1e-9)


@pytest.mark.heavy
@pytest.mark.parametrize("name", MESHES)
def test_chains_of_one_flip_are_plain_descent(name):
    greedily, searched = MESHES[name](), MESHES[name]()
    rules = Rules(GUARDED)
    wanted = greedy.run(KERNELS["willmore"], greedily, rules)
    found = search("willmore", searched, rules, ChainLimits(1, 12))
    np.testing.assert_array_equal(faces_of(searched), faces_of(greedily))
    assert (found.flips, found.state) == (wanted.flips, wanted.state)
    assert found.gain == pytest.approx(wanted.gain, abs=1e-9)


@pytest.mark.heavy
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.slow
def test_deeper_is_never_worse_than_greedy_and_a_minimum(energy, name):
    rules, limits = Rules(GUARDED), ChainLimits(4, 3)
    greedily, mesh = MESHES[name](), MESHES[name]()
    greedy.run(KERNELS[energy], greedily, rules)
    assert search(energy, mesh, rules, limits).state == CONVERGED
    assert willmore.total(mesh) <= willmore.total(greedily) + 1e-12
    state = new_state(mesh, rules, limits, energy)
    for h in np.flatnonzero(mesh.twin != NONE):
        if h < mesh.twin[h]:
            assert find_chain(state, h)[0][0] == 0
    again = snapshots.copy_of(mesh)
    progress = variable_depth.advance(state, Progress(0, 0, 0.0, WORKING))
    assert progress == (0, 0, 0.0, CONVERGED)
    np.testing.assert_array_equal(mesh.origin, again.origin)


@pytest.mark.heavy
@pytest.mark.parametrize("energy", ENERGIES)
def test_maxflips_stops_before_a_chain_that_exceeds_it(energy):
    limits = ChainLimits(3, 2)
    everything = search(energy, MESHES["closed"](), Rules(GUARDED), limits)
    energies, flips = [], []
    for limit in range(everything.flips + 2):
        mesh = MESHES["closed"]()
        progress = search(energy, mesh, Rules(GUARDED, True, limit), limits)
        validate_connectivity(mesh)
        assert limit - limits.depth - 1 < progress.flips <= limit or limit > everything.flips
        done = limit >= everything.flips
        assert progress.state == (CONVERGED if done else STOPPED)
        energies.append(willmore.total(mesh))
        flips.append(progress.flips)
    assert (np.diff(energies) <= 1e-12).all()
    assert (np.diff(flips) >= 0).all()
    assert flips[-1] == flips[-2] == everything.flips > 10


@pytest.mark.heavy
@pytest.mark.parametrize("monotone", [True, False])
def test_any_energy_will_do_and_the_monotone_rule_watches_the_true_one(monotone):
    """Chain by chain: the area falls, and the Willmore energy never rises under the rule."""
    rules, settings = Rules(GUARDED, monotone), Settings(ChainLimits(4, 3))
    kernels = KERNELS["area"]
    everything = variable_depth.run(kernels, MESHES["closed"](), rules, None, settings)
    totals = []
    for limit in range(everything.flips + 1):
        mesh = MESHES["closed"]()
        limited = rules._replace(maxflips=limit)
        progress = variable_depth.run(kernels, mesh, limited, None, settings)
        totals.append((area.total(mesh), willmore.total(mesh)))
        assert progress.gain == pytest.approx(totals[0][0] - totals[-1][0], abs=1e-9)
    areas, energies = np.array(totals).T
    assert (np.diff(areas) <= 1e-12).all()
    assert areas[-1] < areas[0]
    assert (np.diff(energies) <= 1e-9).all() == monotone


@pytest.mark.heavy
@pytest.mark.parametrize("energy", ENERGIES)
def test_locked_edges_stay_and_the_rest_improves(energy):
    mesh = MESHES["locked"]()
    locked = {ends(mesh, h) for h in np.flatnonzero(mesh.locked)}
    assert search(energy, mesh, Rules(FREE), ChainLimits(4, 3)).flips > 5
    assert locked == {ends(mesh, h) for h in np.flatnonzero(mesh.locked)}


@pytest.mark.heavy
@pytest.mark.slow
def test_every_flip_of_a_chain_passes_the_fold_guard():
    """The kept flips, made again one by one on the input."""
    mesh, rules, limits = MESHES["closed"](), Rules(GUARDED), ChainLimits(5, 3)
    greedy.run(KERNELS["willmore"], mesh, rules)
    state = new_state(mesh, rules, limits)
    flips = 0
    for h in np.flatnonzero(mesh.twin > np.arange(len(mesh.twin))):
        best, _ = find_chain(state, h)
        for s in range(best[0]):
            assert can_flip(mesh, state.chain.best[s])
            assert not guards.folds(mesh, state.chain.best[s], GUARDED)
            flip(mesh, state.chain.best[s])
            flips += 1
    assert flips > 10


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("count", "least"), [(800, 112.955), pytest.param(2000, 115.754, marks=pytest.mark.nightly)]
)
@pytest.mark.slow
def test_the_torus_ends_in_the_same_triangulation_whatever_the_start(count, least):
    """Two random flips an edge, and the energy comes down to the digit of the reference figure."""
    vertices, faces = meshes.torus(count, 0.3, 8)
    rules = Rules(GUARDED)
    results = []
    for seed in (None, 101, 102):
        mesh = build(vertices, faces)
        if seed is not None:
            _scramble(mesh, len(mesh.origin), np.random.default_rng(seed))
        assert search("willmore", mesh, rules, ChainLimits()).state == CONVERGED
        validate_connectivity(mesh)
        results.append(reference.edge_set(faces_of(mesh)))
        energy = willmore.total(mesh) - 2.0 * math.pi * len(vertices)
        assert energy == pytest.approx(least, abs=5e-4)
    assert results[0] == results[1] == results[2]


def _scramble(mesh, count, rng):
    while count > 0:
        for h in rng.integers(0, len(mesh.origin), count):
            if can_flip(mesh, h) and not guards.folds(mesh, h, GUARDED):
                flip(mesh, h)
                count -= 1


@pytest.mark.heavy
@pytest.mark.slow
def test_the_kernel_comes_back_often_and_two_runs_are_equal(monkeypatch):
    def counting(state, progress):
        calls.append(progress)
        return advance(state, progress)

    advance, results = variable_depth.advance, []
    monkeypatch.setattr(variable_depth, "advance", counting)
    for _ in range(2):
        calls = []
        mesh = build(*meshes.torus(800, None, 4))
        greedy_rules = Rules(GUARDED)
        variable_depth.run(KERNELS["willmore"], mesh, greedy_rules)
        results.append(mesh)
        assert len(calls) > 5
        assert [p.flips for p in calls] == sorted(p.flips for p in calls)
    for one, other in zip(*results, strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.heavy
def test_a_descent_along_another_energy_is_gone_on_from_where_it_ends_lower():
    rules, limits = ways.rules_for("willmore"), ChainLimits(2, 1)
    detour = ((KERNELS["delaunay"], ways.rules_for("delaunay")),)
    alone = ways.scramble(build(*meshes.torus(200, None, 1)), 4)
    mesh, before = snapshots.copy_of(alone), willmore.total(alone)
    search("willmore", alone, rules, limits)
    settings = Settings(limits, warm_starts=detour)
    progress = variable_depth.run(KERNELS["willmore"], mesh, rules, None, settings)
    assert willmore.total(mesh) < willmore.total(alone) - 1.0
    assert progress.gain == pytest.approx(before - willmore.total(mesh))
    assert progress.state == CONVERGED
    # What the other descent leads to from here is no better.
    assert variable_depth.run(KERNELS["willmore"], mesh, rules, None, settings).flips == 0


@pytest.mark.parametrize(
    ("limits", "wanted"),
    [
        (ChainLimits(1, 5), [1]),
        (ChainLimits(2, 5), [1, 5]),
        (ChainLimits(6, 5), [1, 5, 3, 2, 1, 1]),
        (ChainLimits(4, 1), [1, 1, 1, 1]),
        (ChainLimits(100, 12), [1, 12, 6, 3, 2] + [1] * 95),
    ],
)
def test_chains_branch_half_as_much_at_each_step(limits, wanted):
    assert chains._widths(limits).tolist() == wanted
