"""Saving: atomically, with textures and materials, and never over existing files."""

import os
import socket
import stat
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.mesh_files import saving
from meshlab_willmore.mesh_files.paths import check_place
from meshlab_willmore.mesh_files.saving import SaveOptions, save
from meshlab_willmore.messages import WrongUse
from tests import meshes
from tests.cli.conftest import SAMPLES, call, cube_file, listing, loaded, same_mesh, script_file

TEXTURED = SAMPLES / "bunny10k_textured.obj"
IMAGE = "TextureDouble_A.png"

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="modes and links of POSIX")

# A DAE has the date in it; the first 3DS of a process differs from the next ones.
VARYING = {"dae", "3ds"}


def cube_set():
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(*meshes.cube()))
    return ms


def textured_set():
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(TEXTURED))
    return ms


@pytest.mark.parametrize("ending", ["ply", "obj", "stl", "off", "dae", "x3d", "wrl", "dxf", "3ds"])
def test_saved_mesh_is_that_of_pymeshlab(ending, tmp_path):
    for folder in ("ours", "native"):
        (tmp_path / folder).mkdir()
    ours, native = tmp_path / "ours" / f"a.{ending}", tmp_path / "native" / f"a.{ending}"
    assert save(cube_set(), ours, SaveOptions())[0] == ours
    cube_set().save_current_mesh(str(native))
    assert listing(ours.parent) == listing(native.parent)
    if ending not in VARYING:
        assert ours.read_bytes() == native.read_bytes()


# Side files


def test_material_and_texture_are_saved_beside_the_mesh(tmp_path):
    files = save(textured_set(), tmp_path / "a.obj", SaveOptions(origins=(SAMPLES,)))
    assert sorted(file.name for file in files) == listing(tmp_path) == [IMAGE, "a.obj", "a.obj.mtl"]
    assert files[0].name == "a.obj"
    assert "mtllib ./a.obj.mtl" in (tmp_path / "a.obj").read_text()
    # PyMeshLab would have encoded it anew.
    assert (tmp_path / IMAGE).read_bytes() == (SAMPLES / IMAGE).read_bytes()
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(tmp_path / "a.obj"))
    assert list(ms.current_mesh().textures()) == [IMAGE]


def test_same_texture_may_exist(tmp_path):
    save(textured_set(), tmp_path / "a.ply", SaveOptions(origins=(SAMPLES,)))
    files = save(textured_set(), tmp_path / "b.ply", SaveOptions(origins=(SAMPLES,)))
    assert tmp_path / "b.ply" in files
    assert listing(tmp_path) == [IMAGE, "a.ply", "b.ply"]


def test_different_texture_is_kept_unless_forced(tmp_path):
    other = tmp_path / IMAGE
    other.write_bytes(b"another picture")
    with pytest.raises(
        OSError, match=rf"cannot write .*a\.ply: .*{IMAGE} already exists; use --force"
    ):
        save(textured_set(), tmp_path / "a.ply", SaveOptions(origins=(SAMPLES,)))
    assert listing(tmp_path) == [IMAGE]
    assert other.read_bytes() == b"another picture"
    save(textured_set(), tmp_path / "a.ply", SaveOptions(force=True, origins=(SAMPLES,)))
    assert other.read_bytes() == (SAMPLES / IMAGE).read_bytes()


def test_changed_texture_is_written_again(tmp_path):
    changed = tmp_path / "in" / IMAGE
    changed.parent.mkdir()
    # The file beside the input shows something else by now.
    changed.write_bytes(b"not the picture")
    save(textured_set(), tmp_path / "a.obj", SaveOptions(origins=(changed.parent,)))
    again = pymeshlab.MeshSet()
    again.load_new_mesh(str(tmp_path / "a.obj"))
    (image,) = again.current_mesh().textures().values()
    assert (image.width(), image.height()) == (512, 512)


def test_texture_in_a_parent_folder(tmp_path):
    source = tmp_path / "source" / "mesh"
    source.mkdir(parents=True)
    (tmp_path / "source" / "images").mkdir()
    (tmp_path / "source" / "images" / "t.png").write_bytes((SAMPLES / IMAGE).read_bytes())
    (source / "a.mtl").write_text("newmtl m\nmap_Kd ../images/t.png\n")
    (source / "a.obj").write_text(
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n"
    )
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(source / "a.obj"))
    assert list(ms.current_mesh().textures()) == ["../images/t.png"]
    target = tmp_path / "target" / "mesh"
    target.mkdir(parents=True)
    save(ms, target / "b.obj", SaveOptions(origins=(source,)))
    assert listing(target) == ["b.obj", "b.obj.mtl"]
    assert listing(tmp_path / "target") == ["images", "mesh"]
    assert (target.parent / "images" / "t.png").read_bytes() == (SAMPLES / IMAGE).read_bytes()


@pytest.mark.parametrize(
    ("name", "wish"),
    [("a.stl", SaveOptions()), ("a.ply", SaveOptions(parts=("vn",)))],
)
def test_no_texture_without_coordinates(tmp_path, name, wish):
    save(textured_set(), tmp_path / name, wish)
    assert listing(tmp_path) == [name]


# What is saved


def header(path):
    return path.read_bytes().partition(b"end_header")[0].decode()


def test_mask_lists_everything_that_is_saved(tmp_path):
    ms = textured_set()
    ms.compute_color_by_function_per_vertex()
    ms.compute_scalar_by_function_per_vertex(q="x")
    save(ms, tmp_path / "all.ply", SaveOptions())
    save(ms, tmp_path / "some.ply", SaveOptions(parts=("vn", "vc")))
    assert "property double quality" in header(tmp_path / "all.ply")
    assert "texcoord" in header(tmp_path / "all.ply")
    text = header(tmp_path / "some.ply")
    assert "property double nx" in text
    assert "property uchar red" in text
    assert "quality" not in text
    assert "texcoord" not in text


def test_part_that_the_format_cannot_hold_is_named(tmp_path, capsys):
    save(cube_set(), tmp_path / "a.stl", SaveOptions(parts=("vc", "fc", "wt")))
    note = "Note: .stl files hold no vertex colours (vc) and no wedge texture coordinates (wt)\n"
    assert capsys.readouterr().err == note
    assert (tmp_path / "a.stl").exists()


# Whole or not at all


@contextmanager
def limited_files(size):
    """Files can't become larger, as on a full disk."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


# PLY's writer reports that it had to stop; those of the others don't.
@pytest.mark.parametrize("ending", ["ply", "obj", "xyz", "json", "dae"])
def test_full_disk_is_one_line_and_no_output(tmp_path, ending):
    script = script_file(("Select None", {}))
    out = tmp_path / "out"
    out.mkdir()
    path = out / f"a.{ending}"
    path.write_text("older")
    with limited_files(100_000):
        result = call("run", script, "-i", TEXTURED, "-o", path, "--force")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == f"Error: cannot write {path}: File too large\n"
    assert listing(out) == [path.name]
    assert path.read_text() == "older"


def test_incomplete_file_is_noticed():
    if not Path("/dev/full").exists():
        pytest.skip("needs /dev/full")
    with pytest.raises(OSError, match=r"cannot write a\.ply: No space left on device"):
        saving._check_complete(Path("/dev/full"), Path("a.ply"))


def test_every_file_is_checked(tmp_path, monkeypatch):
    seen = set()
    monkeypatch.setattr(saving, "_check_complete", lambda _, target: seen.add(target.name))
    save(textured_set(), tmp_path / "a.obj", SaveOptions())
    assert sorted(seen) == listing(tmp_path) == [IMAGE, "a.obj", "a.obj.mtl"]


def test_check_does_not_change_the_file(tmp_path):
    path = tmp_path / "a.ply"
    path.write_bytes(b"all of it")
    saving._check_complete(path, path)
    assert path.read_bytes() == b"all of it"


def test_writer_that_writes_nothing(tmp_path):
    class Silent(pymeshlab.MeshSet):
        def save_current_mesh(self, *_arguments, **_named):
            pass

    silent = Silent()
    silent.add_mesh(pymeshlab.Mesh(*meshes.cube()))
    with pytest.raises(OSError, match=r"cannot write .*a\.ply: PyMeshLab wrote no \.ply file"):
        save(silent, tmp_path / "a.ply", SaveOptions())
    assert listing(tmp_path) == []


@pytest.mark.parametrize("error", [KeyboardInterrupt(), RuntimeError("broken")])
def test_error_leaves_no_files(tmp_path, monkeypatch, error):
    path = cube_file(tmp_path / "a.ply")
    before = path.read_bytes()

    def fail(*_arguments):
        raise error

    monkeypatch.setattr(saving, "_check_complete", fail)
    with pytest.raises(type(error)):
        save(textured_set(), path, SaveOptions(force=True))
    assert listing(tmp_path) == ["a.ply"]
    assert path.read_bytes() == before


def test_failed_rename_removes_new_side_files(tmp_path, monkeypatch):
    replace = os.replace

    def fail_for_mesh(source, target):
        if Path(target).name == "a.obj":
            raise OSError(13, "Permission denied")
        replace(source, target)

    monkeypatch.setattr(os, "replace", fail_for_mesh)
    with pytest.raises(OSError, match=r"cannot write .*a\.obj: Permission denied"):
        save(textured_set(), tmp_path / "a.obj", SaveOptions(origins=(SAMPLES,)))
    assert listing(tmp_path) == []


def test_existing_file_is_overwritten_only_when_forced(tmp_path):
    path = tmp_path / "a.ply"
    path.write_text("mine")
    with pytest.raises(OSError, match="already exists; use --force to overwrite"):
        save(cube_set(), path, SaveOptions())
    assert path.read_text() == "mine"
    save(cube_set(), path, SaveOptions(force=True))
    assert np.array_equal(loaded(path).faces, meshes.cube()[1])
    assert listing(tmp_path) == ["a.ply"]


@POSIX
def test_overwritten_file_keeps_its_mode(tmp_path):
    path = tmp_path / "a.ply"
    path.touch()
    path.chmod(0o640)
    save(cube_set(), path, SaveOptions(force=True))
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert path.stat().st_size > 0


@POSIX
def test_link_stays_and_points_to_the_new_mesh(tmp_path):
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    real = folder / "real.ply"
    real.write_text("older")
    link = tmp_path / "a.ply"
    link.symlink_to(real)
    with pytest.raises(OSError, match="already exists; use --force to overwrite"):
        save(cube_set(), link, SaveOptions())
    assert real.read_text() == "older"
    save(cube_set(), link, SaveOptions(force=True))
    assert link.is_symlink()
    assert np.array_equal(loaded(real).faces, meshes.cube()[1])
    assert (listing(tmp_path), listing(folder)) == (["a.ply", "elsewhere"], ["real.ply"])


@POSIX
def test_dangling_link_exists(tmp_path):
    link = tmp_path / "a.ply"
    link.symlink_to("real.ply")
    with pytest.raises(WrongUse, match="already exists; use --force"):
        check_place(link, force=False)
    with pytest.raises(OSError, match="already exists; use --force to overwrite"):
        save(cube_set(), link, SaveOptions())
    assert listing(tmp_path) == ["a.ply"]
    save(cube_set(), link, SaveOptions(force=True))
    assert link.is_symlink()
    assert listing(tmp_path) == ["a.ply", "real.ply"]


@POSIX
def test_link_into_a_missing_folder(tmp_path):
    link = tmp_path / "a.ply"
    link.symlink_to("no/real.ply")
    with pytest.raises(WrongUse, match=r"cannot write .*a\.ply: the folder .*no does"):
        check_place(link, force=True)


@POSIX
@pytest.mark.parametrize("link", ["", "to-"])
@pytest.mark.parametrize("kind", ["pipe.ply", "socket.ply", "folder.ply"])
def test_only_files_are_replaced(kind, link):
    os.mkfifo("pipe.ply")
    with socket.socket(socket.AF_UNIX) as made:
        made.bind("socket.ply")
    Path("folder.ply").mkdir()
    Path(f"to-{kind}").symlink_to(kind)
    before = {name: os.lstat(name).st_mode for name in listing()}
    path = Path(f"{link}{kind}")
    with pytest.raises(WrongUse, match=r"is a folder|cannot write .* a (pipe|socket)"):
        check_place(path, force=True)
    with pytest.raises(OSError, match=r"cannot write .* a (pipe|socket|folder), and only files"):
        save(cube_set(), path, SaveOptions(force=True))
    assert {name: os.lstat(name).st_mode for name in listing()} == before


@POSIX
@pytest.mark.parametrize("name", [IMAGE, "a.obj.mtl"])
def test_side_files_replace_only_files(name):
    ms = textured_set()
    os.mkfifo("pipe")
    Path(name).symlink_to("pipe")
    with pytest.raises(OSError, match=f"cannot write {name}: it leads to a pipe"):
        save(ms, Path("a.obj"), SaveOptions(force=True, origins=(SAMPLES,)))
    assert listing() == sorted([name, "pipe"])
    assert stat.S_ISFIFO(os.stat(name).st_mode)


# Custom attributes


def with_attributes(*names):
    ms = cube_set()
    mesh = ms.current_mesh()
    for place, name in enumerate(names):
        mesh.add_vertex_custom_scalar_attribute(np.arange(14.0) + place, name)
    mesh.add_vertex_custom_point_attribute(np.ones((14, 3)), "Points")
    mesh.add_face_custom_scalar_attribute(np.arange(24.0), "on_faces")
    mesh.add_face_custom_point_attribute(np.ones((24, 3)), "on_faces_too")
    return ms


def properties(path):
    return {line.split()[-1] for line in header(path).splitlines() if line.startswith("property")}


def test_custom_attributes_are_saved(tmp_path, capsys):
    ms = with_attributes("Mine", "thickness-2")
    save(ms, tmp_path / "all.PLY", SaveOptions())
    new = {"Mine", "thickness-2", "Points", "on_faces", "on_faces_too"}
    save(cube_set(), tmp_path / "none.ply", SaveOptions())
    assert properties(tmp_path / "all.PLY") - properties(tmp_path / "none.ply") == new
    assert capsys.readouterr().err == ""
    # A mask says all that is wanted.
    save(ms, tmp_path / "some.ply", SaveOptions(parts=("vq",)))
    assert not new & properties(tmp_path / "some.ply")


def test_formats_without_custom_attributes(tmp_path, capsys):
    save(with_attributes("a"), tmp_path / "a.stl", SaveOptions())
    assert capsys.readouterr().err == "Note: .stl files hold no custom attributes\n"
    save(cube_set(), tmp_path / "b.stl", SaveOptions())
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("name", ["a b", "a\nend_header", "", "a\nproperty float x"])
def test_attributes_with_odd_names(tmp_path, capsys, name):
    path = tmp_path / "a.ply"
    save(with_attributes("good", name), path, SaveOptions())
    # Names that follow the end of the header can't be read from it.
    assert "good" in properties(path) or "end_header" in name
    assert same_mesh(path, cube_file(tmp_path / "b.ply"))
    note = "Note: custom attributes with odd names are not saved\n" if name else ""
    assert capsys.readouterr().err == note


def test_usual_permissions(tmp_path):
    save(cube_set(), tmp_path / "a.ply", SaveOptions())
    usual = tmp_path / "usual"
    usual.touch()
    assert (tmp_path / "a.ply").stat().st_mode == usual.stat().st_mode


def test_long_and_non_ascii_names(tmp_path):
    path = tmp_path / ("ü" * 100 + ".ply")
    save(cube_set(), path, SaveOptions())
    assert listing(tmp_path) == [path.name]
    assert same_mesh(path, cube_file(tmp_path / "b.ply"))


def test_textures_are_compared_by_pixels(tmp_path):
    ms = textured_set()
    (image,) = ms.current_mesh().textures().values()
    encoded_anew = tmp_path / "anew.png"
    image.save(str(encoded_anew))
    assert encoded_anew.read_bytes() != (SAMPLES / IMAGE).read_bytes()
    saving.write_texture(image, tmp_path / "out.png", [encoded_anew, SAMPLES / IMAGE])
    assert (tmp_path / "out.png").read_bytes() == encoded_anew.read_bytes()
    assert listing(tmp_path) == ["anew.png", "out.png"]


# Several processes of a batch


def test_files_that_come_meanwhile_are_not_replaced():
    """As where another process saves a texture of the same name at the same time."""
    Path("new").write_text("pixels")
    Path("same").write_text("pixels")
    Path("other").write_text("other pixels")
    assert saving._place_new(Path("new"), Path("placed")) is True
    assert saving._place_new(Path("new"), Path("same")) is False
    with pytest.raises(OSError, match="belongs to another output"):
        saving._place_new(Path("new"), Path("other"))
    assert Path("placed").read_text() == "pixels"
    assert Path("other").read_text() == "other pixels"


def test_file_of_the_batch_is_replaced_and_one_from_before_is_not(cube):
    """A mesh may have been saved by an attempt of which nobody heard."""
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(cube))
    Path("out.off").write_text("of an attempt")
    save(ms, Path("out.off"), SaveOptions(begun=os.path.getmtime("out.off") - 1.0))
    assert loaded("out.off").faces.shape == (24, 3)
    Path("mine.off").write_text("mine")
    with pytest.raises(FileExistsError, match="already exists; use --force"):
        save(ms, Path("mine.off"), SaveOptions(begun=os.path.getmtime("mine.off") + 1.0))
    assert Path("mine.off").read_text() == "mine"
