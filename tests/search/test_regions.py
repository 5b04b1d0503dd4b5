"""Parts of a mesh that are searched side by side."""

import threading

import numpy as np
import pytest

from meshlab_willmore.energy.table import ENERGIES
from meshlab_willmore.guards.bvh import build_bvh
from meshlab_willmore.measure import willmore_energy_of
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import NONE, flip, is_free
from meshlab_willmore.progress import listening
from meshlab_willmore.search import greedy, regions, variable_depth
from meshlab_willmore.search.compiled import KERNELS
from meshlab_willmore.search.rules import CONVERGED, ChainLimits, Progress, Settings
from meshlab_willmore.search.snapshots import copy_of
from tests import meshes
from tests.connectivity import can_flip, validate_connectivity
from tests.search.ways import locked_edges, rules_for, scramble

MESHES = {
    "closed": lambda: meshes.bumpy_sphere(150, bump=0.7),
    "with a boundary": lambda: meshes.patch(150),
    "in no order": lambda: meshes.hubs(60),
    "bow tie": meshes.bow_tie,
}
NOTHING = Progress(0, 0, 0.0, CONVERGED)
LIMITS = ChainLimits(3, 3)


@pytest.fixture(name="mesh", params=MESHES)
def _mesh(request, monkeypatch):
    monkeypatch.setattr(regions, "LEAST_FACES", 40)
    mesh = build(*MESHES[request.param]())
    for h in range(0, len(mesh.origin), 11):
        mesh.locked[h] = True
        if mesh.twin[h] != NONE:
            mesh.locked[mesh.twin[h]] = True
    return mesh


def regions_of(mesh):
    parts = regions._split(mesh)
    is_common = regions._common_vertices(mesh, parts)
    return [regions._region(mesh, part, is_common) for part in parts]


def test_every_face_is_in_one_part_and_none_is_small(mesh):
    parts = regions_of(mesh)
    faces = np.concatenate([part.faces for part in parts])
    assert sorted(faces.tolist()) == list(range(len(mesh.origin) // 3))
    if len(faces) >= 80:
        assert len(parts) > 1
        assert min(len(part.faces) for part in parts) >= 40


def test_vertices_of_several_parts_have_frozen_faces_only(mesh):
    parts = regions_of(mesh)
    for part in parts:
        np.testing.assert_array_equal(
            part.vertices[faces_of(part.mesh)], faces_of(mesh)[part.faces]
        )
        free = part.vertices[faces_of(part.mesh)[~part.frozen]]
        for other in parts:
            assert other is part or not np.isin(free, other.vertices).any()


@pytest.mark.parametrize("energy", ["virtual willmore", "gaussian curvature"])
def test_what_may_be_flipped_gains_what_it_does_in_the_whole_mesh(mesh, energy):
    cost_reduction = KERNELS[energy].energy.cost_reduction
    for part in regions_of(mesh):
        for h in range(len(part.mesh.origin)):
            if part.mesh.twin[h] == NONE or not is_free(part.mesh, h):
                continue
            there = 3 * part.faces[h // 3] + h % 3
            assert can_flip(part.mesh, h) == can_flip(mesh, there)
            assert cost_reduction(part.mesh, h) == cost_reduction(mesh, there)


def test_without_flips_nothing_changes(mesh):
    before = copy_of(mesh)
    progress, frozen = regions.run(lambda part, halted: NOTHING, mesh)
    assert (progress.flips, progress.gain) == (0, 0.0)
    for name in ("origin", "twin", "locked", "corner"):
        np.testing.assert_array_equal(getattr(mesh, name), getattr(before, name))
    kept = np.concatenate([part.faces[part.frozen] for part in regions_of(mesh)])
    assert np.flatnonzero(frozen).tolist() == sorted(set(faces_of(mesh)[kept].ravel().tolist()))


@pytest.mark.parametrize("seed", range(3))
def test_flips_in_parts_are_flips_of_the_mesh(mesh, seed):
    before = copy_of(mesh)
    kept = np.concatenate([part.faces[part.frozen] for part in regions_of(mesh)])

    def shuffle(part, halted):
        flips = 0
        for h in np.random.default_rng(seed).integers(0, len(part.origin), 300):
            if part.twin[h] != NONE and can_flip(part, h):
                flip(part, h)
                flips += 1
        return Progress(0, flips, 0.5 * flips, CONVERGED)

    progress, _ = regions.run(shuffle, mesh)
    validate_connectivity(mesh)
    assert progress.gain == 0.5 * progress.flips
    assert (progress.flips > 0) == (mesh.origin != before.origin).any()
    np.testing.assert_array_equal(faces_of(mesh)[kept], faces_of(before)[kept])
    assert locked_edges(mesh) == locked_edges(before)
    np.testing.assert_array_equal(before.origin[mesh.corner], mesh.origin)


def test_an_error_in_one_part_halts_the_others(monkeypatch):
    monkeypatch.setattr(regions, "LEAST_FACES", 150)
    mesh = build(*meshes.bumpy_sphere(200))
    started, halts = threading.Event(), []

    def search(part, halted):
        if started.is_set():
            raise KeyboardInterrupt
        started.set()
        while not halted:
            pass
        halts.append(part)
        return NOTHING

    before = mesh.origin.copy()
    with pytest.raises(KeyboardInterrupt):
        regions.run(search, mesh, threads=2)
    assert len(halts) == 1
    np.testing.assert_array_equal(mesh.origin, before)


def searched(mesh, energy, threads=None, bvh=None):
    settings = Settings(LIMITS, threads=threads)
    return variable_depth.run(KERNELS[energy], mesh, rules_for(energy), bvh, settings)


@pytest.mark.heavy
@pytest.mark.parametrize("energy", ["virtual willmore", "willmore", "delaunay"])
@pytest.mark.slow
def test_chains_in_regions_do_not_depend_on_threads_and_leave_none(energy, monkeypatch):
    vertices, faces = meshes.torus(600, None, 1)
    whole = build(vertices, faces)
    searched(whole, energy)
    monkeypatch.setattr(regions, "LEAST_FACES", 120)
    results = []
    for threads in (1, 2, 5):
        mesh = build(vertices, faces)
        progress = searched(mesh, energy, threads)
        validate_connectivity(mesh)
        assert progress.state == CONVERGED
        results.append((progress.flips, progress.gain, mesh.origin.tobytes()))
    assert results[0] == results[1] == results[2]
    total = KERNELS[energy].total
    assert total(mesh) <= 1.02 * total(whole)
    if ENERGIES[energy].is_potential:
        drop = total(build(vertices, faces)) - total(mesh)
        assert progress.gain == pytest.approx(drop, rel=1e-9)
    # In the whole mesh at once there is no chain left either.
    monkeypatch.undo()
    assert searched(mesh, energy).flips == 0


@pytest.mark.heavy
def test_in_regions_too_the_stretched_torus_gets_as_low_as_from_any_start(monkeypatch):
    monkeypatch.setattr(regions, "LEAST_FACES", 400)
    mesh = build(*meshes.torus(2000, 0.3, 8))
    searched(mesh, "willmore")
    assert willmore_energy_of(mesh) == pytest.approx(115.7535, abs=1e-3)


@pytest.mark.heavy
def test_with_the_guard_or_a_limit_the_mesh_is_searched_as_a_whole(monkeypatch):
    monkeypatch.setattr(regions, "LEAST_FACES", 20)

    def run(*_):
        raise AssertionError

    monkeypatch.setattr(regions, "run", run)
    mesh = build(*meshes.bumpy_sphere(60))
    searched(mesh, "willmore", bvh=build_bvh(mesh))
    limited = rules_for("willmore")._replace(maxflips=10**6)
    variable_depth.run(KERNELS["willmore"], mesh, limited, None, Settings(LIMITS))
    with pytest.raises(AssertionError):
        searched(mesh, "willmore")


@pytest.mark.heavy
def test_flips_before_the_chains_are_no_limit(monkeypatch):
    monkeypatch.setattr(regions, "LEAST_FACES", 20)
    parts = []
    monkeypatch.setattr(regions, "run", recording(regions.run, parts))
    scrambled = build(*meshes.bumpy_sphere(60))
    scramble(scrambled, 1)
    assert greedy.run(KERNELS["willmore"], copy_of(scrambled), rules_for("willmore")).flips
    heard = []
    # What other threads do is not heard.
    alone = Settings(LIMITS, threads=1)
    with listening(lambda fraction, text: heard.append(text), seconds=0.0):
        variable_depth.run(KERNELS["willmore"], scrambled, rules_for("willmore"), None, alone)
    assert parts
    assert all(heard)
    assert any(" parts" in text for text in heard)


def recording(function, calls):
    def recorded(*given):
        calls.append(given)
        return function(*given)

    return recorded
