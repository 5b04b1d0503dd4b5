"""Flips keep textures, and the mappings of wedges and of vertices."""

import struct
import zlib

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.meshset import exchange
from meshlab_willmore.meshset.snapshot import take
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, set_of
from tests.meshset.contents import assert_same_state, seams_of, state, surface
from tests.test_mapping import areas, counts

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


# --- textures without pixels --------------------------------------------------------------------


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


# --- textures without coordinates ----------------------------------------------------------------


def unmapped(folder, names):
    """A mesh whose file names textures, of which those in PNG are there, but has no mapping."""
    set_of(*meshes.bumpy_sphere(300)).save_current_mesh(str(folder / "mesh.ply"))
    header, end, body = (folder / "mesh.ply").read_bytes().partition(b"end_header\n")
    comments = "".join(f"comment TextureFile {name}\n" for name in names).encode()
    (folder / "mesh.ply").write_bytes(header + comments + end + body)
    for side, name in enumerate(sorted({*names}), 3):
        if name.endswith(".png"):
            (folder / name).write_bytes(black_png(side))
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(folder / "mesh.ply"))
    return ms


@pytest.mark.parametrize("taken", [lambda ms: ms, copied], ids=["loaded", "copied"])
@pytest.mark.parametrize(
    ("names", "found"),
    [
        (["there.png"], ("there.png",)),
        (["missing.jpg"], ("dummy.png",)),
        (["z.png", "missing.jpg", "a.png"], ("z.png", "dummy.png", "a.png")),
        (["one.jpg", "two.jpg"], ("dummy.png", "dummy.png")),
        (["a.png", "a.png"], ("a.png", "a.png")),
    ],
    ids=" ".join,
)
def test_textures_without_coordinates_are_kept(tmp_path, names, found, taken):
    ms = taken(unmapped(tmp_path, names))
    before, images, snapshot = state(ms), sizes(ms), take(ms)
    assert snapshot.ply.textures == found
    assert bool(images) == (taken is not copied)
    assert snapshot.wedge_uv is None
    assert ms.apply_filter(FLIP, maxflips=1)["flips"] == 1
    after = state(ms)
    for components in ("has_vertex_color", "has_vertex_scalar"):
        # They come with the way in which a mesh without images is carried.
        assert after.pop(components) >= before.pop(components)
    assert_same_state(after, before)
    assert (sizes(ms), take(ms).ply.textures) == (images, found)
    assert take(ms).wedge_uv is None


def test_an_unmapped_texture_and_attributes_are_kept(tmp_path):
    ms = unmapped(tmp_path, ["there.png"])
    values = np.random.default_rng(0).normal(size=300)
    ms.current_mesh().add_vertex_custom_scalar_attribute(values, "w")
    ms.apply_filter(FLIP, maxflips=1)
    mesh = ms.current_mesh()
    np.testing.assert_array_equal(mesh.vertex_custom_scalar_attribute_array("w"), values)
    assert list(mesh.textures()) == ["there.png"]


# --- mappings -----------------------------------------------------------------------------------

OPTIONS = {"energy": "area", "foldangle": 180.0, "minshape": 0.0}


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
