"""What loading leaves out is noted, and nothing else."""

import struct
from pathlib import Path

import numpy as np
import pytest

from meshlab_willmore.mesh_files import loading
from tests.cli.conftest import ONE_PIXEL, SAMPLES, call, cube_file, square_with_textures

# PyMeshLab prints most of it: tests with this fixture run first (see tests/conftest.py).
pytestmark = pytest.mark.usefixtures("capfd")

PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
{more}element face 1
property list uchar int vertex_indices
end_header
0 0 0{values}
1 0 0{values}
0 1 0{values}
3 0 1 2
"""


def notes_on(path, capfd):
    loading.loaded(Path(path))
    captured = capfd.readouterr()
    assert captured.out == ""
    lines = captured.err.splitlines()
    assert all(line.startswith(f"Note: {path}: ") for line in lines)
    return [line.removeprefix(f"Note: {path}: ") for line in lines]


@pytest.mark.parametrize("names", [("red.png", "blue.png"), ("gone.jpg",), ("tex/a.png", "b.png")])
def test_missing_textures(names, capfd):
    path = square_with_textures(".", *names)
    assert notes_on(path, capfd) == [
        f"textures that were not found, and became dummy.png: {', '.join(names)}"
    ]


def test_existing_textures_give_no_note(capfd):
    path = square_with_textures(".", "red.png")
    Path("red.png").write_bytes(ONE_PIXEL)
    assert notes_on(path, capfd) == []


def test_texture_names_with_blanks(capfd):
    path = square_with_textures(".", "my red.png", "blue.png")
    Path("my red.png").write_bytes(ONE_PIXEL)
    Path("blue.png").write_bytes(ONE_PIXEL)
    odd = "textures with blanks in the name, which PyMeshLab can't read: my red.png"
    assert notes_on(path, capfd) == [odd]
    Path("a.ply").write_text(
        PLY.format(more="", values="").replace(
            "ascii 1.0\n", "ascii 1.0\ncomment TextureFile my red.png\n"
        )
    )
    assert notes_on("a.ply", capfd) == [odd]


def test_missing_material_file(capfd):
    path = square_with_textures(".", "red.png")
    Path("square.mtl").unlink()
    (note,) = notes_on(path, capfd)
    assert note.startswith("some materials definitions were not found")


BAD_NUMBERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (float("nan"), 0, 0), (float("inf"), 1, 1)]
FACES = [(0, 1, 2), (0, 1, 3), (0, 1, 4)]


def as_off():
    points = [f"{x} {y} {z}" for x, y, z in BAD_NUMBERS]
    return "\n".join(
        ["OFF", "5 3 0", *points, *(f"3 {a} {b} {c}" for a, b, c in FACES), ""]
    ).encode()


def as_obj():
    points = [f"v {x} {y} {z}" for x, y, z in BAD_NUMBERS]
    faces = [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in FACES]
    return "\n".join([*points, *faces, ""]).encode()


def as_stl():
    corners = np.array(BAD_NUMBERS, "<f4")
    blocks = [bytes(12) + corners[list(face)].tobytes() + bytes(2) for face in FACES]
    return bytes(80) + struct.pack("<I", 3) + b"".join(blocks)


@pytest.mark.parametrize(
    ("name", "data"), [("a.off", as_off), ("a.obj", as_obj), ("a.stl", as_stl)]
)
def test_vertices_with_nan_or_infinite_coordinates(name, data, capfd):
    Path(name).write_bytes(data())
    assert notes_on(name, capfd) == [
        "vertices with NaN or infinite coordinates, left out with their faces: 2"
    ]


def test_faces_with_a_corner_twice(capfd):
    Path("a.off").write_text("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 0 1\n")
    assert notes_on("a.off", capfd) == ["faces with a corner twice, left out: 1"]


@pytest.mark.parametrize(
    ("properties", "unknown"),
    [
        ("float temperature", ["temperature (vertex, float)"]),
        ("list uchar int neighbours", ["neighbours (vertex, int)"]),
        (
            "float red;float green;float blue",
            [f"{c} (vertex, float)" for c in ("red", "green", "blue")],
        ),
        ("double s;double t", ["s (vertex, double)", "t (vertex, double)"]),
        ("uint8 red;uint8 green;uint8 blue", []),
        ("float32 nx;float32 ny;float32 nz", []),
        ("double quality", []),
        ("float s;float t", []),
    ],
)
def test_unread_properties(properties, unknown, capfd):
    names = properties.split(";")
    value = " 2 1 1" if "list" in properties else " 1"
    Path("a.ply").write_text(
        PLY.format(more="".join(f"property {name}\n" for name in names), values=value * len(names))
    )
    expected = [f"properties that PyMeshLab does not read: {', '.join(unknown)}"] if unknown else []
    assert notes_on("a.ply", capfd) == expected


def test_unread_elements(capfd):
    text = PLY.format(more="", values="").replace(
        "end_header\n",
        "element thing 1\nproperty float size\nelement none 0\nproperty float x\nend_header\n",
    )
    Path("a.ply").write_text(text + "5\n")
    assert notes_on("a.ply", capfd) == [
        "properties that PyMeshLab does not read: size (thing, float)"
    ]


def test_text_file_that_ends_early(capfd):
    corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    face = f"facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n"
    Path("a.stl").write_text(f"solid a\n{face}endsolid a\n")
    assert notes_on("a.stl", capfd) == []
    Path("b.stl").write_text(f"solid b\n{face}")
    assert notes_on("b.stl", capfd) == ["it ends before its endsolid; what comes after is missing"]
    Path("c.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n0 1\n")
    assert notes_on("c.xyz", capfd) == ["lines that are no points, left out: 1"]


@pytest.mark.parametrize(("step", "lost"), [(0.125, True), (8, False)])
def test_text_file_far_from_the_origin(step, lost, capfd):
    corners = [(0, 0), (step, 0), (step, step), (0, step)]
    points = [f"vertex {4500000.125 + x} {5400000.125 + y} 7.5\n" for x, y in corners]
    faces = [(0, 1, 2), (0, 2, 3)]
    blocks = [
        f"facet normal 0 0 1\nouter loop\n{''.join(points[i] for i in f)}endloop\nendfacet\n"
        for f in faces
    ]
    Path("a.stl").write_text(f"solid a\n{''.join(blocks)}endsolid a\n")
    note = "so far from the origin, different coordinates become the same in single precision"
    assert (note in notes_on("a.stl", capfd)) == lost


def chunk(number, *parts):
    data = b"".join(parts)
    return struct.pack("<HI", number, len(data) + 6) + data


def as_3ds(*names):
    """A triangle for each name, as 3DS has it."""
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], "<f4").tobytes()
    vertices = chunk(0x4110, struct.pack("<H", 3), points)
    faces = chunk(0x4120, struct.pack("<5H", 1, 0, 1, 2, 0))
    meshes = [
        chunk(0x4000, name.encode() + b"\0", chunk(0x4100, vertices, faces)) for name in names
    ]
    return chunk(0x4D4D, chunk(0x0002, struct.pack("<I", 3)), chunk(0x3D3D, *meshes))


@pytest.mark.parametrize("names", ["a", "ab", "abc"])
def test_several_meshes_in_a_file(names, capfd):
    Path("a.3ds").write_bytes(as_3ds(*names))
    note = f"it holds {len(names)} meshes; the last one is used, the others are layers"
    assert notes_on("a.3ds", capfd) == [note] * (len(names) > 1)


def test_ordinary_files_give_no_note(capfd):
    for name in ("bone.ply", "airplane.obj", "colored_airplane.ply", "bunny10k_textured.obj"):
        loading.loaded(SAMPLES / name)
    loading.loaded(cube_file())
    assert capfd.readouterr().err == ""


@pytest.mark.usefixtures("workers_here")
def test_commands_print_a_note_once():
    Path("a.off").write_bytes(as_off())
    note = "Note: a.off: vertices with NaN or infinite coordinates, left out with their faces: 2\n"
    for result in (call("measure", "a.off", "a.off"), call("flip", "a.off", "out.ply")):
        assert (result.exit_code, result.stderr) == (0, note)
    assert call("measure", "a.off", "--json").stdout.startswith("[")


OBJ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n"


@pytest.mark.parametrize(
    ("more", "lost"),
    [("f 1 2 9\n", 1), ("f 7 8 9\nf 1//5 3//5 6//5\nf 1 3 4\n", 2)],
)
def test_faces_with_missing_vertices(more, lost, capfd):
    Path("a.obj").write_text(OBJ + more)
    assert notes_on("a.obj", capfd) == [f"faces with vertices that do not exist, left out: {lost}"]


@pytest.mark.parametrize("more", ["f 1 3 4\n", "f 1 2 3 4\n", "vn 0 0 1\nf 1//1 3//1 4//1\n"])
def test_complete_faces_give_no_note(more, capfd):
    Path("a.obj").write_text(OBJ + more)
    assert notes_on("a.obj", capfd) == []


def test_unread_images_of_materials(capfd):
    path = square_with_textures(".", "red.png")
    Path("red.png").write_bytes(ONE_PIXEL)
    materials = next(Path().glob("*.mtl"))
    text = materials.read_text()
    materials.write_text(text + "map_Ka red.png\nmap_Bump bumps.png\n  map_Ks shine.png\n")
    names = "bumps.png (map_Bump), shine.png (map_Ks)"
    assert notes_on(path, capfd) == [f"images of materials that PyMeshLab does not read: {names}"]


def test_texture_without_a_name(capfd):
    path = square_with_textures(".", "")
    assert notes_on(path, capfd) == ["textures without a name, which became dummy.png"]
