"""The filter keeps texture mappings, be they of the corners of faces or of vertices."""

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.meshset.edge_flags import fixed_edges
from meshlab_willmore.meshset.snapshot import take
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, set_of
from tests.test_mapping import areas, counts, distorted

OPTIONS = {"energy": "area", "foldangle": 180.0}


def surface(seed):
    """A bumpy grid, and a mapping of it to a plane."""
    vertices, faces = meshes.grid(8, 8)
    vertices[:, 2] = 0.6 * np.random.default_rng(1).random(len(vertices))
    uv = vertices[:, :2].copy()
    distorted(vertices, faces, uv, seed)
    return vertices, faces, uv


def wedges_of(ms):
    return ms.current_mesh().wedge_tex_coord_matrix().reshape(-1, 3, 2)


def mapping_of_vertices(ms):
    mesh = ms.current_mesh()
    return mesh.vertex_tex_coord_matrix()[mesh.face_matrix()]


def test_a_mapping_of_corners_is_kept():
    vertices, faces, uv = surface(2)
    ms = set_of(vertices, faces, w_tex_coords_matrix=uv[faces].reshape(-1, 2))
    assert ms.apply_filter(FLIP, **OPTIONS)["flips"] > 5
    after = wedges_of(ms)
    assert counts(after) == (len(faces), 0, 0)
    np.testing.assert_array_equal(after, uv[ms.current_mesh().face_matrix()])


def test_a_mapping_of_vertices_is_kept():
    vertices, faces, uv = surface(2)
    ms = set_of(vertices, faces, v_tex_coords_matrix=-uv[:, ::-1])
    assert ms.apply_filter(FLIP, **OPTIONS)["flips"] > 5
    assert counts(mapping_of_vertices(ms)) == (0, len(faces), 0)


def test_with_both_mappings_both_are_kept():
    vertices, faces, uv = surface(2)
    other = surface(3)[2]
    ms = set_of(
        vertices,
        faces,
        w_tex_coords_matrix=uv[faces].reshape(-1, 2),
        v_tex_coords_matrix=other,
    )
    assert ms.apply_filter(FLIP, **OPTIONS)["flips"] > 5
    assert counts(wedges_of(ms)) == counts(mapping_of_vertices(ms)) == (len(faces), 0, 0)


def test_coordinates_that_are_not_finite_do_no_harm():
    vertices, faces, uv = surface(2)
    wedges = uv[faces]
    wedges[5, 1, 0] = np.nan
    ms = set_of(vertices, faces, w_tex_coords_matrix=wedges.reshape(-1, 2))
    assert ms.apply_filter(FLIP, **OPTIONS)["flips"] > 5
    np.testing.assert_array_equal(ms.current_mesh().face_matrix()[5], faces[5])
    finite = np.isfinite(wedges_of(ms)).all(axis=(1, 2))
    assert finite.sum() == len(faces) - 1
    assert (areas(wedges_of(ms)[finite]) > 0.0).all()


def test_edges_between_two_textures_are_fixed_without_a_seam_in_the_coordinates():
    vertices, faces, uv = surface(2)
    snapshot = take(set_of(vertices, faces, w_tex_coords_matrix=uv[faces].reshape(-1, 2)))
    records = snapshot.ply.faces
    number = (vertices[faces].mean(axis=1)[:, 0] > 4.0).astype(np.int32)
    fields = {name: kind for name, (kind, *_) in records.dtype.fields.items()}
    with_number = np.zeros(len(records), [*fields.items(), ("texnumber", np.int32)])
    for name in fields:
        with_number[name] = records[name]
    assert len(fixed_edges(snapshot)) == 0
    with_number["texnumber"] = number
    between = fixed_edges(snapshot._replace(ply=snapshot.ply._replace(faces=with_number)))
    wanted = {frozenset((9 * y + 4, 9 * y + 13)) for y in range(8)}
    assert set(map(frozenset, between.tolist())) == wanted


@pytest.mark.heavy
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"energy": "delaunay", "search": "greedy"},
        {"energy": "mean curvature", "search": "variable depth", "depth": 3, "breadth": 1},
    ],
)
@pytest.mark.slow
def test_the_mapping_of_a_real_mesh_is_kept(options):
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "bunny10k_textured.obj"))
    before = counts(wedges_of(ms))
    assert ms.apply_filter(FLIP, **options)["flips"] > 100
    after = counts(wedges_of(ms))
    assert after[0] >= before[0]
    assert after[1] >= before[1]
