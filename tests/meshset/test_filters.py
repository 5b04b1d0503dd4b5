"""What the filters do to meshes good and bad."""

import re

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import (
    intersection_angles,
    measures,
    optimize_flips,
    vertex_willmore_energy,
    willmore_energy,
)
from meshlab_willmore.meshset import scalars
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, random_transform, set_of

SCALAR = "compute_scalar_by_willmore_energy_per_vertex"
MEASURES = "get_willmore_measures"


# --- flips -------------------------------------------------------------------------------------


@pytest.mark.parametrize("energy", ["virtual willmore", "willmore"])
@pytest.mark.parametrize("monotone", [True, False])
def test_flips_are_those_of_the_core(energy, monotone):
    vertices, faces = meshes.bumpy_sphere(200)
    options = {"energy": energy, "monotone": monotone, "foldangle": 60.0, "maxflips": 50}
    expected = optimize_flips(vertices, faces, **options)
    ms = set_of(vertices, faces)
    returned = ms.apply_filter(FLIP, **options)
    np.testing.assert_array_equal(ms.current_mesh().face_matrix(), expected.faces)
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), vertices)
    assert returned.pop("seconds") > 0
    assert returned.pop("mesh_id") == 0
    assert returned == {name: getattr(expected, name) for name in returned}
    arrays = {"faces", "corners", "reason", "passes", "vertices", "faces_before"}
    assert set(returned) == set(expected._fields) - arrays
    assert {type(v) for v in returned.values()} == {int, float, bool}


@pytest.mark.parametrize(
    "options",
    [
        {"energy": "area"},
        {"virtualpoint": "closest"},
        {"virtualpoint": 0.3},
        {"virtualpoint": "0.3"},
        {"checkintersections": True, "foldangle": 180.0, "minshape": 0.0},
        {"search": "variable depth", "depth": 2, "breadth": 1},
        {"search": "annealing", "sweeps": 3, "seed": 5},
        pytest.param({"search": "thorough", "depth": 2}, marks=pytest.mark.heavy),
    ],
)
def test_each_option_reaches_the_core(options):
    vertices, faces = meshes.bumpy_sphere(200)
    ms = set_of(vertices, faces)
    ms.apply_filter(FLIP, **options)
    if "virtualpoint" in options and options["virtualpoint"] != "closest":
        options = {"virtualpoint": float(options["virtualpoint"])}
    expected = optimize_flips(vertices, faces, **options)
    np.testing.assert_array_equal(ms.current_mesh().face_matrix(), expected.faces)
    # So that an option that gets lost is noticed.
    assert not np.array_equal(expected.faces, optimize_flips(vertices, faces).faces)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"depth": 0}, "depth must lie in 1 .. 100, not 0"),
        ({"breadth": 13}, "breadth must lie in 1 .. 12, not 13"),
        ({"sweeps": 0}, "sweeps must lie in 1 .. 1000000000, not 0"),
        ({"seed": -1}, "seed must not be negative, not -1"),
        ({"virtualpoint": 1.0}, "virtualpoint must be 'midpoint', 'closest' or a number"),
        ({"virtualpoint": "nan"}, "between 0 and 1, not nan"),
        ({"virtualpoint": "middle"}, "unknown virtualpoint 'middle'; choose 'midpoint', 'closest'"),
        ({"virtualpoint": True}, "virtualpoint: True is a bool, a text or a number is expected"),
        ({"virtualpoint": None}, "a text or a number is expected"),
        ({"depth": 2.5}, "depth: 2.5 is a float, an int is expected"),
    ],
)
def test_wrong_values_name_the_parameter_and_change_nothing(bumpy, options, message):
    before = bumpy.current_mesh().face_matrix().copy()
    with pytest.raises(pymeshlab.PyMeshLabException, match=message):
        bumpy.apply_filter(FLIP, **options)
    np.testing.assert_array_equal(bumpy.current_mesh().face_matrix(), before)


def test_enums_by_index(bumpy):
    twin = set_of(*meshes.bumpy_sphere(300))
    assert (
        bumpy.apply_filter(FLIP, energy=1, search=1)["gain"]
        == twin.apply_filter(FLIP, energy="willmore", search="greedy")["gain"]
    )


def test_maxflips(bumpy):
    assert bumpy.apply_filter(FLIP, maxflips=5)["flips"] == 5
    assert not bumpy.apply_filter(FLIP, maxflips=0)["converged"]
    assert bumpy.apply_filter(FLIP, maxflips=-1)["converged"]
    assert bumpy.apply_filter(FLIP)["flips"] == 0


def test_featuredeg_keeps_the_right_angles_of_a_cube():
    """All edges that flips would take are right angles, or nearly."""
    ms = set_of(*meshes.cube(0.1))
    assert ms.apply_filter(FLIP, featuredeg=60.0)["flips"] == 0
    assert ms.apply_filter(FLIP, featuredeg=95.0)["flips"] > 0


def test_a_chain_as_in_the_readme(tmp_path):
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "cow.obj"))
    ms.meshing_remove_duplicate_vertices()
    ms.meshing_edge_flip_by_willmore_optimization()
    ms.apply_coord_taubin_smoothing()
    ms.save_current_mesh(str(tmp_path / "out.ply"))
    assert (tmp_path / "out.ply").exists()


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"foldangle": -1}, "foldangle"),
        ({"foldangle": float("nan")}, "foldangle"),
        ({"featuredeg": 181}, "featuredeg"),
        ({"maxflips": -2}, "maxflips"),
    ],
)
def test_values_out_of_range_are_named(bumpy, options, text):
    faces = bumpy.current_mesh().face_matrix()
    with pytest.raises(pymeshlab.PyMeshLabException, match=text) as caught:
        bumpy.apply_filter(FLIP, **options)
    assert str(caught.value).startswith(f"Failed to apply filter: {FLIP}\nDetails: ")
    np.testing.assert_array_equal(bumpy.current_mesh().face_matrix(), faces)


# --- measures ----------------------------------------------------------------------------------


def test_measures(bumpy):
    mesh = bumpy.current_mesh()
    expected = measures(mesh.vertex_matrix(), mesh.face_matrix())
    assert bumpy.get_willmore_measures() == expected._asdict()
    assert expected.gaussian_curvature == pytest.approx(4 * np.pi)
    area = bumpy.get_geometric_measures()["surface_area"]
    assert expected.area == pytest.approx(area, rel=1e-5)


def test_measures_consider_the_transform_as_native_ones_do(bumpy):
    before = bumpy.get_willmore_measures()
    bumpy.set_matrix(transformmatrix=np.diag([2.0, 2, 2, 1]), freeze=False)
    after = bumpy.get_willmore_measures()
    assert after["area"] == pytest.approx(4 * before["area"])
    assert after["area"] == pytest.approx(bumpy.get_geometric_measures()["surface_area"], rel=1e-5)
    assert after["willmore_energy"] == pytest.approx(before["willmore_energy"])


# --- scalars -----------------------------------------------------------------------------------


def assert_scalar_is_willmore_energy(ms):
    mesh = ms.current_mesh()
    expected = vertex_willmore_energy(mesh.vertex_matrix(), mesh.face_matrix())
    np.testing.assert_array_equal(mesh.vertex_scalar_array(), expected)


def test_scalar_is_written_in_place(bumpy):
    held = bumpy.current_mesh()
    assert bumpy.apply_filter(SCALAR) == {}
    assert bumpy.current_mesh() is held
    assert held.vertex_scalar_array().max() > 0
    assert_scalar_is_willmore_energy(bumpy)
    assert len(bumpy) == 1
    assert bumpy.filter_parameter_values("ply") == {"binary": True}


def test_scalar_changes_nothing_else(bumpy):
    transform = random_transform()
    bumpy.set_matrix(transformmatrix=transform, freeze=False)
    bumpy.compute_selection_by_condition_per_vertex(condselect="vi > 50")
    bumpy.add_mesh(pymeshlab.Mesh(*meshes.octahedron()))
    bumpy.set_mesh_visibility(1, False)
    bumpy.set_current_mesh(0)
    mesh = bumpy.current_mesh()
    before = mesh.vertex_matrix(), mesh.face_matrix(), mesh.vertex_selection_array()
    bumpy.apply_filter(SCALAR)
    after = mesh.vertex_matrix(), mesh.face_matrix(), mesh.vertex_selection_array()
    for left, right in zip(before, after, strict=True):
        np.testing.assert_array_equal(left, right)
    np.testing.assert_array_equal(mesh.transform_matrix(), transform)
    assert mesh.is_visible()
    assert not bumpy.mesh(1).is_visible()
    assert bumpy.current_mesh_id() == 0
    assert len(bumpy) == 2
    assert_scalar_is_willmore_energy(bumpy)


def test_coincident_vertices_keep_their_own_scalars():
    """Two bumpy spheres share a point, but not the vertex there: it has two energies."""
    vertices, faces = meshes.bumpy_sphere(40)
    other, _ = meshes.bumpy_sphere(40, seed=5)
    shift = vertices[:7] - other[:7]
    second = other.copy()
    second[:7] += shift
    ms = set_of(np.vstack([vertices, second]), np.vstack([faces, faces + 40]))
    mesh = ms.current_mesh()
    energy = vertex_willmore_energy(mesh.vertex_matrix(), mesh.face_matrix())
    assert (energy[:7] != energy[40:47]).sum() == 6
    ms.apply_filter(SCALAR)
    assert_scalar_is_willmore_energy(ms)


def test_scalar_of_a_mesh_that_is_there_twice():
    vertices, faces = meshes.bumpy_sphere(500)
    other = optimize_flips(vertices, faces).faces
    ms = set_of(np.vstack([vertices, vertices]), np.vstack([faces, other + 500]))
    ms.apply_filter(SCALAR)
    assert_scalar_is_willmore_energy(ms)


@pytest.mark.parametrize(
    "make",
    [meshes.two_triangles, meshes.tetrahedron, lambda: meshes.grid(3, 3), meshes.moebius_band],
)
@pytest.mark.parametrize("scale", [1e-30, 1.0, 1e6])
def test_scalar_of_small_flat_and_odd_meshes(make, scale):
    vertices, faces = make()
    ms = set_of(vertices * scale, faces)
    ms.apply_filter(SCALAR)
    assert_scalar_is_willmore_energy(ms)


def test_scalar_of_a_mesh_too_large_for_native_filters_is_refused():
    vertices, faces = meshes.bumpy_sphere(60)
    vertices[7] *= 1e160
    ms = set_of(vertices, faces)
    with pytest.raises(pymeshlab.PyMeshLabException, match="vertex 7 .* above 1e"):
        ms.apply_filter(SCALAR)


def test_function_of_index():
    values = np.array([1.5, -2.0, 3e-8])
    text = scalars._function_of_index(np.array([3, 8, 9]), values)
    ms = set_of(*meshes.sphere_hull(12))
    ms.compute_scalar_by_function_per_vertex(q="7")
    ms.compute_scalar_by_function_per_vertex(q=text)
    scalar = ms.current_mesh().vertex_scalar_array()
    np.testing.assert_array_equal(scalar[[3, 8, 9]], values)
    assert (np.delete(scalar, [3, 8, 9]) == 7).all()


# --- bad meshes --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [FLIP, SCALAR, MEASURES])
def test_a_point_cloud_is_refused_with_a_cure(name):
    ms = set_of(np.random.default_rng(0).random((10, 3)), np.zeros((0, 3), np.int32))
    with pytest.raises(pymeshlab.PyMeshLabException, match="point cloud") as caught:
        ms.apply_filter(name)
    cures = [word.strip(",.") for word in str(caught.value).split() if word.startswith("generate_")]
    assert cures
    assert set(cures) <= set(pymeshlab.filter_list())


@pytest.mark.parametrize("name", [FLIP, SCALAR, MEASURES])
def test_an_empty_mesh_is_refused(name):
    ms = set_of(*meshes.tetrahedron())
    ms.set_selection_all()
    ms.meshing_remove_selected_vertices()
    with pytest.raises(pymeshlab.PyMeshLabException, match="empty"):
        ms.apply_filter(name)


@pytest.mark.parametrize("name", [FLIP, SCALAR, MEASURES])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_coordinates_that_are_not_finite_are_named_and_their_cure_works(name, value):
    vertices, faces = meshes.bumpy_sphere(30)
    vertices[17, 1] = value
    ms = set_of(vertices, faces)
    with pytest.raises(pymeshlab.PyMeshLabException, match="vertex 17") as caught:
        ms.apply_filter(name)
    np.testing.assert_array_equal(ms.current_mesh().face_matrix(), faces)
    condition = re.search("condselect='(.*)'", str(caught.value))[1]
    ms.compute_selection_by_condition_per_vertex(condselect=condition)
    ms.meshing_remove_selected_vertices()
    assert ms.current_mesh().vertex_number() == 29
    ms.apply_filter(name)


@pytest.mark.parametrize("name", [FLIP, SCALAR, MEASURES])
def test_a_repeated_vertex_is_named_and_its_cure_works(name):
    vertices, faces = meshes.bumpy_sphere(30)
    faces[11] = (3, 3, 5)
    ms = set_of(vertices, faces)
    with pytest.raises(pymeshlab.PyMeshLabException, match="face 11.*meshing_remove_null_faces"):
        ms.apply_filter(name)
    ms.meshing_remove_null_faces()
    ms.apply_filter(name)


ODD = {
    "one triangle": lambda: (np.eye(3), np.array([[0, 1, 2]])),
    "two triangles": meshes.two_triangles,
    "duplicate faces": lambda: _with(meshes.bumpy_sphere(30), lambda v, f: (v, f[[*range(56), 3]])),
    "opposite faces": lambda: (np.eye(3), np.array([[0, 1, 2], [2, 1, 0]])),
    "zero-area faces": lambda: _with(meshes.patch(30), _collinear),
    "coincident vertices": lambda: _with(meshes.bumpy_sphere(30), _coincident),
    "all in one point": lambda: _with(meshes.bumpy_sphere(30), lambda v, f: (v * 0 + 3, f)),
    "non-manifold edge": lambda: meshes.fin()[:2],
    "non-manifold vertex": meshes.bow_tie,
    "mixed orientation": lambda: _with(meshes.bumpy_sphere(60), _mixed),
    "several components": lambda: _with(meshes.bumpy_sphere(60), _twice),
    "moebius band": meshes.moebius_band,
    "unreferenced vertices": lambda: _with(
        meshes.bumpy_sphere(30), lambda v, f: (np.vstack([v, v + 1]), f)
    ),
    "far away": lambda: _with(meshes.bumpy_sphere(60), lambda v, f: (v + 1e8, f)),
    "tiny": lambda: _with(meshes.bumpy_sphere(60), lambda v, f: (v * 1e-150, f)),
    "huge": lambda: _with(meshes.bumpy_sphere(60), lambda v, f: (v * 1e140, f)),
}


def _with(mesh, change):
    return change(*mesh)


def _collinear(vertices, faces):
    vertices[:, 1:] = 0
    return vertices, faces


def _coincident(vertices, faces):
    vertices[faces[5, 1]] = vertices[faces[5, 0]]
    return vertices, faces


def _mixed(vertices, faces):
    faces[::3] = faces[::3, ::-1]
    return vertices, faces


def _twice(vertices, faces):
    return np.vstack([vertices, vertices + 5]), np.vstack([faces, faces + len(vertices)])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", ODD)
@pytest.mark.parametrize("monotone", [True, False])
def test_odd_meshes_come_out_whole(name, monotone):
    vertices, faces = ODD[name]()
    ms = set_of(vertices, faces)
    returned = ms.apply_filter(FLIP, monotone=monotone)
    mesh = ms.current_mesh()
    np.testing.assert_array_equal(mesh.vertex_matrix(), vertices)
    assert mesh.face_number() == len(faces)
    assert np.isfinite([returned["gain"], returned["willmore_after"]]).all()
    assert _edges_with_other_than_two_faces(mesh.face_matrix()) == (
        _edges_with_other_than_two_faces(faces)
    )
    ms.apply_filter(SCALAR)
    assert_scalar_is_willmore_energy(ms)
    assert np.isfinite(list(ms.apply_filter(MEASURES).values())).all()
    assert willmore_energy(vertices, faces) == pytest.approx(returned["willmore_before"], rel=1e-13)
    assert np.isfinite(intersection_angles(vertices, mesh.face_matrix())[1]).all()


def _edges_with_other_than_two_faces(faces):
    """Boundary and non-manifold edges: no flip makes or removes one."""
    edges = np.sort(np.vstack([faces, np.roll(faces, -1, axis=1)]).reshape(2, -1, 3), axis=0)
    pairs, counts = np.unique(edges.reshape(2, -1).T, axis=0, return_counts=True)
    return {(*map(int, pair), int(n)) for pair, n in zip(pairs, counts, strict=True) if n != 2}
