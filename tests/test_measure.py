"""The measures: known values, the reference, invariances."""

import math

import numpy as np
import pytest

from meshlab_willmore.measure import (
    Measures,
    intersection_angles,
    measures,
    triangle_shapes,
    vertex_willmore_energy,
    willmore_energy,
)
from tests import meshes, reference

CLOSED = {"cube": meshes.cube(), "bumpy sphere": meshes.bumpy_sphere(60), "torus": None}
OTHERS = {
    "patch": meshes.patch(40),
    "moebius band": meshes.moebius_band(),
    "fin": meshes.fin()[:2],
    "bow tie": meshes.bow_tie(),
    "two triangles": meshes.two_triangles(),
    "point cloud": (np.random.default_rng(0).random((9, 3)), np.empty((0, 3), np.int32)),
    "nothing": (np.empty((0, 3)), np.empty((0, 3), np.int32)),
}
EULER = {"cube": 2, "bumpy sphere": 2, "torus": 0}


@pytest.fixture(scope="module", autouse=True)
def _torus():
    CLOSED["torus"] = meshes.torus(120, 0.3, 3)


@pytest.fixture(params=[*CLOSED, *OTHERS], name="mesh")
def _mesh(request):
    return {**CLOSED, **OTHERS}[request.param]


def test_angles_and_energies_are_those_of_the_reference(mesh):
    vertices, faces = mesh
    rows, wanted = reference.edge_angles(vertices, faces)
    edges, beta = intersection_angles(vertices, faces)
    assert edges.dtype == np.int32
    assert edges.shape == (len(rows), 2)
    found = {
        tuple(sorted(edge)): angle
        for edge, angle in zip(edges.tolist(), beta.tolist(), strict=True)
    }
    assert len(found) == len(rows)
    for (i, j, _, _), angle in zip(rows.tolist(), wanted, strict=True):
        assert found[i, j] == pytest.approx(float(angle), abs=4e-15)
    field = vertex_willmore_energy(vertices, faces)
    np.testing.assert_allclose(field, reference.vertex_energy(vertices, faces), rtol=0, atol=1e-13)
    assert willmore_energy(vertices, faces) == pytest.approx(field.sum(), abs=1e-12)
    assert field.min(initial=0.0) >= -1e-13


@pytest.mark.parametrize("name", CLOSED)
def test_totals_of_closed_meshes(name):
    vertices, faces = CLOSED[name]
    totals = measures(vertices, faces)
    assert totals.gaussian_curvature == pytest.approx(2 * math.pi * EULER[name], abs=1e-11)
    closed_form = reference.objective(vertices, faces) - 2 * math.pi * len(vertices)
    assert totals.willmore_energy == pytest.approx(closed_form, rel=1e-12)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert totals.area == pytest.approx(0.5 * np.linalg.norm(normals, axis=1).sum(), rel=1e-13)
    assert totals.absolute_gaussian_curvature >= abs(totals.gaussian_curvature)


def test_curvatures_are_those_of_the_reference(mesh):
    vertices, faces = mesh
    totals = measures(vertices, faces)
    defects = reference.angle_defects(vertices, faces)
    assert totals.gaussian_curvature == pytest.approx(defects.sum(), abs=1e-11)
    assert totals.absolute_gaussian_curvature == pytest.approx(np.abs(defects).sum(), abs=1e-11)
    bent = reference.mean_curvature(vertices, faces)
    assert totals.absolute_mean_curvature == pytest.approx(bent, abs=1e-9)


def test_known_values_of_a_cube():
    totals = measures(*meshes.cube(push=0.0))
    assert totals == pytest.approx(
        (6.0, 4 * math.pi, 4 * math.pi, 6 * math.pi, totals[-1]), rel=1e-13
    )


def test_the_paper_s_cube():
    totals = measures(*meshes.cube(push=0.05))
    assert totals.willmore_energy == pytest.approx(45.7570, abs=5e-5)
    assert totals.area == pytest.approx(6.22709, abs=5e-6)


@pytest.mark.parametrize(
    ("arguments", "count", "wanted"),
    [
        ((2000, 0.3, 8), 3850, (4010.3, 119.624, 640.5, 0.191)),
        ((2000, None, 1), 4000, (4129.3, 118.080, 234.1, 0.062)),
    ],
)
@pytest.mark.heavy
def test_the_paper_s_torus(arguments, count, wanted):
    vertices, faces = meshes.torus(*arguments)
    totals = measures(vertices, faces)
    assert len(faces) == count
    assert totals.willmore_energy == pytest.approx(wanted[0], abs=0.05)
    assert totals.area == pytest.approx(wanted[1], abs=5e-4)
    assert totals.absolute_mean_curvature == pytest.approx(wanted[2], abs=0.05)
    assert np.quantile(triangle_shapes(vertices, faces), 0.01) == pytest.approx(wanted[3], abs=5e-4)


def test_a_hull_of_sphere_points_has_no_willmore_energy():
    vertices, faces = meshes.sphere_hull(300)
    _, beta = intersection_angles(vertices, faces)
    assert abs(willmore_energy(vertices, faces)) <= 1e-9 * 2 * beta.sum()
    assert np.abs(vertex_willmore_energy(vertices, faces)).max() < 1e-9


def test_a_flat_disc_has_no_curvature_and_no_energy():
    vertices, faces = meshes.patch(60, height=0.0)
    totals = measures(vertices, faces)
    assert totals[1:] == pytest.approx((0.0, 0.0, 0.0, totals[-1]), abs=1e-12)
    assert totals.area == pytest.approx(_hull_area(vertices), rel=1e-12)


def _hull_area(vertices):
    return meshes.ConvexHull(vertices[:, :2]).volume


@pytest.mark.parametrize("name", ["bumpy sphere", "cube"])
def test_moebius_maps_keep_the_willmore_energy(name):
    vertices, faces = CLOSED[name]
    shifted = vertices - (3.0, 1.0, -2.0)
    inverted = shifted / np.sum(shifted**2, axis=1, keepdims=True)
    wanted = vertex_willmore_energy(vertices, faces)
    found = vertex_willmore_energy(inverted, faces[:, ::-1])
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-11)


@pytest.mark.parametrize("scale", [1e-150, 1e-6, 3.0, 1e6, 1e150])
def test_measures_scale_as_their_units_say(scale):
    vertices, faces = CLOSED["bumpy sphere"]
    one, other = measures(vertices, faces), measures(vertices * scale, faces)
    units = Measures(scale**2, 1.0, 1.0, scale, 1.0)
    assert other == pytest.approx(tuple(a * b for a, b in zip(one, units, strict=True)), rel=1e-12)
    np.testing.assert_allclose(
        triangle_shapes(vertices * scale, faces), triangle_shapes(vertices, faces), rtol=1e-13
    )


def test_a_mesh_of_a_size_beyond_all_floats_does_not_fail():
    vertices, faces = CLOSED["bumpy sphere"]
    totals = measures(vertices * 1e300, faces)
    assert totals.area == math.inf
    assert totals.willmore_energy == pytest.approx(measures(vertices, faces).willmore_energy)


def test_coincident_vertices_have_energy_zero_and_nothing_is_nan():
    vertices, faces = meshes.bumpy_sphere(40)
    vertices[faces[0, 0]] = vertices[faces[0, 1]]
    field = vertex_willmore_energy(vertices, faces)
    assert (field[faces[0, :2]] == 0.0).all()
    assert np.isfinite(field).all()
    assert np.count_nonzero(field) > 20
    assert np.isfinite(intersection_angles(vertices, faces)[1]).all()
    assert np.isfinite(measures(vertices, faces)).all()


def test_shapes_of_known_triangles():
    vertices = np.array(
        [(0, 0, 0), (1, 0, 0), (0.5, math.sqrt(0.75), 0), (0, 1, 0), (2, 0, 0)], float
    )
    shapes = triangle_shapes(vertices, [(0, 1, 2), (0, 1, 3), (0, 1, 4)])
    assert shapes == pytest.approx([1.0, math.sqrt(0.75), 0.0], abs=1e-15)


def test_measures_are_checked_and_leave_the_input_alone():
    vertices, faces = CLOSED["cube"]
    vertices, faces = vertices.copy(), faces.copy()
    vertices.flags.writeable = faces.flags.writeable = False
    measures(vertices, faces)
    vertex_willmore_energy(vertices, faces)
    for function in (willmore_energy, vertex_willmore_energy, intersection_angles, measures):
        with pytest.raises(ValueError, match="face 0"):
            function(vertices, [(0, 1, 99)])
    with pytest.raises(TypeError, match="integers"):
        triangle_shapes(vertices, faces.astype(float))
