"""Loading in a process of its own first: crashes, hangs and errors are told apart."""

import os
import signal
import sys
import time
from pathlib import Path

import pytest

from meshlab_willmore.cli import loading

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="for Linux only")


def why(_, error):
    return str(error)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "a.ply"
    path.touch()
    return path


def test_nothing_of_a_load_that_succeeds_is_seen(file):
    seen = []
    loading.try_in_process(file, lambda _: seen.append(1), why)
    assert seen == []


def test_an_error_is_told_in_the_words_of_its_own(file):
    def fail(_):
        raise ValueError("wrong")

    with pytest.raises(OSError, match=r"^why: wrong$"):
        loading.try_in_process(file, fail, lambda _, error: f"why: {error}")


def test_a_crash_is_named(file):
    with pytest.raises(OSError, match=r"^PyMeshLab crashes on it \(SIGSEGV\); the file is damaged"):
        loading.try_in_process(file, lambda _: os.kill(os.getpid(), signal.SIGSEGV), why)


def test_what_does_not_end_is_ended(file, monkeypatch):
    monkeypatch.setattr(loading, "_SECONDS", 0.1)
    with pytest.raises(OSError, match="does not finish within 0 s"):
        loading.try_in_process(file, lambda _: time.sleep(1000), why)


def test_large_textures_may_take_their_time(file):
    alone = loading._limit(file)
    with (file.parent / "image.PNG").open("wb") as image:
        image.truncate(50_000_000)
    assert loading._limit(file) == pytest.approx(alone + 50.0)


def test_memory_has_a_limit(file):
    with pytest.raises(OSError, match=r"^MemoryError$"):
        loading.try_in_process(
            file, lambda _: bytearray(1 << 46), lambda _, error: type(error).__name__
        )


def test_without_proc_files_are_loaded_all_the_same(file, tmp_path, monkeypatch):
    monkeypatch.setattr(loading, "_PROC", tmp_path / "not mounted")
    loading.try_in_process(file, lambda _: None, why)


def test_a_process_whose_parent_is_gone_ends_itself(file, monkeypatch):
    # Here the parent is alive, but would wait longer.
    monkeypatch.setattr(loading, "_LONGER", 0.05 - loading._SECONDS)
    with pytest.raises(OSError, match=r"crashes on it \(SIGALRM\)"):
        loading.try_in_process(file, lambda _: time.sleep(1000), why)


def test_no_process_and_no_descriptor_is_left(file):
    """Others may be there, of tests before in this process."""

    def there():
        children = Path(f"/proc/self/task/{os.getpid()}/children")
        of_us = children.read_text().split() if children.exists() else []
        return set(os.listdir("/proc/self/fd")), set(of_us)

    before = there()
    loading.try_in_process(file, lambda _: None, why)
    assert there() == before
