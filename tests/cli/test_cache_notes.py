"""What is said where kernels can't be kept."""

import errno
from pathlib import Path

import pytest

from meshlab_willmore.cli import cache_notes
from meshlab_willmore.mesh import jit, kernel_cache


@pytest.fixture(autouse=True)
def _home(monkeypatch, tmp_path):
    monkeypatch.setattr(Path, "home", lambda: tmp_path)


def test_a_full_cache_is_told_of_once(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(jit, "cache_folder", lambda: "/the/cache")
    monkeypatch.setattr(kernel_cache, "write_errors", [OSError(errno.ENOSPC, "full")])
    cache_notes.tell(True)
    cache_notes.tell(True)
    cure = f"export NUMBA_CACHE_DIR={tmp_path / '.cache' / 'numba'}"
    text = "kernels can't be kept in /the/cache: No space left on device"
    assert capsys.readouterr().err == f"Note: {text}; mend it with: {cure}\n"


def test_no_folder_is_told_of_where_something_was_compiled(monkeypatch, capsys):
    monkeypatch.setattr(jit, "cache_folder", lambda: None)
    cache_notes.tell(False)
    assert capsys.readouterr().err == ""
    cache_notes.tell(True)
    line = capsys.readouterr().err
    assert line.startswith("Note: there is no folder to keep kernels in, and each run compiles")
    assert line.count("\n") == 1
