"""Locks."""

import math
import time

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import NONE
from tests import meshes, reference
from tests.connectivity import validate_connectivity

CUBE_EDGES = {(a, b) for a in range(8) for b in range(8) if a < b and (a ^ b) in (1, 2, 4)}


def locked_pairs(mesh):
    ahead = mesh.origin.reshape(-1, 3)[:, [1, 2, 0]].ravel()
    pairs = np.sort(np.column_stack([mesh.origin, ahead])[mesh.locked], axis=1)
    return set(map(tuple, pairs.tolist()))


def test_only_edges_between_two_selected_faces_stay_free():
    vertices, faces = meshes.bumpy_sphere(40)
    mesh = build(vertices, faces)
    selected = np.random.default_rng(0).random(len(faces)) < 0.7
    guards.lock_unselected(mesh, selected)
    own, other = np.arange(len(mesh.twin)) // 3, mesh.twin // 3
    np.testing.assert_array_equal(mesh.locked, ~(selected[own] & selected[other]))


def test_creases_are_the_edges_sharper_than_the_limit():
    mesh = build(*meshes.cube(push=0.0))
    guards.lock_creases(mesh, math.radians(45.0))
    assert locked_pairs(mesh) == CUBE_EDGES


def cylinder(sides):
    """An open cylinder; also its edges along the axis, as vertex pairs."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(sides)])
    here, ahead = np.arange(sides), np.roll(np.arange(sides), -1)
    faces = np.vstack(
        [
            np.column_stack([here, ahead, ahead + sides]),
            np.column_stack([here, ahead + sides, here + sides]),
        ]
    )
    generators = set(zip(here.tolist(), (here + sides).tolist(), strict=True))
    return np.vstack([ring, ring + (0.0, 0.0, 1.0)]), faces.astype(np.int32), generators


CUBE = *meshes.cube(push=0.0), CUBE_EDGES


@pytest.mark.parametrize("precision", [np.float64, np.float32])
@pytest.mark.parametrize(
    ("part", "degrees"), [(CUBE, 90.0), (cylinder(12), 30.0), (cylinder(8), 45.0)]
)
def test_edges_at_the_limit_are_creases_wherever_the_part_lies(part, degrees, precision):
    vertices, faces, edges = part
    for seed in range(12):
        matrix, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
        turned = (vertices @ matrix + seed).astype(precision).astype(float)
        for limit, wanted in ((degrees, edges), (0.0, edges), (degrees + 0.1, set())):
            mesh = build(turned, faces)
            guards.lock_creases(mesh, math.radians(limit))
            assert locked_pairs(mesh) == wanted


def test_caller_locks_edges_in_either_direction():
    vertices, faces = meshes.cube()
    mesh = build(vertices, faces)
    guards.lock_edges(mesh, np.array([(faces[0, 1], faces[0, 0]), faces[5, :2]], np.int64))
    wanted = {tuple(sorted(faces[0, :2].tolist())), tuple(sorted(faces[5, :2].tolist()))}
    assert locked_pairs(mesh) == wanted
    assert (mesh.locked[mesh.twin] == mesh.locked).all()


def test_caller_locks_boundary_and_non_manifold_edges():
    vertices, faces, other = meshes.fin()
    mesh = build(vertices, faces)
    guards.lock_edges(mesh, np.array([(0, other), faces[-1, 1:]], np.int64))
    assert mesh.locked.sum() == 4
    assert (mesh.twin[mesh.locked] == NONE).all()


@pytest.mark.parametrize("pair", [(0, 7), (3, 3), (0, 14), (-1, 0), (2**62, 1)])
def test_a_locked_pair_that_is_no_edge_is_named(pair):
    mesh = build(*meshes.cube())
    with pytest.raises(ValueError, match=rf"locked_edges\[1\] = \({pair[0]}, {pair[1]}\)"):
        guards.lock_edges(mesh, np.array([(0, 1), pair], np.int64))


@pytest.mark.parametrize("pairs", [[(0, 7), (0, 14)], [(0, 1), (0, 14), (0, 2)], [(14, 14)]])
def test_of_several_wrong_pairs_the_first_is_named(pairs):
    vertices, faces = meshes.cube()
    edges = reference.edge_set(faces)
    first = next(e for e, pair in enumerate(pairs) if pair not in edges)
    with pytest.raises(ValueError, match=rf"locked_edges\[{first}\] = "):
        guards.lock_edges(build(vertices, faces), np.array(pairs, np.int64))


@pytest.mark.parametrize("part", ["bumpy_sphere", "patch"])
def test_any_set_of_edges_can_be_locked(part):
    vertices, faces = getattr(meshes, part)(60)
    edges = np.array(sorted(reference.edge_set(faces)), np.int64)
    rng = np.random.default_rng(0)
    for count in (1, 20, len(edges)):
        mesh = build(vertices, faces)
        chosen = rng.permutation(edges)[:count]
        guards.lock_edges(mesh, np.vstack([chosen, chosen[::2, ::-1]]))
        assert locked_pairs(mesh) == set(map(tuple, chosen.tolist()))
        validate_connectivity(mesh)


@pytest.mark.heavy
def test_locking_all_spokes_of_a_wheel_takes_no_longer_than_others():
    count = 100_000
    rim = np.arange(count)
    faces = np.column_stack([rim, np.roll(rim, -1), np.full(count, count)]).astype(np.int32)
    spokes = np.column_stack([np.full(count, count), rim])
    mesh = build(np.zeros((count + 1, 3)), faces)
    guards.lock_edges(mesh, spokes[:1])
    start = time.perf_counter()
    guards.lock_edges(mesh, spokes)
    assert time.perf_counter() - start < 2.0
    assert mesh.locked.sum() == 2 * count


def test_locking_no_edges_locks_none():
    mesh = build(*meshes.cube())
    guards.lock_edges(mesh, np.empty((0, 2), np.int64))
    assert not mesh.locked.any()
