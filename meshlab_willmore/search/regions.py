"""Parts of a large mesh on which a search works side by side.

    split the faces into compact parts
    freeze the faces at vertices where parts meet: lock all their edges
    let the search work on each part as a mesh of its own, all parts at the same time
    put the parts together again

A search reads the faces at the corners of what it flips, and flips no edge of a frozen face. So no
edge that may be flipped has a corner where parts meet, whatever is flipped inside: all faces that
the search may look at are of its own part, and they are the same as in the whole mesh. What it
finds in a part does not depend on what happens elsewhere, nor on the number of threads, but it
stops in front of frozen faces: what may change around them is left to do in the whole mesh.
"""

from typing import NamedTuple

import numpy as np

from ..mesh.build import build, faces_of
from ..mesh.halfedge import NONE, Mesh
from ..mesh.parallel import thread_pool
from ..progress import report, stage
from .rules import CONVERGED, Progress

# Parts have at least so many faces. Smaller ones would be frozen for a good deal.
LEAST_FACES = 16384


class Region(NamedTuple):
    """A part of a mesh, as a mesh of its own.

    Attributes
    ----------
    mesh : Mesh
        Of k faces. Its corners are those of the whole mesh.
    faces : (k,) int64
        Numbers of the faces in the whole mesh, ascending.
    vertices : (n,) int64
        Numbers of the vertices in the whole mesh, ascending.
    frozen : (k,) bool
        Faces that stay.
    """

    mesh: Mesh
    faces: np.ndarray
    vertices: np.ndarray
    frozen: np.ndarray


class _Searches(NamedTuple):
    """What is to be done: the search, its regions, what it returned, and whether to stop.

    `begun` has the places of the regions that were taken, in their order.
    """

    search: object
    regions: list
    begun: list
    found: list
    halted: list


def is_large(mesh):
    """Whether it pays to split a mesh."""
    return len(mesh.origin) // 3 >= 2 * LEAST_FACES


def run(search, mesh, threads=None):
    """Let a search work on parts of `mesh`, in place.

    Parameters
    ----------
    search : callable
        Takes the mesh of a part, which it changes in place, and a list; returns its Progress. Once
        there is something in the list, it should end soon.
    mesh : Mesh
    threads : int, optional
        As for `meshlab_willmore.mesh.parallel.thread_pool`. The result does not depend on it.

    Returns
    -------
    progress : Progress
        The sums of all parts.
    frozen : (n,) bool
        The vertices of the faces that had to stay.
    """
    parts = _split(mesh)
    is_common = _common_vertices(mesh, parts)
    regions = [_region(mesh, part, is_common) for part in parts]
    work = _Searches(search, regions, [], [None] * len(parts), [])
    with thread_pool(threads) as parallel_for:
        try:
            parallel_for(_search, work, len(parts), chunk=1)
        except BaseException:
            work.halted.append(True)
            raise
    _put_together(mesh, regions)
    frozen = np.zeros(len(mesh.vertices), np.bool_)
    for region in regions:
        frozen[region.vertices[faces_of(region.mesh)[region.frozen]]] = True
    flips, gain = sum(p.flips for p in work.found), sum(p.gain for p in work.found)
    return Progress(len(mesh.origin), flips, gain, CONVERGED), frozen


def _search(work, start, stop):
    try:
        for place in range(start, stop):
            work.begun.append(place)
            count, done = len(work.regions), sum(one is not None for one in work.found)
            report(done / count, f"{done} of {count} parts")
            # The other threads go on meanwhile with what they have begun.
            part = (len(work.begun) - done) / (count - done)
            with stage(part, f"part {place + 1} of {count}"):
                work.found[place] = work.search(work.regions[place].mesh, work.halted)
    except BaseException:
        work.halted.append(True)
        raise


def _split(mesh):
    """Return the faces of each part: halves along the longest side, halves of these, and so on."""
    middles = mesh.vertices[:, :3][faces_of(mesh)].mean(axis=1)
    parts = [np.arange(len(middles))]
    while len(middles) // (2 * len(parts)) >= LEAST_FACES:
        parts = [half for part in parts for half in _halves(part, middles[part])]
    return [np.sort(part) for part in parts]


def _halves(part, middles):
    axis = np.argmax(np.ptp(middles, axis=0))
    place = len(part) // 2
    order = np.argpartition(middles[:, axis], place)
    return part[order[:place]], part[order[place:]]


def _common_vertices(mesh, parts):
    """Return the mask of the vertices with faces of several parts."""
    owner = np.empty(len(mesh.origin) // 3, np.int32)
    for number, part in enumerate(parts):
        owner[part] = number
    owner = np.repeat(owner, 3)
    last, is_common = np.empty(len(mesh.vertices), np.int32), np.zeros(len(mesh.vertices), np.bool_)
    last[mesh.origin] = owner
    is_common[mesh.origin[last[mesh.origin] != owner]] = True
    return is_common


def _region(mesh, part, is_common):
    faces = faces_of(mesh)[part]
    vertices, local = np.unique(faces, return_inverse=True)
    local = local.reshape(-1, 3).astype(np.int32)
    half_edges = _half_edges(part)
    own = build(mesh.vertices[vertices], local)
    own = own._replace(
        corner=mesh.corner[half_edges],
        locked=mesh.locked[half_edges],
        uv=mesh.uv,
        deviation=mesh.deviation[part],
    )
    frozen = is_common[faces].any(axis=1)
    kept = np.flatnonzero(np.repeat(frozen, 3))
    own.locked[kept] = True
    twins = own.twin[kept]
    own.locked[twins[twins != NONE]] = True
    return Region(own, part, vertices, frozen)


def _half_edges(faces):
    """Return the half-edges of faces, in order."""
    return (3 * faces[:, None] + np.arange(3)).ravel()


def _put_together(mesh, regions):
    """Bring `mesh`, in place, to what its regions have become."""
    frozen = np.zeros(len(mesh.origin), np.bool_)
    locked = mesh.locked.copy()
    for region in regions:
        half_edges = _half_edges(region.faces)
        mesh.origin[half_edges] = region.vertices[region.mesh.origin]
        mesh.corner[half_edges] = region.mesh.corner
        mesh.locked[half_edges] = region.mesh.locked
        mesh.deviation[region.faces] = region.mesh.deviation
        frozen[half_edges] = np.repeat(region.frozen, 3)
    mesh.twin[:] = build(mesh.vertices, faces_of(mesh)).twin
    # Frozen edges are locked only if they were before, and have not moved on the frozen side.
    kept = np.flatnonzero(frozen)
    mesh.locked[kept] = locked[kept]
    paired = kept[mesh.twin[kept] != NONE]
    mesh.locked[mesh.twin[paired]] = locked[paired]
