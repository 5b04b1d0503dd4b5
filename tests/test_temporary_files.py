"""Temporary folders are removed, and errors name them where they have no room."""

import shutil
import tempfile
from pathlib import Path

import pytest

from meshlab_willmore import temporary_files
from meshlab_willmore.machine import RoomError
from meshlab_willmore.temporary_files import temporary_folder


def test_a_temporary_folder_is_removed_in_the_end():
    with temporary_folder(1) as folder:
        (folder / "file").write_text("text")
    assert not folder.exists()
    with pytest.raises(ValueError, match="mine"), temporary_folder() as folder:
        raise ValueError("mine")
    assert not folder.exists()


@pytest.fixture
def in_memory(monkeypatch, tmp_path):
    """The folder that stands for memory."""
    for name in ("TMPDIR", "TEMP", "TMP"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(tempfile, "tempdir", "/tmp")
    monkeypatch.setattr(temporary_files, "_IN_MEMORY", tmp_path)
    return tmp_path


def place_of(*needed):
    with temporary_folder(*needed) as folder:
        return folder.parent


def test_a_small_folder_is_in_memory(in_memory):
    assert place_of(1000) == in_memory
    assert place_of() == place_of(2**21) == Path("/tmp")


@pytest.mark.parametrize("name", ["TMPDIR", "TEMP", "TMP"])
def test_a_folder_that_the_user_has_chosen_is_taken(in_memory, monkeypatch, name):
    monkeypatch.setenv(name, "/tmp")
    assert place_of(1000) == Path("/tmp")


def test_a_folder_that_the_program_has_chosen_is_taken(in_memory, monkeypatch, tmp_path_factory):
    chosen = tmp_path_factory.mktemp("chosen")
    monkeypatch.setattr(tempfile, "tempdir", str(chosen))
    assert place_of(1000) == chosen


def test_a_small_folder_is_not_in_memory_that_is_full(in_memory, monkeypatch):
    usage = shutil.disk_usage
    monkeypatch.setattr(
        shutil,
        "disk_usage",
        lambda path: usage(path)._replace(free=2**23) if path == in_memory else usage(path),
    )
    assert place_of(1000) == Path("/tmp")


def test_a_small_folder_is_not_in_memory_where_there_is_none(in_memory, monkeypatch):
    monkeypatch.setattr(temporary_files, "_IN_MEMORY", in_memory / "nowhere")
    assert place_of(1000) == Path("/tmp")


def test_too_little_room_is_an_error_before_anything_is_written():
    with pytest.raises(RoomError) as caught, temporary_folder(2**62):
        raise AssertionError("something was begun")
    place = Path(tempfile.gettempdir())
    assert str(caught.value).startswith(
        f"no room for temporary files in {place}: about 4294967296.0 GiB are needed, "
    )
    assert str(caught.value).endswith(" are free; fix it with: export TMPDIR=/a/folder/with/room")


def test_the_folder_is_named_when_any_writer_runs_out_of_room(monkeypatch, tmp_path):
    """A native writer reports nothing: the reader of its file finds it cut short."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))

    def refuse(**_given):
        raise OSError(28, "No space left on device")

    free = shutil.disk_usage(tmp_path)._replace(free=3 * 2**19)

    def write():
        monkeypatch.setattr(tempfile, "TemporaryFile", refuse)
        monkeypatch.setattr(shutil, "disk_usage", lambda _: free)
        raise ValueError("mesh.ply ends early")

    with pytest.raises(RoomError) as caught, temporary_folder(2**19):
        write()
    assert str(caught.value).startswith(
        f"no room for temporary files in {tmp_path}: about 512 KiB are needed, 1.5 MiB are free; "
    )
    assert list(tmp_path.iterdir()) == []


def test_no_place_at_all_for_temporary_files(monkeypatch):
    def fail(*_, **__):
        raise FileNotFoundError(2, "No usable temporary directory found in ['/tmp']")

    monkeypatch.setattr(tempfile, "mkdtemp", fail)
    with pytest.raises(RoomError) as caught, temporary_folder():
        pass
    assert str(caught.value).startswith("no folder for temporary files: No usable temporary")
    assert "; fix it with: export TMPDIR=" in str(caught.value)


def test_the_inner_of_two_folders_names_how_much_is_needed(monkeypatch):
    monkeypatch.setattr(temporary_files, "_is_full", lambda folder: True)

    def step():
        try:
            with temporary_folder(2**62):
                pass
        except RoomError as error:
            raise ValueError(f"step 2: {error}") from error

    with pytest.raises(ValueError, match=r"^step 2: .* are needed"), temporary_folder():
        step()
