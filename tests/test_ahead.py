"""The second process that compiles for the first default run."""

import os
import subprocess
import sys

import numpy as np
import pytest
from numba import config
from numba.core.caching import NullCache

from meshlab_willmore import ahead, optimize_flips
from meshlab_willmore.mesh import compiling
from meshlab_willmore.mesh.jit import jit
from meshlab_willmore.mesh.kernel_cache import KernelCache
from tests import meshes

FIRST_RUN = """
import warnings
from meshlab_willmore import optimize_flips
from meshlab_willmore.mesh import compiling
from tests import meshes

warnings.simplefilter("error")
with compiling.counted() as compiled:
    result = optimize_flips(*meshes.torus(100, 0.3, 8))
print(result.flips, *sorted(kernel.name.split(".")[-1] for kernel in compiled))
"""
KERNELS = ahead.KERNELS
NAMES = {kernel.__name__ for kernel in KERNELS}


class Started:
    """Stands for a process that runs until it is asked for the second time."""

    def __init__(self, command, **_):
        self.command, self.polls = command, 0

    def poll(self):
        self.polls += 1
        return 0 if self.polls > 1 else None


@pytest.fixture
def cold(monkeypatch, tmp_path):
    """A process in which nothing is compiled; return the list of the processes that it starts."""
    started = []

    def popen(command, **given):
        started.append(Started(command, **given))
        return started[-1]

    kernels = [jit(kernel.py_func) for kernel in ahead.KERNELS]
    monkeypatch.setattr(ahead, "KERNELS", kernels)
    monkeypatch.setattr(KernelCache, "is_empty", lambda cache: True)
    monkeypatch.setattr(ahead, "_is_wanted", True)
    monkeypatch.setattr(ahead, "thread_count", lambda: 2)
    monkeypatch.setattr(ahead.subprocess, "Popen", popen)
    monkeypatch.setattr(ahead.atexit, "register", lambda *_: None)
    return started


@pytest.mark.heavy
def test_it_compiles_what_the_default_run_needs():
    optimize_flips(*meshes.torus(100, 0.3, 8))
    before = [len(kernel.signatures) for kernel in ahead.KERNELS]
    assert min(before) > 0
    with compiling.forbidden():
        ahead.compile_kernels()
    assert [len(kernel.signatures) for kernel in ahead.KERNELS] == before


@pytest.mark.heavy
def test_it_is_started_once_with_the_path_of_this_process(cold):
    ahead.start()
    ahead.start()
    (process,) = cold
    assert process.command[:2] == [sys.executable, "-c"]
    assert repr(sys.path) in process.command[2]
    compile(process.command[2], "command", "exec")
    assert process.command[2].endswith(f" ahead.{ahead.compile_kernels.__name__}()")
    for kernel in ahead.KERNELS:
        kernel._cache.wait()
    assert process.polls == 2 + len(ahead.KERNELS) - 1


@pytest.mark.heavy
@pytest.mark.parametrize("what", ["kept", "one core", "no Python", "no cache", "compiled"])
def test_it_is_not_started_in_vain(cold, monkeypatch, what):
    if what == "kept":
        monkeypatch.setattr(KernelCache, "is_empty", lambda cache: False)
    elif what == "one core":
        monkeypatch.setattr(ahead, "thread_count", lambda: 1)
    elif what == "no Python":
        monkeypatch.setattr(sys, "executable", "/usr/bin/blender")
    elif what == "no cache":
        ahead.KERNELS[0]._cache = NullCache()
    else:
        with ahead.prevented():
            optimize_flips(*meshes.torus(100, 0.3, 8))
        monkeypatch.setattr(ahead, "KERNELS", KERNELS)
    ahead.start()
    assert not cold


@pytest.mark.heavy
def test_it_is_not_started_where_that_is_prevented_nor_for_other_searches(cold):
    with ahead.prevented():
        ahead.start()
    vertices, faces = meshes.torus(60, 0.3, 8)
    optimize_flips(vertices, faces, search="greedy")
    optimize_flips(vertices, faces, checkintersections=True)
    assert not cold
    optimize_flips(vertices, faces)
    assert len(cold) == 1


@pytest.mark.heavy
def test_a_system_without_processes_compiles_here(cold, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError("no processes here")

    monkeypatch.setattr(ahead.subprocess, "Popen", refuse)
    ahead.start()
    assert not any(kernel._cache.wait for kernel in ahead.KERNELS)


@pytest.mark.heavy
def test_a_kernel_is_waited_for_once_and_only_if_it_is_missing(tmp_path, monkeypatch):
    def double(value):
        return 2.0 * value

    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))
    kernel, waits = jit(double), []
    kernel._cache.wait = lambda: waits.append("waited")
    assert kernel(2.0) == 4.0
    assert kernel(np.float32(2.0)) == 4.0
    assert waits == ["waited"]
    again = jit(double)
    again._cache.wait = lambda: waits.append("in vain")
    assert again(2.0) == 4.0
    assert "in vain" not in waits


@pytest.mark.nightly
def test_a_first_run_leaves_half_to_the_second_process(tmp_path):
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_NUM_THREADS": "2"}
    command = [sys.executable, "-c", FIRST_RUN]
    first, second = (
        subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        for _ in range(2)
    )
    flips, *compiled = first.stdout.split()
    assert not NAMES & set(compiled)
    assert "_add_up" in compiled
    assert second.stdout.split() == [flips]
    assert not first.stderr
