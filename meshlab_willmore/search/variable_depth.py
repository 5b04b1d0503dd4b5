"""The variable-depth search: chains of flips that may go through a loss.

    descend greedily
    put every edge into a queue
    while the queue is not empty:
        take an edge and flip it, even at a loss
        up to the depth: flip the best edge next to the last flip that the chain has not made itself
        where chains may branch, try the second best and so on as well, until one chain helps
        keep the best prefix if it lowers the energy, and put the edges around it into the queue
        undo the rest
    repeat with the edges that could have seen a change, until no chain helps
    descend greedily again, as flips that lower another energy than chains may be left; go on there
    where another energy still would flip edges, go one flip deeper; repeat if that helped

It is the scheme of S. Lin and B. W. Kernighan ("An effective heuristic algorithm for the
traveling-salesman problem", 1973, DOI 10.1287/opre.21.2.498), with their breadth at the first
steps, applied to flips: the several flips at a time that the paper names as the way out of local
minima ("Mesh optimisation based on Willmore energy", section 5).

Every flip of a chain has to be allowed when it is made. Two functions guide the search: one *ranks*
the edges from which a chain may go on, the other one *judges* the chain and must be the difference
of a potential, so that the cost reductions of a chain add up to the drop of an energy. Each chain
that is kept lowers that energy by more than a tolerance: the search ends. For most energies both
are the same. The virtual Willmore energy has no potential; chains ranked by it are judged by the
Willmore energy.

**What a chain sees.** A chain of D flips that starts at the edge i-j reads the mesh at vertices at
most D edges away from i or j. (The quad around an edge, and the corners of the faces outside, are
neighbours of i or j; one flip leads to edges between these. That an edge exists is known at both of
its ends. An energy that looks further, `Rules.is_wide`, reads one ring more.) So when all edges
were tried, and then those within D edges of a change, over and over until nothing changes, no chain
is left. That takes O(n) time for each round of n edges. Only the guard against self-intersections
looks farther. Starts from which it has refused a flip are noted, and tried again in each round.

**Doubtful places.** What remains of a bad triangulation are a few tangles that no chain of D flips
undoes. They are seen by another energy: the harmonic index (`meshlab_willmore.energy.delaunay`),
which is least where triangles are good, would flip edges there. So chains from these edges, and
around them, may be one flip longer. There are few of them on smooth surfaces.
"""

import numpy as np

from .. import guards
from ..energy import delaunay
from ..guards.bvh import inactive_bvh, refit
from ..mesh.halfedge import apex, flip, is_free, makes_new_edge
from ..mesh.jit import generic, inner, jit
from ..mesh.notify import report
from . import greedy, regions
from .chains import Task, find_chain, no_chain, ring_around
from .greedy import SLICE
from .pending import append, nothing_pending, queue_all, queue_blocked, queue_near, take_first
from .rules import CONVERGED, NO_LIMIT, STOPPED, WORKING, Progress

# What the harmonic index must gain by a flip to cast doubt on a place.
DOUBT = 1e-7


@inner
def _keep(task, length):
    """Flip the edges of the best prefix for good, and queue all edges around."""
    mesh, chain = task.mesh, task.chain
    for s in range(length):
        h = chain.best[s]
        for around in (h, mesh.twin[h]):
            task.touched[mesh.origin[around]] = task.touched[apex(mesh, around)] = True
        flip(mesh, h)
        refit(mesh, task.space, h)
        # A later flip of the chain moves edges to other half-edges, but queues all these as well.
        append(mesh, task.pending, h)
        for place in range(ring_around(mesh, h, chain.ring)):
            append(mesh, task.pending, chain.ring[place])


@generic
def advance(task, progress, ranking, judge):
    """Go on with the search for about `SLICE` scored edges.

    Parameters
    ----------
    task : Task
        Changed in place.
    progress : Progress
        Where to go on.
    ranking, judge : callable
        Jitted functions of a mesh and a half-edge, see above; `ranking` as
        `meshlab_willmore.search.scoring.gain_of` takes it. A judge of None: `ranking` is also the
        judge.

    Returns
    -------
    tuple
        The fields of the new Progress; converged is the state once the queue is empty.
    """
    mesh, pending = task.mesh, task.pending
    scored, flips, gain, _ = progress
    work = 0
    while work < SLICE:
        if pending.ends[1] == 0:
            return scored, flips, gain, CONVERGED
        h = take_first(pending)
        # A flip has put another edge there, which waits under its own name.
        if mesh.twin[h] < h:
            continue
        task.refused[0] = False
        best, more = find_chain(task, h, ranking, judge)
        work += more
        if best.length == 0:
            task.blocked[h] = task.refused[0]
            continue
        if flips + best.length > task.rules.maxflips:
            return scored, flips, gain, STOPPED
        _keep(task, best.length)
        flips += best.length
        gain += best.gain
    return scored, flips, gain, WORKING


@jit
def _mark_doubtful(mesh, rules, doubtful):
    """Mark, in place, the vertices of the diamonds that the harmonic index would have flipped."""
    for h in range(len(mesh.origin)):
        if not (h < mesh.twin[h] and is_free(mesh, h)):
            continue
        if not delaunay.cost_reduction(mesh, h) > DOUBT:
            continue
        if not guards.folds(mesh, h, rules.fold) and makes_new_edge(mesh, h):
            for around in (h, np.int64(mesh.twin[h])):
                doubtful[mesh.origin[around]] = doubtful[apex(mesh, around)] = True


def _work_off(kernel, task, progress, halted):
    """Go on slice by slice until the queue is empty, the limit is reached, or all is halted."""
    progress = progress._replace(state=WORKING)
    while progress.state == WORKING and not halted:
        progress = Progress(*kernel(task, progress))
        report(f"chains, {progress.flips} flips, {task.pending.ends[1]} edges left")
    return progress


def run(kernel, descent, mesh, rules, reach, space=None, threads=None):
    """Flip edges of `mesh` in place until no allowed chain helps, or the limit is reached.

    Large meshes are searched in regions first, on all cores; not with the guard against
    self-intersections, which looks everywhere, or a limit.

    Parameters
    ----------
    kernel : callable
        `advance` for one energy, from `meshlab_willmore.search.entries`.
    descent : callable
        `meshlab_willmore.search.greedy.advance` for it, for the descent at the start.
    mesh : Mesh
    rules : Rules
        A chain that would exceed `maxflips` is not made. Under the monotone rule no chain as a
        whole raises the Willmore energy; its single flips may.
    reach : Reach
    space : Bvh, optional
        As for `meshlab_willmore.search.greedy.run`. It holds for each flip of a chain.
    threads : int, optional
        As many as Numba is set to if left out. The result does not depend on it.

    Returns
    -------
    Progress
        Its state is `CONVERGED` or `STOPPED`.
    """
    space = inactive_bvh() if space is None else space
    progress = greedy.run(descent, mesh, rules, space)
    if progress.state == STOPPED:
        return progress
    touched = None
    if regions.is_large(mesh) and not space.active and rules.maxflips == NO_LIMIT:

        def search(part, halted):
            begin = Progress(len(part.origin), 0, 0.0, WORKING)
            return _search(kernel, part, rules, reach, inactive_bvh(), begin, None, halted)

        found, touched = regions.run(search, mesh, threads)
        progress = _sum(progress, found)
    progress = _search(kernel, mesh, rules, reach, space, progress, touched, [])
    # For a potential, a flip that is left would have been a chain.
    while progress.state == CONVERGED and rules.monotone:
        before, flips = mesh.origin.copy(), progress.flips
        left = rules._replace(maxflips=rules.maxflips - flips)
        progress = _sum(progress, greedy.run(descent, mesh, left, space))
        if progress.state == STOPPED or progress.flips == flips:
            break
        flips = progress.flips
        # With the guard, what these flips have freed may be anywhere.
        touched = None if space.active else _moved_vertices(before, mesh)
        progress = _search(kernel, mesh, rules, reach, space, progress, touched, [])
        if progress.flips == flips:
            break
    return progress


def _sum(one, other):
    """Return the progress of a search that another one has gone on with."""
    return other._replace(flips=one.flips + other.flips, gain=one.gain + other.gain)


def _moved_vertices(before, mesh):
    """Return the mask of the vertices of faces of which the origins were others `before`."""
    moved = np.repeat((before != mesh.origin).reshape(-1, 3).any(axis=1), 3)
    touched = np.zeros(len(mesh.vertices), np.bool_)
    touched[before[moved]] = touched[mesh.origin[moved]] = True
    return touched


def _search(kernel, mesh, rules, reach, space, progress, touched, halted):
    """Make chains until none helps, at first from all edges, or from those near touched vertices.

    Chains that do not branch come first: they are cheap, and do most of the work.
    """
    stages = dict.fromkeys((reach._replace(breadth=1), reach)) if touched is None else (reach,)
    is_new = touched is None
    touched = np.zeros(len(mesh.vertices), np.bool_) if is_new else touched
    blocked, refused = np.zeros(len(mesh.origin), np.bool_), np.zeros(1, np.bool_)
    pending = nothing_pending(mesh)
    for stage in stages:
        task = Task(mesh, pending, no_chain(stage), touched, rules, space, blocked, refused)
        if is_new:
            touched[:] = blocked[:] = False
            queue_all(mesh, pending)
            progress = _work_off(kernel, task, progress, halted)
            if progress.state == STOPPED:
                return progress
    deeper = task._replace(chain=no_chain(reach._replace(depth=reach.depth + 1)))
    doubtful = np.zeros(len(mesh.vertices), np.bool_)
    while True:
        while progress.state == CONVERGED and touched.any():
            queue_near(mesh, pending, touched, reach.depth + rules.is_wide)
            queue_blocked(mesh, pending, blocked)
            progress = _work_off(kernel, task, progress, halted)
        # Single flips are no chains: a depth of 1 is plain descent.
        if progress.state != CONVERGED or reach.depth == 1:
            return progress
        _mark_doubtful(mesh, rules, doubtful)
        queue_near(mesh, pending, doubtful, 0)
        progress = _work_off(kernel, deeper, progress, halted)
        if progress.state != CONVERGED or not touched.any():
            return progress
