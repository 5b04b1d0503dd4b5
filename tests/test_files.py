"""Files that are written whole, and folders that can be written into."""

import os
from pathlib import Path

import pytest

from meshlab_willmore.files import writable_folder, written_whole


def test_a_file_appears_whole_and_with_its_ending(tmp_path):
    path = tmp_path / "mesh.ply"
    with written_whole(path) as beside:
        assert beside.parent == tmp_path
        assert beside.suffix == ".ply"
        beside.write_text("new")
        assert not path.exists()
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_after_an_error_the_older_file_is_as_it_was(tmp_path):
    path = tmp_path / "mesh.ply"
    path.write_text("old")

    def write_half(beside):
        beside.write_text("ne")
        raise RuntimeError("half way")

    with pytest.raises(RuntimeError, match="half way"), written_whole(path) as beside:
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
