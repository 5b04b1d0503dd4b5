"""Whatever a mesh has survives alone as well, and brings nothing with it."""

import numpy as np
import pytest

from meshlab_willmore.meshset import exchange, ply
from meshlab_willmore.meshset.snapshot import selected, take
from tests.meshset.conftest import FLIP
from tests.meshset.contents import (
    ATTRIBUTES,
    assert_same_state,
    plain_set,
    quad_set,
    rich_set,
    state,
)


def with_filter(name, **options):
    def make(tmp_path):
        ms = plain_set(tmp_path)
        ms.apply_filter(name, **options)
        return ms

    return make


def with_attribute(tmp_path):
    ms = plain_set(tmp_path)
    ms.current_mesh().add_face_custom_scalar_attribute(np.arange(596) / 7, "Mine")
    return ms


# Such that the two faces of an edge agree: else all edges would be seams.
WEDGES = {"u0": "x0", "v0": "y0", "u1": "x1", "v1": "y1", "u2": "x2", "v2": "y2"}
ALONE = {
    "nothing": plain_set,
    "vertex selection": with_filter("compute_selection_by_condition_per_vertex", condselect="vi>9"),
    "face selection": with_filter("compute_selection_by_condition_per_face", condselect="fi>99"),
    "edge selection": with_filter("compute_selection_crease_per_edge"),
    "vertex colours": with_filter("compute_color_by_function_per_vertex", x="vi/2"),
    "face colours": with_filter("compute_color_by_function_per_face", r="fi/3"),
    "vertex scalars": with_filter("compute_scalar_by_function_per_vertex", q="x*y"),
    "face scalars": with_filter("compute_scalar_by_function_per_face", q="fi/7"),
    "vertex texture": with_filter("compute_texcoord_by_function_per_vertex", u="x", v="y"),
    "wedge texture": with_filter("compute_texcoord_by_function_per_wedge", **WEDGES),
    "quads": lambda _: quad_set(),
    "radii": lambda tmp_path: plain_set(tmp_path, radius=True),
    "edges": lambda tmp_path: plain_set(tmp_path, edges=[(0, 5), (9, 2)]),
    "attribute": with_attribute,
}


@pytest.mark.parametrize("make", ALONE.values(), ids=ALONE)
def test_each_thing_survives_alone_and_nothing_comes_with_it(make, tmp_path):
    ms = make(tmp_path)
    before, shown = take(ms), state(ms)
    assert ms.apply_filter(FLIP)["flips"] > 0
    assert_same_state(state(ms), shown)
    after = take(ms)
    assert after.ply.vertices.dtype == before.ply.vertices.dtype
    assert after.ply.vertices.tobytes() == before.ply.vertices.tobytes()
    assert after.ply.faces.dtype == before.ply.faces.dtype
    for field in set(before.ply.faces.dtype.names) - {"vertex_indices", "flags", "texcoord"}:
        np.testing.assert_array_equal(after.ply.faces[field], before.ply.faces[field])
    for left, right in zip(after.attributes, before.attributes, strict=True):
        assert left[:2] == right[:2]
        np.testing.assert_array_equal(left.values, right.values)


def test_a_plain_mesh_travels_with_positions_faces_and_normals_only(tmp_path, monkeypatch):
    written, write = [], ply.write

    def noted(path, mesh):
        written.append(mesh)
        write(path, mesh)

    ms = plain_set(tmp_path)
    monkeypatch.setattr(exchange.ply, "write", noted)
    assert ms.apply_filter(FLIP)["flips"] > 0
    part, whole = written
    for mesh in (part, whole):
        assert mesh.vertices.dtype.names == ("x", "y", "z", "nx", "ny", "nz")
        assert mesh.faces.dtype.names == ("vertex_indices_count", "vertex_indices")
    assert len(part.faces) == 100
    assert len(whole.faces) == 596


def test_the_whole_mesh_is_loaded_once(tmp_path, monkeypatch):
    loads, load = [], exchange.native.load

    def noted(target, path):
        load(target, path)
        loads.append((target is ms, target.current_mesh().face_number()))

    ms = plain_set(tmp_path)
    monkeypatch.setattr(exchange.native, "load", noted)
    assert ms.apply_filter(FLIP)["flips"] > 0
    assert loads == [(False, 100), (True, 596)]


def test_the_part_that_is_tried_has_all_that_the_mesh_has():
    """Flags, edges and attributes too, which need not lie at the beginning."""
    whole = take(rich_set())
    for records, selected_one in ((whole.ply.faces, 555), (whole.ply.vertices, 288)):
        records["flags"] = 0
        records["flags"][selected_one] = 0x20
    part = exchange._part(whole)
    assert len(part.ply.faces) == 101
    assert selected(part.ply.faces).nonzero()[0].tolist() == [100]
    assert selected(part.ply.vertices).sum() == 1
    assert part.ply.faces.dtype == whole.ply.faces.dtype
    assert len(part.attributes) == len(whole.attributes) == 4 * len(ATTRIBUTES)
    corners = part.vertices[part.faces]
    kept = [*range(100), 555]
    np.testing.assert_array_equal(corners, whole.vertices[whole.faces[kept]])
    np.testing.assert_array_equal(part.vertices[part.ply.edges], whole.vertices[whole.ply.edges])
    place = {tuple(point): v for v, point in enumerate(whole.vertices.tolist())}
    rows = [place[tuple(point)] for point in part.vertices.tolist()]
    np.testing.assert_array_equal(part.normals, whole.normals[rows])
    for less, more in zip(part.attributes, whole.attributes, strict=True):
        wanted = rows if less.kind.startswith("v") else kept
        np.testing.assert_array_equal(less.values, more.values[wanted])
