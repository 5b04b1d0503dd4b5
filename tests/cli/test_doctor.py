"""`doctor`: what each check finds, and the command that fixes it."""

import json
import os
import shutil
import sys
import tempfile
from pathlib import Path

import pytest

from meshlab_willmore import machine
from meshlab_willmore.cli import doctor
from meshlab_willmore.cli.doctor import Finding
from meshlab_willmore.meshset import catalogue

from .conftest import call

NEEDS_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="shared libraries of Linux")
APT = "apt-get install libgl1 libopengl0"


@pytest.fixture
def on_debian(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: name if name == "apt-get" else None)


def answering(monkeypatch, values, printed=""):
    monkeypatch.setattr(doctor, "ask", lambda _: doctor.Answer(values, printed))


# The command


def test_all_checks_pass(monkeypatch):
    monkeypatch.setattr(doctor, "CHECKS", (lambda: Finding("one", True, "is fine"),))
    result = call("doctor")
    assert (result.exit_code, result.stdout) == (0, "ok   one: is fine\nAll checks passed.\n")


def test_findings_fit_80_columns_and_fixes_stay_in_one_line(monkeypatch):
    text = " ".join(["some-long-word"] * 12)
    bad = Finding("two", False, text, f"command {text}")
    monkeypatch.setattr(doctor, "CHECKS", (lambda: bad,))
    *lines, fix, _ = call("doctor").stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert " ".join(" ".join(lines).split()) == f"BAD two: {text}"
    assert all(line.startswith("     some-long-word") for line in lines[1:])
    assert fix == f"     fix: command {text}"


def test_failed_check_has_a_fix(monkeypatch):
    bad = Finding("two", False, "is gone", "apt-get install two")
    monkeypatch.setattr(doctor, "CHECKS", (lambda: Finding("one", True, "is fine"), lambda: bad))
    result = call("doctor")
    assert (result.exit_code, result.stdout) == (
        1,
        "ok   one: is fine\nBAD  two: is gone\n     fix: apt-get install two\n"
        "1 of 2 checks failed\n",
    )
    result = call("doctor", "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout) == {
        "ok": False,
        "findings": [
            {"name": "one", "ok": True, "text": "is fine", "cure": ""},
            {"name": "two", "ok": False, "text": "is gone", "cure": "apt-get install two"},
        ],
    }


@pytest.mark.heavy
@pytest.mark.slow
def test_checks_pass_on_this_machine(monkeypatch):
    # What is compiled is asked in tests/test_warmup.
    checks = [check for check in doctor.CHECKS if check is not doctor.cache]
    monkeypatch.setattr(doctor, "CHECKS", checks)
    result = call("doctor", "--json")
    assert result.exit_code == 0, result.stdout
    report = json.loads(result.stdout)
    assert report["ok"] is True
    assert len(report["findings"]) == len(checks) > 4
    numba = next(f for f in report["findings"] if f["name"] == "Numba")
    assert numba["text"].startswith("compiles; threads: ")


# PyMeshLab


@pytest.fixture
def without_gl(tmp_path, monkeypatch):
    """A machine without libGL: what the import then says."""
    package = tmp_path / "pymeshlab"
    package.mkdir()
    (package / "__init__.py").write_text(
        "raise ImportError('libGL.so.1: cannot open shared object file: No such file')"
    )
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))


@pytest.mark.slow
def test_missing_library_is_named(without_gl, on_debian):
    finding = doctor.pymeshlab()
    assert finding == Finding(
        "PyMeshLab", False, "can't be loaded: libGL.so.1 is missing or broken", APT
    )
    finding = doctor.filters()
    assert not finding.ok
    assert "libGL.so.1" in finding.text


@NEEDS_LINUX
@pytest.mark.slow
def test_missing_plugins_and_filters_are_named(tmp_path, monkeypatch, on_debian):
    if catalogue.version() != catalogue.recorded_version():
        pytest.skip("other versions have other plugins")
    (tmp_path / "libOpenGL.so.0").write_text("no library")
    monkeypatch.setenv("LD_LIBRARY_PATH", str(tmp_path))
    finding = doctor.pymeshlab()
    assert (finding.ok, finding.cure) == (False, APT)
    assert "filter_meshing" in finding.text
    assert "(libOpenGL.so.0 can't be loaded)" in finding.text
    finding = doctor.filters()
    assert (finding.ok, finding.cure) == (False, APT)
    assert "of PyMeshLab's filters are missing: " in finding.text
    assert finding.text.endswith(" more")


def test_all_install_commands_without_a_known_installer(without_gl, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda _: None)
    assert doctor.pymeshlab().cure == f"{APT} or dnf install mesa-libGL libglvnd-opengl"


def test_missing_filters_in_another_version_are_no_failure(monkeypatch):
    values = {"registered": True, "missing": ["a"], "version": "2023.12", "recorded": "2025.7"}
    answering(monkeypatch, values)
    finding = doctor.filters()
    assert finding.ok
    assert finding.text.endswith(
        "1 of PyMeshLab's filters are missing: a (this is PyMeshLab 2023.12; the list is that of "
        "2025.7)"
    )
    answering(monkeypatch, {**values, "version": "2025.7"})
    assert not doctor.filters().ok


def test_other_import_errors(monkeypatch):
    answering(monkeypatch, {}, "Traceback\nImportError: numpy is too old")
    finding = doctor.pymeshlab()
    assert not finding.ok
    assert finding.text == "can't be loaded: ImportError: numpy is too old"
    assert "pip install --force-reinstall" in finding.cure


# Numba


def test_numba_that_cannot_compile(monkeypatch):
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    answering(monkeypatch, {}, "OSError: no LLVM")
    finding = doctor.compiler()
    assert (finding.ok, finding.text) == (False, "can't compile: OSError: no LLVM")
    assert finding.cure.endswith("-m pip install --upgrade numba")


def test_more_threads_than_cores_are_reported(monkeypatch):
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    answering(monkeypatch, {"threads": 2, "cores": 2})
    assert doctor.compiler() == Finding("Numba", True, "compiles; threads: 2")
    answering(monkeypatch, {"threads": 99, "cores": 2})
    text = "compiles; threads: 99 on 2 cores, more than useful"
    assert doctor.compiler() == Finding("Numba", True, text)


@pytest.mark.parametrize("value", ["1", "2", "01"])
def test_compiler_switched_off(monkeypatch, value):
    monkeypatch.setenv("NUMBA_DISABLE_JIT", value)
    assert doctor.compiler().cure == "unset NUMBA_DISABLE_JIT"
    assert doctor.cache().ok


@pytest.mark.slow
def test_wrong_variable_fails_all_checks_that_need_numba(monkeypatch):
    monkeypatch.setenv("NUMBA_NUM_THREADS", "x")
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    problem = (
        "the variable NUMBA_NUM_THREADS is 'x', but has to be a whole number of threads, 1 or more",
        "unset NUMBA_NUM_THREADS",
    )
    for check in (doctor.settings, doctor.compiler):
        assert check()[1:] == (False, *problem)
    answering(monkeypatch, {}, f"Traceback\nSettingError: {machine.Problem(*problem)}")
    for check in (doctor.filters, doctor.cache):
        assert check()[1:] == (False, *problem)


def test_valid_variables_are_listed(monkeypatch):
    for name in [name for name in os.environ if name.startswith("NUMBA_")]:
        monkeypatch.delenv(name)
    answering(monkeypatch, {"wrong": False})
    assert doctor.settings() == Finding("variables", True, "no NUMBA_ variable is set")
    monkeypatch.setenv("NUMBA_OPT", "3")
    monkeypatch.setenv("NUMBA_NUM_THREADS", "2")
    assert doctor.settings().text == "NUMBA_NUM_THREADS=2, NUMBA_OPT=3"


def test_no_cache_folder(monkeypatch):
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    answering(monkeypatch, {"folder": None, "steps": 9, "missing": None})
    finding = doctor.cache()
    assert not finding.ok
    assert finding.cure.startswith("export NUMBA_CACHE_DIR=")


def test_cache_that_cannot_be_read_is_no_missing_folder(monkeypatch):
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    answering(monkeypatch, {}, "Traceback\nImportError: no LLVM")
    finding = doctor.cache()
    assert (finding.ok, finding.text) == (False, "can't be read: ImportError: no LLVM")


def test_unusable_cache_folder(monkeypatch, tmp_path):
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    file = tmp_path / "file"
    file.touch()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(file))
    assert doctor.cache() == Finding(
        "Numba's cache",
        False,
        f"the folder of NUMBA_CACHE_DIR, {file}, can't be written: it is a file",
        "unset NUMBA_CACHE_DIR",
    )


def test_damaged_files_of_the_cache_are_named(monkeypatch, tmp_path):
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    values = {"folder": str(tmp_path), "steps": 9, "missing": 0}
    answering(monkeypatch, {**values, "damaged": ["/c a/one.nbc"]})
    assert doctor.cache() == Finding(
        "Numba's cache",
        False,
        "1 file damaged, compiled again when needed: /c a/one.nbc",
        "rm -r '/c a/one.nbc'",
    )
    answering(monkeypatch, {**values, "damaged": [f"/c/{i}/{i}.nbc" for i in "1212121212"]})
    finding = doctor.cache()
    assert finding.text.startswith("10 files damaged, ")
    assert finding.cure == "rm -r /c/1 /c/2"


@pytest.mark.parametrize("home", ["file", "relative", None])
def test_unwritable_home_is_not_suggested(monkeypatch, tmp_path, home):
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    (tmp_path / "file").touch()
    homes = {"file": tmp_path / "file", "relative": Path("nowhere")}

    def find():
        if home is None:
            raise RuntimeError("Could not determine home directory.")
        return homes[home]

    monkeypatch.setattr(Path, "home", find)
    answering(monkeypatch, {"folder": None, "steps": 9, "missing": None})
    assert doctor.cache().cure == "export NUMBA_CACHE_DIR=/a/folder/of/yours"


def test_cache_shows_how_much_is_compiled(monkeypatch, tmp_path):
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)

    def found(folder, missing):
        answering(monkeypatch, {"folder": str(folder), "steps": 9, "missing": missing})
        return doctor.cache()

    later = tmp_path / "later"
    now = "the rest on first use, or now with: meshlab-willmore warmup"
    assert found(later, 9).text == f"{later} (nothing compiled yet; {now})"
    text = f"{tmp_path} (7 of 9 ways to flip and measure compiled yet; {now})"
    assert found(tmp_path, 2) == Finding("Numba's cache", True, text)
    assert found(tmp_path, 0) == Finding(
        "Numba's cache", True, f"{tmp_path} (everything is compiled)"
    )
    assert "meshlab-willmore warmup" in found(tmp_path, None).text
    file = tmp_path / "file"
    file.touch()
    assert not found(file, 0).ok


# The rest


def test_package_not_installed(monkeypatch):
    monkeypatch.setattr(doctor, "LIBRARIES", ("numpy", "surely-no-such-package"))
    finding = doctor.packages()
    assert (finding.ok, finding.text) == (False, "surely-no-such-package not installed")
    assert finding.cure.endswith("-m pip install surely-no-such-package")


def test_little_room_for_temporary_files(monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.delenv("TMPDIR", raising=False)
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=50 * 2**20))
    finding = doctor.temporary()
    assert finding == Finding(
        "temporary files",
        False,
        f"the folder for temporary files, {tmp_path}, has only 50.0 MiB free",
        "export TMPDIR=/a/folder/with/room",
    )
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=500 * 2**20))
    assert doctor.temporary() == Finding("temporary files", True, f"{tmp_path}, 500 MiB free")
    monkeypatch.setenv("TMPDIR", str(tmp_path / "gone"))
    assert doctor.temporary().text == (
        f"TMPDIR names {tmp_path / 'gone'}, where no file can be written: there is no such folder; "
        f"{tmp_path} is used"
    )
    file = tmp_path / "file"
    file.touch()
    monkeypatch.setattr(tempfile, "tempdir", str(file))
    assert doctor.temporary().text == f"no temporary file can be written into {file}: it is a file"


def test_no_folder_for_temporary_files(monkeypatch):
    def fail():
        raise FileNotFoundError(2, "No usable temporary directory found in ['/tmp', '/']")

    monkeypatch.setattr(tempfile, "gettempdir", fail)
    finding = doctor.temporary()
    assert finding.text.startswith("no folder for temporary files: No usable")
    assert finding.cure.startswith("export TMPDIR=")


# Asking


def test_answer_among_other_output():
    answer = doctor.ask("print('Warning: noise', end='')\nanswer = {'a': 1}")
    assert answer == doctor.Answer({"a": 1}, "Warning: noise")


def test_crashed_process_has_no_answer():
    assert doctor.ask("import os\nos.abort()").values == {}
    answer = doctor.ask("raise ValueError('why')")
    assert answer.values == {}
    assert answer.printed.endswith("ValueError: why")


def test_process_that_never_answers(monkeypatch):
    monkeypatch.setattr(doctor, "_SECONDS", 0.2)
    answer = doctor.ask("import time\ntime.sleep(60)")
    assert answer == doctor.Answer({}, "no answer in 0.2 seconds")
