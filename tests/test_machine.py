"""Faults of the machine: each is named, with its cure, and nothing else is blamed."""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from meshlab_willmore import machine
from meshlab_willmore.machine import MachineError, Problem, RoomError, SettingError


@pytest.fixture(autouse=True)
def _no_settings(monkeypatch):
    for name in [name for name in os.environ if name.startswith("NUMBA_")]:
        monkeypatch.delenv(name)


def run(program, **environment):
    return subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


# Variables


@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    [
        ("NUMBA_NUM_THREADS", ["1", "99", " 2"], ["x", "0", "-1", "1.5", ""]),
        ("NUMBA_OPT", ["0", "3", "max"], ["4", "-1", "x", ""]),
        ("NUMBA_THREADING_LAYER", ["tbb", "default"], ["x", ""]),
        ("NUMBA_THREADING_LAYER_PRIORITY", ["omp tbb workqueue"], ["x", "omp", "omp omp tbb"]),
        ("NUMBA_CPU_NAME", ["generic", ""], ["nonsense"]),
        ("NUMBA_CPU_FEATURES", [""], ["nonsense", "+nonsense"]),
    ],
)
def test_a_value_that_cannot_be_is_named_with_its_cure(monkeypatch, name, right, wrong):
    assert machine.wrong_settings() == []
    for value in right:
        monkeypatch.setenv(name, value)
        assert machine.wrong_settings() == []
    for value in wrong:
        monkeypatch.setenv(name, value)
        (problem,) = machine.wrong_settings()
        assert problem.text.startswith(f"the variable {name} is {value!r}, ")
        assert problem.cure == f"unset {name}"


@pytest.mark.parametrize(
    ("name", "value"), [("NUMBA_NUM_THREADS", "0"), ("NUMBA_BOUNDSCHECK", "yes")]
)
def test_the_import_says_which_variable_is_wrong_and_numba_says_nothing(name, value):
    done = run(
        "import contextlib, traceback\n"
        "try:\n    import meshlab_willmore\n"
        "except ImportError as error:\n    print(error)",
        **{name: value},
    )
    assert done.stderr == ""
    assert done.stdout.startswith(f"the variable {name} is {value!r}, ")
    assert done.stdout.endswith(f"; mend it with: unset {name}\n")


def test_several_wrong_variables_are_all_named(monkeypatch):
    monkeypatch.setenv("NUMBA_NUM_THREADS", "0")
    monkeypatch.setenv("NUMBA_OPT", "9")
    both = str(machine.join(machine.wrong_settings()))
    assert "NUMBA_NUM_THREADS is '0'" in both
    assert "NUMBA_OPT is '9'" in both
    assert both.endswith("; mend it with: unset NUMBA_NUM_THREADS; unset NUMBA_OPT")


def test_a_folder_for_the_cache_that_is_of_no_use(monkeypatch, tmp_path):
    file = tmp_path / "file"
    file.touch()
    assert machine.cache_problem() is None
    for good in ("", str(tmp_path), str(tmp_path / "later" / "still")):
        monkeypatch.setenv("NUMBA_CACHE_DIR", good)
        assert machine.cache_problem() is None
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(file / "in"))
    assert machine.cache_problem() == Problem(
        f"the folder of NUMBA_CACHE_DIR, {file / 'in'}, can't be written: {file} is a file",
        "unset NUMBA_CACHE_DIR",
    )
    monkeypatch.setenv("NUMBA_CACHE_DIR", "here")
    assert machine.cache_problem().cure == f"export NUMBA_CACHE_DIR={Path.cwd() / 'here'}"


# Temporary files


def test_a_temporary_folder_is_there_and_then_gone():
    with machine.temporary_folder(1) as folder:
        (folder / "file").write_text("text")
    assert not folder.exists()
    with pytest.raises(ValueError, match="mine"), machine.temporary_folder() as folder:
        raise ValueError("mine")
    assert not folder.exists()


def test_too_little_room_is_reported_before_anything_is_written():
    with pytest.raises(RoomError) as caught, machine.temporary_folder(2**62):
        raise AssertionError("something was begun")
    place = Path(tempfile.gettempdir())
    assert str(caught.value).startswith(
        f"no room for temporary files in {place}: about 4294967296.0 GiB are needed, "
    )
    assert str(caught.value).endswith(" are free; mend it with: export TMPDIR=/a/folder/with/room")


def test_any_writer_that_runs_out_of_room_names_the_folder(monkeypatch, tmp_path):
    """A native writer raises nothing: what reads its file finds it cut short."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))

    def refuse(**_given):
        raise OSError(28, "No space left on device")

    free = shutil.disk_usage(tmp_path)._replace(free=3 * 2**19)

    def write():
        monkeypatch.setattr(tempfile, "TemporaryFile", refuse)
        monkeypatch.setattr(shutil, "disk_usage", lambda _: free)
        raise ValueError("mesh.ply ends early")

    with pytest.raises(RoomError) as caught, machine.temporary_folder(2**19):
        write()
    assert str(caught.value).startswith(
        f"no room for temporary files in {tmp_path}: about 512 KiB are needed, 1.5 MiB are free; "
    )
    assert list(tmp_path.iterdir()) == []


def test_no_place_at_all_for_temporary_files(monkeypatch):
    def fail(**_given):
        raise FileNotFoundError(2, "No usable temporary directory found in ['/tmp']")

    monkeypatch.setattr(tempfile, "mkdtemp", fail)
    with pytest.raises(RoomError) as caught, machine.temporary_folder():
        pass
    assert str(caught.value).startswith("no folder for temporary files: No usable temporary")
    assert "; mend it with: export TMPDIR=" in str(caught.value)


def test_the_machines_fault_is_found_behind_others():
    fault = SettingError("why")
    error = ValueError("a.ply: it failed")
    error.__cause__ = RuntimeError("it failed")
    assert machine.fault_of(error) is None
    error.__cause__.__cause__ = fault
    assert machine.fault_of(error) is fault
    assert machine.fault_of(None) is None
    assert isinstance(fault, MachineError)


def test_the_error_of_the_inner_of_two_folders_says_how_much_is_needed(monkeypatch):
    monkeypatch.setattr(machine, "_is_full", lambda folder: True)

    def step():
        try:
            with machine.temporary_folder(2**62):
                pass
        except RoomError as error:
            raise ValueError(f"step 2: {error}") from error

    with pytest.raises(ValueError, match=r"^step 2: .* are needed"), machine.temporary_folder():
        step()
