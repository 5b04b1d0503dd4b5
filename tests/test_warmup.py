"""Warmup compiles everything in advance."""

import inspect
import subprocess
import sys
from pathlib import Path

import numba
import pytest
from numba import njit

from meshlab_willmore import warmup
from meshlab_willmore.cli import doctor
from meshlab_willmore.optimize import optimize_flips
from meshlab_willmore.options import ENERGY, SEARCH, VIRTUALPOINT

ROOT = Path(__file__).parents[1]
# All that a process has to compile, on a slow machine.
LONG = 1200
WARM = """
from meshlab_willmore import warmup
if __name__ == "__main__":
    warmup.warm_up(print, 2)
"""
MISSING = """
from meshlab_willmore import warmup
print(warmup.missing())
"""
USED = """
from tests.kernels_in_use import called_from_python
kernels = called_from_python()
assert len(kernels) > 40, len(kernels)
unused = sorted(name for name, kernel in kernels.items() if not kernel.signatures)
assert unused == [], unused

import numpy as np, pymeshlab, meshlab_willmore
from meshlab_willmore import measure, optimize_flips
from meshlab_willmore.compare.quality import quality_of
from meshlab_willmore.mesh import compiling
from tests import meshes
FLIP = "meshing_edge_flip_by_willmore_optimization"
with compiling.forbidden():
    for options in (
        {}, {"featuredeg": 30}, {"selection": False}, {"energy": "area", "search": "thorough"},
        {"virtualpoint": "0.1", "search": "variable depth"}, {"checkintersections": True},
        {"monotone": False, "foldangle": 180, "minshape": 0}, {"search": "annealing", "sweeps": 3},
    ):
        ms = pymeshlab.MeshSet()
        ms.create_cube()
        ms.meshing_poly_to_tri()
        ms.meshing_surface_subdivision_midpoint(threshold=pymeshlab.PercentageValue(0))
        ms.apply_coord_two_steps_smoothing()
        ms.compute_selection_by_condition_per_face(condselect="x0 < 0.2")
        ms.compute_texcoord_parametrization_triangle_trivial_per_wedge()
        ms.apply_filter(FLIP, **options)
        ms.get_willmore_measures()
        ms.compute_scalar_by_willmore_energy_per_vertex()
    vertices, faces = meshes.moebius_band()
    shared = np.asfortranarray(vertices, np.float32)
    shared.flags.writeable = False
    optimize_flips(shared, faces.astype(np.uint16), locked_edges=np.asfortranarray(faces[:5, :2]))
    optimize_flips(shared, faces, wedge_uv=np.asfortranarray(shared[faces])[:, :, 1:])
    optimize_flips(np.zeros((0, 3)), np.zeros((0, 3), int))
    measure.self_intersections(vertices, np.asfortranarray(faces))
    quality_of(ms, ms.current_mesh().face_matrix(), None)
"""


def printed(program):
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


@pytest.mark.heavy
@pytest.mark.timeout(LONG)
@pytest.mark.slow
def test_after_it_no_process_compiles_anything():
    finding = doctor.cache()
    assert finding.ok, finding
    if not finding.text.endswith("(everything is compiled)"):
        printed(WARM)
    assert printed(MISSING + USED) == ["[]"]


def test_without_locks_for_processes_one_does(monkeypatch):
    def denied(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(warmup, "ProcessPoolExecutor", denied)
    monkeypatch.setattr(warmup, "cache_folder", lambda: "/the/folder")
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 0)
    ran = []
    monkeypatch.setattr(warmup, "steps", lambda: [warmup.WarmupStep("one", lambda: ran.append(1))])
    assert warmup.warm_up(print, 2).compiled == 0
    assert ran == [1]


def test_every_search_of_every_energy_is_a_step_with_the_default_first():
    names = [step.name for step in warmup.steps()]
    given = inspect.signature(optimize_flips).parameters
    assert names[0] == f"{given['search'].default}, {given['energy'].default}"
    assert len(set(names)) == len(names)
    for search in SEARCH.choices:
        assert {f"{search}, {energy}" for energy in ENERGY.choices} < set(names)
        assert {f"{search}, virtual points {place}" for place in VIRTUALPOINT.choices} < set(names)
        assert f"{search}, normals of vertices" in names


def test_the_mesh_has_flips_to_make():
    assert warmup.steps()[0].run().flips > 0


@pytest.mark.heavy
def test_what_would_be_compiled_is_named(monkeypatch):
    def kernel(x):
        return x

    kernel.__module__ = "meshlab_willmore.of_a_test"
    compiled = njit(kernel)
    monkeypatch.setattr(
        warmup,
        "steps",
        lambda: [
            warmup.WarmupStep("new", lambda: compiled(1)),
            warmup.WarmupStep("none", lambda: None),
        ],
    )
    assert warmup.missing() == ["new"]
    assert not compiled.signatures
    lines = []
    done = warmup.warm_up(lines.append)
    assert (done.compiled, len(lines)) == (1, 1)
    assert lines[0].startswith("new: compiled in ")
    assert 0.0 < done.compiling_seconds <= done.seconds
    assert warmup.missing() == []
    assert warmup.warm_up(lines.append).compiled == 0
    assert len(lines) == 1


def test_without_a_compiler_or_a_cache_there_is_an_error(monkeypatch):
    monkeypatch.setattr(warmup, "steps", list)
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    with pytest.raises(RuntimeError, match="NUMBA_DISABLE_JIT is set"):
        warmup.warm_up(print)
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 0)
    monkeypatch.setattr(warmup, "cache_folder", lambda: None)
    with pytest.raises(RuntimeError, match="set NUMBA_CACHE_DIR"):
        warmup.warm_up(print)


def test_the_error_on_a_full_disk_names_the_folder(monkeypatch):
    def fail():
        warmup.write_errors.append(OSError(28, "No space left on device"))

    monkeypatch.setattr(numba.config, "DISABLE_JIT", 0)
    monkeypatch.setattr(warmup, "cache_folder", lambda: "/the/folder")
    monkeypatch.setattr(warmup, "steps", lambda: [warmup.WarmupStep("one", fail)])
    with pytest.raises(OSError, match="can't be written in /the/folder: .*No space left"):
        warmup.warm_up(print)
