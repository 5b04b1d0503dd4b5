"""Nothing of the mesh is lost: each promise on a mesh that has everything, then on real meshes."""

import struct
import zlib

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import optimize_flips
from meshlab_willmore.meshset import edge_flags, exchange, ply
from meshlab_willmore.meshset.snapshot import take
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, set_of
from tests.meshset.contents import (
    ATTRIBUTES,
    assert_same_state,
    plain_set,
    quad_set,
    rich_set,
    state,
)


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


def test_only_selected_faces_change(bumpy):
    bumpy.compute_selection_by_condition_per_face(condselect="fi > 299")
    before = bumpy.current_mesh().face_matrix()
    assert bumpy.apply_filter(FLIP)["flips"] > 0, "selection is on by default"
    after = bumpy.current_mesh().face_matrix()
    np.testing.assert_array_equal(before[:300], after[:300])
    assert bumpy.apply_filter(FLIP, selection=False)["flips"] > 0
    assert (before[:300] != bumpy.current_mesh().face_matrix()[:300]).any()


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


# --- polygons ----------------------------------------------------------------------------------


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


# --- textures ----------------------------------------------------------------------------------


@pytest.fixture
def textured():
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "bunny10k_textured.obj"))
    return ms


def wedges_by_corner(ms):
    """{(face's texture chart corner)}: the set of (vertex, u, v) over all corners."""
    mesh = ms.current_mesh()
    corners = np.column_stack([mesh.face_matrix().ravel(), mesh.wedge_tex_coord_matrix()])
    return np.unique(corners, axis=0)


def pixels(image, folder):
    path = folder / "pixels.bmp"
    image.save(str(path))
    return path.read_bytes()


@pytest.mark.heavy
def test_textures_survive(textured, tmp_path):
    before = state(textured)
    image = pixels(textured.current_mesh().texture(0), tmp_path)
    coordinates = wedges_by_corner(textured)
    assert textured.apply_filter(FLIP)["flips"] > 0
    assert_same_state(state(textured), before)
    assert pixels(textured.current_mesh().texture(0), tmp_path) == image
    after = wedges_by_corner(textured)
    rows = {tuple(row) for row in coordinates}
    assert all(tuple(row) in rows for row in after), "each corner takes a coordinate of its vertex"


def seams_of(ms):
    """Edges whose two faces have other texture coordinates at an end, or another texture."""
    records = take(ms).ply.faces
    if "texcoord" not in records.dtype.names:
        return set()
    count = len(records)
    number = records["texnumber"] if "texnumber" in records.dtype.names else np.zeros(count, int)
    rows = zip(
        records["vertex_indices"].tolist(),
        records["texcoord"].reshape(-1, 3, 2).tolist(),
        number.tolist(),
        strict=True,
    )
    sides = {}
    for face, corners, texture in rows:
        for c in range(3):
            ends = {face[c]: tuple(corners[c]), face[c - 2]: tuple(corners[c - 2])}
            sides.setdefault(frozenset(ends), []).append((ends, texture))
    return {edge for edge, (one, *others) in sides.items() if any(one != o for o in others)}


@pytest.mark.heavy
@pytest.mark.slow
def test_seams_stay(textured):
    before = seams_of(textured)
    assert len(before) > 100
    textured.apply_filter(FLIP)
    assert seams_of(textured) == before


@pytest.mark.heavy
def test_the_image_of_a_textured_face_stays_in_its_chart(textured):
    """No new face stretches over the texture: its area there stays positive and in scale."""
    before = _texture_areas(textured)
    textured.apply_filter(FLIP)
    after = _texture_areas(textured)
    assert abs(after.sum() - before.sum()) < 1e-6 * abs(before).sum()


def _texture_areas(ms):
    a, b, c = ms.current_mesh().wedge_tex_coord_matrix().reshape(-1, 3, 2).transpose(1, 0, 2)
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def two_textures(tmp_path, names=("first.png", "second.png")):
    """A bumpy grid whose left half uses one image and whose right half uses another."""
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "bunny10k_textured.obj"))
    tmp_path = tmp_path / "mesh"
    for name in names:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        exchange._save_image(ms.current_mesh().texture(0), tmp_path / name)
    vertices, faces = meshes.grid(10, 10)
    vertices[:, 2] = np.random.default_rng(2).random(len(vertices))
    lines = [f"v {x} {y} {z}" for x, y, z in vertices]
    lines += [f"vt {x / 10} {y / 10}" for x, y, _ in vertices]
    current = ""
    materials = []
    for face in faces:
        name = names[int(vertices[face, 0].mean() > 5)]
        if name != current:
            lines.append(f"usemtl material{names.index(name)}")
            current = name
        lines.append("f " + " ".join(f"{v + 1}/{v + 1}" for v in face))
    for n, name in enumerate(names):
        materials += [f"newmtl material{n}", f"map_Kd {name}"]
    (tmp_path / "two.mtl").write_text("\n".join(materials) + "\n")
    (tmp_path / "two.obj").write_text("mtllib two.mtl\n" + "\n".join(lines) + "\n")
    both = pymeshlab.MeshSet()
    both.load_new_mesh(str(tmp_path / "two.obj"))
    return both


NAMES = [
    ("first.png", "second.png"),
    ("images/first.jpg", "second.png"),
    ("../images/first.png", "../../second.png"),
]


@pytest.mark.parametrize("names", NAMES)
def test_several_textures_survive(tmp_path, names):
    ms = two_textures(tmp_path, names)
    assert ms.current_mesh().texture_number() == 2
    before = state(ms)
    numbers = take(ms).ply.faces["texnumber"]
    assert set(numbers) == {0, 1}
    assert ms.apply_filter(FLIP)["flips"] > 0
    assert_same_state(state(ms), before)
    after = take(ms)
    np.testing.assert_array_equal(after.ply.faces["texnumber"], numbers)
    middle = after.vertices[after.faces].mean(axis=1)[:, 0]
    assert ((middle > 5) == (numbers == numbers[-1])).all(), "no flip across the two textures"


@pytest.mark.parametrize(
    "name", ["with space.png", "photo.jpg", "scan.tga", "Wände.png", "TEXTUR~1.PNG", "50%25.png"]
)
@pytest.mark.heavy
def test_a_texture_keeps_any_name(textured, tmp_path, name):
    exchange._save_image(textured.current_mesh().texture(0), tmp_path / name)
    textured.set_texture_per_mesh(textname=str(tmp_path / name))
    image = pixels(textured.current_mesh().texture(0), tmp_path)
    before = state(textured)
    textured.apply_filter(FLIP)
    assert_same_state(state(textured), before)
    assert pixels(textured.current_mesh().textures()[name], tmp_path) == image


def black_png(side):
    """A square grey-scale picture."""
    pixel_rows = zlib.compress(bytes(side * (side + 1)))
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0))]
    chunks += [(b"IDAT", pixel_rows), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )


@pytest.mark.heavy
def test_a_file_of_a_textures_name_in_the_working_folder_is_not_taken(
    textured, tmp_path, monkeypatch
):
    (tmp_path / "TextureDouble_A.png").write_bytes(black_png(4))
    monkeypatch.chdir(tmp_path)
    image = pixels(textured.current_mesh().texture(0), tmp_path)
    textured.apply_filter(FLIP)
    assert pixels(textured.current_mesh().texture(0), tmp_path) == image
    assert exchange.Path.cwd() == tmp_path


def test_several_oddly_named_textures_are_lost_by_name_only(tmp_path):
    ms = two_textures(tmp_path, ("a~1.png", "b.png"))
    with pytest.raises(pymeshlab.PyMeshLabException, match="a~1.png"):
        ms.apply_filter(FLIP)
    image = pixels(ms.current_mesh().textures()["a~1.png"], tmp_path)
    assert ms.apply_filter(FLIP, allowloss=True)["flips"] > 0
    images = ms.current_mesh().textures()
    assert set(images) == {"a%7E1.png", "b.png"}
    assert pixels(images["a%7E1.png"], tmp_path) == image


@pytest.mark.heavy
def test_the_current_folder_and_the_users_files_stay(textured, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    textured.apply_filter(FLIP)
    assert not list(tmp_path.iterdir())


# --- what can't be carried ---------------------------------------------------------------------


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


def sizes(ms):
    return {name: (i.width(), i.height()) for name, i in ms.current_mesh().textures().items()}


def split_off(ms):
    """Its texture has a name and an image of no size."""
    ms.generate_splitting_by_connected_components()
    return ms


def split_off_alone(ms):
    split_off(ms).set_current_mesh(0)
    ms.delete_current_mesh()
    return ms


def copied(ms):
    """Its texture has a name and no image at all."""
    copy = pymeshlab.MeshSet()
    copy.add_mesh(ms.current_mesh())
    return copy


@pytest.mark.parametrize("taken", [split_off, split_off_alone, copied])
@pytest.mark.parametrize(
    "names",
    [
        ("a.png", "b.png"),
        ("dummy.png", "a"),
        ("one/a.png", "other/a.png"),
        ("a.png", "A.PNG"),
        ("missing.png", "b.png"),
        ("x" * 255, "y.png"),
    ],
    ids=lambda names: names[0][:9],
)
@pytest.mark.heavy
def test_textures_without_pixels_stay_so(tmp_path, names, taken):
    ms = taken(two_textures(tmp_path, names))
    before, images, textures = state(ms), sizes(ms), take(ms).ply.textures
    numbers = take(ms).ply.faces["texnumber"]
    assert all(size == (0, 0) for size in images.values())
    assert bool(images) == (taken is not copied)
    mesh_id, others = ms.current_mesh_id(), [mesh.id() for mesh in ms]
    assert ms.apply_filter(FLIP, maxflips=1)["flips"] == 1
    after = state(ms)
    for components in ("has_vertex_color", "has_vertex_scalar"):
        # They come with the way in which the mesh is carried.
        assert after.pop(components) >= before.pop(components)
    assert_same_state({name: after[name] for name in before}, before)
    assert (sizes(ms), take(ms).ply.textures) == (images, textures)
    np.testing.assert_array_equal(take(ms).ply.faces["texnumber"], numbers)
    assert (ms.current_mesh_id(), [mesh.id() for mesh in ms]) == (mesh_id, others)
    ms.create_cube()
    assert ms.current_mesh_id() == max(others) + 1


def test_a_flip_does_not_make_a_picture_to_be_saved_over_the_users(textured, tmp_path):
    split_off(textured)
    textured.apply_filter(FLIP, maxflips=1)
    picture = tmp_path / "TextureDouble_A.png"
    picture.write_bytes(black_png(4))
    with pytest.raises(pymeshlab.PyMeshLabException, match="Failed to save the image"):
        textured.save_current_mesh(str(tmp_path / "part.obj"))
    assert picture.read_bytes() == black_png(4)
    assert (tmp_path / "part.obj").exists()


@pytest.mark.heavy
def test_one_of_several_textures_without_pixels_is_lost_by_name_only(textured, tmp_path):
    split_off(textured)
    textured.compute_matrix_from_translation(axisx=1.0)
    textured.set_current_mesh(0)
    exchange._save_image(textured.current_mesh().texture(0), tmp_path / "other.png")
    textured.set_texture_per_mesh(textname=str(tmp_path / "other.png"))
    textured.generate_by_merging_visible_meshes()
    before, faces = sizes(textured), textured.current_mesh().face_matrix()
    assert before == {"other.png": (512, 512), "TextureDouble_A.png": (0, 0)}
    with pytest.raises(pymeshlab.PyMeshLabException, match="TextureDouble_A.png.*allowloss"):
        textured.apply_filter(FLIP)
    assert sizes(textured) == before
    np.testing.assert_array_equal(textured.current_mesh().face_matrix(), faces)
    assert textured.apply_filter(FLIP, allowloss=True)["flips"] > 0
    assert sizes(textured)["other.png"] == (512, 512)


@pytest.mark.heavy
def test_two_textures_of_one_name_stay_two(tmp_path):
    ms = two_textures(tmp_path, ("one/a.png", "other/a.png"))
    ms.save_current_mesh(str(tmp_path / "both.ply"), save_textures=False)
    exchange._save_image(ms.current_mesh().texture(0), tmp_path / "a.png")
    header = (tmp_path / "both.ply").read_bytes()
    for folder in (b"one/", b"other/"):
        header = header.replace(b"TextureFile " + folder, b"TextureFile ")
    (tmp_path / "both.ply").write_bytes(header)
    ms.clear()
    ms.load_new_mesh(str(tmp_path / "both.ply"))
    before = take(ms).ply
    assert before.textures == ("a.png", "a.png")
    assert ms.apply_filter(FLIP)["flips"] > 0
    after = take(ms).ply
    assert after.textures == before.textures
    np.testing.assert_array_equal(after.faces["texnumber"], before.faces["texnumber"])


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


def test_a_full_disk_changes_nothing(bumpy, monkeypatch, tmp_path):
    def full(*_):
        raise OSError(28, "No space left on device")

    faces = bumpy.current_mesh().face_matrix()
    monkeypatch.setattr(exchange.ply, "write", full)
    with pytest.raises(pymeshlab.PyMeshLabException, match="No space left"):
        bumpy.apply_filter(FLIP)
    np.testing.assert_array_equal(bumpy.current_mesh().face_matrix(), faces)
    assert len(bumpy) == 1


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
