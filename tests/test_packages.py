"""Source distribution and wheel: both are whole, and the first builds and tests from itself."""

import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from tests.extras import needs

ROOT = Path(__file__).parents[1]
SCRIPTS = sorted(path.name for path in (ROOT / "filter_scripts").glob("*.mlx"))
# They need no kernel.
QUICK = ["tests/test_files.py", "tests/test_filter_scripts.py", "tests/cli/test_shipped.py"]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(600),
    *(needs(module, "dist") for module in ("build", "twine")),
]


def run(*arguments, **given):
    """Run a program; its output is shown if it fails."""
    done = subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, check=False, **given
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    """The folder with the source distribution, and the wheel that was built from it."""
    if not (ROOT / ".git").exists():
        pytest.skip("it takes a checkout")
    folder = tmp_path_factory.mktemp("dist")
    clone = folder / "clone"
    subprocess.run(["git", "clone", "-q", str(ROOT), str(clone)], check=True)
    run("-m", "build", "--outdir", str(folder), str(clone))
    return folder


def only(folder, pattern):
    (path,) = folder.glob(pattern)
    return path


def test_metadata_is_valid(packages):
    paths = [str(only(packages, "*.whl")), str(only(packages, "*.tar.gz"))]
    done = run("-m", "twine", "check", "--strict", *paths)
    assert done.stdout.count("PASSED") == 2


def test_source_distribution_has_all_files_of_the_checkout(packages):
    with tarfile.open(only(packages, "*.tar.gz")) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    listed = subprocess.run(
        ["git", "ls-files"], cwd=packages / "clone", capture_output=True, text=True, check=True
    )
    assert set(listed.stdout.splitlines()) - names <= {".gitignore"}


def test_wheel_has_the_package_and_its_data_only(packages):
    names = zipfile.ZipFile(only(packages, "*.whl")).namelist()
    folders = {name.partition("/")[0] for name in names}
    assert {name for name in folders if not name.endswith(".dist-info")} <= {
        "meshlab_willmore",
        "pymeshlab-stubs",
    }
    for name in SCRIPTS:
        assert f"meshlab_willmore/filter_scripts/{name}" in names
    assert "meshlab_willmore/meshset/native_filters.json" in names


def test_scripts_are_reachable_in_the_wheel(packages, tmp_path):
    zipfile.ZipFile(only(packages, "*.whl")).extractall(tmp_path / "installed")
    paths = os.pathsep.join([str(tmp_path / "installed"), *filter(None, sys.path)])
    program = (
        "import meshlab_willmore; from meshlab_willmore.cli import main; "
        "print(meshlab_willmore.__file__); main(['scripts', '--copy', 'copied'])"
    )
    done = run("-c", program, cwd=tmp_path, env={**os.environ, "PYTHONPATH": paths})
    assert done.stdout.startswith(str(tmp_path / "installed"))
    assert sorted(path.name for path in (tmp_path / "copied").iterdir()) == SCRIPTS


def test_source_distribution_tests_from_itself(packages, tmp_path):
    with tarfile.open(only(packages, "*.tar.gz")) as archive:
        archive.extractall(tmp_path, filter="data")
    folder = only(tmp_path, "meshlab_willmore-*")
    paths = os.pathsep.join([str(folder), *filter(None, sys.path)])
    options = ["-q", "-n0", "-p", "no:cacheprovider", "-m", "not slow"]
    done = run(
        "-m", "pytest", *options, *QUICK, cwd=folder, env={**os.environ, "PYTHONPATH": paths}
    )
    assert " passed" in done.stdout
