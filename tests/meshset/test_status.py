"""What PyMeshLab prints and saves of the layers: as if flips kept their places."""

import re

import pymeshlab

from tests import meshes
from tests.meshset.conftest import FLIP


def three():
    ms = pymeshlab.MeshSet()
    for n in range(3):
        ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(40 + n)), f"mesh\n\n{n}")
    ms.set_current_mesh(0)
    return ms


def test_the_status_tells_ids_that_lead_to_the_meshes(capfd):
    ms = three()
    held = ms.current_mesh()
    ms.apply_filter(FLIP)
    capfd.readouterr()
    ms.print_status()
    printed = capfd.readouterr().out
    assert printed.startswith("Number meshes: 3\n\tMesh id: 0\n")
    assert re.findall(r"Mesh id: (\d)\n\tMesh label: mesh\n\n(\d)\n", printed) == [
        ("0", "0"),
        ("1", "1"),
        ("2", "2"),
    ]
    assert held.id() == 0


def test_a_project_has_the_meshes_in_their_order(tmp_path):
    ms = three()
    ms.apply_filter(FLIP)
    for n in range(3):
        ms.set_current_mesh(n)
        ms.save_current_mesh(str(tmp_path / f"{n}.ply"))
    ms.set_mesh_visibility(1, False)
    project = str(tmp_path / "all.mlp")
    ms.save_project(project)
    loaded = pymeshlab.MeshSet()
    loaded.load_project(project)
    # PyMeshLab leaves hidden meshes out.
    assert [(mesh.id(), mesh.vertex_number()) for mesh in loaded] == [(0, 40), (1, 42)]
