"""Ctrl-C at any moment."""

import contextlib
import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.meshset import interrupts, layers, native
from tests import meshes
from tests.meshset.conftest import FLIP, random_transform


@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
def test_an_interrupt_waits_until_the_set_is_whole(bumpy):
    order = []

    def load(target):
        os.kill(os.getpid(), signal.SIGINT)
        target.add_mesh(pymeshlab.Mesh(*meshes.octahedron()))
        order.append("loaded")

    who = layers.identity_of(bumpy.current_mesh())
    with pytest.raises(KeyboardInterrupt):
        layers.replace_current(bumpy, load, load, who)
    assert order == ["loaded"]
    assert bumpy.current_mesh().face_number() == 8
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_interrupt_that_is_swallowed_on_the_way_is_not_lost():
    def swallow():
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)

    def stumble():
        swallow()
        raise ValueError("a consequence")

    with pytest.raises(KeyboardInterrupt), interrupts.preserved():
        swallow()
    with pytest.raises(KeyboardInterrupt), interrupts.preserved():
        stumble()
    with pytest.raises(ValueError, match="of its own"), interrupts.preserved():
        raise ValueError("of its own")
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_ignored_interrupt_stays_ignored():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        for context in (interrupts.preserved, interrupts.deferred):
            with context():
                signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_thread_that_is_not_the_main_one_can_flip(bumpy):
    results = []
    thread = threading.Thread(target=lambda: results.append(bumpy.apply_filter(FLIP)))
    thread.start()
    thread.join()
    assert results[0]["flips"] > 0


def test_an_interrupted_scalar_filter_keeps_the_transform(bumpy, monkeypatch):
    bumpy.set_matrix(transformmatrix=random_transform(), freeze=False)
    apply = native._own.apply_filter

    def interrupted(ms, name, **given):
        if name == "set_matrix_identity":
            signal.raise_signal(signal.SIGINT)
        return apply(ms, name, **given)

    monkeypatch.setattr(native._own, "apply_filter", interrupted)
    with pytest.raises(KeyboardInterrupt):
        bumpy.compute_scalar_by_willmore_energy_per_vertex()
    np.testing.assert_array_equal(bumpy.current_mesh().transform_matrix(), random_transform())
    assert native.ids(bumpy) == [0]


INTERRUPTED = """
import os, signal, sys, threading, time
import numpy as np, pymeshlab, meshlab_willmore
sys.path.insert(0, sys.argv[1])
from meshlab_willmore.mesh.parallel import CHUNK
from meshlab_willmore.search import parallel_greedy
from tests import meshes
# Of the annealing, far more than anyone would wait for.
options = {"search": sys.argv[2], "energy": "willmore", "sweeps": 10**6}
ms = pymeshlab.MeshSet()
ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(200)))
ms.meshing_edge_flip_by_willmore_optimization(**options | {"sweeps": 1})
ms.clear()
is_timed = sys.argv[2] == "annealing"
vertices, faces = meshes.torus(5_000 if is_timed else 50_000, None, 1)
ms.add_mesh(pymeshlab.Mesh(vertices, faces))
sent = []
def interrupt():
    sent.append(time.perf_counter())
    os.kill(os.getpid(), signal.SIGINT)
if is_timed:
    threading.Timer(1.0, interrupt).start()
else:
    # In the middle of the first round, on one thread or another.
    find_maxima = parallel_greedy.find_maxima
    def interrupted(candidates, start, stop):
        if start == 3 * CHUNK and not sent:
            interrupt()
        find_maxima(candidates, start, stop)
    parallel_greedy.find_maxima = interrupted
try:
    ms.meshing_edge_flip_by_willmore_optimization(**options)
    print("done")
except KeyboardInterrupt:
    late = time.perf_counter() - sent[0]
    same = np.array_equal(ms.current_mesh().face_matrix(), faces)
    print("interrupted", late < 1.0, same, len(ms), ms.current_mesh_id(), late)
"""


@pytest.mark.heavy
@pytest.mark.skipif(os.name == "nt", reason="no signals to send")
@pytest.mark.parametrize("search", ["parallel greedy", "annealing"])
@pytest.mark.slow
def test_ctrl_c_stops_a_long_run_and_changes_nothing(search, request):
    root = str(request.config.rootpath)
    run = subprocess.run(
        [sys.executable, "-c", INTERRUPTED, root, search],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert run.stdout.startswith("interrupted True True 1 0"), run.stdout + run.stderr
