"""Area, curvatures, Delaunay and uniform virtual Willmore: all are differences of a total."""

import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.spatial import Delaunay

from meshlab_willmore import guards
from meshlab_willmore.energy import (
    area,
    delaunay,
    gaussian_curvature,
    mean_curvature,
    table,
    uniform,
    willmore,
)
from meshlab_willmore.energy.triangles import twice_area
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import apex, flip
from meshlab_willmore.mesh.points import Point
from tests import meshes, reference
from tests.connectivity import can_flip
from tests.fuzz import energies
from tests.meshes import SMALL as MESHES

ENERGIES = {
    "area": (area, reference.area),
    "mean curvature": (mean_curvature, reference.mean_curvature),
    "gaussian curvature": (gaussian_curvature, reference.absolute_gaussian_curvature),
    "delaunay": (delaunay, reference.cotangents),
    "uniform virtual willmore": (uniform, reference.uniform_objective),
}
# The power of the length in the unit of each.
POWERS = {
    "area": 2,
    "mean curvature": 1,
    "gaussian curvature": 0,
    "delaunay": 0,
    "uniform virtual willmore": 0,
}
ROUNDING = 1e-15
# No flip turns a face of a flat mesh over.
FLAT = guards.FoldLimits(active=True, angle=0.5 * math.pi, shape=0.0)

each_energy = pytest.mark.parametrize("energy", ENERGIES)
each_mesh = pytest.mark.parametrize("name", MESHES)


def flippable(mesh):
    """The lower half-edge of each edge that connectivity lets flip."""
    return [h for h in range(len(mesh.origin)) if h < mesh.twin[h] and can_flip(mesh, h)]


def ends(mesh, h):
    return int(mesh.origin[h]), int(mesh.origin[mesh.twin[h]])


def corners_at(mesh, h):
    """The vertices of the diamond."""
    return {*ends(mesh, h), int(apex(mesh, h)), int(apex(mesh, mesh.twin[h]))}


@each_mesh
@each_energy
@pytest.mark.slow
def test_cost_reduction_is_the_brute_force_difference(energy, name):
    vertices, faces = MESHES[name]
    mesh = build(vertices, faces)
    module, objective = ENERGIES[energy]
    noise = 4 * ROUNDING * max(1.0, objective(vertices, faces))
    edges = flippable(mesh)
    assert edges
    for h in edges:
        wanted = reference.reduction(objective, vertices, faces, *ends(mesh, h))
        assert module.cost_reduction(mesh, h) == pytest.approx(wanted, abs=noise)
        assert module.cost_reduction(mesh, mesh.twin[h]) == pytest.approx(wanted, abs=noise)


@each_mesh
@each_energy
def test_total_is_that_of_the_reference(energy, name):
    module, objective = ENERGIES[energy]
    wanted = objective(*MESHES[name])
    assert module.total(build(*MESHES[name])) == pytest.approx(wanted, rel=4e-15, abs=1e-14)


@each_mesh
@each_energy
def test_cost_reductions_add_up_to_the_drop_of_the_total_along_a_sequence(energy, name):
    """Random flips lead to folds, slivers and large fans, where the energies must still agree."""
    mesh = build(*MESHES[name])
    module, _ = ENERGIES[energy]
    rng = np.random.default_rng(0)
    for _ in range(30):
        h = rng.choice(flippable(mesh))
        before, gain = module.total(mesh), module.cost_reduction(mesh, h)
        flip(mesh, h)
        after = module.total(mesh)
        noise = 10 * ROUNDING * max(1.0, before, after)
        assert before - after == pytest.approx(gain, abs=noise)
        assert module.cost_reduction(mesh, h) == pytest.approx(-gain, abs=noise)


@each_energy
def test_after_many_flips_the_total_is_that_of_the_reference(energy):
    vertices, faces = MESHES["closed"]
    mesh = build(vertices, faces)
    rng = np.random.default_rng(1)
    for _ in range(60):
        flip(mesh, rng.choice(flippable(mesh)))
    module, objective = ENERGIES[energy]
    assert module.total(mesh) == pytest.approx(objective(vertices, faces_of(mesh)), rel=1e-13)


@each_energy
def test_coincident_points_are_never_worth_a_flip(energy):
    """What is not minus infinity is the difference of the totals, also next to such points."""
    vertices, faces, coincident = meshes.with_coincident_ends()
    mesh = build(vertices, faces)
    module, _ = ENERGIES[energy]
    undefined = 0
    for h in flippable(mesh):
        gain = module.cost_reduction(mesh, h)
        if coincident <= corners_at(mesh, h):
            undefined += 1
            assert gain == -math.inf
        elif gain != -math.inf:
            before = module.total(mesh)
            flip(mesh, h)
            noise = 10 * ROUNDING * max(1.0, before)
            assert before - module.total(mesh) == pytest.approx(gain, abs=noise)
            for _ in range(3):
                flip(mesh, h)
    assert undefined
    assert math.isfinite(module.total(mesh))


@each_energy
@pytest.mark.parametrize("name", ["closed", "boundary"])
def test_far_from_the_origin_no_digit_is_lost(name, energy):
    """All differences of the shifted coordinates are exact, and nothing else may be looked at."""
    vertices, faces = MESHES[name]
    here, there = (build(moved, faces) for moved in meshes.near_and_far(vertices))
    module, _ = ENERGIES[energy]
    assert module.total(there) == module.total(here)
    for h in flippable(here):
        assert module.cost_reduction(there, h) == module.cost_reduction(here, h)


@each_energy
@pytest.mark.parametrize("exponent", [-60, -20, 20, 60])
def test_a_power_of_two_scales_the_energy_exactly(exponent, energy):
    vertices, faces = MESHES["closed"]
    here, there = build(vertices, faces), build(np.ldexp(vertices, exponent), faces)
    module, _ = ENERGIES[energy]
    factor = 2.0 ** (POWERS[energy] * exponent)
    assert module.total(there) == factor * module.total(here)
    for h in flippable(here):
        assert module.cost_reduction(there, h) == factor * module.cost_reduction(here, h)


@each_energy
def test_a_rotation_changes_nothing(energy):
    vertices, faces = MESHES["fin"]
    rotation, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    here, there = build(vertices, faces), build(vertices @ rotation, faces)
    module, _ = ENERGIES[energy]
    total = module.total(here)
    assert module.total(there) == pytest.approx(total, rel=1e-14)
    for h in flippable(here):
        wanted = module.cost_reduction(here, h)
        assert module.cost_reduction(there, h) == pytest.approx(wanted, abs=1e-14 * total)


def near(mesh, energy, h):
    """The edges whose cost reduction a flip of `h` may change, `h` being flipped already."""
    two = (h // 3, mesh.twin[h] // 3)
    inside = [g for f in two for g in range(3 * f, 3 * f + 3)]
    if table.ENERGIES[energy].is_narrow:
        reached = inside
    elif energy == "gaussian curvature":
        touched = corners_at(mesh, h)
        edges = [g for g in range(len(mesh.origin)) if g < mesh.twin[g]]
        reached = [g for g in edges if touched & corners_at(mesh, g)]
    else:
        outside = [mesh.twin[g] // 3 for g in inside if mesh.twin[g] >= 0]
        reached = inside + [g for f in outside for g in range(3 * f, 3 * f + 3)]
    return {frozenset(ends(mesh, g)) for g in reached if mesh.twin[g] >= 0}


@each_energy
def test_a_flip_changes_no_cost_reductions_but_those_near_it(energy):
    module, _ = ENERGIES[energy]
    vertices, faces = meshes.bumpy_sphere(60)
    mesh = build(vertices, faces)

    def costs():
        edges = [h for h in range(len(mesh.origin)) if h < mesh.twin[h]]
        return {frozenset(ends(mesh, h)): module.cost_reduction(mesh, h) for h in edges}

    before = costs()
    for h in flippable(mesh)[::7]:
        flip(mesh, h)
        after = costs()
        changed = {e for e in after if abs(after[e] - before.get(e, math.inf)) > 1e-11}
        assert changed <= near(mesh, energy, h)
        assert len(changed) >= 5
        for _ in range(3):
            flip(mesh, h)


@pytest.mark.parametrize("thinness", [1e-3, 1e-8, 1e-13])
@pytest.mark.parametrize("turned", range(3))
def test_the_area_of_a_needle_has_all_its_digits(turned, thinness):
    """A corner at the tip would lose as many as the needle is thin."""
    rng = np.random.default_rng(0)
    for _ in range(20):
        base = np.round(2.0**50 * rng.uniform(-1.0, 1.0, 3)) / 2.0**50
        tip = np.round(2.0**50 * rng.uniform(1.0, 2.0, 3)) / 2.0**50
        points = np.array([base, base + thinness * rng.normal(size=3), tip])
        exact = [[Fraction(x) for x in row] for row in points.tolist()]
        (ux, uy, uz), (vx, vy, vz) = (
            [p - q for p, q in zip(corner, exact[0], strict=True)] for corner in exact[1:]
        )
        squared = (uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2
        found = twice_area(*(Point(*corner) for corner in np.roll(points, turned, axis=0).tolist()))
        assert found == pytest.approx(math.sqrt(squared), rel=2e-15, abs=0.0)


def test_flat_quads_tie_in_area():
    vertices, faces = meshes.grid(4, 4)
    vertices[:, 0] += 0.3 * vertices[:, 1]
    mesh = build(vertices, faces)
    diagonals = [h for h in flippable(mesh) if abs(np.subtract(*ends(mesh, h))) == 6]
    assert len(diagonals) == 14
    for h in diagonals:
        assert area.cost_reduction(mesh, h) == pytest.approx(0.0, abs=1e-15)


def test_curvatures_of_known_shapes():
    flat_cube = build(*meshes.cube(push=0.0))
    assert mean_curvature.total(flat_cube) == pytest.approx(12 * math.pi / 2, rel=1e-15)
    assert gaussian_curvature.total(flat_cube) == pytest.approx(4 * math.pi, rel=1e-15)
    sphere = build(*meshes.sphere_hull(50))
    assert gaussian_curvature.total(sphere) == pytest.approx(4 * math.pi, rel=1e-14)
    tetrahedron = build(*meshes.tetrahedron())
    edges = 6 * math.sqrt(8.0) * math.acos(-1 / 3)
    assert mean_curvature.total(tetrahedron) == pytest.approx(edges, rel=1e-15)
    square = build(*meshes.grid(3, 3))
    assert mean_curvature.total(square) == 0.0
    assert gaussian_curvature.total(square) == pytest.approx(0.0, abs=1e-14)


def test_only_closed_fans_have_gaussian_curvature():
    band = build(*meshes.moebius_band())
    assert gaussian_curvature.total(band) == 0.0
    assert [gaussian_curvature.cost_reduction(band, h) for h in flippable(band)] == [0.0] * 21
    tie = build(*meshes.bow_tie())
    assert gaussian_curvature.angle_defects(tie)[0] == 0.0
    loose = build(np.vstack([meshes.octahedron()[0], [(5.0, 5.0, 5.0)]]), meshes.octahedron()[1])
    defects = gaussian_curvature.angle_defects(loose)
    np.testing.assert_allclose(defects, [2 * math.pi / 3] * 6 + [0.0], rtol=1e-15)


def test_gaussian_curvature_of_a_large_fan():
    count = 120
    angle = 2 * np.pi * np.arange(count) / count
    ring = np.column_stack([np.cos(angle), np.sin(angle), 0.2 * np.cos(17 * angle)])
    vertices = np.vstack([ring, [(0, 0, 1), (0, 0, -1)]])
    ahead = (np.arange(count) + 1) % count
    top = np.column_stack([np.arange(count), ahead, np.full(count, count)])
    bottom = np.column_stack([ahead, np.arange(count), np.full(count, count + 1)])
    faces = np.vstack([top, bottom]).astype(np.int32)
    mesh = build(vertices, faces)
    edges = [h for h in flippable(mesh) if max(ends(mesh, h)) >= count]
    assert len(edges) == 2 * count
    for h in edges[:20]:
        wanted = reference.reduction(
            reference.absolute_gaussian_curvature, vertices, faces, *ends(mesh, h)
        )
        assert gaussian_curvature.cost_reduction(mesh, h) == pytest.approx(wanted, abs=1e-13)


def test_delaunay_reduction_has_the_sign_of_the_criterion():
    """In a convex quad of the plane: positive where the angles at k and l sum to more than pi."""
    rng = np.random.default_rng(0)
    signs = []
    for _ in range(300):
        turns = np.sort(rng.uniform(0, 2 * np.pi, 4))
        radii = rng.uniform(0.8, 1.2, 4)
        quad = np.column_stack([radii * np.cos(turns), radii * np.sin(turns), np.zeros(4)])
        i, l, j, k = quad
        # Convex where each corner turns to the left.
        arriving = quad - np.roll(quad, 1, axis=0)
        if np.cross(arriving, np.roll(arriving, -1, axis=0))[:, 2].min() < 0.05:
            continue
        angles = reference.corner_angles(np.array([i, j, k, l]), [(0, 1, 2), (1, 0, 3)])
        excess = float(angles[0, 2] + angles[1, 2]) - math.pi
        mesh = build(np.array([i, j, k, l]), np.array([(0, 1, 2), (1, 0, 3)], np.int32))
        gain = delaunay.cost_reduction(mesh, 0)
        assert gain * excess > 0.0
        signs.append(excess > 0.0)
    assert 20 < sum(signs) < len(signs) - 20


@pytest.mark.parametrize("seed", range(2))
def test_descent_ends_at_the_delaunay_triangulation_of_the_plane(seed):
    vertices, faces = meshes.patch(40, seed=seed, height=0.0)
    mesh = build(vertices, faces)
    rng = np.random.default_rng(seed)
    for _ in range(200):
        h = rng.choice(flippable(mesh))
        if not guards.folds(mesh, h, FLAT):
            flip(mesh, h)
    wanted = {frozenset(face) for face in Delaunay(vertices[:, :2]).simplices.tolist()}
    assert {frozenset(face) for face in faces_of(mesh).tolist()} != wanted
    flips = 0
    while True:
        proper = [h for h in flippable(mesh) if not guards.folds(mesh, h, FLAT)]
        gain, h = max((delaunay.cost_reduction(mesh, h), h) for h in proper)
        if gain <= 1e-9:
            break
        flip(mesh, h)
        flips += 1
    assert flips > 10
    assert {frozenset(face) for face in faces_of(mesh).tolist()} == wanted


def test_a_face_without_area_is_flipped_away():
    vertices = np.array([(0, 0, 0), (2, 0, 0), (1, 0, 0), (1, -1, 0)], float)
    mesh = build(vertices, np.array([(0, 1, 2), (1, 0, 3)], np.int32))
    assert delaunay.total(mesh) == pytest.approx(delaunay.FLATTEST, abs=5.0)
    assert delaunay.cost_reduction(mesh, 0) == pytest.approx(delaunay.FLATTEST, abs=5.0)
    flip(mesh, 0)
    # Two halves of a square: twice the cotangents of 45, 45 and 90 degrees.
    assert delaunay.total(mesh) == pytest.approx(4.0, rel=1e-15)


@each_mesh
def test_uniform_virtual_willmore_is_willmore_with_a_penalty_on_obtuse_faces(name):
    vertices, faces = MESHES[name]
    excess = np.maximum(reference.corner_angles(vertices, faces) - np.pi / 2, 0).sum()
    wanted = 2 * reference.objective(vertices, faces) + 2 * np.pi * len(faces) + 8 * excess
    found = uniform.total(build(vertices, faces))
    assert found == pytest.approx(float(wanted), rel=4e-15)


def test_uniform_virtual_willmore_breaks_the_ties_of_willmore_in_acute_favour():
    """The faces of a sphere's hull tie in Willmore energy where four of them share a circle."""
    vertices = np.array([(5, 0, 0), (-5, 0, 0), (4, 3, 0), (4, -3, 0)], float)
    mesh = build(vertices, np.array([(0, 1, 2), (1, 0, 3)], np.int32))
    assert willmore.cost_reduction(mesh, 0) == 0.0
    angles = reference.corner_angles(vertices, [(2, 0, 3), (3, 1, 2)])
    excess = float(np.maximum(angles - np.pi / 2, 0).sum())
    assert excess > 0.1
    assert uniform.cost_reduction(mesh, 0) == pytest.approx(-8 * excess, rel=1e-14)


def test_a_flip_to_a_face_without_a_normal_has_no_mean_curvature_to_gain():
    """A point in the middle of a sharp edge: a face between the three would hide its bend."""
    vertices = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (1, 1, 0), (1, 0, 1)], float)
    mesh = build(vertices, np.array([(0, 1, 3), (1, 2, 3), (1, 0, 4), (2, 1, 4)], np.int32))
    h = next(h for h in range(12) if {mesh.origin[h], mesh.origin[mesh.twin[h]]} == {1, 3})
    assert mean_curvature.total(mesh) == pytest.approx(np.pi)
    assert mean_curvature.cost_reduction(mesh, h) == -np.inf


def flat_with_zero_areas():
    vertices, faces = meshes.patch(60, 2, 0.0)
    vertices[::3, 1] = 0.5
    return vertices, faces


def with_coincident_points():
    vertices, faces = meshes.bumpy_sphere(60)
    vertices[faces[::9, 0]] = vertices[faces[::9, 1]]
    return vertices, faces


@pytest.mark.parametrize("name", ["area", "mean curvature", "gaussian curvature", "delaunay"])
@pytest.mark.parametrize("arrays", [flat_with_zero_areas(), with_coincident_points()])
def test_degenerate_faces_cost_what_the_total_says(name, arrays):
    """Else the gains of flips add up to something out of nothing, and a search need not end."""
    module, _ = ENERGIES[name]
    mesh, rng = build(*arrays), np.random.default_rng(0)
    checked = 0
    for h in rng.integers(0, len(mesh.origin), 300):
        gain = module.cost_reduction(mesh, h) if can_flip(mesh, h) else -np.inf
        if gain > -np.inf:
            before = module.total(mesh)
            flip(mesh, h)
            size = max(1.0, abs(before))
            assert gain == pytest.approx(before - module.total(mesh), abs=1e-12 * size)
            checked += 1
    assert checked > 100


def needles(seed, height):
    """A bumpy sphere with points so near to edges that the triangles there are nearly flat."""
    vertices, faces = meshes.bumpy_sphere(24, seed)
    rng = np.random.default_rng(seed)
    for a, b, c in faces[rng.permutation(len(faces))[:3]]:
        middle = vertices[b] + 0.4 * (vertices[c] - vertices[b])
        vertices[a] = middle + height * rng.normal(size=3)
    return vertices, faces


@pytest.mark.parametrize("height", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("name", ["area", "mean curvature", "delaunay"])
def test_the_gain_at_needles_is_the_difference_of_the_exact_sums(name, height):
    """Neither cut off nor made of rounding, where a face is thin, but not without area."""
    module, _ = ENERGIES[name]
    exact = energies.ENERGIES[name]
    for seed in range(3):
        vertices, faces = needles(seed, height)
        mesh = build(vertices, faces)
        before, _ = exact(vertices, faces)
        for h in flippable(mesh):
            after, _ = exact(vertices, reference.flipped(faces.tolist(), *ends(mesh, h)))
            gain = module.cost_reduction(mesh, h)
            slack = 1e-9 * float(max(before, after))
            assert gain == pytest.approx(float(before - after), rel=1e-8, abs=slack)


def test_what_is_neither_flat_nor_known_is_not_flipped():
    """Its cotangents are finite, and larger than those of a face without area count."""
    vertices = np.array([(0, 0, 0), (2, 0, 0), (1, 1e-20, 0), (1, -1, 0)], float)
    mesh = build(vertices, np.array([(0, 1, 2), (1, 0, 3)], np.int32))
    assert delaunay.cost_reduction(mesh, 0) == -math.inf
    vertices[2, 1] = 0.0
    assert delaunay.cost_reduction(mesh, 0) > 0.0
