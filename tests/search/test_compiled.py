"""What the searches know of each energy, and the copies of what is compiled for each."""

import ast
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from meshlab_willmore.energy import area, virtual, willmore
from meshlab_willmore.energy.table import AT, ENERGIES, VIRTUAL_POINTS
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import is_free
from meshlab_willmore.search import annealing, costs, scoring
from meshlab_willmore.search.compiled import KERNELS, PLACED_KERNELS, TILT_KERNELS, compiled
from meshlab_willmore.search.copies import with_globals
from tests import meshes

ROOT = Path(__file__).parents[2]
SCRIPT = """
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.search import greedy, parallel_greedy
from meshlab_willmore.search.compiled import KERNELS
from tests import meshes
from tests.search.ways import rules_for
found = []
for energy in ("willmore", "area", "delaunay"):
    for search, kernel in (greedy, greedy.advance), (parallel_greedy, KERNELS[energy].score):
        mesh = build(*meshes.bumpy_sphere(60, bump=0.6))
        search.run(KERNELS[energy], mesh, rules_for(energy))
        misses = kernel.stats.cache_misses
        found.append((sum(misses.values()), faces_of(mesh).tolist()))
print(found)
"""


def test_each_energy_has_a_set_of_kernels():
    assert list(KERNELS) == list(ENERGIES)
    assert list(PLACED_KERNELS) == [*VIRTUAL_POINTS, AT]
    assert KERNELS["virtual willmore"] is PLACED_KERNELS["midpoint"]
    assert KERNELS["willmore"].judges
    # What the Willmore energy judges is compiled once.
    for kernels in PLACED_KERNELS.values():
        assert not kernels.judges
        assert kernels.anneal is KERNELS["willmore"].anneal
        assert kernels.losses is KERNELS["willmore"].losses
        assert kernels.total is willmore.total


def test_the_number_of_an_energy_is_its_own():
    rows = [*KERNELS.values(), *PLACED_KERNELS.values(), TILT_KERNELS]
    numbers = [each.number for each in rows]
    assert len(set(numbers)) == len(costs.MODULES) == len(rows) - 1
    vertices, faces = meshes.bumpy_sphere(30, bump=0.6)
    mesh, place = build(np.hstack([vertices, vertices]), faces), 0.3
    edges = np.array([h for h in range(len(mesh.origin)) if is_free(mesh, h)], np.int32)
    gains, seen = np.full(len(edges), 7.0), []
    for kernels in rows:
        function = kernels.energy.cost_reduction
        wanted = [costs.gain_of(function, mesh, h, place) for h in edges.tolist()]
        costs.find_gains(kernels.number, mesh, edges, len(edges) - 1, place, gains)
        np.testing.assert_array_equal(gains[:-1], wanted[:-1])
        assert gains[-1] == 7.0
        seen.append(tuple(gains))
    assert len(set(seen)) == len(costs.MODULES)


def test_a_copy_has_a_name_and_globals_of_its_own():
    copies = [
        with_globals(annealing.anneal, f"of_{e.__name__}", {"energy": e}) for e in (area, virtual)
    ]
    assert [copy.__globals__["energy"] for copy in copies] == [area, virtual]
    assert annealing.energy is willmore
    assert all(copy.__code__ is annealing.anneal.__code__ for copy in copies)
    kernel = compiled(scoring.score_each, virtual, willmore)
    assert kernel is compiled(scoring.score_each, virtual, willmore)
    function = getattr(kernel, "py_func", kernel)
    assert function.__qualname__ == "score_each_virtual_willmore"


@pytest.mark.heavy
@pytest.mark.slow
def test_a_second_process_finds_each_copy_and_no_other():
    command = [sys.executable, "-W", "error", "-c", SCRIPT]
    first, second = (
        ast.literal_eval(subprocess.check_output(command, text=True, cwd=ROOT)) for _ in range(2)
    )
    assert [misses for misses, _ in second] == [0] * 6
    faces = [found for _, found in first]
    assert faces == [found for _, found in second]
    for some in (faces[::2], faces[1::2]):
        assert some[0] != some[1] != some[2] != some[0]
