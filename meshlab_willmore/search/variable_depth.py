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
is left. That takes O(n) time for each round of n edges.
"""

from typing import NamedTuple

import numpy as np

from .. import guards
from ..energy import willmore
from ..mesh.halfedge import (
    NONE,
    Mesh,
    apex,
    flip,
    following,
    is_free,
    makes_new_edge,
    previous,
)
from ..mesh.jit import generic, jit
from . import greedy
from .greedy import CONVERGED, SLICE, STOPPED, WORKING, Progress, Rules

RING = 12
CORNERS = 6


class Reach(NamedTuple):
    """How far chains go.

    Attributes
    ----------
    depth : int
        Most flips of a chain, at least 1.
    breadth : int
        Number of edges, 1 to `RING`, that are tried for the second flip of a chain; half as many,
        rounded up, for the third, and so on. 1: chains do not branch.
    """

    depth: int = 5
    breadth: int = 3


class Chain(NamedTuple):
    """The chain at hand, for up to D flips: row s belongs to the flip after s others.

    Attributes
    ----------
    flipped : (D,) int32
        Half-edges flipped so far.
    joined : (D, 2) int32
        Ends of the edges that these flips made, the lower one first.
    corner : (D, 6) int32
        What stood in `Mesh.corner` before the flip.
    gain : (D + 1,) float64
        What the first s flips gain, as ranked.
    drop : (D + 1,) float64
        The same as judged.
    willmore : (D + 1,) float64
        The same for the Willmore energy; only kept up to date under the monotone rule.
    width : (D,) int64
        Number of candidates to try.
    candidate : (D, 12) int32
        Half-edges that might be flipped, best first.
    score : (D, 12) float64
        What they gain, as ranked.
    offered : (D,) int64
        Number of candidates.
    seen : (D,) int64
        How many of them were looked at.
    tried : (D,) int64
        How many of these were allowed, and flipped.
    ring : (12,) int32
        Half-edges around the last flip.
    best : (D,) int32
        Half-edges of the best prefix.
    """

    flipped: np.ndarray
    joined: np.ndarray
    corner: np.ndarray
    gain: np.ndarray
    drop: np.ndarray
    willmore: np.ndarray
    width: np.ndarray
    candidate: np.ndarray
    score: np.ndarray
    offered: np.ndarray
    seen: np.ndarray
    tried: np.ndarray
    ring: np.ndarray
    best: np.ndarray


class Pending(NamedTuple):
    """The edges at which a chain may start: a queue, first in, first out.

    Attributes
    ----------
    item : (3 m,) int32
        A ring buffer of half-edges, the lower one of twins.
    waits : (3 m,) bool
        Which half-edges are in the queue.
    ends : (2,) int64
        Place of the first one, and their number.
    """

    item: np.ndarray
    waits: np.ndarray
    ends: np.ndarray


class Task(NamedTuple):
    """What the search works on; it changes all but the rules in place.

    `touched` (n,) marks the vertices of the diamonds that were flipped for good.
    """

    mesh: Mesh
    pending: Pending
    chain: Chain
    touched: np.ndarray
    rules: Rules


class Prefix(NamedTuple):
    """The best part of a chain found so far: its flips, what they gain as ranked, as judged."""

    length: int
    gain: float
    drop: float


def _widths(reach):
    """Return how many candidates are tried at each step, the start being one."""
    widths, width = [1], reach.breadth
    for _ in range(reach.depth - 1):
        widths.append(width)
        width = (width + 1) // 2
    return np.array(widths, np.int64)


def _no_chain(reach):
    depth = reach.depth
    return Chain(
        flipped=np.empty(depth, np.int32),
        joined=np.empty((depth, 2), np.int32),
        corner=np.empty((depth, CORNERS), np.int32),
        gain=np.zeros(depth + 1),
        drop=np.zeros(depth + 1),
        willmore=np.zeros(depth + 1),
        width=_widths(reach),
        candidate=np.empty((depth, RING), np.int32),
        score=np.empty((depth, RING)),
        offered=np.zeros(depth, np.int64),
        seen=np.zeros(depth, np.int64),
        tried=np.zeros(depth, np.int64),
        ring=np.empty(RING, np.int32),
        best=np.empty(depth, np.int32),
    )


def _nothing_pending(mesh):
    count = len(mesh.origin)
    return Pending(np.empty(count, np.int32), np.zeros(count, np.bool_), np.zeros(2, np.int64))


@jit
def _append(mesh, pending, h):
    """Put the edge of `h` last into the queue, unless it waits already or has one face only."""
    t = mesh.twin[h]
    if t == NONE:
        return
    low = min(h, t)
    if not pending.waits[low]:
        pending.waits[low] = True
        pending.item[(pending.ends[0] + pending.ends[1]) % len(pending.item)] = low
        pending.ends[1] += 1


@jit
def _take_first(pending):
    """Take the first half-edge out of the queue, which must not be empty."""
    h = np.int64(pending.item[pending.ends[0]])
    pending.waits[h] = False
    pending.ends[0] = (pending.ends[0] + 1) % len(pending.item)
    pending.ends[1] -= 1
    return h


@jit
def ring_around(mesh, h, ring):
    """Write the sides of the diamond of `h`, and the other sides of the faces outside, to `ring`.

    Returns
    -------
    int
        Their number, at most `RING`: the edges besides `h` whose cost reductions its flip changes.
    """
    t = mesh.twin[h]
    count = 0
    for side in (following(h), previous(h), following(t), previous(t)):
        ring[count] = side
        count += 1
        outside = mesh.twin[side]
        if outside != NONE:
            ring[count], ring[count + 1] = following(outside), previous(outside)
            count += 2
    return count


@jit
def _may_flip(mesh, h, rules):
    """Tell whether connectivity, locks and guards allow to flip `h`, energies aside."""
    return is_free(mesh, h) and not guards.folds(mesh, h, rules.fold) and makes_new_edge(mesh, h)


@jit
def _is_joined(task, h, length):
    """Tell whether the chain has made the edge of `h` itself."""
    a, b = task.mesh.origin[h], task.mesh.origin[following(h)]
    low, high = min(a, b), max(a, b)
    for s in range(length):
        if task.chain.joined[s, 0] == low and task.chain.joined[s, 1] == high:
            return True
    return False


@jit
def _offer(task, s, h, score):
    """Sort `h` into the candidates of step `s`, after those of the same rank."""
    chain, step = task.chain, task.rules.rank_step
    place = chain.offered[s]
    chain.offered[s] += 1
    # In steps, so that rounding does not decide between edges that are equal by symmetry.
    rank = np.rint(score / step)
    while place > 0 and np.rint(chain.score[s, place - 1] / step) < rank:
        chain.score[s, place] = chain.score[s, place - 1]
        chain.candidate[s, place] = chain.candidate[s, place - 1]
        place -= 1
    chain.score[s, place] = score
    chain.candidate[s, place] = h


@generic
def _find_candidates(task, count, s, ranking):
    """Fill the candidates of step `s` from the first `count` half-edges of the ring."""
    mesh, chain = task.mesh, task.chain
    chain.offered[s] = chain.seen[s] = chain.tried[s] = 0
    for place in range(count):
        h = chain.ring[place]
        if is_free(mesh, h):
            score = ranking(mesh, h)
            if score > -np.inf:
                _offer(task, s, h, score)


@jit
def _next_candidate(task, s):
    """Return the place of the best candidate of step `s` not tried yet that is allowed, or NONE."""
    chain = task.chain
    while chain.seen[s] < chain.offered[s] and chain.tried[s] < chain.width[s]:
        place = chain.seen[s]
        chain.seen[s] += 1
        h = chain.candidate[s, place]
        if not _is_joined(task, h, s) and _may_flip(task.mesh, h, task.rules):
            chain.tried[s] += 1
            return place
    return NONE


@jit
def _add(task, h, s, score, drop):
    """Write down what `h`, as the flip after `s` others, gains as ranked and as judged."""
    chain = task.chain
    chain.flipped[s] = h
    chain.gain[s + 1] = chain.gain[s] + score
    chain.drop[s + 1] = chain.drop[s] + drop
    if task.rules.monotone:
        chain.willmore[s + 1] = chain.willmore[s] + willmore.cost_reduction(task.mesh, h)


@jit
def _better(task, length, best):
    """Return the better one of the prefix `best` and the whole chain of `length` flips."""
    chain, rules = task.chain, task.rules
    if not chain.drop[length] > best.drop + rules.tolerance:
        return best
    if rules.monotone and chain.willmore[length] < -rules.tie:
        return best
    chain.best[:length] = chain.flipped[:length]
    return Prefix(length, chain.gain[length], chain.drop[length])


@jit
def _do(task, s):
    """Make the flip of step `s`."""
    mesh, chain = task.mesh, task.chain
    h = chain.flipped[s]
    t = mesh.twin[h]
    a, b = apex(mesh, h), apex(mesh, t)
    chain.joined[s, 0], chain.joined[s, 1] = min(a, b), max(a, b)
    for c in range(3):
        chain.corner[s, c] = mesh.corner[h - h % 3 + c]
        chain.corner[s, 3 + c] = mesh.corner[t - t % 3 + c]
    flip(mesh, h)


@jit
def _undo(task, s):
    """Take the flip of step `s` back: the mesh is the same as before it, bit for bit."""
    mesh, chain = task.mesh, task.chain
    h = chain.flipped[s]
    t = mesh.twin[h]
    # A flip turns the diagonal by a quarter.
    flip(mesh, h)
    flip(mesh, h)
    flip(mesh, h)
    for c in range(3):
        mesh.corner[h - h % 3 + c] = chain.corner[s, c]
        mesh.corner[t - t % 3 + c] = chain.corner[s, 3 + c]


@generic
def _finish(task, count, s, best, ranking, judge):
    """Return the best prefix when step `s`, the last one, is any of `count` edges of the ring.

    Nothing comes after these flips, so they need not be made to know what they are worth, and
    whether they are allowed is asked only where they are worth enough.
    """
    mesh, chain, rules = task.mesh, task.chain, task.rules
    for place in range(count):
        h = chain.ring[place]
        if not is_free(mesh, h):
            continue
        score = ranking(mesh, h)
        if not score > -np.inf:
            continue
        drop = score if judge is None else judge(mesh, h)
        if not chain.drop[s] + drop > best.drop + rules.tolerance:
            continue
        if not _is_joined(task, h, s) and _may_flip(mesh, h, rules):
            _add(task, h, s, score, drop)
            best = _better(task, s + 1, best)
    return best


@generic
def find_chain(task, start, ranking, judge):
    """Find a chain that starts with the flip of `start` and lowers the energy.

    Parameters
    ----------
    task : Task
        The mesh is the same afterwards. ``chain.best`` is overwritten.
    start : int
        Half-edge with a twin.
    ranking, judge : callable
        As for `advance`.

    Returns
    -------
    best : Prefix
        Of length 0 if there is none.
    work : int
        Number of scored edges.
    """
    mesh, chain = task.mesh, task.chain
    best = Prefix(0, 0.0, 0.0)
    depth = len(chain.flipped)
    chain.ring[0] = start
    s, count, work, is_new = 0, 1, 0, True
    while True:
        if is_new:
            work += count
            _find_candidates(task, count, s, ranking)
            is_new = False
        place = _next_candidate(task, s)
        if place != NONE:
            h, score = np.int64(chain.candidate[s, place]), chain.score[s, place]
            _add(task, h, s, score, score if judge is None else judge(mesh, h))
            # Where an angle is undefined, nothing comes of it.
            if not np.isfinite(chain.drop[s + 1]):
                continue
            best = _better(task, s + 1, best)
            if s + 1 == depth:
                continue
            _do(task, s)
            count = ring_around(mesh, h, chain.ring)
            s += 1
            if s + 1 < depth:
                is_new = True
                continue
            work += count
            best = _finish(task, count, s, best, ranking, judge)
        elif s == 0:
            return best, work
        # This way is explored: one step back, or all the way once it was worth it.
        s -= 1
        _undo(task, s)
        while s > 0 and best.length > 0:
            s -= 1
            _undo(task, s)


@jit
def _keep(task, length):
    """Flip the edges of the best prefix for good, and queue all edges around."""
    mesh, chain = task.mesh, task.chain
    for s in range(length):
        h = chain.best[s]
        for around in (h, mesh.twin[h]):
            task.touched[mesh.origin[around]] = task.touched[apex(mesh, around)] = True
        flip(mesh, h)
        # A later flip of the chain moves edges to other half-edges, but queues all these as well.
        _append(mesh, task.pending, h)
        for place in range(ring_around(mesh, h, chain.ring)):
            _append(mesh, task.pending, chain.ring[place])


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
        Jitted functions of a mesh and a half-edge, see above. A judge of None: `ranking` is also
        the judge.

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
        h = _take_first(pending)
        # A flip has put another edge there, which waits under its own name.
        if mesh.twin[h] < h:
            continue
        best, more = find_chain(task, h, ranking, judge)
        work += more
        if best.length == 0:
            continue
        if flips + best.length > task.rules.maxflips:
            return scored, flips, gain, STOPPED
        _keep(task, best.length)
        flips += best.length
        gain += best.gain
    return scored, flips, gain, WORKING


@jit
def _queue_all(mesh, pending):
    """Queue every edge, in the order of the half-edges."""
    for h in range(len(mesh.origin)):
        _append(mesh, pending, h)


@jit
def _queue_near(mesh, pending, touched, hops):
    """Queue every edge at most `hops` edges away from a marked vertex, and clear the marks."""
    distance = np.where(touched, 0, hops + 1)
    for hop in range(hops):
        for h in range(len(mesh.origin)):
            a, b = mesh.origin[h], mesh.origin[following(h)]
            if distance[a] == hop:
                distance[b] = min(distance[b], hop + 1)
            elif distance[b] == hop:
                distance[a] = min(distance[a], hop + 1)
    for h in range(len(mesh.origin)):
        if min(distance[mesh.origin[h]], distance[mesh.origin[following(h)]]) <= hops:
            _append(mesh, pending, h)
    touched[:] = False


def _work_off(kernel, task, progress):
    """Go on slice by slice until the queue is empty or the limit is reached."""
    progress = progress._replace(state=WORKING)
    while progress.state == WORKING:
        progress = Progress(*kernel(task, progress))
    return progress


def run(kernel, descent, mesh, rules, reach):
    """Flip edges of `mesh` in place until no allowed chain helps, or the limit is reached.

    Chains that do not branch come first: they are cheap, and do most of the work.

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

    Returns
    -------
    Progress
        Its state is `CONVERGED` or `STOPPED`.
    """
    progress = greedy.run(descent, mesh, rules)
    if progress.state == STOPPED:
        return progress
    touched = np.zeros(len(mesh.vertices), np.bool_)
    pending = _nothing_pending(mesh)
    for stage in dict.fromkeys((reach._replace(breadth=1), reach)):
        task = Task(mesh, pending, _no_chain(stage), touched, rules)
        touched[:] = False
        _queue_all(mesh, pending)
        progress = _work_off(kernel, task, progress)
        if progress.state == STOPPED:
            return progress
    while progress.state == CONVERGED and touched.any():
        _queue_near(mesh, pending, touched, reach.depth + rules.is_wide)
        progress = _work_off(kernel, task, progress)
    return progress
