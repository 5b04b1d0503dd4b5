"""Annealing against a walk that looks at every state by itself."""

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.energy import willmore
from meshlab_willmore.guards.bvh import inactive_bvh
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import NONE, flip
from meshlab_willmore.search import annealing, greedy, snapshots
from meshlab_willmore.search.compiled import KERNELS
from meshlab_willmore.search.rules import CONVERGED, STOPPED, Schedule, Settings
from tests import meshes
from tests.connectivity import can_flip, validate_connectivity
from tests.search.ways import (
    FREE,
    MESHES,
    assert_equal,
    each_energy_and_mesh,
    ends,
    interrupted,
    least_energy,
    locked_edges,
    rules_for,
)

WILLMORE = KERNELS["willmore"]
# Hotter than the default: on meshes as small as these it has to be, to leave anything.
SHORT = Schedule(sweeps=20, seed=1, hot=0.5, cold=0.05)


def allowed_losses(mesh, rules):
    gains = [
        willmore.cost_reduction(mesh, h)
        for h in np.flatnonzero(mesh.twin > np.arange(len(mesh.twin)))
        if can_flip(mesh, h) and not guards.folds(mesh, h, rules.fold)
    ]
    return [-gain for gain in gains if gain < 0.0]


def walk_slowly(mesh, rules, schedule, loss):
    """Yield flips, cost reductions summed, energy and faces of all states, the start first."""
    random = np.random.default_rng(schedule.seed)
    ratio = schedule.cold / schedule.hot
    flips, drop = 0, 0.0
    yield flips, drop, willmore.total(mesh), faces_of(mesh)
    for sweep in range(schedule.sweeps):
        temperature = loss * schedule.hot * ratio ** (sweep / (schedule.sweeps - 1))
        for _ in range(len(mesh.origin) // 2):
            pick, chance = random.random(2)
            h = int(pick * len(mesh.origin))
            if not can_flip(mesh, h) or guards.folds(mesh, h, rules.fold):
                continue
            gain = willmore.cost_reduction(mesh, h)
            if gain < 0.0 and chance >= np.exp(gain / temperature):
                continue
            if flips == rules.maxflips:
                return
            flip(mesh, h)
            validate_connectivity(mesh)
            flips += 1
            drop += gain
            yield flips, drop, willmore.total(mesh), faces_of(mesh)


@pytest.mark.parametrize("name", ["closed", "boundary", "cube", "fin", "locked", "moebius band"])
@pytest.mark.slow
def test_the_walk_and_its_best_state_are_those_of_the_slow_one(name):
    rules = rules_for("willmore")
    mesh = MESHES[name]()
    greedy.run(WILLMORE, mesh, rules)
    losses = allowed_losses(mesh, rules)
    loss = annealing._median_loss(WILLMORE, mesh, rules)
    assert loss == pytest.approx(np.median(losses) if losses else 0.0, rel=1e-12)
    seen = list(walk_slowly(snapshots.copy_of(mesh), rules, SHORT, loss))
    start = snapshots.Snapshot(mesh, inactive_bvh(), 5, CONVERGED)
    last, best = annealing._anneal(WILLMORE, start, rules, SHORT, loss)
    assert last.flips == seen[-1][0] + 5
    assert last.flips > 20 + 5
    np.testing.assert_array_equal(faces_of(last.mesh), seen[-1][3])
    # No state is lower than the best, and the best one is one of them.
    energies = np.array([energy for _, _, energy, _ in seen])
    lowest = seen[best.flips - 5]
    assert energies.min() >= willmore.total(best.mesh) - rules.tolerance
    assert lowest[2] == pytest.approx(willmore.total(best.mesh), abs=1e-9)
    np.testing.assert_array_equal(np.sort(faces_of(best.mesh)), np.sort(lowest[3]))
    validate_connectivity(best.mesh)
    # The sum of the cost reductions does not drift away from the energy.
    drops = np.array([drop for _, drop, _, _ in seen])
    np.testing.assert_allclose(drops, energies[0] - energies, atol=1e-9)
    # Corners stay at their vertices through all the taking back.
    first = MESHES[name]()
    for found in (last, best):
        np.testing.assert_array_equal(found.mesh.origin, first.origin[found.mesh.corner])
        assert locked_edges(found.mesh) == locked_edges(first)


def test_the_best_state_lies_on_the_way_not_at_its_end():
    """Hot until the end, so that the state on the way is the one that counts."""
    mesh, rules = MESHES["closed"](), rules_for("willmore")
    hot = Schedule(sweeps=30, seed=3, hot=1.0, cold=1.0)
    begin = snapshots.Snapshot(mesh, inactive_bvh(), 0, CONVERGED)
    last, best = annealing._anneal(WILLMORE, begin, rules, hot, 1.0)
    assert 0 < best.flips < last.flips
    assert willmore.total(best.mesh) < willmore.total(last.mesh) - 1.0
    assert willmore.total(best.mesh) < willmore.total(mesh) - 1.0


@pytest.mark.heavy
@each_energy_and_mesh
@pytest.mark.slow
def test_never_worse_than_greedy_and_its_gain_is_the_drop(energy, name):
    kernels, rules = KERNELS[energy], rules_for(energy)
    start, greedily, mesh = MESHES[name](), MESHES[name](), MESHES[name]()
    wanted = greedy.run(kernels, greedily, rules)
    progress = annealing.run(kernels, mesh, rules, None, Settings(schedule=SHORT))
    validate_connectivity(mesh)
    assert progress.state == CONVERGED
    assert kernels.total(mesh) <= kernels.total(greedily)
    assert progress.flips >= wanted.flips
    drop = kernels.total(start) - kernels.total(mesh)
    assert progress.gain == pytest.approx(drop, rel=1e-12, abs=1e-12)
    assert locked_edges(mesh) == locked_edges(start)
    np.testing.assert_array_equal(mesh.origin, start.origin[mesh.corner])
    # Converged: nothing is left for greedy flips.
    again = snapshots.copy_of(mesh)
    assert greedy.run(kernels, again, rules).flips == 0


@pytest.mark.heavy
@pytest.mark.parametrize("monotone", [True, False])
@pytest.mark.slow
def test_the_virtual_energy_leads_and_the_true_one_judges(monotone):
    rules = rules_for("virtual willmore")._replace(monotone=monotone)
    mesh = build(*meshes.torus(200, None, 1))
    greedily, start = snapshots.copy_of(mesh), willmore.total(mesh)
    greedy.run(KERNELS["virtual willmore"], greedily, rules)
    schedule = Schedule(sweeps=100)
    progress = annealing.run(
        KERNELS["virtual willmore"], mesh, rules, None, Settings(schedule=schedule)
    )
    assert progress.gain == pytest.approx(start - willmore.total(mesh), rel=1e-12)
    assert willmore.total(mesh) < willmore.total(greedily) - 1.0
    if monotone:
        assert willmore.total(mesh) < start
        again = snapshots.copy_of(mesh)
        assert greedy.run(KERNELS["virtual willmore"], again, rules).flips == 0


def test_the_same_seed_gives_the_same_mesh_and_another_seed_another():
    rules, results = rules_for("willmore"), []
    for seed in (0, 0, 1):
        mesh = MESHES["closed"]()
        schedule = SHORT._replace(seed=seed, sweeps=8)
        begin = snapshots.Snapshot(mesh, inactive_bvh(), 0, CONVERGED)
        results.append(annealing._anneal(WILLMORE, begin, rules, schedule, 2.0)[0])
    assert results[0].flips == results[1].flips != results[2].flips
    assert_equal(results[0].mesh, results[1].mesh)
    assert (results[0].mesh.origin != results[2].mesh.origin).any()


@pytest.mark.parametrize("size", [1, 7, 59, 60, 61])
def test_the_size_of_a_call_changes_nothing(size, monkeypatch):
    def counting(state, progress, draws, temperature):
        sizes.append(len(draws))
        return WILLMORE.anneal(state, progress, draws, temperature)

    rules, schedule = rules_for("willmore"), SHORT._replace(sweeps=6)
    whole, in_parts, sizes = MESHES["closed"](), MESHES["closed"](), []
    wanted = annealing.run(WILLMORE, whole, rules, None, Settings(schedule=schedule))
    monkeypatch.setattr(annealing, "WORK_PER_CALL", size)
    kernels = WILLMORE._replace(anneal=counting)
    assert annealing.run(kernels, in_parts, rules, None, Settings(schedule=schedule)) == wanted
    assert_equal(whole, in_parts)
    edges = len(whole.origin) // 2
    assert sum(sizes) == 6 * edges
    assert max(sizes) == min(size, edges)


def test_an_interrupt_leaves_the_mesh_as_it_was():
    anneal, calls = interrupted(WILLMORE.anneal, 4)
    kernels, rules = WILLMORE._replace(anneal=anneal), rules_for("willmore")
    mesh = MESHES["closed"]()
    with pytest.raises(KeyboardInterrupt):
        annealing.run(kernels, mesh, rules, None, Settings(schedule=SHORT))
    assert calls[-1].flips > 0
    assert_equal(mesh, MESHES["closed"]())


def test_maxflips_counts_every_flip_on_the_way():
    schedule = Schedule(sweeps=10, seed=2, hot=0.6, cold=0.05)
    everything = annealing.run(
        WILLMORE, MESHES["closed"](), rules_for("willmore"), None, Settings(schedule=schedule)
    )
    greedily = greedy.run(WILLMORE, MESHES["closed"](), rules_for("willmore"))
    start = willmore.total(MESHES["closed"]())
    for limit in (0, 1, 5, greedily.flips, greedily.flips + 1, greedily.flips + 40, 10**6):
        mesh = MESHES["closed"]()
        rules = rules_for("willmore")._replace(maxflips=limit)
        progress = annealing.run(WILLMORE, mesh, rules, None, Settings(schedule=schedule))
        validate_connectivity(mesh)
        assert progress.flips <= limit
        assert progress.gain == pytest.approx(start - willmore.total(mesh), abs=1e-9)
        if limit < greedily.flips:
            assert progress.state == STOPPED
            assert progress.flips == limit
        else:
            assert progress.gain >= greedily.gain - 1e-9
    assert progress == everything


def test_a_walk_stops_at_the_limit():
    rules = rules_for("willmore")._replace(maxflips=12)
    begin = snapshots.Snapshot(MESHES["closed"](), inactive_bvh(), 5, CONVERGED)
    last, best = annealing._anneal(WILLMORE, begin, rules, SHORT, 2.0)
    assert last.flips == 12
    assert last.state == best.state == STOPPED
    assert 5 <= best.flips <= 12


def test_a_mesh_with_nothing_to_lose_is_left_alone():
    """Flat: no flip gains or loses anything that counts, or everything is locked."""
    mesh = MESHES["closed"]()
    mesh.locked[:] = mesh.twin != NONE
    progress = annealing.run(WILLMORE, mesh, rules_for("willmore"), None, Settings(schedule=SHORT))
    assert progress[1:] == (0, 0.0, CONVERGED)


OPTIMA = [
    (meshes.bumpy_sphere(6, 1, 0.6), 390),
    pytest.param(meshes.patch(9, 3, 0.6), 512, marks=pytest.mark.heavy),
    pytest.param(meshes.patch(9, 0, 0.6), 2976, marks=pytest.mark.heavy),
]


@pytest.mark.parametrize(("arrays", "count"), OPTIMA)
def test_the_best_of_all_triangulations_is_found(arrays, count):
    rules = rules_for("willmore", FREE)
    least, found = least_energy(*arrays)
    assert found == count
    greedily = build(*arrays)
    greedy.run(WILLMORE, greedily, rules)
    assert willmore.total(greedily) > least + 0.01
    reached = []
    for seed in range(5):
        mesh = build(*arrays)
        annealing.run(
            WILLMORE, mesh, rules, None, Settings(schedule=Schedule(sweeps=100, seed=seed, hot=1.0))
        )
        reached.append(willmore.total(mesh))
    assert min(reached) == pytest.approx(least, abs=1e-9)


@pytest.mark.heavy
@pytest.mark.slow
def test_the_torus_comes_near_the_reference_figure():
    vertices, faces = meshes.torus(2000, 0.3, 8)
    for seed in (0, 1):
        mesh = build(vertices, faces)
        annealing.run(
            WILLMORE, mesh, rules_for("willmore"), None, Settings(schedule=Schedule(seed=seed))
        )
        energy = willmore.total(mesh) - 2.0 * np.pi * len(vertices)
        assert 115.75 < energy < 1.02 * 115.754


def test_no_edge_of_a_face_that_is_not_selected_moves():
    mesh = MESHES["locked"]()
    kept = locked_edges(mesh)
    moved = {ends(mesh, h) for h in range(len(mesh.origin))}
    annealing.run(WILLMORE, mesh, rules_for("willmore", FREE), None, Settings(schedule=SHORT))
    now = {ends(mesh, h) for h in range(len(mesh.origin))}
    assert kept <= now
    assert now != moved
