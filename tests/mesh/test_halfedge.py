"""The flip, and whether it is allowed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshlab_willmore.mesh import halfedge
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import (
    NONE,
    apex,
    are_joined,
    diamond,
    flip,
    following,
    next_in_fan,
    previous,
)
from tests import meshes, reference
from tests.connectivity import can_flip, validate_connectivity

QUICK = settings(max_examples=25)
MIXED = [
    meshes.bumpy_sphere(30),
    meshes.patch(30),
    meshes.moebius_band(),
    meshes.fin()[:2],
    meshes.bow_tie(),
    meshes.cube(),
    meshes.hubs(),
    (meshes.hubs()[0], meshes.hubs()[1][5:]),
]


def flippable(mesh):
    return [h for h in range(len(mesh.origin)) if can_flip(mesh, h)]


def around(mesh, h):
    """The vertices i, j, k, l of the diamond."""
    t = mesh.twin[h]
    return tuple(int(v) for v in (mesh.origin[h], mesh.origin[t], apex(mesh, h), apex(mesh, t)))


def cyclic(face):
    """A face as a tuple that starts at its lowest vertex."""
    face = [int(v) for v in face]
    return tuple(np.roll(face, -face.index(min(face))).tolist())


def test_next_and_previous_stay_in_the_face():
    h = np.arange(12)
    ahead = np.array([following(x) for x in range(12)])
    assert (ahead // 3 == h // 3).all()
    assert [previous(x) for x in ahead.tolist()] == h.tolist()
    assert [following(following(following(x))) for x in range(12)] == h.tolist()


@pytest.mark.parametrize("mesh_index", range(len(MIXED)))
def test_a_fan_is_a_ring_of_half_edges_from_one_vertex(mesh_index):
    mesh = build(*MIXED[mesh_index])
    for start in range(len(mesh.origin)):
        ring = [start]
        while (h := next_in_fan(mesh, ring[-1])) != start:
            ring.append(h)
            assert len(ring) <= len(mesh.origin)
        v = mesh.origin[start]
        assert (mesh.origin[ring] == v).all()
        if not mesh.several_fans[v]:
            assert sorted(ring) == np.flatnonzero(mesh.origin == v).tolist()


def test_flip_puts_the_two_new_faces_into_the_slots_of_the_old():
    mesh = build(*meshes.two_triangles())
    i, j, k, l = around(mesh, 0)
    flip(mesh, 0)
    first, second = faces_of(mesh)
    assert cyclic(first) == cyclic((k, i, l))
    assert cyclic(second) == cyclic((l, j, k))
    assert around(mesh, 0) == (l, k, i, j)


def test_flip_touches_nothing_outside_the_two_faces():
    vertices, faces = meshes.bumpy_sphere(30)
    for h in flippable(build(vertices, faces)):
        mesh = build(vertices, faces)
        inside = [h // 3, mesh.twin[h] // 3]
        flip(mesh, h)
        outside = np.delete(np.arange(len(faces)), inside)
        np.testing.assert_array_equal(faces_of(mesh)[outside], faces[outside])
        np.testing.assert_array_equal(
            mesh.corner.reshape(-1, 3)[outside], np.arange(faces.size).reshape(-1, 3)[outside]
        )


@pytest.mark.parametrize("mesh_index", range(len(MIXED)))
def test_four_flips_give_the_mesh_back(mesh_index):
    vertices, faces = MIXED[mesh_index]
    original = build(vertices, faces)
    original.locked[0::7] = True
    original.locked[original.twin[original.locked & (original.twin != NONE)]] = True
    for h in flippable(original):
        mesh = original._replace(
            **{
                name: getattr(original, name).copy()
                for name in ("origin", "twin", "locked", "corner")
            }
        )
        for _ in range(4):
            flip(mesh, h)
        for name in ("origin", "twin", "locked"):
            np.testing.assert_array_equal(getattr(mesh, name), getattr(original, name))
        np.testing.assert_array_equal(mesh.origin, original.origin[mesh.corner])


@QUICK
@given(st.integers(0, len(MIXED) - 1), st.lists(st.integers(0, 10**6), min_size=1, max_size=25))
def test_connectivity_is_valid_after_every_flip(mesh_index, choices):
    vertices, faces = MIXED[mesh_index]
    mesh = build(vertices, faces)
    chi = len(reference.edge_set(faces))
    for choice in choices:
        h = flippable(mesh)[choice % len(flippable(mesh))]
        i, j, k, l = around(mesh, h)
        edges = reference.edge_set(faces_of(mesh))
        flip(mesh, h)
        validate_connectivity(mesh)
        expected = (edges - {(min(i, j), max(i, j))}) | {(min(k, l), max(k, l))}
        assert reference.edge_set(faces_of(mesh)) == expected
        assert len(expected) == chi
        np.testing.assert_array_equal(mesh.origin, faces.ravel()[mesh.corner])


@pytest.mark.parametrize("mesh_index", range(len(MIXED)))
def test_can_flip_agrees_with_a_search_of_all_edges(mesh_index):
    vertices, faces = MIXED[mesh_index]
    mesh = build(vertices, faces)
    edges = reference.edge_set(faces)
    valence = np.bincount(np.array(sorted(edges)).ravel(), minlength=len(vertices))
    for h in np.flatnonzero(mesh.twin != NONE):
        i, j, k, l = around(mesh, h)
        allowed = k != l and (min(k, l), max(k, l)) not in edges and min(valence[[i, j]]) > 3
        # At vertices with several fans a flip may be refused although it were possible.
        if can_flip(mesh, h):
            assert allowed
        elif not mesh.several_fans[[i, j, k, l]].any():
            assert not allowed


@pytest.mark.parametrize("few", [halfedge.FEW_EDGES, 2])
@pytest.mark.parametrize("mesh_index", range(len(MIXED)))
def test_vertices_are_joined_by_an_edge_or_if_in_doubt(mesh_index, few, monkeypatch):
    # Compiled kernels keep the number that they were compiled with.
    monkeypatch.setattr(halfedge, "FEW_EDGES", few)
    mesh = build(*MIXED[mesh_index])
    edges = reference.edge_set(faces_of(mesh))
    for a in range(len(mesh.origin)):
        for b in range(a % 7, len(mesh.origin), 7):
            u, v = sorted((int(mesh.origin[a]), int(mesh.origin[b])))
            if u != v:
                in_doubt = mesh.several_fans[u] and mesh.several_fans[v]
                assert are_joined(mesh, a, b) == ((u, v) in edges or in_doubt)


def test_nothing_flips_in_small_meshes():
    for vertices, faces in (meshes.tetrahedron(), meshes.two_triangles()):
        assert flippable(build(vertices, faces)) == []


def test_two_faces_back_to_back_do_not_flip():
    vertices, faces = meshes.two_triangles()
    assert flippable(build(vertices, np.vstack([faces[:1], faces[:1, ::-1]]))) == []


def test_an_edge_between_two_vertices_of_several_fans_is_not_made_twice():
    """The new edge would join two bow-tie vertices whose first fans do not see the old edge."""
    ring = [(0, 2, 4), (0, 4, 3), (0, 3, 5), (0, 5, 2), (1, 4, 2), (1, 3, 4), (1, 5, 3), (1, 2, 5)]
    faces = np.array([*ring, (0, 1, 6)], np.int32)
    vertices = np.random.default_rng(0).normal(size=(7, 3))
    mesh = build(vertices, faces)
    assert mesh.several_fans[[0, 1]].all()
    opposite = [h for h in range(24) if {0, 1} <= set(around(mesh, h)[2:])]
    assert len(opposite) == 8
    assert not any(can_flip(mesh, h) for h in opposite)


def test_a_locked_edge_does_not_flip():
    mesh = build(*meshes.octahedron())
    assert len(flippable(mesh)) == len(mesh.origin)
    mesh.locked[[3, mesh.twin[3]]] = True
    assert 3 not in flippable(mesh)
    assert len(flippable(mesh)) == len(mesh.origin) - 2


def test_the_diamond_is_the_one_of_the_picture():
    vertices, faces = meshes.bumpy_sphere(20)
    mesh = build(vertices, faces)
    for h in range(len(mesh.origin)):
        np.testing.assert_array_equal(diamond(mesh, h), vertices[list(around(mesh, h))])


def test_corners_stay_on_their_side_of_locked_edges():
    """Two rows of a grid, the line between them locked: corners never change the row."""
    vertices, faces = meshes.grid(6, 8)
    vertices[:, 2] = np.random.default_rng(0).random(len(vertices))
    mesh = build(vertices, faces)
    middle = vertices[mesh.origin, 1] == 3
    ahead = middle[[following(h) for h in range(len(middle))]]
    mesh.locked[middle & ahead] = True
    upper = np.arange(len(faces)) >= len(faces) // 2
    rng = np.random.default_rng(1)
    for _ in range(200):
        flip(mesh, rng.choice(flippable(mesh)))
    np.testing.assert_array_equal(np.repeat(upper, 3)[mesh.corner], np.repeat(upper, 3))
    np.testing.assert_array_equal(mesh.origin, faces.ravel()[mesh.corner])
