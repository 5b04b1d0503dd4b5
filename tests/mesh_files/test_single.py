"""Single precision in PLY files: the vertices' numbers change, and nothing else."""

import struct
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.mesh_files.saving import SaveOptions, save
from meshlab_willmore.mesh_files.single import to_single
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


@pytest.mark.parametrize("is_text", [False, True])
def test_elements_before_and_after_the_vertices_are_copied(tmp_path, is_text):
    kind = "ascii" if is_text else "binary_little_endian"
    header = [
        "ply",
        f"format {kind} 1.0",
        "element camera 1",
        "property double view",
        "element vertex 4",
        "property double x",
        "property int flags",
        "element face 2",
        "property list uchar int vertex_indices",
        "property double quality",
        "end_header",
    ]
    text = "\n".join(header).encode() + b"\n"
    x = [0.1, 1e-50, 3.0, -1 / 3]
    faces = [((0, 1, 2, 3), 0.2), ((0, 1, 2), 0.1)]
    if is_text:
        camera, after = b"0.1\n", b"4 0 1 2 3 0.2\n3 0 1 2 0.1\n"
        before = b"".join(f"{value!r} 7\n".encode() for value in x)
        wanted = b"0.1 7\n0.0 7\n3.0 7\n-0.33333334 7\n"
    else:
        camera = struct.pack("<d", 0.1)
        after = b"".join(
            struct.pack(f"<B{len(face)}id", len(face), *face, value) for face, value in faces
        )
        before = b"".join(struct.pack("<di", value, 7) for value in x)
        wanted = b"".join(struct.pack("<fi", value, 7) for value in x)
    path = tmp_path / "a.ply"
    path.write_bytes(text + camera + before + after)
    to_single(path)
    assert path.read_bytes() == (text.replace(b"double x", b"float x") + camera + wanted + after)
