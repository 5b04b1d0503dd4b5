import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.meshset import ply
from tests import meshes
from tests.meshset.conftest import set_of


@pytest.fixture
def saved(tmp_path):
    vertices, faces = meshes.bumpy_sphere(30)
    ms = set_of(vertices, faces)
    path = tmp_path / "mesh.ply"
    ms.save_current_mesh(str(path), save_face_flag=True)
    return path, vertices, faces


def test_read_gives_what_was_saved(saved):
    path, vertices, faces = saved
    mesh = ply.read(path)
    np.testing.assert_array_equal(mesh.vertices["x"], vertices[:, 0])
    np.testing.assert_array_equal(mesh.faces["vertex_indices"], faces)
    assert mesh.textures == ()


def test_pymeshlab_reads_what_write_writes(saved, tmp_path):
    path, vertices, faces = saved
    edges = np.array([[0, 5], [7, 9]], np.int32)
    other = tmp_path / "other.ply"
    ply.write(other, ply.read(path)._replace(edges=edges))
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(other))
    mesh = ms.current_mesh()
    np.testing.assert_array_equal(mesh.vertex_matrix(), vertices)
    np.testing.assert_array_equal(mesh.face_matrix(), faces)
    np.testing.assert_array_equal(mesh.edge_matrix(), edges)


def test_write_then_read_is_the_identity(saved, tmp_path):
    mesh = ply.read(saved[0])._replace(textures=("a.png", "folder/ü.jpg"))
    ply.write(tmp_path / "again.ply", mesh)
    again = ply.read(tmp_path / "again.ply")
    assert again.textures == mesh.textures
    assert again.vertices.dtype == mesh.vertices.dtype
    assert again.vertices.tobytes() == mesh.vertices.tobytes()
    assert again.faces.tobytes() == mesh.faces.tobytes()


def test_read_refuses_faces_that_are_no_triangles(saved):
    path, *_ = saved
    data = path.read_bytes()
    start = data.index(b"end_header\n") + len(b"end_header\n")
    mesh = ply.read(path)
    first_count = start + mesh.vertices.nbytes
    path.write_bytes(data[:first_count] + b"\x04" + data[first_count + 1 :])
    with pytest.raises(ValueError, match="vertex_indices does not have 3 entries"):
        ply.read(path)


@pytest.mark.parametrize("length", [20, -20])
def test_read_refuses_a_file_that_is_cut_short(saved, length):
    path, *_ = saved
    path.write_bytes(path.read_bytes()[:length])
    with pytest.raises(ValueError, match="is the disk full"):
        ply.read(path)
