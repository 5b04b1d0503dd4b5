"""Wrong variables of Numba's are named with their cure; without Numba the import goes on."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from meshlab_willmore import numba_settings
from meshlab_willmore.machine import Problem, join


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
    assert numba_settings.wrong_settings() == []
    for value in right:
        monkeypatch.setenv(name, value)
        assert numba_settings.wrong_settings() == []
    for value in wrong:
        monkeypatch.setenv(name, value)
        (problem,) = numba_settings.wrong_settings()
        assert problem.text.startswith(f"the variable {name} is {value!r}, ")
        assert problem.cure == f"unset {name}"


@pytest.mark.parametrize(
    ("name", "value"), [("NUMBA_NUM_THREADS", "0"), ("NUMBA_BOUNDSCHECK", "yes")]
)
def test_the_first_use_says_which_variable_is_wrong_and_numba_prints_nothing(name, value):
    done = run(
        "try:\n    import meshlab_willmore\n    meshlab_willmore.measures\n"
        "except ImportError as error:\n    print(error)",
        **{name: value},
    )
    assert done.stderr == ""
    assert done.stdout.startswith(f"the variable {name} is {value!r}, ")
    assert done.stdout.endswith(f"; fix it with: unset {name}\n")


def test_several_wrong_variables_are_all_named(monkeypatch):
    monkeypatch.setenv("NUMBA_NUM_THREADS", "0")
    monkeypatch.setenv("NUMBA_OPT", "9")
    both = str(join(numba_settings.wrong_settings()))
    assert "NUMBA_NUM_THREADS is '0'" in both
    assert "NUMBA_OPT is '9'" in both
    assert both.endswith("; fix it with: unset NUMBA_NUM_THREADS; unset NUMBA_OPT")


def test_a_cache_folder_that_cannot_be_used_is_named(monkeypatch, tmp_path):
    file = tmp_path / "file"
    file.touch()
    assert numba_settings.cache_problem() is None
    for good in ("", str(tmp_path), str(tmp_path / "later" / "still")):
        monkeypatch.setenv("NUMBA_CACHE_DIR", good)
        assert numba_settings.cache_problem() is None
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(file / "in"))
    assert numba_settings.cache_problem() == Problem(
        f"the folder of NUMBA_CACHE_DIR, {file / 'in'}, can't be written: {file} is a file",
        "unset NUMBA_CACHE_DIR",
    )
    monkeypatch.setenv("NUMBA_CACHE_DIR", "here")
    assert numba_settings.cache_problem().cure == f"export NUMBA_CACHE_DIR={Path.cwd() / 'here'}"


def test_without_numba_the_import_goes_on_and_its_use_says_why():
    done = run(
        "import sys\nsys.modules['numba'] = None\n"
        "import meshlab_willmore\nprint('there')\nmeshlab_willmore.measures"
    )
    assert done.stdout == "there\n"
    assert "numba" in done.stderr.splitlines()[-1]
