"""Polygons, edge selections and seams between textures stay, by the flags of edges."""

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import optimize_flips
from meshlab_willmore.meshset import edge_flags
from meshlab_willmore.meshset.edge_flags import fixed_edges
from meshlab_willmore.meshset.snapshot import take
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, set_of
from tests.meshset.contents import quad_set, surface


def polygons_of(ms):
    return sorted(tuple(sorted(p)) for p in ms.current_mesh().polygonal_face_list() if len(p) > 3)


def test_polygons_survive():
    ms = quad_set()
    before = polygons_of(ms)
    assert len(before) == 32
    assert ms.apply_filter(FLIP)["flips"] > 0
    assert polygons_of(ms) == before


def test_polygons_of_a_real_mesh_survive():
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "cow.obj"))
    ms.compute_selection_by_condition_per_face(condselect="fi < 2500")
    ms.meshing_tri_to_quad_dominant()
    before = polygons_of(ms)
    assert len(before) > 1000
    ms.apply_filter(FLIP, selection=False, energy="willmore")
    assert polygons_of(ms) == before


@pytest.mark.parametrize("first_bit", edge_flags._SIDE_BITS)
def test_side_bits_move_with_their_sides(first_bit):
    """A flip beside a marked side turns its face in the slot: the mark has to stay on the side."""
    ms = set_of(*meshes.patch(60))
    snapshot = take(ms)
    records = snapshot.ply.faces
    marked = np.flatnonzero(records["vertex_indices"] % 2 == 0)
    records["flags"] = 0
    for side in marked:
        records["flags"][side // 3] |= 1 << (first_bit + side % 3)
    new = optimize_flips(snapshot.vertices, snapshot.faces)
    assert new.flips > 10
    flags = edge_flags.carry_side_bits(snapshot.ply, new.faces)
    before = sides_of(snapshot.faces, records["flags"], first_bit)
    after = sides_of(new.faces, flags, first_bit)
    kept = before.keys() & after.keys()
    assert len(kept) < len(before), "some sides are flipped away"
    assert {side: after[side] for side in kept} == {side: before[side] for side in kept}
    assert not any(after[side] for side in after.keys() - kept), "new sides are not marked"


def sides_of(faces, flags, first_bit):
    bits = edge_flags._side_bits(flags, first_bit)
    heads = np.roll(faces, -1, axis=1)
    both = zip(faces.ravel().tolist(), heads.ravel().tolist(), strict=True)
    return dict(zip(both, bits.ravel().tolist(), strict=True))


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
