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

from ..energy import delaunay, willmore
from ..guards import add_deviation
from ..guards.bvh import inactive_bvh, refit
from ..mesh.halfedge import NONE, apex, flip, following, is_free
from ..mesh.jit import inner, jit
from ..mesh.notify import report
from . import greedy, regions
from .chains import ChainState, empty_chain, find_chain, find_ring
from .containers import empty_fifo, pop, push
from .rules import (
    ALLOWED,
    CONVERGED,
    DEFAULTS,
    NO_LIMIT,
    STOPPED,
    WORK_PER_CALL,
    WORKING,
    Progress,
    refusal,
)

# What ranks and what judges chains: `meshlab_willmore.search.compiled` puts the modules of each
# energy in these places. A judge of None: the same as what ranks.
energy, judge = willmore, None
# What the harmonic index must gain by a flip to cast doubt on a place.
DOUBT = 1e-7

# --- the queue of starts -------------------------------------------------------------------------


@inner
def _queue_edge(mesh, queue, h):
    """Put the edge of `h` last into the queue, unless it has one face only."""
    t = mesh.twin[h]
    if t != NONE:
        push(queue, min(h, t))


@jit
def queue_all(mesh, queue):
    """Queue every edge, in the order of the half-edges."""
    for h in range(len(mesh.origin)):
        _queue_edge(mesh, queue, h)


@jit
def _queue_near(mesh, queue, marked, hops):
    """Queue every edge at most `hops` edges away from a marked vertex, and clear the marks."""
    distance = np.where(marked, 0, hops + 1)
    for hop in range(hops):
        for h in range(len(mesh.origin)):
            a, b = mesh.origin[h], mesh.origin[following(h)]
            if distance[a] == hop:
                distance[b] = min(distance[b], hop + 1)
            elif distance[b] == hop:
                distance[a] = min(distance[a], hop + 1)
    for h in range(len(mesh.origin)):
        if min(distance[mesh.origin[h]], distance[mesh.origin[following(h)]]) <= hops:
            _queue_edge(mesh, queue, h)
    marked[:] = False


@jit
def _queue_blocked(mesh, queue, blocked):
    """Queue every edge that is marked, and clear the marks."""
    for h in range(len(blocked)):
        if blocked[h]:
            _queue_edge(mesh, queue, h)
    blocked[:] = False


@inner
def _mark_diamond(mesh, h, marked):
    """Mark the four vertices of the diamond of `h`."""
    for around in (h, np.int64(mesh.twin[h])):
        marked[mesh.origin[around]] = marked[apex(mesh, around)] = True


@jit
def _mark_doubtful(mesh, rules, doubtful):
    """Mark, in place, the vertices of the diamonds that the harmonic index would have flipped."""
    for h in range(len(mesh.origin)):
        if not (h < mesh.twin[h] and is_free(mesh, h)):
            continue
        if delaunay.cost_reduction(mesh, h) > DOUBT and refusal(mesh, h, rules) == ALLOWED:
            _mark_diamond(mesh, h, doubtful)


# --- the search ----------------------------------------------------------------------------------


@inner
def _keep(state, length):
    """Flip the edges of the best prefix for good, and queue all edges around."""
    mesh, chain, queue = state.mesh, state.chain, state.queue
    for s in range(length):
        h = np.int64(chain.best[s])
        _mark_diamond(mesh, h, state.changed)
        flip(mesh, h)
        add_deviation(mesh, h)
        refit(mesh, state.bvh, h)
        # A later flip of the chain moves edges to other half-edges, but queues all these as well.
        _queue_edge(mesh, queue, h)
        for place in range(find_ring(state, h)):
            _queue_edge(mesh, queue, chain.ring[place])


def advance(state, progress):
    """Go on with the search for about `WORK_PER_CALL` scored edges.

    Parameters
    ----------
    state : ChainState
        Changed in place.
    progress : Progress
        Where to go on.

    Returns
    -------
    tuple
        The fields of the new Progress; converged is the state once the queue is empty.
    """
    mesh, queue = state.mesh, state.queue
    scored, flips, gain, _ = progress
    work = 0
    while work < WORK_PER_CALL:
        if queue.ends[1] == 0:
            return scored, flips, gain, CONVERGED
        h = pop(queue)
        # A flip has put another edge there, which is queued under its own name.
        if mesh.twin[h] < h:
            continue
        state.hit_cut[0] = False
        best, more = find_chain(state, h, energy, judge)
        work += more
        if best.length == 0:
            state.blocked[h] = state.hit_cut[0]
            continue
        if flips + best.length > state.rules.maxflips:
            return scored, flips, gain, STOPPED
        _keep(state, best.length)
        flips += best.length
        gain += best.gain
    return scored, flips, gain, WORKING


def _work_off(kernel, state, progress, halted):
    """Go on call by call until the queue is empty, the limit is reached, or all is halted."""
    progress = progress._replace(state=WORKING)
    while progress.state == WORKING and not halted:
        progress = Progress(*kernel(state, progress))
        report(f"chains, {progress.flips} flips, {state.queue.ends[1]} edges left")
    return progress


def run(kernels, mesh, rules, bvh=None, settings=DEFAULTS):
    """Flip edges of `mesh` in place until no allowed chain helps, or the limit is reached.

    Parameters and result are those of `meshlab_willmore.search.greedy.run`. A chain that would
    exceed `Rules.maxflips` is not made. Under the monotone rule no chain as a whole raises the
    Willmore energy; its single flips may. Large meshes are searched in regions first, on all cores;
    not with the guard against self-intersections, which looks everywhere, or a limit.
    """
    bvh = inactive_bvh() if bvh is None else bvh
    progress = greedy.run(kernels, mesh, rules, bvh)
    if progress.state == STOPPED:
        return progress
    changed = None
    if regions.is_large(mesh) and not bvh.active and rules.maxflips == NO_LIMIT:

        def search(part, halted):
            begin = Progress(len(part.origin), 0, 0.0, WORKING)
            return _search(kernels, part, rules, bvh, settings.limits, begin, None, halted)

        found, changed = regions.run(search, mesh, settings.threads)
        progress = _sum(progress, found)
    progress = _search(kernels, mesh, rules, bvh, settings.limits, progress, changed)
    # For a potential, a flip that is left would have been a chain.
    while progress.state == CONVERGED and rules.monotone:
        before, flips = mesh.origin.copy(), progress.flips
        left = rules._replace(maxflips=rules.maxflips - flips)
        progress = _sum(progress, greedy.run(kernels, mesh, left, bvh))
        if progress.state == STOPPED or progress.flips == flips:
            break
        flips = progress.flips
        # With the guard, what these flips have freed may be anywhere.
        changed = None if bvh.active else _moved_vertices(before, mesh)
        progress = _search(kernels, mesh, rules, bvh, settings.limits, progress, changed)
        if progress.flips == flips:
            break
    return progress


def _sum(one, other):
    """Return the progress of a search that another one has gone on with."""
    return other._replace(flips=one.flips + other.flips, gain=one.gain + other.gain)


def _moved_vertices(before, mesh):
    """Return the mask of the vertices of faces of which the origins were others `before`."""
    moved = np.repeat((before != mesh.origin).reshape(-1, 3).any(axis=1), 3)
    marked = np.zeros(len(mesh.vertices), np.bool_)
    marked[before[moved]] = marked[mesh.origin[moved]] = True
    return marked


def _search(kernels, mesh, rules, bvh, limits, progress, changed, halted=()):
    """Make chains until none helps, at first from all edges, or from those near changed vertices.

    Chains that do not branch come first: they are cheap, and do most of the work.
    """
    is_new = changed is None
    stages = dict.fromkeys((limits._replace(breadth=1), limits)) if is_new else (limits,)
    changed = np.zeros(len(mesh.vertices), np.bool_) if is_new else changed
    blocked, hit_cut = np.zeros(len(mesh.origin), np.bool_), np.zeros(1, np.bool_)
    queue = empty_fifo(len(mesh.origin))
    for stage in stages:
        chain = empty_chain(stage)
        state = ChainState(mesh, queue, chain, changed, rules, bvh, blocked, hit_cut)
        if is_new:
            changed[:] = blocked[:] = False
            queue_all(mesh, queue)
            progress = _work_off(kernels.depth, state, progress, halted)
            if progress.state == STOPPED:
                return progress
    deeper = state._replace(chain=empty_chain(limits._replace(depth=limits.depth + 1)))
    doubtful = np.zeros(len(mesh.vertices), np.bool_)
    while True:
        while progress.state == CONVERGED and changed.any():
            _queue_near(mesh, queue, changed, limits.depth + rules.is_wide)
            _queue_blocked(mesh, queue, blocked)
            progress = _work_off(kernels.depth, state, progress, halted)
        # Single flips are no chains: a depth of 1 is plain descent.
        if progress.state != CONVERGED or limits.depth == 1:
            return progress
        _mark_doubtful(mesh, rules, doubtful)
        _queue_near(mesh, queue, doubtful, 0)
        progress = _work_off(kernels.depth, deeper, progress, halted)
        if progress.state != CONVERGED or not changed.any():
            return progress
