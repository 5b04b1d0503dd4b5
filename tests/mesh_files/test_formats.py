"""What the format of an output can't hold is noted, and nothing else."""

from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.mesh_files import formats
from meshlab_willmore.mesh_files.saving import SaveOptions, save
from tests import meshes
from tests.cli.conftest import ONE_PIXEL, SAMPLES, square_with_textures

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def notes(name, capsys, options=None, **given):
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(**{"vertex_matrix": SQUARE, "face_matrix": FACES, **given}))
    save(ms, Path(name), options or SaveOptions())
    captured = capsys.readouterr()
    assert captured.out == ""
    return captured.err


PARTS = {
    "edges": {"edge_matrix": [[0, 1]]},
    "vertices without faces": {"vertex_matrix": np.vstack([SQUARE, [5.0, 5, 5]])},
    "vertex colours": {"v_color_matrix": np.linspace(0.0, 1.0, 16).reshape(4, 4)},
    "face colours": {"f_color_matrix": np.linspace(0.0, 1.0, 8).reshape(2, 4)},
    "vertex quality": {"v_scalar_array": np.arange(4.0)},
    "face quality": {"f_scalar_array": np.arange(2.0)},
    "wedge texture coordinates": {"w_tex_coords_matrix": np.linspace(0.0, 1.0, 12).reshape(6, 2)},
}


@pytest.mark.parametrize(
    ("ending", "lost"),
    [
        ("ply", ["edges"]),
        ("obj", ["vertex quality", "face quality"]),
        ("off", ["edges", "vertex quality", "face quality", "wedge texture coordinates"]),
        ("stl", [part for part in PARTS if part != "face colours"]),
        ("xyz", ["edges", *list(PARTS)[2:]]),
    ],
)
def test_parts_that_a_format_cannot_hold(ending, lost, capsys):
    for part, given in PARTS.items():
        note = notes(f"{part}.{ending}", capsys, **given)
        assert (f"no {part}" in note) == (part in lost), (part, note)
        assert ("no faces" in note) == (ending == "xyz")


# Formats that PyMeshLab writes and does not load; some writers crash for meshes so small.
WRITTEN_ONLY = {"dxf", "json", "nxs", "nxz"}


def parts_of_file(path):
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(path))
    return set(formats._parts_of(ms.current_mesh()))


@pytest.mark.parametrize("ending", sorted(set(formats._HELD) - WRITTEN_ONLY))
def test_table_is_what_pymeshlab_saves_and_loads(ending, tmp_path):
    """For each part, a square that has it is saved, and loaded again."""
    given = {**PARTS, "vertex texture coordinates": {"v_tex_coords_matrix": SQUARE[:, :2] / 3}}
    names = {name: part for part, (_, name) in formats.PARTS.items()}
    # Where there is no image, pymeshlab.Mesh leaves open of which they are.
    del given["wedge texture coordinates"]
    for name in given:
        ms = pymeshlab.MeshSet()
        ms.add_mesh(
            pymeshlab.Mesh(**{"vertex_matrix": SQUARE, "face_matrix": FACES, **given[name]})
        )
        assert_held(ms, names.get(name, name), tmp_path / f"a.{ending}")
    (tmp_path / "red.png").write_bytes(ONE_PIXEL)
    for textures in (["red.png"], []):
        mapped = square_with_textures(tmp_path / "in", *textures)
        (tmp_path / "in" / "red.png").write_bytes(ONE_PIXEL)
        ms = pymeshlab.MeshSet()
        ms.load_new_mesh(str(mapped))
        assert bool(textures) == bool(ms.current_mesh().texture_number())
        assert_held(ms, "wt", tmp_path / f"a.{ending}")


def assert_held(ms, part, path):
    ending = path.suffix[1:]
    ms.save_current_mesh(str(path), save_textures=False)
    kept = parts_of_file(path)
    assert (part in kept) == formats._is_held(part, ms.current_mesh(), ending), part
    assert ("faces" in kept) == ("faces" in formats._HELD[ending])


def test_table_has_all_formats_that_pymeshlab_writes():
    others = ["asc", "bre", "fbx", "gltf", "gts", "ptx", "pts", "qobj", "tri", "vmi", "u3d", "idtf"]
    assert not any(map(formats.is_written, others))
    assert all(map(formats.is_written, [*formats._HELD, *formats.COMMON]))


@pytest.mark.parametrize("ending", ["ply", "obj", "off", "stl", "wrl", "dae", "PLY", "dxf"])
def test_ordinary_mesh_gives_no_note(ending, capsys):
    assert notes(f"a.{ending}", capsys) == ""


def test_no_note_on_parts_that_were_not_chosen(capsys):
    assert notes("a.stl", capsys, SaveOptions(parts=("fc",)), **PARTS["vertex colours"]) == ""
    note = notes("b.stl", capsys, SaveOptions(parts=("fc",)), **PARTS["edges"])
    assert note == "Note: b.stl: .stl files hold no edges\n"


def test_texture_in_formats_with_and_without_coordinates(capsys):
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "bunny10k_textured.obj"))
    save(ms, Path("a.wrl"), SaveOptions())
    assert capsys.readouterr().err == ""
    save(ms, Path("a.off"), SaveOptions())
    assert capsys.readouterr().err == "Note: a.off: .off files hold no wedge texture coordinates\n"


@pytest.mark.parametrize("ending", ["ply", "obj", "off", "stl"])
@pytest.mark.parametrize(("far", "merged"), [(0.0, 0), (2.0**20, 0), (2.0**24, 3), (1e9, 3)])
def test_vertices_merge_far_from_the_origin(ending, far, merged, capsys):
    grid = SQUARE + far
    note = notes(f"a.{ending}", capsys, vertex_matrix=grid)
    if ending != "stl" or not merged:
        assert note == ""
    else:
        start = "Note: a.stl: so far from the origin, .stl files can't hold all vertices apart"
        assert note.startswith(f"{start}: {merged} get the place of another")


def test_no_note_near_the_origin(capsys):
    cube = meshes.cube()
    assert notes("a.stl", capsys, vertex_matrix=cube[0] + 3.0, face_matrix=cube[1]) == ""


@pytest.mark.parametrize(
    ("ending", "far", "is_noted"),
    [
        ("stl", 2e6, True),
        ("stl", 3e2, False),
        ("dae", 2e5, True),
        ("wrl", 3e2, False),
        ("obj", 2e6, False),
    ],
)
def test_vertices_move_far_from_the_origin(ending, far, is_noted, capsys):
    slanted = SQUARE + [[0.1, 0.3, 0.1], [0.2, 0.1, 0.6], [0.4, 0.3, 0.2], [0.1, 0.2, 0.9]]
    slanted[:, :2] += far
    note = notes(f"a.{ending}", capsys, vertex_matrix=slanted)
    start = (
        f"Note: a.{ending}: so far from the origin, .{ending} files hold too few digits: vertices"
    )
    assert note.startswith(start) if is_noted else note == ""


@pytest.mark.parametrize("ending", ["ply", "obj", "wrl"])
def test_textures_without_coordinates(ending, capsys):
    Path("t.png").write_bytes(ONE_PIXEL)
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(SQUARE, FACES))
    ms.save_current_mesh("in.ply", binary=False)
    text = Path("in.ply").read_text().replace("element", "comment TextureFile t.png\nelement", 1)
    Path("in.ply").write_text(text)
    ms.load_new_mesh("in.ply")
    out = Path(f"out.{ending}")
    save(ms, out, SaveOptions())
    is_noted = "does not save the names of textures (t.png)" in capsys.readouterr().err
    assert is_noted == (ending != "wrl")
    assert (b"t.png" in out.read_bytes()) != is_noted
