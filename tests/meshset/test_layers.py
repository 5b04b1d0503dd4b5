"""Nobody who holds a mesh or counts layers is harmed by a flip."""

import contextlib
import dataclasses
import gc
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import measure
from meshlab_willmore.meshset import exchange, interrupts, layers, native
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, random_transform, set_of


def many_meshes(ms, count=300):
    """Fill memory with other meshes, so that a dangling pointer would show."""
    for n in range(count):
        ms.add_mesh(pymeshlab.Mesh(*meshes.sphere_hull(20 + n % 30)), set_as_current=False)


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
    assert new_id == bumpy.current_mesh_id() != held.id()
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
    assert bumpy.current_mesh_id() == 1


def test_sweeping_leaves_the_script_alone(bumpy):
    bumpy.set_selection_none()
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    before = script_of(bumpy)
    del held
    layers.sweep(bumpy)
    assert native.ids(bumpy) == [1]
    assert script_of(bumpy) == before


def take_by_making_it_current(ms):
    ms.set_current_mesh(0)
    ms.set_current_mesh(1)


def take_by_showing_it(ms):
    ms.set_mesh_visibility(0, True)


@pytest.mark.parametrize("take", [take_by_making_it_current, take_by_showing_it])
def test_a_layer_that_the_user_takes_back_is_one_like_others(bumpy, take):
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    take(bumpy)
    assert held.is_visible()
    del held
    bumpy.meshing_remove_duplicate_vertices()
    assert native.ids(bumpy) == [0, 1]
    assert len(bumpy) == 2


def test_a_parked_layer_that_the_user_deleted_is_forgotten(bumpy):
    held = bumpy.current_mesh()
    bumpy.apply_filter(FLIP)
    bumpy.set_current_mesh(held.id())
    del held
    bumpy.delete_current_mesh()
    bumpy.meshing_remove_duplicate_vertices()
    assert len(bumpy) == 1


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


def test_deleting_hidden_layers_spares_parked_ones(bumpy):
    held = bumpy.current_mesh()
    faces = held.face_matrix()
    bumpy.apply_filter(FLIP)
    bumpy.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()), set_as_current=False)
    bumpy.set_mesh_visibility(2, False)
    bumpy.delete_non_visible_meshes()
    many_meshes(bumpy)
    np.testing.assert_array_equal(held.face_matrix(), faces)
    assert not bumpy.mesh_id_exists(2)
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
    mine = holding.filter_parameter_values(name, targetmesh=held.id())
    assert mine["targetmesh"] == held.id(), "the caller may name it"


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
    assert held.id() == 0
    assert bumpy.current_mesh_id() == 1


@pytest.mark.parametrize("more", [(), ("apply_coord_taubin_smoothing",)])
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


def test_sets_are_told_apart_by_identity():
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
    assert returned["mesh_id"] == bumpy.current_mesh_id() == 4
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


# --- without a trace ---------------------------------------------------------------------------


def script_of(ms):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "script.mlx"
        ms.save_filter_script(str(path))
        return path.read_text()


def test_the_filter_script_holds_the_users_steps_only(bumpy):
    bumpy.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()), set_as_current=False)
    bumpy.set_matrix(transformmatrix=random_transform(), freeze=False)
    bumpy.compute_selection_by_condition_per_face(condselect="fi > 2 && fi < 1000")
    bumpy.set_selection_none()
    before = script_of(bumpy)
    assert before.count("<filter") == 3
    bumpy.apply_filter(FLIP)
    bumpy.compute_scalar_by_willmore_energy_per_vertex()
    scripted = ["Matrix: Set/Copy Transformation", "Conditional Face Selection", "Select None"]
    scripted += ["Willmore flipping optimization", "Willmore energy per vertex"]
    assert re.findall('<filter name="([^"]*)"', script_of(bumpy)) == scripted


def test_the_script_of_a_set_with_one_mesh_holds_the_flips_only(bumpy):
    bumpy.apply_filter(FLIP)
    assert script_of(bumpy).count("<filter") == 1


def test_a_filter_script_that_cannot_be_kept_is_an_error_beforehand(bumpy, monkeypatch):
    bumpy.set_selection_none()
    before, faces = script_of(bumpy), bumpy.current_mesh().face_matrix()
    monkeypatch.setattr(native, "_save_filter_script", lambda ms, path: None)
    with pytest.raises(pymeshlab.PyMeshLabException, match="filter script could not be written"):
        bumpy.apply_filter(FLIP)
    monkeypatch.undo()
    assert script_of(bumpy) == before
    np.testing.assert_array_equal(bumpy.current_mesh().face_matrix(), faces)


def test_nothing_is_printed(bumpy, capfd):
    bumpy.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()), set_as_current=False)
    bumpy.set_selection_none()
    capfd.readouterr()
    bumpy.apply_filter(FLIP)
    bumpy.compute_scalar_by_willmore_energy_per_vertex()
    bumpy.get_willmore_measures()
    assert capfd.readouterr() == ("", "")


def test_muted_hides_c_output_and_nothing_else(capfd):
    pymeshlab.print_pymeshlab_version()
    with native.muted():
        pymeshlab.print_pymeshlab_version()
    print("python")
    pymeshlab.print_pymeshlab_version()
    sys.stdout.flush()
    native._flush_c_streams()
    lines = capfd.readouterr().out.split("\n")
    assert sum(line.startswith("PyMeshLab") for line in lines) == 2
    assert "python" in lines


def test_verbosity_is_restored(capfd):
    ms = pymeshlab.MeshSet(verbose=True)
    ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(60)))
    ms.set_matrix(transformmatrix=random_transform(), freeze=False)
    capfd.readouterr()
    ms.apply_filter(FLIP)
    ours = capfd.readouterr().out
    assert ours.count("Applying filter") == 1, "the helpers' filters are silent"
    assert "Loading" not in ours
    ms.meshing_remove_duplicate_vertices()
    native._flush_c_streams()
    assert "Applying filter meshing_remove_duplicate_vertices" in capfd.readouterr().out


# --- interrupts --------------------------------------------------------------------------------


@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
def test_an_interrupt_waits_until_the_set_is_whole(bumpy):
    order = []

    def load(target):
        os.kill(os.getpid(), signal.SIGINT)
        target.add_mesh(pymeshlab.Mesh(*meshes.octahedron()))
        order.append("loaded")

    who = layers.identity(bumpy.current_mesh())
    with pytest.raises(KeyboardInterrupt):
        layers.replace_current(bumpy, load, load, who)
    assert order == ["loaded"]
    assert bumpy.current_mesh().face_number() == 8
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_interrupt_that_is_swallowed_on_the_way_is_not_lost():
    def swallow():
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)

    def stumble():
        swallow()
        raise ValueError("a consequence")

    with pytest.raises(KeyboardInterrupt), interrupts.kept():
        swallow()
    with pytest.raises(KeyboardInterrupt), interrupts.kept():
        stumble()
    with pytest.raises(ValueError, match="of its own"), interrupts.kept():
        raise ValueError("of its own")
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_ignored_interrupt_stays_ignored():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        for context in (interrupts.kept, interrupts.deferred):
            with context():
                signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_thread_that_is_not_the_main_one_can_flip(bumpy):
    results = []
    thread = threading.Thread(target=lambda: results.append(bumpy.apply_filter(FLIP)))
    thread.start()
    thread.join()
    assert results[0]["flips"] > 0


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


def test_an_interrupted_scalar_filter_keeps_the_transform(bumpy, monkeypatch):
    bumpy.set_matrix(transformmatrix=random_transform(), freeze=False)
    apply = native._apply_filter

    def interrupted(ms, name, **given):
        if name == "set_matrix_identity":
            signal.raise_signal(signal.SIGINT)
        return apply(ms, name, **given)

    monkeypatch.setattr(native, "_apply_filter", interrupted)
    with pytest.raises(KeyboardInterrupt):
        bumpy.compute_scalar_by_willmore_energy_per_vertex()
    np.testing.assert_array_equal(bumpy.current_mesh().transform_matrix(), random_transform())
    assert native.ids(bumpy) == [0]


def test_overridden_methods_do_not_come_between():
    class Odd(pymeshlab.MeshSet):
        def load_new_mesh(self, path):
            super().load_new_mesh(path)
            self.compute_matrix_from_translation(axisx=100.0, freeze=True)

        def add_mesh(self, mesh, *, label):
            super().add_mesh(mesh, label)

    ms = Odd()
    vertices, faces = meshes.bumpy_sphere(100)
    ms.add_mesh(pymeshlab.Mesh(vertices, faces), label="mesh")
    assert ms.apply_filter(FLIP)["flips"] > 0
    ms.compute_scalar_by_willmore_energy_per_vertex()
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), vertices)


INTERRUPTED = """
import os, signal, sys, threading, time
import numpy as np, pymeshlab, meshlab_willmore
sys.path.insert(0, sys.argv[1])
from tests import meshes
ms = pymeshlab.MeshSet()
ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(200)))
ms.apply_filter("meshing_edge_flip_by_willmore_optimization")
ms.clear()
vertices, faces = meshes.torus(150_000, None, 1)
ms.add_mesh(pymeshlab.Mesh(vertices, faces))
sent = []
def interrupt():
    time.sleep(0.6)
    sent.append(time.perf_counter())
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
try:
    ms.apply_filter("meshing_edge_flip_by_willmore_optimization")
    print("done")
except KeyboardInterrupt:
    late = time.perf_counter() - sent[0]
    same = np.array_equal(ms.current_mesh().face_matrix(), faces)
    print("interrupted", late < 1.0, same, len(ms), ms.current_mesh_id(), late)
"""


@pytest.mark.heavy
@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
def test_ctrl_c_stops_a_long_run_and_changes_nothing(request):
    root = str(request.config.rootpath)
    run = subprocess.run(
        [sys.executable, "-c", INTERRUPTED, root], capture_output=True, text=True, timeout=300
    )
    assert run.stdout.startswith("interrupted True True 1 0"), run.stdout + run.stderr


AFTER_A_FAILURE = """
import sys
import pymeshlab, meshlab_willmore
sys.path.insert(0, sys.argv[1])
from tests import meshes
ms = pymeshlab.MeshSet()
ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(200)))
for _ in range(20):
    failing = pymeshlab.MeshSet()
    failing.add_mesh(pymeshlab.Mesh(*meshes.fin()[:2]))
    try:
        failing.meshing_edge_flip_by_planar_optimization()
    except pymeshlab.PyMeshLabException:
        pass
    del failing
    rubbish = [bytearray(n) for n in range(100, 4000, 7)]
    ms.meshing_edge_flip_by_willmore_optimization()
print("alive")
"""


def test_a_native_failure_in_a_set_that_is_gone_does_no_harm(request):
    root = str(request.config.rootpath)
    run = subprocess.run(
        [sys.executable, "-c", AFTER_A_FAILURE, root], capture_output=True, text=True, timeout=300
    )
    assert run.stdout.strip() == "alive", run.stderr
