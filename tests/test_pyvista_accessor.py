"""PyVista's meshes and trimesh's: flipped with all their data."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import meshlab_willmore
from meshlab_willmore import optimize_flips
from tests.extras import needs

GUIDE = Path(__file__).parents[1] / "docs" / "guide" / "pyvista.md"

pytestmark = needs("pyvista", "pyvista")


@pytest.fixture
def pyvista():
    import pyvista

    return pyvista


@pytest.fixture
def rough(pyvista):
    """A rough sphere without data."""
    mesh = pyvista.Sphere(radius=1.0, theta_resolution=24, phi_resolution=14)
    mesh.clear_data()
    mesh.points = mesh.points + np.random.default_rng(3).normal(0, 0.03, mesh.points.shape)
    return mesh


def faces_of(mesh):
    return mesh.faces.reshape(-1, 4)[:, 1:]


def run(code):
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout


# --- the accessor ------------------------------------------------------------------------------


def test_pyvista_finds_it_by_its_entry_point():
    code = """
import sys, pyvista
mesh = pyvista.Sphere()
assert "willmore" in dir(mesh) and "meshlab_willmore" not in sys.modules
print(type(mesh.willmore).__name__, pyvista.registered_accessors()[-1].name)
"""
    assert run(code) == "WillmoreAccessor willmore\n"


@pytest.mark.slow
def test_with_an_older_pyvista_the_class_does_the_same():
    code = """
import pyvista
del pyvista.register_dataset_accessor
from meshlab_willmore.pyvista_accessor import WillmoreAccessor
mesh = pyvista.Plane(i_resolution=3, j_resolution=3).triangulate()
print(WillmoreAccessor(mesh).flip(energy="delaunay", maxflips=0).n_cells)
"""
    assert run(code) == "18\n"


# --- flips -------------------------------------------------------------------------------------


def test_the_faces_are_those_of_the_function_and_the_mesh_stays_as_it_was(rough):
    before = rough.copy()
    flipped = rough.willmore.flip(energy="willmore", foldangle=60)
    expected = optimize_flips(rough.points, faces_of(rough), energy="willmore", foldangle=60)
    assert expected.flips > 20
    np.testing.assert_array_equal(faces_of(flipped), expected.faces)
    np.testing.assert_array_equal(flipped.points, rough.points)
    assert flipped.points.dtype == rough.points.dtype
    assert flipped.willmore.result.flips == expected.flips
    assert rough == before
    assert rough.willmore.result is None
    assert rough.willmore.flip(energy="willmore", maxflips=0) == rough


def test_data_of_points_cells_and_of_the_whole_stay(rough):
    rough["height"] = rough.points[:, 2]
    rough.cell_data["face"] = np.arange(rough.n_cells)
    rough.field_data["name"] = ["rough"]
    rough.set_active_scalars("height")
    flipped = rough.willmore.flip()
    kept = (faces_of(flipped) == faces_of(rough)).all(axis=1)
    assert 0 < kept.sum() < rough.n_cells
    np.testing.assert_array_equal(flipped.point_data["height"], rough.points[:, 2])
    np.testing.assert_array_equal(flipped.cell_data["face"], np.arange(rough.n_cells))
    assert flipped.field_data["name"][0] == "rough"
    assert flipped.active_scalars_name == "height"
    assert flipped.array_names == rough.array_names


def test_vertices_and_lines_beside_the_faces_stay(pyvista, rough):
    faces, points = rough.faces, rough.points
    mesh = pyvista.PolyData(points, faces=faces, lines=[2, 0, 9], verts=[1, 5])
    mesh.cell_data["place"] = np.arange(mesh.n_cells)
    mesh.cell_data.active_normals = np.full((mesh.n_cells, 3), 7.0)
    flipped = mesh.willmore.flip()
    np.testing.assert_array_equal(faces_of(flipped), faces_of(rough.willmore.flip()))
    np.testing.assert_array_equal(flipped.lines, [2, 0, 9])
    np.testing.assert_array_equal(flipped.verts, [1, 5])
    np.testing.assert_array_equal(flipped.cell_data["place"], np.arange(mesh.n_cells))
    normals = flipped.cell_data.active_normals
    assert (normals[:2] == 7.0).all()
    np.testing.assert_allclose(normals[2:], rough.willmore.flip().face_normals, atol=1e-6)


def test_active_normals_are_those_of_the_new_faces(rough):
    mesh = rough.compute_normals(consistent_normals=False, split_vertices=False)
    mesh.point_data["mine"] = mesh.point_data.pop("Normals")
    mesh.point_data.active_normals_name = "mine"
    flipped = mesh.willmore.flip()
    anew = rough.willmore.flip().compute_normals(consistent_normals=False, split_vertices=False)
    assert flipped.array_names == mesh.array_names
    np.testing.assert_allclose(flipped.point_data["mine"], anew.point_data["Normals"])
    np.testing.assert_allclose(flipped.cell_data["Normals"], anew.cell_data["Normals"])
    assert abs(flipped.point_data["mine"] - mesh.point_data["mine"]).max() > 0.01
    assert flipped.point_data.active_normals_name == "mine"


def test_texture_coordinates_are_not_folded(rough):
    uv = rough.points[:, :2].astype(float)
    rough.active_texture_coordinates = uv
    flipped = rough.willmore.flip(energy="delaunay")
    wedge_uv = uv[faces_of(rough)]
    for given, expected in ((None, wedge_uv), (wedge_uv * 0.0, None)):
        flipped = rough.willmore.flip(wedge_uv=given)
        result = optimize_flips(rough.points, faces_of(rough), wedge_uv=expected)
        np.testing.assert_array_equal(faces_of(flipped), result.faces)
    free, bound = (
        optimize_flips(rough.points, faces_of(rough), wedge_uv=given).flips
        for given in (None, wedge_uv)
    )
    assert bound < free


def test_what_the_function_refuses_is_refused(rough):
    with pytest.raises(ValueError, match="unknown energy 'wilmore'"):
        rough.willmore.flip(energy="wilmore")


# --- measures ----------------------------------------------------------------------------------


def test_energy_and_measures_are_those_of_the_functions(rough):
    arrays = rough.points, faces_of(rough)
    assert rough.willmore.measures() == meshlab_willmore.measures(*arrays)
    expected = meshlab_willmore.vertex_willmore_energy(*arrays)
    np.testing.assert_array_equal(rough.willmore.energy(), expected)


def test_a_mesh_without_faces(pyvista):
    points = pyvista.PolyData(np.eye(3))
    assert points.willmore.flip() == points
    assert points.willmore.measures().area == 0.0
    assert pyvista.PolyData().willmore.flip().n_points == 0


@pytest.mark.parametrize("method", ["flip", "energy", "measures"])
def test_what_is_no_triangle_is_an_error_with_its_cure(pyvista, rough, method):
    quads = pyvista.Plane(i_resolution=2, j_resolution=2)
    mixed = quads.merge(quads.translate((0, 0, 1)).triangulate())
    for mesh in (quads, mixed, rough.strip()):
        with pytest.raises(ValueError, match=r"not triangles.*mesh\.triangulate\(\)\.willmore"):
            getattr(mesh.willmore, method)()
        getattr(mesh.triangulate().willmore, method)()


# --- the guide ---------------------------------------------------------------------------------


@pytest.mark.heavy
@pytest.mark.parametrize(
    "library", ["pyvista", pytest.param("trimesh", marks=needs("trimesh", "dev"))]
)
def test_the_examples_of_the_guide_run(rough, library, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    rough.save("scan.ply")
    blocks = re.findall(r"^```python\n(.*?)^```$", GUIDE.read_text(), re.MULTILINE | re.DOTALL)
    (block,) = [block for block in blocks if f"import {library}\n" in block]
    exec(compile(block, str(GUIDE), "exec"), {})
    said = capsys.readouterr().out
    flips = int(re.search(r"(\d+) flips", said)[1])
    assert flips == rough.willmore.flip(preset="faithful").willmore.result.flips > 0
    energies = [float(number) for number in re.findall(r"\d+\.\d+", said)]
    assert len(energies) == 2
    assert energies[1] < energies[0]
    assert len(list(tmp_path.glob("flipped.*"))) == 1
