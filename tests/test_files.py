"""Files that are written atomically and replace regular files only, and folders."""

import os
import socket
import stat
import sys
from pathlib import Path

import pytest

from meshlab_willmore.files import atomic_write, replace, special, writable_folder, write

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="pipes, sockets and links of POSIX")


def test_a_file_is_written_atomically_under_its_name(tmp_path):
    path = tmp_path / "mesh.ply"
    with atomic_write(path) as beside:
        assert beside.parent.parent == tmp_path
        assert beside.name == path.name
        beside.write_text("new")
        assert not path.exists()
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_after_an_error_the_existing_file_is_unchanged(tmp_path):
    path = tmp_path / "mesh.ply"
    path.write_text("old")

    def write_half(beside):
        beside.write_text("ne")
        raise RuntimeError("half way")

    with pytest.raises(RuntimeError, match="half way"), atomic_write(path) as beside:
        write_half(beside)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_folder_is_made_and_left_empty(tmp_path):
    folder = tmp_path / "a" / "b"
    for _ in range(2):
        assert writable_folder(folder) == folder
        assert list(folder.iterdir()) == []


def test_a_file_in_the_folders_place_is_named(tmp_path):
    path = tmp_path / "taken"
    path.write_text("mine")
    with pytest.raises(OSError, match=r"cannot write into .*taken: it is a file"):
        writable_folder(path)
    with pytest.raises(OSError, match=r"cannot write into .*below: Not a directory"):
        writable_folder(path / "below")
    assert path.read_text() == "mine"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write")
def test_a_folder_without_write_permission_is_named(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(OSError, match=r"cannot write into .*: Permission denied"):
        writable_folder(tmp_path)


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs a file system that is read-only")
def test_a_read_only_file_system_is_named():
    with pytest.raises(OSError, match=r"cannot write into /proc/self: "):
        writable_folder(Path("/proc/self"))


# What is no regular file


@pytest.fixture
def nodes(tmp_path):
    """A pipe, a socket, a folder and links that lead nowhere, and a link to each."""
    os.mkfifo(tmp_path / "pipe")
    with socket.socket(socket.AF_UNIX) as made:
        here = Path.cwd()
        os.chdir(tmp_path)  # a socket's name takes a hundred bytes
        made.bind("socket")
        os.chdir(here)
    (tmp_path / "folder").mkdir()
    for name in ("pipe", "socket", "folder", "ring"):
        (tmp_path / f"to-{name}").symlink_to(name)
    (tmp_path / "ring").symlink_to("to-ring")
    return tmp_path


def kinds(folder):
    return {path.name: stat.S_IFMT(path.lstat().st_mode) for path in folder.iterdir()}


@POSIX
@pytest.mark.parametrize("name", ["pipe", "socket", "folder", "ring"])
@pytest.mark.parametrize("link", ["", "to-"])
def test_nothing_but_a_file_is_replaced(nodes, name, link):
    path = nodes / f"{link}{name}"
    draft = nodes / "draft"
    draft.write_text("new")
    before = kinds(nodes)
    with pytest.raises(OSError, match=f"^cannot write {path}: "), atomic_write(path) as beside:
        beside.write_text("new")
    with pytest.raises(OSError, match=f"^cannot write {path}: "):
        replace(draft, path)
    with pytest.raises(OSError, match=f"^cannot write {path}: "):
        write(path, b"new")
    assert kinds(nodes) == before


@POSIX
@pytest.mark.parametrize("name", ["pipe", "to-pipe"])
def test_a_pipe_gets_the_data(nodes, name):
    end = os.open(nodes / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    write(nodes / name, b"all of it")
    assert os.read(end, 100) == b"all of it"
    os.close(end)
    assert special(nodes / name) == "a pipe"


@POSIX
def test_a_device_is_written_into():
    assert special(Path("/dev/null")) == "a device"
    write(Path("/dev/null"), b"nowhere")
    if Path("/dev/full").exists():
        with pytest.raises(OSError, match=r"^cannot write /dev/full: No space left on device$"):
            write(Path("/dev/full"), b"nowhere")


@POSIX
def test_a_file_behind_links_is_replaced_and_keeps_its_mode(tmp_path):
    real = tmp_path / "elsewhere/real"
    real.parent.mkdir()
    real.write_text("old")
    real.chmod(0o640)
    (tmp_path / "second.mlx").symlink_to("elsewhere/real")
    link = tmp_path / "first.mlx"
    link.symlink_to("second.mlx")
    with atomic_write(link) as beside:
        assert beside.suffix == ".mlx"
        beside.write_text("new")
    assert link.is_symlink()
    assert real.read_text() == "new"
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert sorted(os.listdir(tmp_path)) == ["elsewhere", "first.mlx", "second.mlx"]
    assert os.listdir(real.parent) == ["real"]


@POSIX
def test_a_link_that_leads_nowhere_leads_to_the_new_file(tmp_path):
    link = tmp_path / "link"
    link.symlink_to("real")
    write(link, b"new")
    assert link.is_symlink()
    assert (tmp_path / "real").read_bytes() == b"new"
    other = tmp_path / "other"
    other.symlink_to("no/real")
    with pytest.raises(OSError, match=r"^cannot write .*No such file or directory$"):
        write(other, b"new")


def test_other_files_in_the_folder_are_left_alone(tmp_path):
    mine = tmp_path / f".mesh.{os.getpid()}.ply"
    mine.write_text("mine")
    with atomic_write(tmp_path / "mesh.ply") as beside:
        beside.write_text("new")
    assert mine.read_text() == "mine"


def test_a_name_may_be_as_long_as_the_disk_takes(tmp_path):
    path = tmp_path / ("n" * 251 + ".ply")
    with atomic_write(path) as beside:
        beside.write_text("new")
    assert path.read_text() == "new"
