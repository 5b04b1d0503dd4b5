"""Kernels, warm: connectivity, measures, and each energy and search.

pip install '.[bench]'
python -m pytest -o python_files='bench_*.py' benchmarks
"""

import pytest

from benchmarks import surfaces
from meshlab_willmore import measure, optimize_flips
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.validate import check_mesh, to_unit_scale
from meshlab_willmore.options import ENERGY, SEARCH

FACES = 20_000
ROUNDS = 5
# Slow ones get a smaller mesh.
SEARCH_FACES = 2_000
SWEEPS = 10

pytestmark = pytest.mark.timeout(0)


@pytest.fixture(scope="module")
def surface():
    return surfaces.sheared_torus(FACES)


@pytest.fixture(scope="module")
def small_surface():
    return surfaces.sheared_torus(SEARCH_FACES)


def warm(benchmark, function, *arguments, **given):
    return benchmark.pedantic(
        function, args=arguments, kwargs=given, rounds=ROUNDS, iterations=1, warmup_rounds=1
    )


def test_checking(benchmark, surface):
    warm(benchmark, check_mesh, *surface)


def test_scaling_to_unit_size(benchmark, surface):
    warm(benchmark, to_unit_scale, *surface)


def test_building_connectivity(benchmark, surface):
    mesh = warm(benchmark, build, *surface)
    assert len(mesh.origin) == 3 * len(surface[1])


@pytest.mark.parametrize("name", ["measures", "vertex_willmore_energy", "self_intersections"])
def test_measuring(benchmark, surface, name):
    warm(benchmark, getattr(measure, name), *surface)


@pytest.mark.parametrize("energy", ENERGY.choices)
def test_energies(benchmark, surface, energy):
    assert warm(benchmark, optimize_flips, *surface, energy=energy).flips


@pytest.mark.parametrize("search", SEARCH.choices)
def test_searches(benchmark, small_surface, search):
    given = {"energy": "willmore", "search": search, "sweeps": SWEEPS}
    assert warm(benchmark, optimize_flips, *small_surface, **given).flips


def test_guard_against_self_intersections(benchmark, surface):
    assert warm(benchmark, optimize_flips, *surface, checkintersections=True).flips
