"""Kernels for kernels, and kernels where no cache can be written."""

import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
import pytest
from numba.core.caching import NullCache
from numba.core.errors import TypingError
from numba.core.runtime import _nrt_python, rtsys

import meshlab_willmore
from meshlab_willmore import optimize_flips
from meshlab_willmore.execution import SEARCHES
from meshlab_willmore.mesh.jit import allocating_jit, generic, inlined, inner, jit
from tests import meshes

SCRIPT = """
import pathlib, meshlab_willmore.optimize
from meshlab_willmore.mesh import points
assert pathlib.Path(points.__file__).is_relative_to(pathlib.Path.cwd())
print(points.norm(points.Point(2.0, 3.0, 6.0)))
"""


def compiled_here(kernel):
    """Return `kernel` without its cache: Numba shows no code that comes from there."""
    kernel._cache = NullCache()
    return kernel


def first(array):
    return array[0]


def last(array):
    return array[len(array) - 1]


@pytest.mark.heavy
@pytest.mark.parametrize("compiled", [inner, generic, inlined])
def test_kernels_for_kernels_are_compiled_for_them_only_until_python_calls(compiled):
    kernel = compiled_here(compiled(first))

    def caller(array):
        return kernel(array) + 1.0

    array = np.array([2.0, 3.0])
    assert generic(caller)(array) == 3.0
    assert "cpython" not in "".join(kernel.inspect_llvm().values())
    assert [kernel(array), kernel(array[1:])] == [2.0, 3.0]
    assert len(kernel.signatures) == 1


@pytest.mark.heavy
def test_kernels_for_python_have_no_way_in_for_c():
    kernel = compiled_here(jit(last))
    assert kernel(np.array([2.0])) == 2.0
    code = "".join(kernel.inspect_llvm().values())
    assert "cpython" in code
    assert "cfunc" not in code


@pytest.mark.heavy
@pytest.mark.slow
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


def new_array(count):
    return np.empty(count)


@pytest.mark.heavy
def test_only_allocating_kernels_may_create_arrays():
    assert len(compiled_here(allocating_jit(new_array))(2)) == 2
    with pytest.raises(TypingError, match="Only accept returning of array passed into"):
        compiled_here(jit(new_array))(2)


@pytest.mark.heavy
def test_kernels_that_count_no_references_leak_none():
    vertices, faces = meshes.torus(100, 0.3, 8)

    def flip():
        for search in SEARCHES:
            optimize_flips(vertices, faces, search=search, sweeps=2, checkintersections=True)

    def held():
        found = rtsys.get_allocation_stats()
        return found.alloc - found.free, found.mi_alloc - found.mi_free, sys.getrefcount(faces)

    flip()
    _nrt_python.memsys_enable_stats()
    try:
        before = held()
        flip()
        assert held() == before
    finally:
        _nrt_python.memsys_disable_stats()
