"""Ids of layers beside our filters: as callers and filter scripts count them, and PyMeshLab's."""

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.meshset import exchange, ids, native
from tests import meshes
from tests.meshset.conftest import FLIP, set_of

SCALAR = "compute_scalar_by_willmore_energy_per_vertex"


def two():
    """A set with two meshes to flip, the first one current."""
    ms = set_of(*meshes.bumpy_sphere(100))
    ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(120)), "other")
    ms.set_current_mesh(0)
    return ms


def next_id(ms):
    """The id of the next layer, which stays in the set."""
    ms.add_mesh(pymeshlab.Mesh(np.zeros((1, 3))))
    return ms.current_mesh_id()


@pytest.mark.parametrize("deleted", [0, 1, 3])
def test_flips_of_a_lone_mesh_leave_its_id_and_the_next_one(bumpy, deleted):
    for _ in range(deleted):
        next_id(bumpy)
        bumpy.delete_current_mesh()
    bumpy.set_current_mesh(0)
    assert bumpy.apply_filter(FLIP)["flips"] > 0
    assert bumpy.current_mesh_id() == 0
    assert next_id(bumpy) == deleted + 1
    assert ids.logical_id(bumpy, deleted + 1) == deleted + 1


def test_a_lone_mesh_with_a_large_id_gets_a_new_one(bumpy, monkeypatch):
    monkeypatch.setattr("meshlab_willmore.meshset.layers._MOST_IDS_TO_REBUILD", 2)
    for _ in range(4):
        next_id(bumpy)
        bumpy.delete_current_mesh()
    bumpy.set_current_mesh(0)
    assert bumpy.apply_filter(FLIP)["mesh_id"] == 0
    assert native.ids(bumpy) == [6]
    assert bumpy.current_mesh().id() == bumpy.current_mesh_id() == 0
    assert next_id(bumpy) == 5


def test_a_replaced_layer_keeps_its_logical_id():
    ms = two()
    assert ms.apply_filter(FLIP)["mesh_id"] == 0
    assert (native.ids(ms), ids.logical_id(ms, 2)) == ([1, 2], 0)
    ms.set_current_mesh(1)
    assert ms.apply_filter(FLIP)["mesh_id"] == 1
    assert (native.ids(ms), ids.logical_id(ms, 3)) == ([2, 3], 1)
    ms.set_current_mesh(0)
    assert ms.apply_filter(FLIP, energy="willmore")["mesh_id"] == 0
    assert (native.ids(ms), ids.physical_id(ms, 0)) == ([3, 4], 4)


def test_layers_made_after_flips_are_counted_as_if_there_were_none():
    ms = two()
    ms.apply_filter(FLIP)
    assert next_id(ms) == 2
    assert ids.physical_id(ms, 2) == 3


def test_the_helper_layer_of_the_scalar_is_not_counted():
    ms = two()
    ms.apply_filter(SCALAR)
    assert next_id(ms) == 2
    assert not ms.mesh_id_exists(3)


def test_the_mesh_before_the_flips_is_not_what_its_id_means_while_it_is_held():
    ms = two()
    held = ms.current_mesh()
    before = held.face_matrix()
    ms.apply_filter(FLIP)
    assert held.id() == 0
    assert ms.mesh(0) is not held
    assert (ms.mesh(0).face_matrix() != before).any()
    ms.delete_current_mesh()
    assert not ms.mesh_id_exists(0), "not the one before, either"


def test_an_emptied_set_starts_anew():
    ms = two()
    ms.apply_filter(FLIP)
    ms.clear()
    assert next_id(ms) == 0
    assert not ids.has_moved(ms)
    assert ids.logical_id(ms, 3) == 3


def test_a_load_that_fails_is_not_counted(monkeypatch):
    ms = two()
    load = exchange._load

    def fail(target, *args):
        load(target, *args)
        if target is ms:
            raise OSError("no room")

    monkeypatch.setattr(exchange, "_load", fail)
    with pytest.raises(pymeshlab.PyMeshLabException, match="no room"):
        ms.apply_filter(FLIP)
    monkeypatch.undo()
    assert next_id(ms) == 2
    assert native.ids(ms) == [0, 1, 3]


def test_native_filters_find_a_replaced_mesh_by_its_old_id():
    ms = two()
    ms.apply_filter(FLIP)
    ms.set_current_mesh(1)
    distance = ms.get_hausdorff_distance(sampledmesh=1, targetmesh=0, samplenum=10)
    assert distance["n_samples"] > 0
