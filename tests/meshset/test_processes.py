"""The filter in several processes, the core on several threads."""

import multiprocessing
import subprocess
import sys
import threading

import numpy as np
import pytest

from meshlab_willmore import optimize_flips
from tests import meshes

# Each process is to have a mesh set of its own.
SCRIPT = """
import multiprocessing
import pymeshlab, meshlab_willmore
from tests import meshes

def flipped(count):
    ms = pymeshlab.MeshSet(verbose=False)
    ms.add_mesh(pymeshlab.Mesh(*meshes.torus(count, None, 1)))
    flips = ms.meshing_edge_flip_by_willmore_optimization()["flips"]
    return flips, ms.current_mesh().face_matrix().tolist()

if __name__ == "__main__":
    counts = [300, 400, 500]
    wanted = [flipped(count) for count in counts]
    for way in multiprocessing.get_all_start_methods():
        if way in ("fork", "spawn"):
            with multiprocessing.get_context(way).Pool(2) as pool:
                assert pool.map(flipped, counts) == wanted, way
    print(min(flips for flips, _ in wanted) > 0)
"""


def has_locks():
    """Whether processes can have locks in common, for which there must be shared memory."""
    try:
        multiprocessing.get_context("spawn").Lock()
    except (ImportError, OSError):
        return False
    return True


@pytest.mark.heavy
@pytest.mark.slow
@pytest.mark.skipif(not has_locks(), reason="no locks for several processes")
def test_processes_that_were_forked_or_spawned_find_the_same(tmp_path, request):
    script = tmp_path / "script.py"
    script.write_text(f"import sys\nsys.path.insert(0, {str(request.config.rootpath)!r})\n{SCRIPT}")
    done = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, check=False, timeout=300
    )
    assert done.stdout == "True\n", done.stderr


def test_threads_find_the_same():
    models = [meshes.bumpy_sphere(count) for count in (60, 80, 100, 120)]
    wanted = [optimize_flips(*model).faces for model in models]
    found = {}

    def run(number):
        found[number] = optimize_flips(*models[number]).faces

    threads = [threading.Thread(target=run, args=(number,)) for number in range(len(models))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for number, faces in enumerate(wanted):
        np.testing.assert_array_equal(found[number], faces)
