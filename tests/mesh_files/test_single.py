"""Single precision in PLY files: the vertices' numbers change, and nothing else."""

from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.mesh_files.saving import SaveOptions, save
from tests.cli.conftest import SAMPLES, listing


@pytest.fixture
def full_set():
    """A mesh with texture coordinates, face scalars and attributes of numbers and of points."""
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "bunny10k_textured.obj"))
    ms.compute_scalar_by_aspect_ratio_per_face()
    ms.compute_new_custom_scalar_attribute_per_vertex(name="one", expr="x")
    ms.compute_new_custom_point_attribute_per_vertex(name="three", x_expr="x", y_expr="y")
    return ms


def header_of(path):
    return Path(path).read_bytes().partition(b"end_header")[0].decode().splitlines()


def mesh_of(path):
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(path))
    mesh = ms.current_mesh()
    found = {"vertices": mesh.vertex_matrix(), "faces": mesh.face_matrix()}
    if mesh.has_wedge_tex_coord():
        found["texture"] = mesh.wedge_tex_coord_matrix()
        found["colours"] = mesh.face_color_matrix()
    if mesh.has_face_scalar():
        found["scalars"] = mesh.face_scalar_array()
    return found


@pytest.mark.parametrize("parts", [(), ("fq", "vn", "wt", "fc")])
@pytest.mark.parametrize("is_text", [False, True])
def test_only_numbers_of_vertices_change(tmp_path, full_set, is_text, parts):
    double, single = tmp_path / "double.ply", tmp_path / "single.ply"
    save(full_set, double, SaveOptions(parts, is_text))
    save(full_set, single, SaveOptions(parts, is_text, is_single=True))
    at = [header_of(path).index("element face 9999") for path in (double, single)]
    assert header_of(double)[at[0] :] == header_of(single)[at[1] :]
    vertex = header_of(single)[: at[1]]
    assert vertex == [line.replace("double", "float") for line in header_of(double)[: at[0]]]
    assert "property float x" in vertex
    assert ("property list uchar float three" in vertex) == (not parts)
    before, after = mesh_of(double), mesh_of(single)
    assert before.keys() == after.keys()
    assert "scalars" in before
    rounded = before.pop("vertices").astype(np.float32)
    assert np.array_equal(after.pop("vertices").astype(np.float32), rounded)
    assert all(np.array_equal(before[name], after[name]) for name in before)
    assert single.stat().st_size < double.stat().st_size
    assert "single.ply.single" not in listing(tmp_path)


def test_attributes_are_rounded(tmp_path, full_set):
    save(full_set, tmp_path / "a.ply", SaveOptions(is_text=True, is_single=True))
    lines = (tmp_path / "a.ply").read_text().partition("end_header\n")[2].splitlines()
    numbers = np.array([line.split() for line in lines[:5051]], dtype=float)
    x, one, count, three = (numbers[:, place] for place in (0, -5, -4, -3))
    assert np.array_equal(x, one)
    assert np.array_equal(x, three)
    assert (count == 3).all()


def test_empty_elements_are_kept(tmp_path):
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(np.eye(3)))
    save(ms, tmp_path / "a.ply", SaveOptions(is_single=True))
    assert np.array_equal(mesh_of(tmp_path / "a.ply")["vertices"], np.eye(3))
