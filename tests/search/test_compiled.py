"""The copies of the searches: one for each energy, distinguished by the cache of kernels."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from meshlab_willmore.energy import area, virtual, virtual_at, willmore
from meshlab_willmore.energy.table import AT, ENERGIES, VIRTUAL_POINTS
from meshlab_willmore.search import compiled, greedy
from meshlab_willmore.search.compiled import KERNELS, PLACED_KERNELS

ROOT = Path(__file__).parents[2]
SCRIPT = """
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.search import greedy
from meshlab_willmore.search.compiled import KERNELS
from tests import meshes
from tests.search.ways import rules_for
found = []
for energy in ("willmore", "area", "delaunay"):
    mesh, kernels = build(*meshes.bumpy_sphere(60, bump=0.6)), KERNELS[energy]
    greedy.run(kernels, mesh, rules_for(energy))
    misses = kernels.greedy.stats.cache_misses
    found.append((sum(misses.values()), faces_of(mesh).tolist()))
print(found)
"""


def test_each_energy_has_a_set_of_kernels():
    assert list(KERNELS) == list(ENERGIES)
    assert list(PLACED_KERNELS) == [*VIRTUAL_POINTS, AT]
    assert KERNELS["virtual willmore"] is PLACED_KERNELS["midpoint"]
    assert PLACED_KERNELS[AT].energy is virtual_at
    # What the Willmore energy judges is compiled once.
    for kernels in PLACED_KERNELS.values():
        assert kernels.anneal is KERNELS["willmore"].anneal
        assert kernels.losses is KERNELS["willmore"].losses
        assert kernels.total is willmore.total


def test_a_copy_has_a_name_and_globals_of_its_own():
    copies = [compiled.specialised(greedy.advance, energy) for energy in (area, virtual)]
    assert [copy.__qualname__ for copy in copies] == ["advance_area", "advance_virtual"]
    assert [copy.__globals__["energy"] for copy in copies] == [area, virtual]
    judged = compiled.specialised(greedy.advance, virtual, willmore)
    assert judged.__qualname__ == "advance_virtual_willmore"
    assert greedy.energy is willmore
    assert all(copy.__code__ is greedy.advance.__code__ for copy in copies)


@pytest.mark.heavy
@pytest.mark.slow
def test_a_second_process_finds_each_copy_and_no_other():
    command = [sys.executable, "-W", "error", "-c", SCRIPT]
    first, second = (
        ast.literal_eval(subprocess.check_output(command, text=True, cwd=ROOT)) for _ in range(2)
    )
    assert [misses for misses, _ in second] == [0, 0, 0]
    faces = [found for _, found in first]
    assert faces == [found for _, found in second]
    assert faces[0] != faces[1] != faces[2] != faces[0]
