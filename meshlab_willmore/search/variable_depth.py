"""The variable-depth search: chains of flips that may go through a loss.

    descend greedily; descend along another energy first as well; go on with the better end
    put every edge into a queue
    while the queue is not empty:
        take an edge and flip it, even at a loss
        up to the depth: flip the best edge next to the last flip that the chain has not made itself
        keep the best prefix if it lowers the energy, and put the edges around it into the queue
        undo the rest
    repeat with the edges that could have seen a change, until no chain helps
    try longer chains that branch, to the second best edge and so on until one helps, where chains
        have helped and where another energy still would flip edges; repeat if that helped
    descend along the other energy again; repeat from there if it ends lower

It is the scheme of S. Lin and B. W. Kernighan ("An effective heuristic algorithm for the
traveling-salesman problem", 1973, DOI 10.1287/opre.21.2.498), with their breadth at the first
steps, applied to flips: the several flips at a time that the paper names as the way out of local
minima ("Mesh optimisation based on Willmore energy", section 5).

Every flip of a chain has to be allowed when it is made. Two functions guide the search: one *ranks*
the edges from which a chain may go on, the other one *judges* the chain and must be the difference
of a potential, so that the cost reductions of a chain add up to the drop of an energy. Each chain
that is kept lowers that energy by more than a tolerance, and so does each descent: the search ends.
For most energies both are the same. The virtual Willmore energy has no potential; chains ranked by
it are judged by the Willmore energy.

**Two descents.** Greedy descent along the harmonic index (`meshlab_willmore.energy.delaunay`) and
then along the energy itself often ends far lower than that along the energy alone: it sees where
the surface is rough from much further off. On the face scan both differ in one face of 500. Chains
follow there from both ends before these are compared, and then everywhere from the better one. It
is the same at the end: what the search returns is not left for a better end of that descent either,
so that a second run hardly ever makes a flip: only where flips tie, as there the order of the
faces decides where descent ends. Whether a chain helps does not depend on that order.

**What a chain sees.** A chain of D flips that starts at the edge i-j reads the mesh at vertices at
most D edges away from i or j. (The quad around an edge, and the corners of the faces outside, are
neighbours of i or j; one flip leads to edges between these. That an edge exists is known at both of
its ends. An energy that looks further, `Rules.is_wide`, reads one ring more.) So when all edges
were tried, and then those within D edges of a change, over and over until nothing changes, no chain
is left. That takes O(n) time for each round of n edges. Only the guard against self-intersections
looks farther. Starts from which it has refused a flip are noted, and tried again in each round.

**When a chain is given up.** No flip is tried after which the loss is larger than `most_loss` of
`meshlab_willmore.energy.table`. The loss of most flips of a good triangulation alone is; of the
chains that help, one in a hundred gets there.

**Doubtful places.** Chains that branch take four times as long as others and hardly find more. What
remains of a bad triangulation are a few tangles. They are seen by another energy: the harmonic
index, which is least where triangles are good, or the Willmore energy, would flip edges there. So
chains branch, and may be one flip longer, from these edges and around them, and where chains have
helped. There are few such places on smooth surfaces.
"""

import functools

import numpy as np

from ..energy import delaunay, willmore
from ..guards import add_deviation
from ..guards.bvh import refit
from ..mesh.build import EDGE_SHIFT, edge_numbers, faces_of
from ..mesh.halfedge import NONE, apex, flip, following, is_free
from ..mesh.jit import allocating_jit, inner, jit
from ..progress import report, stage
from . import greedy, parallel_greedy, regions
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
    rest_of,
)
from .snapshots import better, descend, extend, finish, snapshot_of

# What another energy must gain by a flip to cast doubt on a place.
DOUBT = 1e-7
# Shares of the time that is left, measured on scans: of greedy descent, of chains in regions, of
# the first chains of a search, and of what may have to be repeated.
DESCENT, IN_REGIONS, FIRST, REPEATED = 0.02, 0.95, 0.75, 0.85
# The time of chains from each of two ends, from all edges, and that of what follows; and how many
# times as many vertices as differ the chains look at.
ENDS, REST, REACH = (1.8, 0.8), 1.25, 40.0

# --- the queue of starts -------------------------------------------------------------------------


@inner
def _queue_edge(mesh, queue, h):
    """Put the edge of `h` last into the queue, unless it has one face only."""
    t = mesh.twin[h]
    if t != NONE:
        push(queue, min(h, t))


@allocating_jit
def _spread(mesh, marked, hops):
    """Return the mask of the vertices at most `hops` edges away from a marked one."""
    distance = np.where(marked, 0, hops + 1)
    for hop in range(hops):
        for h in range(len(mesh.origin)):
            a, b = mesh.origin[h], mesh.origin[following(h)]
            if distance[a] == hop:
                distance[b] = min(distance[b], hop + 1)
            elif distance[b] == hop:
                distance[a] = min(distance[a], hop + 1)
    return distance <= hops


@jit
def queue_marked(mesh, queue, marked):
    """Queue every edge with a marked end, in the order of the half-edges."""
    for h in range(len(mesh.origin)):
        if marked[mesh.origin[h]] or marked[mesh.origin[following(h)]]:
            _queue_edge(mesh, queue, h)


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


@allocating_jit
def _doubtful_vertices(mesh, rules):
    """Return the mask of the vertices of the diamonds that another energy would have flipped."""
    doubtful = np.zeros(len(mesh.vertices), np.bool_)
    for h in range(len(mesh.origin)):
        if not (h < mesh.twin[h] and is_free(mesh, h)):
            continue
        gain = max(delaunay.cost_reduction(mesh, h), willmore.cost_reduction(mesh, h))
        if gain > DOUBT and refusal(mesh, h, rules) == ALLOWED:
            _mark_diamond(mesh, h, doubtful)
    return doubtful


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
        for place in range(find_ring(mesh, h, chain.ring, chain.ring_size)):
            _queue_edge(mesh, queue, chain.ring[place])


@jit
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
        best, more = find_chain(state, h)
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


def _work_off(state, progress, halted, part=REPEATED):
    """Go on call by call until the queue is empty, the limit is reached, or all is halted."""
    progress, most = progress._replace(state=WORKING), max(int(state.queue.ends[1]), 1)
    with stage(part):
        while progress.state == WORKING and not halted:
            progress = Progress(*advance(state, progress))
            left = int(state.queue.ends[1])
            report(1.0 - left / most, f"chains, {progress.flips} flips, {left} edges left")
    return progress


def run(kernels, mesh, rules, bvh=None, settings=DEFAULTS):
    """Flip edges of `mesh` in place until no allowed chain helps, or the limit is reached.

    Parameters and result are those of `meshlab_willmore.search.greedy.run`, but the gain is the
    drop of the energy that judges. A chain that would exceed `Rules.maxflips`, which limits the
    flips on the way to each state, is not made. The monotone rule holds from each start: no chain
    as a whole raises the Willmore energy, though its single flips may. The result is no worse than
    the greedy one from the mesh itself. Large meshes are searched in regions first, on all cores;
    not with the guard against self-intersections, which looks everywhere, or a limit.
    """
    begin = snapshot_of(mesh, bvh)
    with stage(DESCENT):
        found = descend(kernels, begin, rules)
    found = _best_descent(kernels, begin, found, rules, settings)
    changed = None
    while found.state == CONVERGED:
        search = functools.partial(_make_chains, kernels, settings=settings, changed=changed)
        with stage(REPEATED):
            deep = extend(found, search, rules)
        with stage(REPEATED):
            found = _best_descent(kernels, deep, deep, rules, settings)
        if found is deep:
            break
        # With the guard, what these flips have freed may be anywhere.
        changed = None if begin.bvh.active else _where_they_differ(deep.mesh, found.mesh)
    progress = finish(kernels, mesh, found)
    if begin.bvh.active:
        bvh.box[:] = found.bvh.box
    return progress


def _best_descent(kernels, begin, found, rules, settings):
    """Return `found`, unless the way along another energy is better.

    From both, chains without branches go on where they differ: nowhere else would they lead to
    different states.
    """
    # With the guard, where that way leads depends on the order of the faces.
    for other_kernels, other_rules in () if begin.bvh.active else settings.warm_starts:
        limited = other_rules._replace(maxflips=rules.maxflips)
        with stage(DESCENT):
            other = extend(begin, _quick_descent(other_kernels, settings), limited)
        with stage(DESCENT):
            other = extend(other, _quick_descent(kernels, settings), rules)
        ends = [found, other]
        if found.state == other.state == CONVERGED:
            near = _where_they_differ(found.mesh, other.mesh)
            limits = settings.limits._replace(breadth=1)
            search = functools.partial(search_by_chains, kernels, limits=limits, changed=near)
            reach = min(1.0, REACH * np.count_nonzero(near) / max(len(near), 1))
            for place in range(len(ends)):
                work = reach * sum(ENDS[place:])
                with stage(reach * ENDS[place] / (work + REST)):
                    ends[place] = extend(ends[place], search, rules)
        ends[0] = found if ends[0].flips == found.flips else ends[0]
        found = better(kernels, rules, *ends)
    return found


def _quick_descent(kernels, settings):
    return functools.partial(parallel_greedy.run, kernels, settings=settings)


def _make_chains(kernels, mesh, rules, bvh, settings, changed):
    """Make chains until none helps, near changed vertices or, if that is None, everywhere."""
    limits, progress = settings.limits, Progress(len(mesh.origin), 0, 0.0, WORKING)
    if changed is None and regions.is_large(mesh) and not bvh.active and rules.maxflips == NO_LIMIT:

        def search(part, halted):
            return search_by_chains(kernels, part, rules, bvh, limits, halted=halted)

        with stage(IN_REGIONS):
            progress, changed = regions.run(search, mesh, settings.threads)
    with stage(IN_REGIONS):
        progress = _sum(progress, search_by_chains(kernels, mesh, rules, bvh, limits, changed))
    # For a potential, a flip that is left would have been a chain.
    while progress.state == CONVERGED and rules.monotone:
        before, flips = mesh.origin.copy(), progress.flips
        left = rules._replace(maxflips=rest_of(rules.maxflips, flips))
        with stage(REPEATED):
            progress = _sum(progress, greedy.run(kernels, mesh, left, bvh))
        if progress.state == STOPPED or progress.flips == flips:
            break
        flips = progress.flips
        # With the guard, what these flips have freed may be anywhere.
        changed = None if bvh.active else _moved_vertices(before, mesh)
        left = rules._replace(maxflips=rest_of(rules.maxflips, flips))
        with stage(REPEATED):
            progress = _sum(progress, search_by_chains(kernels, mesh, left, bvh, limits, changed))
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


def _where_they_differ(one, other):
    """Return the mask of the ends of the edges that only one of two triangulations has."""
    marked = np.zeros(len(one.vertices), np.bool_)
    numbers = (edge_numbers(faces_of(mesh)) for mesh in (one, other))
    differing = np.setxor1d(*numbers, assume_unique=True)
    marked[differing >> EDGE_SHIFT] = marked[differing & (2**EDGE_SHIFT - 1)] = True
    return marked


def search_by_chains(kernels, mesh, rules, bvh, limits, changed=None, halted=()):
    """Make chains until none helps, at first from all edges, or from those near changed vertices.

    Chains that do not branch come first: they are cheap, and do most of the work. Then chains that
    branch and are one flip longer start where others have helped, and at doubtful places.
    """
    hops, vertices = limits.depth + rules.is_wide, len(mesh.vertices)
    queue, made = empty_fifo(len(mesh.origin)), np.zeros(vertices, np.bool_)
    straight, branching = (
        ChainState(
            mesh,
            kernels.number,
            kernels.judges,
            queue,
            empty_chain(chain_limits, kernels.most_loss),
            made,
            rules,
            bvh,
            blocked=np.zeros(len(mesh.origin), np.bool_),
            hit_cut=np.zeros(1, np.bool_),
        )
        for chain_limits in (limits._replace(breadth=1), limits._replace(depth=limits.depth + 1))
    )
    near = np.ones(vertices, np.bool_) if changed is None else changed
    reach, moved = _spread(mesh, near, hops + 1), np.zeros(vertices, np.bool_)
    queue_marked(mesh, queue, _spread(mesh, near, hops))
    progress, part = Progress(len(mesh.origin), 0, 0.0, WORKING), FIRST
    while True:
        progress = _work_off(straight, progress, halted, part)
        part = REPEATED
        while progress.state == CONVERGED and made.any():
            moved |= made
            queue_marked(mesh, queue, _spread(mesh, made, hops))
            _queue_blocked(mesh, queue, straight.blocked)
            made[:] = False
            progress = _work_off(straight, progress, halted)
        # Single flips are no chains: a depth of 1 is plain descent.
        if progress.state != CONVERGED or limits.depth == 1:
            return progress
        # Elsewhere they would do what they did before.
        reach |= _spread(mesh, moved, hops + 1)
        queue_marked(mesh, queue, moved | (reach & _doubtful_vertices(mesh, rules)))
        _queue_blocked(mesh, queue, branching.blocked)
        reach[:] = moved[:] = False
        progress = _work_off(branching, progress, halted)
        if progress.state != CONVERGED or not made.any():
            return progress
