"""Loading: an error names the input that is wrong, and the others are processed."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from meshlab_willmore import memory
from meshlab_willmore.batch import process
from meshlab_willmore.mesh_files import loading, paths
from meshlab_willmore.mesh_files.paths import check_place
from meshlab_willmore.messages import WrongUse
from tests.cli.conftest import (
    FLIP,
    ONE_PIXEL,
    SAMPLES,
    TAUBIN,
    call,
    cube_file,
    listing,
    loaded,
    same_mesh,
    script_file,
    square_with_textures,
)

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="pipes, sockets and links of POSIX")
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="loads in a process of its own on Linux")

SQUARE = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"


def square(path):
    Path(path).write_text(SQUARE)
    return Path(path)


def nothing_to_read(path):
    path.touch()


def a_folder(path):
    path.mkdir()


def nonsense(path):
    path.write_text("no mesh")


def a_pipe(path):
    os.mkfifo(path)


def a_socket(path):
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(str(path))


def a_link_to_nothing(path):
    path.symlink_to("nothing")


def a_link_to_itself(path):
    path.symlink_to(path.name)


def half_a_face(path):
    # PyMeshLab crashes on it.
    path.write_text(SQUARE[:40])


def no_vertices(path):
    path.write_text("OFF\n0 0 0\n")


BAD = [
    (nothing_to_read, "is empty", ()),
    (a_folder, "is a folder", ()),
    (nonsense, "cannot read ", ()),
    (no_vertices, "cannot read ", ()),
    (a_pipe, "is a pipe; meshes are read from files", POSIX),
    (a_socket, "is a socket; meshes are read from files", POSIX),
    (a_link_to_nothing, "there is no file ", POSIX),
    (a_link_to_itself, "there is no file ", POSIX),
    (half_a_face, "PyMeshLab crashes on it", LINUX),
]


@pytest.mark.slow
def test_bad_inputs_are_named_and_the_others_are_processed():
    Path("in").mkdir()
    square("in/a.off")
    bad = [(make, line) for make, line, platform in BAD if not platform or not platform.args[0]]
    for number, (make, _) in enumerate(bad):
        make(Path(f"in/b{number}.off"))
    cube_file("in/c.ply")
    # What a changed working folder would lead to.
    square("c.ply")
    arguments = ["-i", "in/*.off", "in/c.ply", "-o", "{index:02}{name}_done.ply"]
    result = call("run", script_file(TAUBIN), *arguments, "--workers", 1)
    assert result.exit_code == 1
    *errors, last = result.stderr.splitlines()
    assert last == f"Error: {len(bad)} of {len(bad) + 2} inputs failed; the others are done"
    for number, (_, line) in enumerate(bad):
        (error,) = (error for error in errors if f"in/b{number}.off" in error)
        assert line in error
    done = f"{len(bad) + 2:02}c_done.ply"
    assert listing() == ["01a_done.ply", done, "c.ply", "in", "script.mlx"]
    assert len(loaded(done).faces) == 24
    table = call("measure", "in/a.off", "in/b*.off", "in/c.ply", "--json", "--workers", 1)
    assert [row["file"] for row in json.loads(table.stdout)] == ["in/a.off", "in/c.ply"]
    assert table.stderr == result.stderr


@pytest.mark.usefixtures("workers_here")
@pytest.mark.parametrize("bad", ["missing.ply", "*.nothing", "text.xyzzy"])
def test_missing_and_unknown_inputs_do_not_stop_the_others(bad):
    Path("text.xyzzy").write_text("hello")
    square("a.off")
    result = call("run", script_file(TAUBIN), "-i", bad, "a.off", "-o", "{name}.ply")
    assert result.exit_code == 1
    assert bad in result.stderr.splitlines()[0]
    assert Path("a.ply").exists()


def test_input_removed_during_the_run(monkeypatch):
    square("a.off")
    square("b.off")
    take_away = "import os; os.path.exists('b.off') and os.remove('b.off'); "
    monkeypatch.setattr(process, "_PROGRAM", take_away + process._PROGRAM)
    result = call("run", script_file(TAUBIN), "-i", "a.off", "b.off", "-o", "{name}.ply")
    assert result.exit_code == 1
    assert result.stderr.splitlines()[0].startswith("Error: cannot read b.off: ")
    assert Path("a.ply").exists()
    assert not Path("b.ply").exists()


@pytest.mark.usefixtures("workers_here")
def test_input_without_permission(monkeypatch):
    square("a.off")
    square("b.off")
    access = os.access
    monkeypatch.setattr(
        os, "access", lambda path, mode: Path(path).stem != "b" and access(path, mode)
    )
    result = call("run", script_file(TAUBIN), "-i", "a.off", "b.off", "-o", "{name}.ply")
    assert result.exit_code == 1
    assert result.stderr.startswith("Error: b.off can't be read: permission denied\n")
    assert Path("a.ply").exists()


def test_folder_without_permission(monkeypatch):
    square("a.off")
    stat = os.stat

    def refuse(path, **given):
        if Path(os.fspath(path)).parent.name == "closed":
            raise PermissionError(13, "Permission denied")
        return stat(path, **given)

    Path("closed").mkdir()
    square("closed/b.off")
    monkeypatch.setattr(os, "stat", refuse)
    with pytest.raises(WrongUse, match=r"closed/b\.off can't be read: permission denied"):
        paths.check_input(Path("closed/b.off"))
    monkeypatch.setattr(Path, "lstat", refuse)
    with pytest.raises(OSError, match=r"^cannot write closed/c\.ply: Permission denied$"):
        check_place(Path("closed/c.ply"), force=False)


@pytest.mark.usefixtures("workers_here")
def test_existing_output_of_a_bad_input_is_no_error():
    square("a.off")
    Path("b.off").touch()
    square("b.ply")
    result = call("run", script_file(TAUBIN), "-i", "*.off", "-o", "{name}.ply")
    assert result.exit_code == 1
    assert "b.ply already exists" not in result.stderr
    assert Path("b.ply").read_text() == SQUARE


@pytest.mark.usefixtures("workers_here")
def test_all_inputs_fail():
    Path("a.off").write_text("no mesh")
    Path("b.off").touch()
    result = call("run", script_file(TAUBIN), "-i", "*.off", "-o", "{name}.ply")
    assert result.exit_code == 1
    assert result.stderr.splitlines()[-1] == "Error: 2 of 2 inputs failed"


def test_all_layers_must_be_readable():
    square("a.off")
    Path("b.off").touch()
    result = call("run", script_file(TAUBIN), "-i", "*.off", "--layers", "-o", "c.ply")
    assert (result.exit_code, result.stderr) == (2, "Error: b.off is empty (0 bytes)\n")


NAMES = ["a b", "ü", "[a]", "{name}", "a'b", 'a"b', "a#b%20", "-x", "~", "a;b", " a"]


@pytest.mark.usefixtures("workers_here")
@POSIX
def test_names_with_odd_characters(tmp_path):
    for name in NAMES:
        square(f"{name}.off")
    result = call("run", script_file(TAUBIN), "-i", "./*.off", "-o", "{name}_done.ply")
    assert (result.exit_code, result.stderr) == (0, "")
    assert {f"{name}_done.ply" for name in NAMES} <= set(listing())


@POSIX
def test_name_that_is_not_utf8():
    path = Path(os.fsdecode(b"\xff.off"))
    try:
        square(path)
    except OSError:
        pytest.skip("needs a file system with any bytes in names")
    with pytest.raises(WrongUse, match="PyMeshLab takes names in UTF-8 only"):
        paths.check_input(path)


def test_working_folder_is_kept_after_each_load_and_save():
    Path("in").mkdir()
    Path("in/bad.ply").write_text("no mesh")
    here = Path.cwd()
    with pytest.raises(OSError, match=r"cannot read in/bad\.ply: Header not found"):
        loading.loaded(Path("in/bad.ply"))
    assert Path.cwd() == here
    assert call("flip", "in/bad.ply", "out.ply").exit_code == 1
    assert Path.cwd() == here


def test_image_in_the_working_folder_is_not_used_as_texture():
    # PyMeshLab itself looks into the working folder first.
    Path("red.png").write_bytes((SAMPLES / "TextureDouble_A.png").read_bytes())
    textured = square_with_textures("in", "red.png")
    Path("in/red.png").write_bytes(ONE_PIXEL)
    ms = loading.loaded(textured)
    assert list(ms.current_mesh().textures()) == ["red.png"]
    assert ms.current_mesh().textures()["red.png"].width() == 1


def test_result_in_a_batch_is_the_same_as_alone():
    cube = cube_file()
    Path("a.ply").write_text("no mesh")
    script = script_file(FLIP, TAUBIN)
    assert call("run", script, "-i", cube, "-o", "alone.ply").exit_code == 0
    assert call("run", script, "-i", "a.ply", cube, "-o", "{name}_two.ply").exit_code == 1
    assert same_mesh("alone.ply", "cube_two.ply")


@pytest.mark.usefixtures("workers_here")
def test_textures_of_the_same_name_are_not_mixed_up():
    pictures = {"a": ONE_PIXEL, "b": (SAMPLES / "TextureDouble_A.png").read_bytes()}
    for folder, data in pictures.items():
        square_with_textures(folder, "red.png")
        (Path(folder) / "red.png").write_bytes(data)
    Path("out").mkdir()
    script = script_file(("Select None", {}))
    inputs_given = ["-i", "a/square.obj", "b/square.obj"]
    result = call("run", script, *inputs_given, "-o", "out/{index}.obj", "--force")
    assert result.exit_code == 1
    assert result.stderr.splitlines()[0] == (
        "Error: b/square.obj: cannot write out/2.obj: out/red.png belongs to another output; "
        "use different folders"
    )
    assert Path("out/red.png").read_bytes() == ONE_PIXEL
    # Twice the same one is no matter.
    again = call(
        "run", script, "-i", "a/square.obj", "a/square.obj", "-o", "{index}.obj", "--force"
    )
    assert (again.exit_code, again.stderr) == (0, "")


@pytest.mark.usefixtures("workers_here")
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("bad.off", SQUARE.replace("3 0 2 3", "3 0 2 77")),
        ("bad.OFF", "# a scan\n\n" + SQUARE.replace("OFF\n", "OFF ").replace("3 0 2 3", "3 0 2 4")),
    ],
)
def test_face_with_a_missing_vertex_is_an_error(name, text):
    square("good.off")
    Path(name).write_text(text)
    done = call("run", script_file(TAUBIN), "-i", name, "good.off", "-o", "{name}.ply")
    assert done.exit_code == 1
    assert f"cannot read {name}: face 1 has a vertex that is not in 0 .. 3" in done.stderr
    assert Path("good.ply").exists()


@pytest.mark.parametrize(
    "text", [SQUARE.replace("3 0 2 3", "3 0 2 3 255 0 0"), SQUARE.replace("4 2 0", "4 2  # counts")]
)
def test_unusual_off_files_are_read(text):
    Path("a.off").write_text(text)
    assert loading.loaded(Path("a.off")).current_mesh().face_number() == 2


# In a process of its own

BUFFERED = """
from meshlab_willmore.cli import main
print("before")
main(["measure", "cube.ply", "--json"], standalone_mode=False)
print("after")
"""


@LINUX
@pytest.mark.slow
def test_nothing_in_a_buffer_is_lost():
    cube_file()
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}
    done = subprocess.run(
        [sys.executable, "-c", BUFFERED],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.startswith("before\n[")
    assert done.stdout.endswith("]\nafter\n")


def why(_, error):
    return str(error)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "a.ply"
    path.touch()
    return path


@LINUX
def test_trial_load_has_no_effect(file):
    seen = []
    loading.try_in_process(file, lambda _: seen.append(1), why)
    assert seen == []


@LINUX
def test_error_message_of_a_trial_load(file):
    def fail(_):
        raise ValueError("wrong")

    with pytest.raises(OSError, match=r"^why: wrong$"):
        loading.try_in_process(file, fail, lambda _, error: f"why: {error}")


@LINUX
def test_crash_is_named(file):
    with pytest.raises(OSError, match=r"^PyMeshLab crashes on it \(SIGSEGV\); the file is damaged"):
        loading.try_in_process(file, lambda _: os.kill(os.getpid(), signal.SIGSEGV), why)


@LINUX
def test_endless_load_is_stopped(file, monkeypatch):
    monkeypatch.setattr(loading, "_SECONDS", 0.1)
    with pytest.raises(OSError, match="does not finish within 0 s"):
        loading.try_in_process(file, lambda _: time.sleep(1000), why)


@LINUX
def test_large_textures_get_more_time(file):
    alone = loading.time_limit(file)
    with (file.parent / "image.PNG").open("wb") as image:
        image.truncate(50_000_000)
    assert loading.time_limit(file) == pytest.approx(alone + 50.0)


@LINUX
def test_memory_is_limited(file):
    with pytest.raises(OSError, match=r"^MemoryError$"):
        loading.try_in_process(
            file, lambda _: bytearray(1 << 46), lambda _, error: type(error).__name__
        )


@LINUX
def test_loading_without_proc(file, tmp_path, monkeypatch):
    monkeypatch.setattr(memory, "_PROC", tmp_path / "not mounted" / "self")
    loading.try_in_process(file, lambda _: None, why)


@LINUX
def test_process_ends_itself_without_its_parent(file, monkeypatch):
    # Here the parent is alive, but would wait longer.
    monkeypatch.setattr(loading, "_LONGER", 0.05 - loading._SECONDS)
    with pytest.raises(OSError, match=r"crashes on it \(SIGALRM\)"):
        loading.try_in_process(file, lambda _: time.sleep(1000), why)


@LINUX
def test_no_process_and_no_descriptor_is_left(file):
    """Others may be there, of tests before in this process."""

    def there():
        children = Path(f"/proc/self/task/{os.getpid()}/children")
        of_us = children.read_text().split() if children.exists() else []
        return set(os.listdir("/proc/self/fd")), set(of_us)

    before = there()
    loading.try_in_process(file, lambda _: None, why)
    assert there() == before
