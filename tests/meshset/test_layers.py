"""Replaced layers and parked ones: flips leave held `Mesh` objects and other layers alone."""

import dataclasses
import gc

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import measure
from meshlab_willmore.meshset import exchange, layers, native
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, random_transform, script_of, set_of


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


# --- held meshes -------------------------------------------------------------------------------


def many_meshes(ms, count=300):
    """Fill memory with other meshes, so that a dangling pointer would show."""
    for n in range(count):
        ms.add_mesh(pymeshlab.Mesh(*meshes.sphere_hull(20 + n % 30)), set_as_current=False)


@pytest.mark.slow
def test_a_held_mesh_still_reads_its_own_data(bumpy):
    held = bumpy.current_mesh()
    vertices, faces = held.vertex_matrix(), held.face_matrix()
    assert bumpy.apply_filter(FLIP)["flips"] > 0
    assert (bumpy.current_mesh().face_matrix() != faces).any()
    other = pymeshlab.MeshSet()
    for target in (bumpy, other):
        many_meshes(target)
    np.testing.assert_array_equal(held.vertex_matrix(), vertices)
    np.testing.assert_array_equal(held.face_matrix(), faces)


@pytest.mark.slow
def test_every_reference_counts_also_one_in_a_container(bumpy):
    faces = bumpy.current_mesh().face_matrix()
    keep = {"mesh": [bumpy.mesh(0)]}
    bumpy.apply_filter(FLIP)
    many_meshes(bumpy)
    np.testing.assert_array_equal(keep["mesh"][0].face_matrix(), faces)


def test_a_mesh_in_garbage_does_not_count(bumpy):
    cycle = [bumpy.current_mesh()]
    cycle.append(cycle)
    gc.disable()
    try:
        del cycle
        bumpy.apply_filter(FLIP)
    finally:
        gc.enable()
    assert native.ids(bumpy) == [0]


def test_a_mesh_in_old_garbage_is_parked_until_it_is_collected(bumpy):
    cycle = [bumpy.current_mesh()]
    cycle.append(cycle)
    gc.disable()
    try:
        gc.collect()
        del cycle
        bumpy.apply_filter(FLIP)
        assert (native.ids(bumpy), len(bumpy), bumpy.current_mesh_id()) == ([0, 1], 1, 0)
    finally:
        gc.enable()
    gc.collect()
    bumpy.apply_filter(FLIP)
    assert (len(native.ids(bumpy)), len(bumpy), bumpy.current_mesh_id()) == (1, 1, 0)


def fails_in_its_words(ms):
    ms.apply_filter(FLIP, nope=1)


def fails_in_a_value(ms):
    ms.apply_filter(FLIP, foldangle=-1)


def fails_while_reading(ms):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(exchange.ply, "read", lambda path: 1 / 0)
        ms.apply_filter(FLIP)


def fails_while_measuring(ms):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(measure, "measures", lambda vertices, faces: 1 / 0)
        ms.get_willmore_measures()


FAILURES = [fails_in_its_words, fails_in_a_value, fails_while_reading, fails_while_measuring]


@pytest.mark.parametrize("fail", FAILURES)
def test_an_exception_that_is_kept_does_not_hold_the_mesh(bumpy, fail):
    with pytest.raises(pymeshlab.PyMeshLabException) as kept:
        fail(bumpy)
    assert bumpy.apply_filter(FLIP)["mesh_id"] == 0
    assert native.ids(bumpy) == [0]
    assert kept.value.__traceback__ is not None


def test_a_held_mesh_is_parked_hidden_and_not_counted(bumpy):
    held = bumpy.current_mesh()
    new_id = bumpy.apply_filter(FLIP)["mesh_id"]
    assert new_id == bumpy.current_mesh_id() == held.id()
    assert bumpy.current_mesh() is not held
    assert not held.is_visible()
    assert bumpy.current_mesh().is_visible()
    assert bumpy.current_mesh().label() == held.label() == "mesh"
    assert len(bumpy) == bumpy.mesh_number() == 1
    assert [mesh.id() for mesh in bumpy] == [new_id]


def test_a_parked_layer_goes_when_it_is_free(bumpy):
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    bumpy.meshing_remove_duplicate_vertices()
    assert native.ids(bumpy) == [0, 1]
    del held
    bumpy.meshing_remove_duplicate_vertices()
    assert native.ids(bumpy) == [1]
    assert bumpy.current_mesh_id() == 0


def test_sweeping_leaves_the_script_alone(bumpy):
    bumpy.set_selection_none()
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    before = script_of(bumpy)
    del held
    layers.sweep(bumpy)
    assert native.ids(bumpy) == [1]
    assert script_of(bumpy) == before


def test_a_held_mesh_can_be_added_as_a_layer_like_others(bumpy):
    held = bumpy.current_mesh()
    faces = held.face_matrix()
    bumpy.apply_filter(FLIP)
    bumpy.add_mesh(held, "before")
    assert [mesh.id() for mesh in bumpy] == [0, 1]
    assert (bumpy.mesh(1).face_matrix() == faces).all()
    assert bumpy.is_mesh_visible(1)


def test_the_id_of_a_held_mesh_hides_and_shows_the_flipped_one(bumpy):
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    bumpy.set_mesh_visibility(held.id(), False)
    assert not bumpy.is_current_mesh_visible()
    bumpy.set_mesh_visibility(held.id(), True)
    assert bumpy.is_mesh_visible(held.id())
    assert not held.is_visible()


def test_a_set_whose_last_layer_is_deleted_is_empty_though_a_mesh_is_held(bumpy):
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    bumpy.delete_current_mesh()
    assert (len(bumpy), list(bumpy), bumpy.mesh_id_exists(0)) == (0, [], False)
    for ask in (bumpy.current_mesh, bumpy.current_mesh_id, bumpy.is_current_mesh_visible):
        with pytest.raises(pymeshlab.PyMeshLabException, match="no current Mesh"):
            ask()
    for name in ("meshing_remove_duplicate_vertices", FLIP):
        for call in (bumpy.apply_filter, bumpy.filter_parameter_values):
            with pytest.raises(pymeshlab.PyMeshLabException, match="at least one mesh"):
                call(name)
    assert held.face_number() == 596
    bumpy.create_cube()
    assert (bumpy.current_mesh_id(), len(bumpy)) == (1, 1)


def test_clear_forgets_parked_layers_with_all_others(bumpy):
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    del held
    bumpy.clear()
    for _ in range(2):
        bumpy.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()))
        bumpy.set_current_mesh_visibility(False)
    bumpy.meshing_remove_duplicate_vertices()
    assert native.ids(bumpy) == [0, 1]


@pytest.mark.slow
def test_deleting_hidden_layers_spares_parked_ones(bumpy):
    held = bumpy.current_mesh()
    faces = held.face_matrix()
    bumpy.apply_filter(FLIP)
    bumpy.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()), set_as_current=False)
    bumpy.set_mesh_visibility(1, False)
    bumpy.delete_non_visible_meshes()
    many_meshes(bumpy)
    np.testing.assert_array_equal(held.face_matrix(), faces)
    assert native.ids(bumpy)[:2] == [0, 1]
    assert not bumpy.mesh_id_exists(1)
    assert not held.is_visible()


def two_layers():
    ms = set_of(*meshes.bumpy_sphere(100))
    ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(80, 9)), set_as_current=False)
    return ms


def test_native_filters_take_no_parked_layer_for_a_partner():
    free, holding = two_layers(), two_layers()
    held = holding.current_mesh()
    for ms in (free, holding):
        ms.apply_filter(FLIP)
    name = "get_hausdorff_distance"
    assert holding.filter_parameter_values(name) == free.filter_parameter_values(name)
    assert holding.apply_filter(name) == free.apply_filter(name)
    assert held.id() == holding.current_mesh_id()
    mine = holding.filter_parameter_values(name, targetmesh=held.id())
    assert mine["targetmesh"] == held.id()


def test_parked_layers_are_not_merged():
    ms = two_layers()
    held = ms.current_mesh()
    faces = held.face_matrix()
    ms.apply_filter(FLIP)
    with pytest.raises(pymeshlab.PyMeshLabException, match="'mesh'.*is held"):
        ms.generate_by_merging_visible_meshes(mergevisible=False)
    ms.generate_by_merging_visible_meshes()
    assert ms.current_mesh().face_number() == 196 + 156
    many_meshes(ms, 30)
    np.testing.assert_array_equal(held.face_matrix(), faces)


def test_scripts_do_not_delete_parked_layers(bumpy, tmp_path):
    other = set_of(*meshes.tetrahedron())
    other.delete_non_visible_meshes()
    script = str(tmp_path / "delete.mlx")
    other.save_filter_script(script)
    bumpy.load_filter_script(script)
    held = bumpy.current_mesh()
    faces = held.face_matrix()
    bumpy.apply_filter(FLIP)
    bumpy.apply_filter_script()
    bumpy.clear_filter_script()
    bumpy.delete_non_visible_meshes()
    bumpy.clear_filter_script()
    bumpy.load_filter_script(script)
    bumpy.apply_filter_script()
    np.testing.assert_array_equal(held.face_matrix(), faces)
    assert len(bumpy) == 1


def test_scripts_do_not_merge_parked_layers(bumpy, tmp_path):
    other = set_of(*meshes.tetrahedron())
    other.generate_by_merging_visible_meshes(mergevisible=False)
    script = str(tmp_path / "merge.mlx")
    other.save_filter_script(script)
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    bumpy.load_filter_script(script)
    with pytest.raises(pymeshlab.PyMeshLabException, match="step 1 .* is held"):
        bumpy.apply_filter_script()
    assert held.face_number() == bumpy.current_mesh().face_number()


def test_a_deleted_layer_does_not_hand_over_to_a_parked_one(bumpy):
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    bumpy.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()))
    bumpy.delete_current_mesh()
    assert bumpy.current_mesh() is not held
    assert bumpy.current_mesh_id() == 0


@pytest.mark.parametrize("more", [(), ("apply_coord_taubin_smoothing",)])
@pytest.mark.slow
def test_a_loop_over_the_meshes_visits_each_once(more):
    ms = pymeshlab.MeshSet()
    for seed in range(3):
        ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(60, seed)))
    flips = []
    for mesh in ms:
        ms.set_current_mesh(mesh.id())
        flips.append(ms.apply_filter(FLIP)["flips"])
        for name in more:
            ms.apply_filter(name)
    assert len(flips) == 3
    assert all(n > 0 for n in flips)
    del mesh
    assert len(ms) == 3


def test_an_iterator_survives_the_deletion_of_its_layer():
    ms = pymeshlab.MeshSet()
    for seed in range(2):
        ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(60, seed)), str(seed))
    ms.set_current_mesh(0)
    iterator = iter(ms)
    assert next(iterator).label() == "0"
    ms.apply_filter(FLIP)
    many_meshes(ms, 20)
    assert [mesh.label() for mesh in iterator] == ["1"]
