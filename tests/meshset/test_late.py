"""What is saved to read a mesh, and when: nobody sees that a mesh was saved."""

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.meshset import late, native
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, script_of
from tests.meshset.contents import plain_set, state

pytestmark = pytest.mark.usefixtures("saved")


@pytest.fixture
def sources(monkeypatch):
    """The sets that were saved from."""
    found, save = [], native.save

    def noted(ms, path, **options):
        found.append(ms)
        save(ms, path, **options)

    monkeypatch.setattr(native, "save", noted)
    return found


def noted_name(ms, capfd):
    """The name of the file that PyMeshLab notes for the only mesh."""
    capfd.readouterr()
    ms.print_status()
    return capfd.readouterr().out.partition("Full name: ")[2].strip()


def test_a_mesh_without_flips_keeps_the_name_of_its_file(tmp_path, capfd, sources, saved):
    ms = plain_set(tmp_path)
    assert ms.apply_filter(FLIP, maxflips=0)["flips"] == 0
    assert noted_name(ms, capfd) == str(tmp_path / "plain.ply")
    assert ms not in sources
    assert len(sources) == (saved == "early")


def test_a_mesh_keeps_the_name_of_its_file_where_a_search_fails(tmp_path, capfd, sources):
    ms = plain_set(tmp_path)
    ms.compute_coord_by_function(x="vi == 7 ? 1/0 : x")
    with pytest.raises(pymeshlab.PyMeshLabException, match="not finite"):
        ms.apply_filter(FLIP)
    assert noted_name(ms, capfd) == str(tmp_path / "plain.ply")
    assert ms not in sources


def test_a_plain_mesh_with_flips_is_saved_once(tmp_path, sources, saved):
    ms = plain_set(tmp_path)
    assert ms.apply_filter(FLIP)["flips"] > 0
    assert [source is ms for source in sources] == [saved == "late"]


def with_texture(ms):
    ms.compute_texcoord_by_function_per_wedge()
    ms.set_texture_per_mesh(textname=str(SAMPLES / "TextureDouble_A.png"))


NEEDS_A_COPY = {
    "wedges": lambda ms: ms.compute_texcoord_by_function_per_wedge(),
    "vertex texture": lambda ms: ms.compute_texcoord_by_function_per_vertex(),
    "texture": with_texture,
    "vertex attribute": lambda ms: ms.current_mesh().add_vertex_custom_scalar_attribute(
        np.zeros(300), "a"
    ),
    "face attribute": lambda ms: ms.current_mesh().add_face_custom_point_attribute(
        np.zeros((596, 3)), "a"
    ),
}


@pytest.mark.parametrize("change", NEEDS_A_COPY.values(), ids=NEEDS_A_COPY)
def test_a_copy_is_saved_of_a_mesh_with_names_or_mappings(tmp_path, sources, change):
    ms = plain_set(tmp_path)
    change(ms)
    assert ms.apply_filter(FLIP, maxflips=1)["flips"] <= 1
    assert ms not in sources
    assert sources


def test_flips_are_the_same_whenever_the_mesh_is_saved(monkeypatch):
    """Also the bits of faces, of a mesh of quads and triangles: it is read again when they show."""
    results = []
    for least in (10**9, 0):
        monkeypatch.setattr(late, "LEAST_FACES", least)
        ms = pymeshlab.MeshSet()
        ms.load_new_mesh(str(SAMPLES / "cow.obj"))
        ms.compute_selection_by_condition_per_face(condselect="fi < 2500")
        ms.meshing_tri_to_quad_dominant()
        returned = ms.apply_filter(FLIP, selection=False)
        del returned["seconds"]
        polygons = [tuple(face) for face in ms.current_mesh().polygonal_face_list()]
        results.append((returned, polygons, ms.current_mesh().face_matrix().tolist()))
    assert results[0] == results[1]
    assert max(map(len, results[0][1])) > 3


def test_a_verbose_set_prints_the_same(capfd, tmp_path, monkeypatch):
    printed = []
    for least in (10**9, 0):
        monkeypatch.setattr(late, "LEAST_FACES", least)
        ms = pymeshlab.MeshSet(verbose=True)
        ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(300)))
        capfd.readouterr()
        ms.apply_filter(FLIP)
        out, err = capfd.readouterr()
        # How much of the progress is printed depends on the time.
        printed.append((out, [line[:30] for line in err.splitlines()[-2:]]))
        assert "Saving" not in out + err
        assert script_of(ms).count("<filter") == 1
    assert printed[0] == printed[1]


def test_a_mesh_that_cannot_be_saved_is_left_as_it_is(tmp_path, capfd, monkeypatch):
    ms = plain_set(tmp_path)
    before, faces = state(ms), ms.current_mesh().face_matrix()

    def full(*_, **__):
        raise pymeshlab.PyMeshLabException("Output Stream Error")

    monkeypatch.setattr(native, "save", full)
    with pytest.raises(pymeshlab.PyMeshLabException, match="Output Stream Error"):
        ms.apply_filter(FLIP)
    assert state(ms).keys() == before.keys()
    np.testing.assert_array_equal(ms.current_mesh().face_matrix(), faces)
    assert noted_name(ms, capfd) == str(tmp_path / "plain.ply")


def test_a_mesh_without_a_label_gets_none(tmp_path):
    """PyMeshLab shows the name of the file for it."""
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(300)))
    assert ms.apply_filter(FLIP)["flips"] > 0
    ms.save_current_mesh(str(tmp_path / "mine.ply"))
    assert ms.current_mesh().label() == "mine.ply"


def test_held_meshes_and_other_layers_stay(tmp_path):
    ms = plain_set(tmp_path)
    ms.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()), "other")
    ms.set_current_mesh(0)
    held = ms.current_mesh()
    faces = held.face_matrix()
    assert ms.apply_filter(FLIP)["flips"] > 0
    np.testing.assert_array_equal(held.face_matrix(), faces)
    assert (held.face_matrix() != ms.current_mesh().face_matrix()).any()
    assert [mesh.label() for mesh in ms] == ["plain.ply", "other"]
