"""Half-edge connectivity against the dictionaries of the reference."""

import numpy as np
import pytest

from meshlab_willmore.mesh.build import (
    build,
    faces_of,
    interior_vertices,
    sort_by_vertex,
)
from meshlab_willmore.mesh.halfedge import NONE
from tests import meshes, reference
from tests.connectivity import validate_connectivity

MESHES = {
    "tetrahedron": meshes.tetrahedron(),
    "cube": meshes.cube(),
    "bumpy sphere": meshes.bumpy_sphere(50),
    "patch": meshes.patch(40),
    "two triangles": meshes.two_triangles(),
    "moebius band": meshes.moebius_band(),
    "fin": meshes.fin()[:2],
    "bow tie": meshes.bow_tie(),
    "hubs": meshes.hubs(),
    "open hubs": (meshes.hubs()[0], meshes.hubs()[1][5:]),
    "duplicate faces": (meshes.cube()[0], np.vstack([meshes.cube()[1]] * 2)),
    "no faces": (np.zeros((4, 3)), np.empty((0, 3), np.int32)),
    "nothing": (np.zeros((0, 3)), np.empty((0, 3), np.int32)),
}


@pytest.fixture(params=MESHES, name="mesh")
def _mesh(request):
    return build(*MESHES[request.param])


def test_sorting_by_vertex_is_stable_and_returns_where_each_vertex_starts():
    vertex = np.random.default_rng(0).integers(0, 9, 60)
    order = np.random.default_rng(1).permutation(60)
    starts = np.full(11, 77)
    found = sort_by_vertex(order, vertex, starts)
    wanted = [[h for h in order if vertex[h] == v] for v in range(9)]
    assert found.tolist() == [h for group in wanted for h in group]
    assert [found[starts[v] : starts[v + 1]].tolist() for v in range(9)] == wanted


def test_twins_are_those_of_the_reference(mesh):
    edges = np.flatnonzero(np.arange(len(mesh.twin)) < mesh.twin)
    pairs = np.sort(np.column_stack([mesh.origin[edges], mesh.origin[mesh.twin[edges]]]), axis=1)
    wanted = np.sort(reference.diamonds(faces_of(mesh))[:, :2], axis=1)
    assert sorted(pairs.tolist()) == sorted(wanted.tolist())
    validate_connectivity(mesh)


def test_interior_vertices_are_those_of_the_reference(mesh):
    wanted = reference.interior_vertices(faces_of(mesh), len(mesh.vertices))
    np.testing.assert_array_equal(interior_vertices(mesh), wanted)


def test_build_copies_the_faces_and_starts_unlocked(mesh):
    faces = faces_of(mesh)
    faces[:] = -7
    assert (mesh.origin >= 0).all()
    assert not mesh.locked.any()
    assert mesh.corner.tolist() == list(range(len(mesh.origin)))


def test_only_the_shared_vertex_of_a_bow_tie_has_several_fans():
    assert np.flatnonzero(build(*meshes.bow_tie()).several_fans).tolist() == [0]


def test_a_fin_gives_several_fans_to_the_ends_of_its_edge_and_no_twins():
    vertices, faces, other = meshes.fin()
    mesh = build(vertices, faces)
    assert np.flatnonzero(mesh.several_fans).tolist() == [0, other]
    ends = mesh.origin, faces[:, [1, 2, 0]].ravel()
    on_edge = np.sort(np.column_stack(ends), axis=1).tolist()
    half_edges = [h for h, pair in enumerate(on_edge) if pair == [0, other]]
    assert len(half_edges) == 3
    assert (mesh.twin[half_edges] == NONE).all()


def test_neighbours_of_opposite_orientation_are_no_twins():
    vertices, faces = meshes.two_triangles()
    faces[1] = faces[1][::-1]
    assert (build(vertices, faces).twin == NONE).all()


@pytest.mark.parametrize("field", ["twin", "origin", "locked", "several_fans"])
def test_validation_finds_a_broken_invariant(field):
    mesh = build(*meshes.bumpy_sphere(20))
    array = getattr(mesh, field)
    array[5] = {"twin": array[6], "origin": array[4]}.get(field, True)
    with pytest.raises(ValueError, match="half-edge"):
        validate_connectivity(mesh)
