"""Helper filters leave no trace: in the script, on the terminal, in verbosity."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.meshset import native
from tests import meshes
from tests.meshset.conftest import FLIP, random_transform, script_of


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


def test_a_filter_script_that_cannot_be_written_is_an_error_beforehand(bumpy, monkeypatch):
    bumpy.set_selection_none()
    before, faces = script_of(bumpy), bumpy.current_mesh().face_matrix()
    monkeypatch.setattr(native._own, "save_filter_script", lambda ms, path: None)
    with pytest.raises(pymeshlab.PyMeshLabException, match="filter script could not be written"):
        bumpy.apply_filter(FLIP)
    monkeypatch.undo()
    assert script_of(bumpy) == before
    np.testing.assert_array_equal(bumpy.current_mesh().face_matrix(), faces)


def move(ms):
    ms.set_matrix(transformmatrix=random_transform(), freeze=False)


HELPED = {
    "moved": move,
    "selected": lambda ms: ms.set_selection_all(),
    "second id": lambda ms: (ms.add_mesh(ms.current_mesh()), ms.delete_current_mesh()),
    "beside another": lambda ms: ms.add_mesh(ms.current_mesh()),
}


@pytest.mark.parametrize("prepare", HELPED.values(), ids=HELPED)
def test_a_script_that_cannot_be_kept_is_an_error_before_helper_filters(
    bumpy, monkeypatch, prepare
):
    prepare(bumpy)
    before, faces = script_of(bumpy), bumpy.current_mesh().face_matrix()
    ids, save, calls = [mesh.id() for mesh in bumpy], native._own.save_filter_script, []

    def only_once(ms, path):
        """The first time the script is read for the step that is noted."""
        calls.append(path)
        if len(calls) == 1:
            save(ms, path)

    monkeypatch.setattr(native._own, "save_filter_script", only_once)
    with pytest.raises(pymeshlab.PyMeshLabException, match="filter script could not be written"):
        bumpy.apply_filter(FLIP)
    monkeypatch.undo()
    assert script_of(bumpy) == before
    assert [mesh.id() for mesh in bumpy] == ids
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


def test_the_working_folder_is_kept_also_one_that_was_moved_or_deleted(tmp_path, monkeypatch):
    (tmp_path / "scans").mkdir()
    broken = tmp_path / "scans" / "broken.ply"
    broken.write_text("no mesh")
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    with pytest.raises(pymeshlab.PyMeshLabException), native.kept_working_folder():
        pymeshlab.MeshSet().load_new_mesh(str(broken))
    assert Path.cwd() == here
    with native.kept_working_folder():
        os.chdir(broken.parent)
        here.rename(tmp_path / "there")
    assert Path.cwd() == tmp_path / "there"
    Path.cwd().rmdir()
    with native.kept_working_folder():
        os.chdir(broken.parent)
    with pytest.raises(FileNotFoundError):
        Path.cwd()
    os.chdir(tmp_path)


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


@pytest.mark.slow
def test_a_native_failure_in_a_set_that_is_gone_does_no_harm(request):
    root = str(request.config.rootpath)
    run = subprocess.run(
        [sys.executable, "-c", AFTER_A_FAILURE, root], capture_output=True, text=True, timeout=300
    )
    assert run.stdout.strip() == "alive", run.stderr
