"""The tools that the study of faithful flips compares: our presets and settings, and others' flips.

A tool takes vertices and faces, and returns the faces of the same vertices after its flips, and how
many seconds it took, without compilation and without the exchange of the mesh.
"""

import functools
import importlib.util
import multiprocessing
import time
from collections.abc import Callable
from typing import NamedTuple

import pymeshlab

from meshlab_willmore import optimize_flips
from meshlab_willmore.compare.rows import CURVATURE, PEERS, PLANAR
from meshlab_willmore.energy.table import ENERGIES
from meshlab_willmore.presets import PRESETS
from studies.fidelity import diagonal
from studies.parts import arrays_of
from tests import meshes

QUICK = ("parallel greedy",)
SEARCHES = ("parallel greedy", "greedy", "variable depth", "annealing", "thorough")
# Of MeshLib, as parts of the diagonal, and iterations: more than it takes.
DEVIATIONS = (1e-3, 1e-2)
MESHLIB_ITERATIONS = 100


class Tool(NamedTuple):
    """A way to flip edges; `run` returns None where it takes too long, fails, or loses faces."""

    name: str
    run: Callable


def all_tools(searches=QUICK, limit=60.0):
    """Our presets, our energies with each search, and others' flips where they are installed."""
    yield from presets()
    yield from settings(searches)
    for row in PEERS:
        if row.filter == CURVATURE:
            yield Tool(row.name, functools.partial(flipped_by_curvature, limit, row.given))
        else:
            yield Tool(row.name, functools.partial(_filtered, PLANAR, row.given))
    if importlib.util.find_spec("meshlib") is not None:
        for share in DEVIATIONS:
            name = f"MeshLib Delaunay within {100 * share:g} %"
            yield Tool(name, functools.partial(_flipped_by_meshlib, share))


def presets():
    for name in PRESETS:
        yield Tool(f"**{name}**", functools.partial(_flipped, {"preset": name}))


def settings(searches):
    for search in searches:
        for energy in ENERGIES:
            given = {"energy": energy, "search": search}
            name = energy if search == QUICK[0] else f"{energy}, {search}"
            yield Tool(name, functools.partial(_flipped, given))


def _flipped(given, vertices, faces):
    _compile(*given.items())
    start = time.perf_counter()
    result = optimize_flips(vertices, faces, **given)
    return result.faces, time.perf_counter() - start


@functools.cache
def _compile(*given):
    optimize_flips(*meshes.cube(), **dict(given))


def _filtered(name, given, vertices, faces):
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(vertices, faces))
    start = time.perf_counter()
    try:
        ms.apply_filter(name, **given)
    except pymeshlab.PyMeshLabException:
        # They refuse meshes that are not manifold.
        return None
    seconds = time.perf_counter() - start
    return arrays_of(ms)[1], seconds


def flipped_by_curvature(limit, given, vertices, faces):
    """MeshLab's curvature flip, which need not end, in a process that is killed then."""
    context = multiprocessing.get_context("spawn")
    mine, its = context.Pipe(duplex=False)
    process = context.Process(target=_send, args=(its, given, vertices, faces), daemon=True)
    process.start()
    its.close()
    try:
        # The first word comes when the child has been started.
        mine.recv()
        return mine.recv() if mine.poll(limit) else None
    except EOFError:
        return None
    finally:
        process.kill()
        process.join()


def _send(pipe, given, vertices, faces):
    pipe.send("ready")
    pipe.send(_filtered(CURVATURE, given, vertices, faces))


def _flipped_by_meshlib(share, vertices, faces):
    # Optional, and slow to import.
    from meshlib import mrmeshnumpy, mrmeshpy

    mesh = mrmeshnumpy.meshFromFacesVerts(faces, vertices)
    chosen = mrmeshpy.DeloneSettings()
    chosen.maxDeviationAfterFlip = share * diagonal(vertices)
    start = time.perf_counter()
    mrmeshpy.makeDeloneEdgeFlips(mesh, chosen, MESHLIB_ITERATIONS)
    seconds = time.perf_counter() - start
    flipped = mrmeshnumpy.getNumpyFaces(mesh.topology)
    # It leaves out faces at non-manifold edges.
    return (flipped, seconds) if flipped.shape == faces.shape else None
