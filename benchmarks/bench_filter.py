"""The filter from set to set: warm, and in a process of its own with a full and an empty cache.

pip install '.[bench]'
python -m pytest -o python_files='bench_*.py' benchmarks
"""

import os
import subprocess
import sys

import pymeshlab
import pytest

from benchmarks import surfaces

FACES = 20_000
ROUNDS = 5
# Compiling takes long, and about the same each time.
COLD_ROUNDS = 1
FIRST_FLIPS = """
import pymeshlab, meshlab_willmore
from meshlab_willmore.demo.models import dented_cube
ms = pymeshlab.MeshSet()
ms.add_mesh(pymeshlab.Mesh(*dented_cube()))
assert ms.meshing_edge_flip_by_willmore_optimization()["flips"]
"""
PROGRAMS = {
    "import of PyMeshLab": "import pymeshlab",
    "import of both": "import pymeshlab, meshlab_willmore",
    "first flips": FIRST_FLIPS,
}

pytestmark = pytest.mark.timeout(0)


def test_filter_warm(benchmark):
    surface = surfaces.sheared_torus(FACES)

    def prepared():
        ms = pymeshlab.MeshSet()
        ms.add_mesh(pymeshlab.Mesh(*surface))
        return (ms,), {}

    def flip(ms):
        return ms.meshing_edge_flip_by_willmore_optimization()

    flip(*prepared()[0])
    assert benchmark.pedantic(flip, setup=prepared, rounds=ROUNDS)["flips"]


@pytest.mark.parametrize("program", PROGRAMS.values(), ids=PROGRAMS.keys())
def test_process_with_a_full_cache(benchmark, program):
    benchmark.pedantic(run, args=(program,), rounds=ROUNDS, warmup_rounds=1)


def test_process_with_an_empty_cache(benchmark, tmp_path):
    folders = iter(tmp_path / str(number) for number in range(COLD_ROUNDS))

    def prepared():
        return (FIRST_FLIPS,), {"NUMBA_CACHE_DIR": str(next(folders))}

    benchmark.pedantic(run, setup=prepared, rounds=COLD_ROUNDS)


def run(program, **environment):
    subprocess.run([sys.executable, "-c", program], env={**os.environ, **environment}, check=True)
