"""Kernels where no cache can be written."""

import os
import pathlib
import shutil
import subprocess
import sys

import pytest

import meshlab_willmore

SCRIPT = """
import pathlib, meshlab_willmore.optimize
from meshlab_willmore.mesh import points
assert pathlib.Path(points.__file__).is_relative_to(pathlib.Path.cwd())
print(points.norm(points.Point(2.0, 3.0, 6.0)))
"""


@pytest.mark.heavy
def test_without_a_place_for_a_cache_kernels_are_compiled_all_the_same(tmp_path):
    """Files in place of all folders that Numba tries: also root cannot write there."""
    source = pathlib.Path(meshlab_willmore.__file__).parent
    copy = tmp_path / "meshlab_willmore"
    shutil.copytree(source, copy, ignore=shutil.ignore_patterns("__pycache__"))
    for folder in [copy, *(path for path in copy.rglob("*") if path.is_dir())]:
        (folder / "__pycache__").touch()
    nowhere = tmp_path / "nowhere"
    nowhere.touch()
    environment = {name: value for name, value in os.environ.items() if "NUMBA" not in name}
    for name in ("HOME", "XDG_CACHE_HOME", "LOCALAPPDATA", "APPDATA"):
        environment[name] = str(nowhere)
    run = subprocess.run(
        [sys.executable, "-B", "-W", "error", "-c", SCRIPT],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (run.returncode, run.stdout, run.stderr) == (0, "7.0\n", "")
