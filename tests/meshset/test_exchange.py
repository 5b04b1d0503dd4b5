"""Nothing of the mesh is lost: each promise on a mesh that has everything, then on real meshes."""

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.meshset import exchange, ply
from meshlab_willmore.meshset.snapshot import selected, take
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, set_of
from tests.meshset.contents import (
    ATTRIBUTES,
    assert_same_state,
    plain_set,
    quad_set,
    rich_set,
    seams_of,
    state,
)


@pytest.fixture(autouse=True)
def anew(monkeypatch):
    """Each mesh is the first of its kind in the process, and fills several blocks of rows."""
    monkeypatch.setattr(exchange, "_came_through", set())
    monkeypatch.setattr(ply, "_ROWS", 64)


def attributes_of(ms):
    """The values of the custom attributes of `rich_set`, by their real names."""
    mesh = ms.current_mesh()
    readers = {
        "": mesh.vertex_custom_scalar_attribute_array,
        "P": mesh.vertex_custom_point_attribute_matrix,
        "-f": mesh.face_custom_scalar_attribute_array,
        ".F": mesh.face_custom_point_attribute_matrix,
    }
    return {name + s: read(name + s) for name in ATTRIBUTES for s, read in readers.items()}


def test_everything_survives():
    ms = rich_set()
    before, attributes = state(ms), attributes_of(ms)
    assert ms.apply_filter(FLIP)["flips"] > 0
    assert_same_state(state(ms), before)
    assert_same_state(attributes_of(ms), attributes)


def test_carried_attributes_can_be_used_and_saved(tmp_path):
    ms = set_of(*meshes.bumpy_sphere(100))
    values = np.random.default_rng(0).normal(size=100)
    ms.current_mesh().add_vertex_custom_scalar_attribute(values, "w")
    ms.apply_filter(FLIP)
    ms.compute_scalar_by_function_per_vertex(q="w")
    np.testing.assert_array_equal(ms.current_mesh().vertex_scalar_array(), values)
    ms.save_current_mesh(str(tmp_path / "saved.ply"), __ca_vs__w=True)
    assert b"property double w" in (tmp_path / "saved.ply").read_bytes()


def test_a_mesh_without_extras_gets_none():
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "cow.obj"))
    before = state(ms)
    assert not before["has_vertex_color"]
    ms.apply_filter(FLIP)
    assert_same_state(state(ms), before)


@pytest.mark.usefixtures("saved")
def test_normals_are_those_that_a_native_flip_leaves(bumpy):
    bumpy.apply_filter(FLIP)
    mesh = bumpy.current_mesh()
    native = set_of(mesh.vertex_matrix(), mesh.face_matrix())
    native.meshing_edge_flip_by_planar_optimization(pthreshold=0, iterations=0)
    twin = native.current_mesh()
    np.testing.assert_array_equal(twin.face_matrix(), mesh.face_matrix(), "nothing to flip")
    np.testing.assert_allclose(mesh.vertex_normal_matrix(), twin.vertex_normal_matrix(), atol=1e-12)
    # Those of MeshLab's planar flip are as long as twice the areas, those of a new mesh are units.
    normals = twin.face_normal_matrix()
    units = normals / np.linalg.norm(normals, axis=1)[:, None]
    np.testing.assert_allclose(mesh.face_normal_matrix(), units, atol=1e-12)


def test_points_without_faces_keep_their_normals():
    vertices, faces = meshes.bumpy_sphere(60)
    vertices = np.vstack((vertices, [[9.0, 9, 9], [8, 8, 8]]))
    normals = np.tile([0.0, 0.6, 0.8], (62, 1))
    ms = set_of(vertices, faces, v_normals_matrix=normals)
    np.testing.assert_array_equal(ms.current_mesh().vertex_normal_matrix()[60:], normals[60:])
    assert ms.apply_filter(FLIP)["flips"] > 0
    np.testing.assert_allclose(ms.current_mesh().vertex_normal_matrix()[60:], normals[60:])


def test_faces_keep_their_slots(bumpy):
    before = bumpy.current_mesh().face_matrix()
    bumpy.apply_filter(FLIP, maxflips=1)
    after = bumpy.current_mesh().face_matrix()
    assert (before != after).any(axis=1).sum() == 2


# --- selection ---------------------------------------------------------------------------------


@pytest.mark.usefixtures("saved")
def test_only_selected_faces_change(bumpy):
    bumpy.compute_selection_by_condition_per_face(condselect="fi > 299")
    before = bumpy.current_mesh().face_matrix()
    assert bumpy.apply_filter(FLIP)["flips"] > 0, "selection is on by default"
    after = bumpy.current_mesh().face_matrix()
    np.testing.assert_array_equal(before[:300], after[:300])
    assert bumpy.apply_filter(FLIP, selection=False)["flips"] > 0
    assert (before[:300] != bumpy.current_mesh().face_matrix()[:300]).any()


@pytest.mark.usefixtures("saved")
def test_native_filters_still_see_that_faces_are_selected(bumpy):
    name = "meshing_edge_flip_by_planar_optimization"
    for _ in range(2):
        assert not bumpy.filter_parameter_values(name)["selection"]
        bumpy.apply_filter(FLIP, maxflips=1)
    bumpy.compute_selection_by_condition_per_face(condselect="fi > 299")
    for _ in range(2):
        assert bumpy.filter_parameter_values(name)["selection"]
        bumpy.apply_filter(FLIP, maxflips=1)


def selected_edges(ms):
    """The pairs of points of the selected edges; they become a layer of their own for it."""
    ms.generate_polyline_from_selected_edges()
    mesh = ms.current_mesh()
    points = mesh.vertex_matrix()[mesh.edge_matrix()]
    return {frozenset(map(tuple, edge)) for edge in points.tolist()}


@pytest.mark.usefixtures("saved")
def test_selected_edges_stay_selected_unless_they_are_flipped(bumpy):
    bumpy.compute_selection_crease_per_edge(angledegneg=-5, angledegpos=20)
    vertices, faces = bumpy.current_mesh().vertex_matrix(), bumpy.current_mesh().face_matrix()
    twin = set_of(vertices, faces)
    twin.compute_selection_crease_per_edge(angledegneg=-5, angledegpos=20)
    before = selected_edges(twin)
    bumpy.apply_filter(FLIP)
    faces = bumpy.current_mesh().face_matrix()
    sides = vertices[np.stack((faces, np.roll(faces, -1, axis=1)), axis=-1)].reshape(-1, 2, 3)
    there = {frozenset(map(tuple, side)) for side in sides.tolist()}
    assert 0 < len(before & there) < len(before) < 894
    assert selected_edges(bumpy) == before & there


def test_selection_without_selected_faces_flips_nothing(bumpy):
    assert bumpy.apply_filter(FLIP, selection=True)["flips"] == 0


# --- what can't be carried ---------------------------------------------------------------------


@pytest.mark.usefixtures("saved")
def test_what_would_be_lost_is_an_error_before_anything_changes(bumpy):
    bumpy.compute_curvature_principal_directions_per_vertex()
    before = state(bumpy)
    faces = bumpy.current_mesh().face_matrix()
    mesh = bumpy.current_mesh()
    with pytest.raises(pymeshlab.PyMeshLabException, match="curvature directions") as caught:
        bumpy.apply_filter(FLIP)
    assert "allowloss" in str(caught.value)
    assert bumpy.current_mesh() is mesh
    assert_same_state(state(bumpy), before)
    np.testing.assert_array_equal(mesh.face_matrix(), faces)
    del mesh
    assert bumpy.apply_filter(FLIP, allowloss=True)["flips"] > 0
    after = state(bumpy)
    assert_same_state(after, before)


@pytest.mark.usefixtures("saved")
def test_radii_that_a_float_does_not_hold_are_an_error(tmp_path, monkeypatch):
    """MeshLab's files bring in none, but its filters could."""
    ms = plain_set(tmp_path, radius=True)
    read = ply.read

    def scaled(path):
        mesh = read(path)
        mesh.vertices["radius"] /= 3
        return mesh

    monkeypatch.setattr(exchange.ply, "read", scaled)
    with pytest.raises(pymeshlab.PyMeshLabException, match="last digits of the radii"):
        ms.apply_filter(FLIP)
    assert ms.apply_filter(FLIP, allowloss=True)["flips"] > 0


def test_attributes_that_cannot_be_named_are_an_error(bumpy):
    bumpy.current_mesh().add_vertex_custom_scalar_attribute(np.zeros(300), "two\nlines")
    with pytest.raises(pymeshlab.PyMeshLabException, match="odd names"):
        bumpy.apply_filter(FLIP)
    assert bumpy.apply_filter(FLIP, allowloss=True)["flips"] > 0


@pytest.mark.usefixtures("saved")
def test_what_pymeshlab_drops_is_noticed(bumpy, monkeypatch):
    """If PyMeshLab came to read its files otherwise, the mesh would stay as it is."""
    carry = exchange._load

    def forgetful(ms, path, snapshot):
        carry(ms, path, snapshot)
        ms.set_selection_all()

    faces = bumpy.current_mesh().face_matrix()
    monkeypatch.setattr(exchange, "_load", forgetful)
    with pytest.raises(pymeshlab.PyMeshLabException, match="vertex selection, face selection"):
        bumpy.apply_filter(FLIP)
    np.testing.assert_array_equal(bumpy.current_mesh().face_matrix(), faces)


@pytest.mark.usefixtures("saved")
def test_what_only_the_whole_mesh_would_lose_is_put_back(bumpy, monkeypatch):
    """As above, where the part that is tried first comes through."""
    bumpy.compute_selection_by_condition_per_vertex(condselect="vi < 99")
    carry, calls = exchange._load, []

    def forgetful(ms, path, snapshot):
        carry(ms, path, snapshot)
        calls.append(ms is bumpy)
        if len(calls) == 2:
            ms.set_selection_all()

    before, faces = state(bumpy), bumpy.current_mesh().face_matrix()
    normals = bumpy.current_mesh().vertex_normal_matrix()
    monkeypatch.setattr(exchange, "_load", forgetful)
    with pytest.raises(pymeshlab.PyMeshLabException, match="vertex selection, face selection"):
        bumpy.apply_filter(FLIP)
    assert calls == [False, True, True]
    assert bumpy.current_mesh_id() == 0
    assert_same_state(state(bumpy), before)
    np.testing.assert_array_equal(bumpy.current_mesh().face_matrix(), faces)
    found = bumpy.current_mesh().vertex_normal_matrix()
    scale = np.linalg.norm(normals, axis=1)[:, None]
    np.testing.assert_allclose(found, normals / scale, atol=1e-12)


@pytest.mark.usefixtures("saved")
def test_a_full_disk_changes_nothing(bumpy, monkeypatch, tmp_path):
    def full(*_):
        raise OSError(28, "No space left on device")

    faces = bumpy.current_mesh().face_matrix()
    monkeypatch.setattr(exchange.ply, "write", full)
    with pytest.raises(pymeshlab.PyMeshLabException, match="No space left"):
        bumpy.apply_filter(FLIP)
    np.testing.assert_array_equal(bumpy.current_mesh().face_matrix(), faces)
    assert len(bumpy) == 1


# --- each kind of data alone --------------------------------------------------------------------


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
    "white": with_filter("compute_color_by_function_per_vertex", x="255", y="255", z="255"),
    "nearly white": with_filter(
        "compute_color_by_function_per_vertex", x="255", y="255", z="255", a="vi == 7 ? 254 : 255"
    ),
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


@pytest.mark.heavy
@pytest.mark.parametrize("make", ALONE.values(), ids=ALONE)
@pytest.mark.usefixtures("saved")
def test_each_thing_survives_alone_and_nothing_comes_with_it(make, tmp_path):
    ms = make(tmp_path)
    before, shown = take(ms), state(ms)
    assert ms.apply_filter(FLIP)["flips"] > 0
    assert_same_state(state(ms), shown)
    after = take(ms)
    np.testing.assert_array_equal(after.ply.edges, before.ply.edges)
    assert after.ply.vertices.dtype == before.ply.vertices.dtype
    assert after.ply.vertices.tobytes() == before.ply.vertices.tobytes()
    assert after.ply.faces.dtype == before.ply.faces.dtype
    for field in set(before.ply.faces.dtype.names) - {"vertex_indices", "flags", "texcoord"}:
        np.testing.assert_array_equal(after.ply.faces[field], before.ply.faces[field])
    for left, right in zip(after.attributes, before.attributes, strict=True):
        assert left[:2] == right[:2]
        np.testing.assert_array_equal(left.values, right.values)


@pytest.mark.usefixtures("saved")
def test_a_plain_mesh_travels_with_positions_faces_and_normals_only(tmp_path, monkeypatch):
    written, write = [], ply.write

    def noted(path, mesh):
        written.append(mesh)
        write(path, mesh)

    ms = plain_set(tmp_path)
    monkeypatch.setattr(exchange.ply, "write", noted)
    assert ms.apply_filter(FLIP)["flips"] > 0
    whole, part = written
    for mesh in (part, whole):
        assert mesh.vertices.dtype.names == ("x", "y", "z", "nx", "ny", "nz")
        assert mesh.faces.dtype.names == ("vertex_indices_count", "vertex_indices")
    assert len(part.faces) == 100
    assert len(whole.faces) == 596


@pytest.mark.usefixtures("saved")
def test_the_whole_mesh_is_loaded_once(tmp_path, monkeypatch):
    loads, load = [], exchange.native.load

    def noted(target, path):
        load(target, path)
        loads.append((target is ms, target.current_mesh().face_number()))

    ms = plain_set(tmp_path)
    monkeypatch.setattr(exchange.native, "load", noted)
    assert ms.apply_filter(FLIP)["flips"] > 0
    assert loads == [(False, 100), (True, 596)]


@pytest.mark.heavy
@pytest.mark.parametrize("name", [name for name in ALONE if name != "nothing"])
def test_a_part_is_tried_of_the_first_mesh_of_each_kind(name, tmp_path, monkeypatch):
    loads, load = [], exchange.native.load

    def noted(target, path):
        load(target, path)
        loads.append(path.name)

    monkeypatch.setattr(exchange.native, "load", noted)
    tried = []
    for make in (plain_set, plain_set, ALONE[name], ALONE[name], plain_set):
        loads.clear()
        assert make(tmp_path).apply_filter(FLIP)["flips"] > 0
        tried.append("part.ply" in loads)
    # An attribute or a texture has a name, which is another one each time.
    assert tried == [True, False, True, name in ("attribute", "quads"), False]


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


# --- real meshes -------------------------------------------------------------------------------

REAL = [
    "airplane.obj",
    "bone.ply",
    "bunny.obj",
    "bunny10k_textured.obj",
    "colored_airplane.ply",
    "cow.obj",
    "cube.obj",
    "rangemaps/face000.ply",
]


def test_these_are_all_samples_with_faces():
    """The others are projects, scripts, images, and a point cloud."""
    found = {
        str(path.relative_to(SAMPLES))
        for path in SAMPLES.rglob("*")
        if path.suffix in {".obj", ".ply", ".off", ".stl"}
    }
    assert found == set(REAL)
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "chameleon.pts"))
    with pytest.raises(pymeshlab.PyMeshLabException, match="point cloud"):
        ms.apply_filter(FLIP)


@pytest.mark.heavy
@pytest.mark.parametrize("name", REAL)
@pytest.mark.slow
def test_real_meshes_keep_everything(name, tmp_path):
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / name))
    ms.meshing_remove_duplicate_vertices()
    ms.meshing_remove_duplicate_faces()
    ms.meshing_remove_unreferenced_vertices()
    ms.compute_selection_by_condition_per_face(condselect="fi > 40")
    mesh = ms.current_mesh()
    mesh.add_face_custom_scalar_attribute(np.arange(mesh.face_number()) / 3.0, "Third")
    seams = seams_of(ms)
    faces = mesh.face_matrix()
    del mesh
    before = state(ms)
    returned = ms.apply_filter(FLIP)
    assert_same_state(state(ms), before)
    after = ms.current_mesh().face_matrix()
    np.testing.assert_array_equal(after[:41], faces[:41])
    assert returned["willmore_after"] <= returned["willmore_before"]
    thirds = ms.current_mesh().face_custom_scalar_attribute_array("Third")
    np.testing.assert_array_equal(thirds, np.arange(len(faces)) / 3.0)
    changed = (faces != after).any(axis=1)
    assert returned["flips"] == 0 or changed.any()
    assert seams_of(ms) == seams
    # The chain goes on, and the result can be saved.
    ms.apply_coord_taubin_smoothing(stepsmoothnum=1)
    ms.save_current_mesh(str(tmp_path / "out.ply"))
    assert (tmp_path / "out.ply").stat().st_size > 0
