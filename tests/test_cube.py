"""The claims of docs/cube.md that do not need a long search."""

import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from meshlab_willmore import optimize_flips
from meshlab_willmore.mesh.build import build
from studies.triangulations import (
    CORNERS,
    FAN,
    TOTALS,
    best_first,
    classes,
    extrinsic_curvature,
    faces_of_ways,
    symmetries,
    totals,
)
from tests import meshes, reference
from tests.connectivity import validate_connectivity

FANS = [FAN] * 6
PUSH = 0.05


def edges_of(ways, number=None):
    """The edges of a triangulation, with its vertices renamed."""
    faces = faces_of_ways(ways)
    return frozenset(reference.edge_set(faces if number is None else number[faces]))


def test_the_48_symmetries_of_the_cube():
    numbers = symmetries()
    vertices, _ = meshes.cube(PUSH)
    assert len({tuple(number) for number in numbers.tolist()}) == 48
    wanted = np.linalg.norm(vertices[:, None] - vertices, axis=2)
    for number in numbers:
        moved = vertices[number]
        found = np.linalg.norm(moved[:, None] - moved, axis=2)
        np.testing.assert_allclose(found, wanted, atol=1e-12)


def test_the_ways_to_triangulate_the_sides_make_380_classes():
    ways, sizes = classes()
    assert (len(ways), sizes.sum()) == (380, 5**6)
    assert ways.tolist().count(FANS) == 1
    assert sizes[ways.tolist().index(FANS)] == 1
    # None of those looked at is a copy of another.
    numbers = symmetries()
    seen = set()
    for row, size in zip(ways[::15], sizes[::15], strict=True):
        copies = {edges_of(row, number) for number in numbers}
        assert len(copies) == size
        assert seen.isdisjoint(copies)
        seen |= copies
        validate_connectivity(build(meshes.cube(PUSH)[0], faces_of_ways(row)))


def reference_extrinsic_curvature(vertices, faces):
    """With the convex cones of the stars from Qhull."""
    total = -reference.angle_defects(vertices, faces).sum()
    for v in range(len(vertices)):
        around = {int(u) for face in faces for u in face if v in face} - {v}
        star = np.vstack([vertices[v], vertices[sorted(around)]])
        hull = ConvexHull(star)
        at_v = hull.simplices[(hull.simplices == 0).any(axis=1)]
        if len(at_v):
            angles = reference.corner_angles(star, [np.roll(f, -list(f).index(0)) for f in at_v])
            total += 2.0 * (2.0 * math.pi - float(angles[:, 0].sum()))
    return total


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.slow
def test_the_extrinsic_curvature_is_that_of_the_convex_cones(seed):
    vertices, faces = meshes.bumpy_sphere(30, seed, bump=0.5)
    wanted = reference_extrinsic_curvature(vertices, faces)
    assert extrinsic_curvature(build(vertices, faces)) == pytest.approx(wanted, rel=1e-12)
    assert wanted > 5.0 * math.pi


@pytest.mark.parametrize("mesh", [meshes.sphere_hull(20), meshes.cube(0.0), meshes.tetrahedron()])
def test_the_extrinsic_curvature_of_convex_meshes_is_4_pi(mesh):
    assert extrinsic_curvature(build(*mesh)) == pytest.approx(4.0 * math.pi, rel=1e-12)


@pytest.mark.heavy
@pytest.mark.parametrize("push", [0.01, 0.05, 0.1, 0.2, 0.3])
def test_the_fans_are_least_in_all_and_the_paper_s_start_greatest_in_most(push):
    vertices, initial = meshes.cube(push)
    ways, sizes = classes()
    every = np.array([totals(build(vertices, faces_of_ways(row))) for row in ways])
    fans, start = totals(build(vertices, faces_of_ways(FANS))), totals(build(vertices, initial))
    for column, name in enumerate(TOTALS):
        least = every[:, column] < every[:, column].min() + 1e-9
        assert fans[column] == pytest.approx(every[:, column].min(), abs=1e-12)
        if name == "abs K":
            # No vertex has negative curvature, so all have 4 pi, the least that a sphere can have.
            assert least.all()
            assert fans[column] == pytest.approx(4.0 * math.pi, rel=1e-12)
        else:
            assert sizes[least].sum() == 1
        if name in ("area", "extrinsic", "M"):
            assert start[column] == pytest.approx(every[:, column].max(), abs=1e-12)


def test_the_paper_s_flips_lead_from_the_greatest_area_to_the_least():
    vertices, faces = meshes.cube(PUSH)
    found = optimize_flips(vertices, faces).faces
    assert reference.edge_set(found) == reference.edge_set(faces_of_ways(FANS))
    assert reference.area(vertices, found) == pytest.approx(6.02993, abs=5e-6)


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("measure", "wanted"),
    [("area", 4.83738), ("M", 23.63764), ("extrinsic", 12.80518)],
)
@pytest.mark.slow
def test_flips_of_cube_edges_lower_the_area_but_not_the_curvatures(measure, wanted):
    vertices, _ = meshes.cube(PUSH)
    found = best_first(vertices, [faces_of_ways(FANS)], measure, 60)
    assert found.value <= wanted + 5e-6
    assert found.expanded == 60
    mesh = build(vertices, found.faces)
    validate_connectivity(mesh)
    assert totals(mesh)[TOTALS.index(measure)] == pytest.approx(found.value, rel=1e-12)
    if measure != "area":
        assert found.value == pytest.approx(wanted, abs=5e-6)
        assert np.bincount(found.faces.ravel())[CORNERS:].tolist() == [4] * 6
