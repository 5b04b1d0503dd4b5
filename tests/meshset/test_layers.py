"""Nobody who holds a mesh or counts layers is harmed by a flip."""

import dataclasses

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.meshset import exchange, layers
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, random_transform, set_of


@pytest.mark.slow
def test_sets_are_distinguished_by_identity():
    @dataclasses.dataclass
    class Job(pymeshlab.MeshSet):
        def __post_init__(self):
            super().__init__()

    first, second = Job(), Job()
    assert first == second
    for ms in (first, second):
        ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(60)))
    held = first.current_mesh()
    first.apply_filter(FLIP)
    second.create_cube()
    assert held.id() == 0
    assert layers.parked(first) == {0}
    assert not layers.parked(second)


def test_subclasses_see_their_own_calls_only():
    calls = []

    class Logged(pymeshlab.MeshSet):
        def apply_filter(self, name, **kwargs):
            calls.append(name)
            return super().apply_filter(name, **kwargs)

    ms = Logged()
    for seed in range(2):
        ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(60, seed)))
    ms.set_matrix(transformmatrix=random_transform(), freeze=False)
    ms.meshing_edge_flip_by_willmore_optimization()
    ms.compute_scalar_by_willmore_energy_per_vertex()
    assert calls == ["set_matrix", FLIP, "compute_scalar_by_willmore_energy_per_vertex"]


@pytest.mark.parametrize("wanted", [0, 1, 7])
def test_the_id_of_the_only_mesh_stays(wanted):
    ms = pymeshlab.MeshSet()
    for _ in range(wanted):
        ms.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()))
    ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(60)), "last")
    for _ in range(wanted):
        ms.set_current_mesh(min(m.id() for m in ms))
        ms.delete_current_mesh()
    assert (len(ms), ms.current_mesh_id()) == (1, wanted)
    assert ms.apply_filter(FLIP)["mesh_id"] == wanted
    assert (len(ms), ms.current_mesh_id(), ms.current_mesh().label()) == (1, wanted, "last")
    ms.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()))
    assert ms.current_mesh_id() == wanted + 1, "the count of ids goes on where it was"


def test_other_meshes_keep_their_ids_and_data(bumpy):
    others = [pymeshlab.Mesh(*meshes.sphere_hull(20 + n)) for n in range(3)]
    for mesh in others:
        bumpy.add_mesh(mesh, set_as_current=False)
    returned = bumpy.apply_filter(FLIP)
    assert len(bumpy) == 4
    assert returned["mesh_id"] == bumpy.current_mesh_id() == 0
    for n, mesh in enumerate(others):
        np.testing.assert_array_equal(bumpy.mesh(n + 1).face_matrix(), mesh.face_matrix())


def test_nothing_to_flip_leaves_the_very_mesh():
    ms = set_of(*meshes.sphere_hull(60))
    ms.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()))
    ms.set_current_mesh(0)
    held = ms.current_mesh()
    assert ms.apply_filter(FLIP)["flips"] == 0
    assert ms.current_mesh() is held
    assert len(ms) == 2


def test_rasters_stay(bumpy, tmp_path):
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "bunny10k_textured.obj"))
    picture = tmp_path / "picture.png"
    ms.current_mesh().texture(0).save(str(picture))
    bumpy.load_new_raster(str(picture))
    bumpy.apply_filter(FLIP)
    assert bumpy.raster_number() == 1


@pytest.mark.parametrize("company", [False, True])
@pytest.mark.parametrize("held", [False, True])
def test_a_load_that_fails_half_way_changes_nothing(company, held, monkeypatch):
    ms = set_of(*meshes.bumpy_sphere(100))
    if company:
        ms.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()), set_as_current=False)
    ms.set_matrix(transformmatrix=random_transform(), freeze=False)
    ms.set_current_mesh_visibility(False)
    ms.current_mesh().add_vertex_custom_scalar_attribute(np.arange(100.0), "w")
    before = ids_and_faces(ms)
    keep = ms.current_mesh() if held else None
    carry, calls = exchange._load, []

    def fail_the_second_time(*args):
        carry(*args)
        calls.append(args)
        if len(calls) == 2:
            raise MemoryError("no more of it")

    monkeypatch.setattr(exchange, "_load", fail_the_second_time)
    with pytest.raises(pymeshlab.PyMeshLabException, match="no more of it"):
        ms.apply_filter(FLIP)
    del keep
    assert ids_and_faces(ms) == before
    assert ms.current_mesh().label() == "mesh"
    assert not ms.current_mesh().is_visible()
    np.testing.assert_array_equal(ms.current_mesh().transform_matrix(), random_transform())
    values = ms.current_mesh().vertex_custom_scalar_attribute_array("w")
    np.testing.assert_array_equal(values, np.arange(100.0))


def ids_and_faces(ms):
    return ms.current_mesh_id(), [(m.id(), m.face_matrix().tolist()) for m in ms]
