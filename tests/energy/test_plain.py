"""Plain arithmetic against the library's functions and the careful ones, and where it gives up."""

import math

import numpy as np
import pytest

from meshlab_willmore.energy import area, delaunay, mean_curvature
from meshlab_willmore.energy.plain import arctangent, plain_normal
from meshlab_willmore.energy.wings import wings_of
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import diamond
from meshlab_willmore.mesh.points import Point
from tests import meshes

QUICK = {"area": area, "delaunay": delaunay, "mean curvature": mean_curvature}
ULP = 2.0**-52

each_energy = pytest.mark.parametrize("module", QUICK.values(), ids=list(QUICK))


def reductions(module, mesh):
    """What plain arithmetic, the careful one, and the two together say of each edge."""
    edges = [h for h in range(len(mesh.origin)) if h < mesh.twin[h]]
    return np.transpose(
        [
            (
                module.quick_reduction(diamond(mesh, h), wings_of(mesh, h)),
                module._careful_reduction(mesh, h),
                module.cost_reduction(mesh, h),
            )
            for h in edges
        ]
    )


def test_the_arctangent_is_that_of_the_library_in_all_quadrants():
    rng = np.random.default_rng(0)
    s, r = rng.choice([-1.0, 1.0], (2, 10_000)) * 10.0 ** rng.uniform(-9.0, 9.0, (2, 10_000))
    eighths = np.linspace(-math.pi, math.pi, 17)
    s = np.concatenate([s, np.sin(eighths), [0.0, -0.0, 0.0, -0.0, 1.0, -1.0]])
    r = np.concatenate([r, np.cos(eighths), [1.0, 1.0, -1.0, -1.0, 0.0, 0.0]])
    found = np.array([arctangent(*pair) for pair in zip(s.tolist(), r.tolist(), strict=True)])
    wanted = np.arctan2(s, r)
    assert np.all(np.abs(found - wanted) <= 2.0 * ULP * np.abs(wanted))
    np.testing.assert_array_equal(np.signbit(found), np.signbit(wanted))


def test_what_has_no_direction_has_no_arctangent():
    for s, r in ((0.0, 0.0), (math.nan, 1.0), (1.0, math.nan)):
        assert math.isnan(arctangent(s, r))


@pytest.mark.parametrize("thinness", [1e-3, 1e-9, 0.0])
def test_a_thin_triangle_has_no_plain_normal(thinness):
    assert math.isnan(plain_normal(Point(1.0, 0.0, 0.0), Point(1.0, thinness, 0.0)).x)
    assert plain_normal(Point(1.0, 0.0, 0.0), Point(1.0, 0.1, 0.0)) == Point(0.0, 0.0, 0.1)


def test_a_tiny_triangle_has_no_plain_normal():
    assert math.isnan(plain_normal(Point(1e-60, 0.0, 0.0), Point(0.0, 1e-60, 0.0)).x)


@each_energy
@pytest.mark.parametrize("arrays", [meshes.bumpy_sphere(60), meshes.patch(60)])
def test_plain_arithmetic_is_enough_where_no_face_is_thin(module, arrays):
    mesh = build(*arrays)
    quick, careful, both = reductions(module, mesh)
    known = np.isfinite(quick)
    assert np.mean(known) > 0.95
    np.testing.assert_array_equal(both[known], quick[known])
    np.testing.assert_allclose(quick[known], careful[known], 0.0, 1e-14 * module.total(mesh))


@each_energy
def test_a_closer_look_is_taken_at_thin_faces(module):
    vertices, faces = meshes.bumpy_sphere(60)
    for a, b, c in faces[::20]:
        vertices[a] = 0.5 * (vertices[b] + vertices[c]) + 1e-6
    quick, careful, both = reductions(module, build(vertices, faces))
    unknown = ~np.isfinite(quick)
    assert 10 < np.count_nonzero(unknown) < len(quick) - 10
    np.testing.assert_array_equal(both[unknown], careful[unknown])
    assert np.any(np.isfinite(both[unknown]))
