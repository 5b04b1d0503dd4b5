"""The filter from set to set: warm, and in a process of its own with a full and an empty cache.

pip install '.[bench]'
python -m pytest -o python_files='bench_*.py' tests/benchmarks
"""

import os
import subprocess
import sys

import pymeshlab
import pytest

from tests.benchmarks import surfaces

FACES = 20_000
ROUNDS = 5
# Compiling takes long, and about the same each time.
COLD_ROUNDS = 1
PROCESS = """
import pymeshlab, meshlab_willmore
ms = pymeshlab.MeshSet()
ms.create_sphere(subdiv=3)
ms.meshing_edge_flip_by_willmore_optimization()
"""
IMPORT = "import pymeshlab, meshlab_willmore"
IMPORT_WITHOUT = "import pymeshlab"

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


@pytest.mark.parametrize("program", [IMPORT_WITHOUT, IMPORT, PROCESS])
def test_process_with_a_full_cache(benchmark, program):
    benchmark.pedantic(run, args=(program,), rounds=ROUNDS, warmup_rounds=1)


def test_process_with_an_empty_cache(benchmark, tmp_path):
    folders = iter(tmp_path / str(number) for number in range(COLD_ROUNDS))

    def prepared():
        return (PROCESS,), {"NUMBA_CACHE_DIR": str(next(folders))}

    benchmark.pedantic(run, setup=prepared, rounds=COLD_ROUNDS)


def run(program, **environment):
    subprocess.run([sys.executable, "-c", program], env={**os.environ, **environment}, check=True)
