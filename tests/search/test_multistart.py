"""The thorough search against the searches that it is made of."""

import numpy as np
import pytest

from meshlab_willmore.energy import willmore
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.search import greedy, multistart, snapshots, variable_depth
from meshlab_willmore.search.compiled import KERNELS
from meshlab_willmore.search.rules import CONVERGED, STOPPED, ChainLimits, Settings
from tests import meshes, reference
from tests.connectivity import validate_connectivity
from tests.search.ways import (
    FREE,
    MESHES,
    assert_equal,
    each_energy_and_mesh,
    interrupted,
    least_energy,
    locked_edges,
    rules_for,
    scramble,
)

SHORT = Settings(ChainLimits(2, 1))
NAMES = ("delaunay", "mean curvature")


def with_starts(settings=SHORT, names=NAMES):
    """These settings, with the warm starts of the thorough search, or others."""
    return settings._replace(warm_starts=tuple((KERNELS[name], rules_for(name)) for name in names))


def by_hand(energy, mesh, settings):
    """The states that chains reach from each start, with the flips on the way."""
    kernels, rules, found = KERNELS[energy], rules_for(energy), []
    one_way = with_starts(settings, NAMES[:1])
    for name in (None, *NAMES[1:]):
        trial, flips = snapshots.copy_of(mesh), 0
        if name:
            flips = greedy.run(KERNELS[name], trial, rules_for(name)).flips
        flips += variable_depth.run(kernels, trial, rules, None, one_way).flips
        found.append((float(kernels.total(trial)), flips, trial))
    return found


@pytest.mark.heavy
@each_energy_and_mesh
@pytest.mark.slow
def test_it_is_the_best_of_its_starts(energy, name):
    kernels, rules = KERNELS[energy], rules_for(energy)
    start, mesh = MESHES[name](), MESHES[name]()
    found = by_hand(energy, start, SHORT)
    progress = multistart.run(kernels, mesh, rules, None, with_starts())
    validate_connectivity(mesh)
    total = kernels.total(mesh)
    # Never worse than chains from the mesh itself, and the best up to what counts as a gain.
    assert total <= found[0][0]
    assert total <= min(energy for energy, _, _ in found) + 2 * rules.tolerance
    chosen = [
        flips
        for energy, flips, state in found
        if (state.origin == mesh.origin).all() and energy == total
    ]
    assert progress.flips == chosen[0]
    assert progress.gain == pytest.approx(kernels.total(start) - total, rel=1e-12, abs=1e-12)
    assert progress.state == CONVERGED
    assert locked_edges(mesh) == locked_edges(start)
    np.testing.assert_array_equal(mesh.origin, start.origin[mesh.corner])


@pytest.mark.heavy
def test_another_start_wins_where_the_mesh_itself_is_stuck():
    kernels, rules = KERNELS["willmore"], rules_for("willmore")
    begin = scramble(build(*meshes.torus(200, None, 1)), 4)
    alone, mesh = snapshots.copy_of(begin), snapshots.copy_of(begin)
    variable_depth.run(kernels, alone, rules, None, SHORT)
    multistart.run(kernels, mesh, rules, None, with_starts())
    assert willmore.total(mesh) < willmore.total(alone) - 1.0


@pytest.mark.heavy
def test_without_other_starts_it_is_variable_depth():
    kernels, rules = KERNELS["willmore"], rules_for("willmore")
    one, other = MESHES["closed"](), MESHES["closed"]()
    wanted = variable_depth.run(kernels, one, rules, None, SHORT)
    progress = multistart.run(kernels, other, rules, None, SHORT)
    assert_equal(one, other)
    assert (progress.flips, progress.state) == (wanted.flips, wanted.state)
    assert progress.gain == pytest.approx(wanted.gain, abs=1e-9)


@pytest.mark.heavy
@pytest.mark.parametrize("limit", [0, 1, 7, 20, 10**6])
def test_maxflips_counts_the_flips_on_the_way(limit):
    kernels = KERNELS["willmore"]
    start, mesh, rules = MESHES["closed"](), MESHES["closed"](), rules_for("willmore")
    everything = multistart.run(kernels, MESHES["closed"](), rules, None, with_starts())
    limited = rules._replace(maxflips=limit)
    progress = multistart.run(kernels, mesh, limited, None, with_starts())
    assert progress.flips <= limit
    assert willmore.total(mesh) <= willmore.total(start)
    assert progress.state == (STOPPED if limit < 10**6 else CONVERGED)
    if limit == 10**6:
        assert progress == everything
    assert everything.flips > 20


def test_an_interrupt_leaves_the_mesh_as_it_was(monkeypatch):
    advance, _ = interrupted(variable_depth.advance, 3)
    monkeypatch.setattr(variable_depth, "advance", advance)
    kernels, rules = KERNELS["willmore"], rules_for("willmore")
    mesh, settings = MESHES["closed"](), with_starts(Settings(ChainLimits(3, 2)))
    with pytest.raises(KeyboardInterrupt):
        multistart.run(kernels, mesh, rules, None, settings)
    assert_equal(mesh, MESHES["closed"]())


@pytest.mark.heavy
def test_the_best_of_all_triangulations_is_found():
    arrays = meshes.bumpy_sphere(6, 1, 0.6)
    mesh = build(*arrays)
    rules = rules_for("willmore", FREE)
    multistart.run(KERNELS["willmore"], mesh, rules, None, with_starts(Settings()))
    assert willmore.total(mesh) == pytest.approx(least_energy(*arrays)[0], abs=1e-9)


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("arguments", "seeds", "most"),
    [
        ((800, 0.3, 8), (None, 21), 112.955),
        pytest.param((2000, 0.3, 8), (None, 21), 115.754, marks=pytest.mark.nightly),
        pytest.param((2000, None, 1), (None, 21, 22), 206.4, marks=pytest.mark.nightly),
    ],
)
@pytest.mark.slow
def test_the_torus_ends_equally_well_whatever_the_start(arguments, seeds, most):
    """From the mesh as it is, and after two random flips an edge."""
    vertices, faces = meshes.torus(*arguments)
    rules, found = rules_for("willmore"), []
    for seed in seeds:
        mesh = build(vertices, faces)
        if seed is not None:
            scramble(mesh, seed)
        multistart.run(KERNELS["willmore"], mesh, rules, None, with_starts(Settings()))
        assert willmore.total(mesh) - 2.0 * np.pi * len(vertices) <= most
        found.append(reference.edge_set(faces_of(mesh)))
    # All but a few edges agree; one flip that the fold guard forbids is the difference.
    assert all(len(edges ^ found[0]) <= 4 for edges in found)
