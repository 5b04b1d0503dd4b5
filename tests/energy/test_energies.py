"""Both energies against brute force on whole meshes."""

import math

import numpy as np
import pytest

from meshlab_willmore.energy import virtual, willmore
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import apex, flip
from tests import meshes, reference
from tests.connectivity import can_flip
from tests.meshes import SMALL as MESHES

ENERGIES = {
    "willmore": (willmore.cost_reduction, reference.willmore_reduction),
    "virtual willmore": (virtual.cost_reduction, reference.virtual_reduction),
}
ROUNDING = 2e-13
EXTENDED = np.finfo(np.longdouble).eps < np.finfo(float).eps


def flippable(mesh):
    return [h for h in range(len(mesh.origin)) if can_flip(mesh, h)]


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.slow
def test_cost_reduction_is_the_brute_force_difference(energy, name):
    vertices, faces = MESHES[name]
    mesh = build(vertices, faces)
    cost_reduction, brute_force = ENERGIES[energy]
    edges = [h for h in flippable(mesh) if h < mesh.twin[h]]
    assert edges
    for h in edges:
        i, j = int(mesh.origin[h]), int(mesh.origin[mesh.twin[h]])
        wanted = brute_force(vertices, faces, i, j)
        assert cost_reduction(mesh, h) == pytest.approx(wanted, abs=ROUNDING)
        assert cost_reduction(mesh, mesh.twin[h]) == pytest.approx(wanted, abs=ROUNDING)


@pytest.mark.parametrize("name", MESHES)
def test_total_is_that_of_the_reference(name):
    wanted = reference.objective(*MESHES[name])
    assert willmore.total(build(*MESHES[name])) == pytest.approx(wanted, rel=1e-14)


@pytest.mark.parametrize("name", MESHES)
def test_willmore_reduction_is_the_drop_of_the_total_along_a_sequence(name):
    mesh = build(*MESHES[name])
    rng = np.random.default_rng(0)
    for _ in range(30):
        h = rng.choice(flippable(mesh))
        before, gain = willmore.total(mesh), willmore.cost_reduction(mesh, h)
        flip(mesh, h)
        assert before - willmore.total(mesh) == pytest.approx(gain, abs=1e-12)


@pytest.mark.parametrize("energy", ENERGIES)
def test_flipping_back_costs_what_flipping_gained(energy):
    cost_reduction, _ = ENERGIES[energy]
    vertices, faces = meshes.bumpy_sphere(24)
    for h in flippable(build(vertices, faces)):
        mesh = build(vertices, faces)
        gain = cost_reduction(mesh, h)
        flip(mesh, h)
        assert cost_reduction(mesh, h) == pytest.approx(-gain, abs=ROUNDING)


@pytest.mark.parametrize("energy", ENERGIES)
def test_coincident_points_are_never_worth_a_flip(energy):
    """Whatever the energy sees of a pair of coincident vertices, it is minus infinity, not NaN."""
    vertices, faces, _ = meshes.with_coincident_ends()
    mesh = build(vertices, faces)
    cost_reduction, _ = ENERGIES[energy]
    reductions = [cost_reduction(mesh, h) for h in flippable(mesh)]
    assert -math.inf in reductions
    assert all(r == -math.inf or math.isfinite(r) for r in reductions)
    assert math.isfinite(willmore.total(mesh))


@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("name", ["closed", "boundary"])
def test_far_from_the_origin_no_digit_is_lost(name, energy):
    """All differences of the shifted coordinates are exact, and nothing else may be looked at."""
    vertices, faces = MESHES[name]
    here, there = (build(moved, faces) for moved in meshes.near_and_far(vertices))
    cost_reduction, _ = ENERGIES[energy]
    for h in flippable(here):
        assert cost_reduction(there, h) == cost_reduction(here, h)


@pytest.mark.skipif(not EXTENDED, reason="long double is no better than double here")
@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("distance", [1e-6, 1e-9, 1e-12])
def test_close_vertices_cost_no_digits(distance, energy):
    vertices, faces = meshes.bumpy_sphere(24)
    vertices[faces[0, 0]] = vertices[faces[0, 1]] + distance
    mesh = build(vertices, faces)
    cost_reduction, brute_force = ENERGIES[energy]
    exact = vertices.astype(np.longdouble)
    near = {int(v) for v in faces[0, :2]}
    edges = [h for h in flippable(mesh) if h < mesh.twin[h]]
    edges = [h for h in edges if near & set(mesh.origin[[h, mesh.twin[h]]].tolist())]
    assert len(edges) > 5
    # What the reference itself loses where the circles pass through two vertices so close.
    noise = 1e2 * float(np.finfo(np.longdouble).eps) / distance
    for h in edges:
        i, j = int(mesh.origin[h]), int(mesh.origin[mesh.twin[h]])
        wanted = brute_force(exact, faces, i, j)
        assert cost_reduction(mesh, h) == pytest.approx(wanted, abs=ROUNDING + noise)


def test_virtual_reduction_of_a_planar_parallelogram_is_zero():
    vertices, faces = meshes.grid(5, 5)
    vertices[:, 0] += 0.3 * vertices[:, 1]
    mesh = build(vertices, faces)
    diagonals = [h for h in flippable(mesh) if {int(apex(mesh, h)), int(apex(mesh, mesh.twin[h]))}]
    inside = [
        h for h in diagonals if abs(int(mesh.origin[h]) - int(mesh.origin[mesh.twin[h]])) == 7
    ]
    assert inside
    for h in inside:
        assert virtual.cost_reduction(mesh, h) == pytest.approx(0.0, abs=1e-13)


def test_the_virtual_vertices_leave_the_kernel_arrays_alone():
    vertices, faces = meshes.bumpy_sphere(24)
    mesh = build(vertices, faces)
    for h in flippable(mesh):
        virtual.cost_reduction(mesh, h)
    np.testing.assert_array_equal(faces_of(mesh), faces)
