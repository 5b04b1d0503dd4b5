"""Chains of flips: how one is found from a start, step by step, each flip an allowed one.

See `meshlab_willmore.search.variable_depth`, the search that they make up.
"""

from typing import NamedTuple

import numpy as np

from ..energy import willmore
from ..guards import add_deviation
from ..guards.bvh import Bvh, refit
from ..mesh.halfedge import NONE, Mesh, apex, flip, following, is_free
from ..mesh.jit import inlined, inner
from . import stencil
from .containers import Fifo
from .costs import find_gains
from .rules import ALLOWED, INTERSECTS, Rules, refusal_by_all
from .stencil import RING, EdgeList

# The part of the largest of several numbers that the rounding of their sum stays below.
ROUNDING = 1e-13
CORNERS = 6
# Scored edges after which a start is given up: as many as six flips deep at the largest breadth.
MOST_WORK = 10_000


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
    deviation : (D, 2) float64
        What stood in `Mesh.deviation`.
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
    ring_size : (1,) int64
        Their number.
    ring_gain : (12,) float64
        What those that are free gain, as ranked.
    best : (D,) int32
        Half-edges of the best prefix.
    floor : (1,) float64
        No flip is tried after which the drop is lower than this.
    """

    flipped: np.ndarray
    joined: np.ndarray
    corner: np.ndarray
    deviation: np.ndarray
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
    ring_size: np.ndarray
    ring_gain: np.ndarray
    best: np.ndarray
    floor: np.ndarray


class ChainState(NamedTuple):
    """State of the variable-depth search; all but the rules changes in place.

    Attributes
    ----------
    mesh : Mesh
    energy : int
        Number of the one that ranks, in `meshlab_willmore.search.costs`.
    judges : bool
        Whether it also judges; else the Willmore energy does.
    queue : Fifo
        Starts of chains, the lower half-edge of each edge.
    chain : Chain
    changed : (n,) bool
        The vertices of the diamonds that were flipped for good.
    rules : Rules
    bvh : Bvh
    blocked : (3 m,) bool
        The starts of chains that failed after a flip was refused for a cut.
    hit_cut : (1,) bool
        Whether that was so in the chain at hand.
    """

    mesh: Mesh
    energy: int
    judges: bool
    queue: Fifo
    chain: Chain
    changed: np.ndarray
    rules: Rules
    bvh: Bvh
    blocked: np.ndarray
    hit_cut: np.ndarray


class Prefix(NamedTuple):
    """The best part of a chain found so far: its flips, what they gain as ranked, as judged."""

    length: int
    gain: float
    drop: float


def _widths(limits):
    """Return how many candidates are tried at each step, the start being one."""
    widths, width = [1], limits.breadth
    for _ in range(limits.depth - 1):
        widths.append(width)
        width = (width + 1) // 2
    return np.array(widths, np.int64)


def empty_chain(limits, most_loss=np.inf):
    """Return room for chains within these limits, a ChainLimits, that lose no more than that."""
    depth = limits.depth
    return Chain(
        flipped=np.empty(depth, np.int32),
        joined=np.empty((depth, 2), np.int32),
        corner=np.empty((depth, CORNERS), np.int32),
        deviation=np.empty((depth, 2)),
        gain=np.zeros(depth + 1),
        drop=np.zeros(depth + 1),
        willmore=np.zeros(depth + 1),
        width=_widths(limits),
        candidate=np.empty((depth, RING), np.int32),
        score=np.empty((depth, RING)),
        offered=np.zeros(depth, np.int64),
        seen=np.zeros(depth, np.int64),
        tried=np.zeros(depth, np.int64),
        ring=np.empty(RING, np.int32),
        ring_size=np.zeros(1, np.int64),
        ring_gain=np.empty(RING),
        best=np.empty(depth, np.int32),
        floor=np.full(1, -most_loss),
    )


@inner
def find_ring(mesh, h, ring, ring_size):
    """Write the edges around that of `h` into the ring of a chain; return their number."""
    ring_size[0] = 0
    stencil.visit_ring(EdgeList(mesh, ring, ring_size), h, stencil.append, None)
    return ring_size[0]


@inner
def _may_flip(state, h):
    """Whether the guards allow to flip `h`, which is free, to an edge that does not exist yet."""
    reason = refusal_by_all(state.mesh, state.bvh, h, state.rules)
    if reason == INTERSECTS:
        state.hit_cut[0] = True
    return reason == ALLOWED


@inner
def _is_joined(origin, h, joined, length):
    """Whether one of the first `length` flips of a chain has made the edge of `h`."""
    a, b = origin[h], origin[following(h)]
    low, high = min(a, b), max(a, b)
    found = False
    for s in range(length):
        found |= joined[s, 0] == low and joined[s, 1] == high
    return found


@inlined
def _is_lower(origin, one, other):
    """Whether the edge of the half-edge `one` has lower vertices than that of `other`."""
    a, b = origin[one], origin[following(one)]
    c, d = origin[other], origin[following(other)]
    low, other_low = min(a, b), min(c, d)
    return low < other_low or (low == other_low and max(a, b) < max(c, d))


@inner
def _score_ring(mesh, energy, place, ring, count, gains):
    """Move those of the first `count` edges of a ring that are free to its front, and score them.

    Returns
    -------
    int
        Their number.
    """
    free = 0
    for s in range(count):
        h = np.int64(ring[s])
        if is_free(mesh, h):
            ring[free] = h
            free += 1
    find_gains(energy, mesh, ring, free, place, gains)
    return free


@inner
def _sort_candidates(chain, origin, count, s, step):
    """Fill the candidates of step `s` from the first `count` edges of the ring, which are scored.

    Those of the same rank go by their vertices: so the order does not depend on that of the faces,
    which is another one in a second run.
    """
    ring, gains, score, candidate = chain.ring, chain.ring_gain, chain.score, chain.candidate
    offered = 0
    for found in range(count):
        h, gain = np.int64(ring[found]), gains[found]
        if not gain > -np.inf:
            continue
        # In steps, so that rounding does not decide between edges that are equal by symmetry.
        rank, place = np.rint(gain / step), offered
        while place > 0:
            other, before = np.rint(score[s, place - 1] / step), np.int64(candidate[s, place - 1])
            if other > rank or (other == rank and not _is_lower(origin, h, before)):
                break
            score[s, place] = score[s, place - 1]
            candidate[s, place] = before
            place -= 1
        score[s, place] = gain
        candidate[s, place] = h
        offered += 1
    chain.offered[s] = offered
    chain.seen[s] = chain.tried[s] = 0


@inner
def _find_candidates(state, count, s):
    """Fill the candidates of step `s` from the first `count` half-edges of the ring."""
    mesh, chain, rules = state.mesh, state.chain, state.rules
    free = _score_ring(mesh, state.energy, rules.virtualpoint, chain.ring, count, chain.ring_gain)
    _sort_candidates(chain, mesh.origin, free, s, rules.rank_step)


@inner
def _next_candidate(state, s):
    """Return the place of the best candidate of step `s` not tried yet that is allowed, or NONE.

    Also what it gains as judged, which is finite: no chain has a flip with an undefined angle.
    """
    chain = state.chain
    while chain.seen[s] < chain.offered[s] and chain.tried[s] < chain.width[s]:
        place = chain.seen[s]
        chain.seen[s] += 1
        h = np.int64(chain.candidate[s, place])
        drop = chain.score[s, place]
        if not state.judges:
            drop = willmore.cost_reduction(state.mesh, h)
        if not (np.isfinite(drop) and chain.drop[s] + drop >= chain.floor[0]):
            continue
        if not _is_joined(state.mesh.origin, h, chain.joined, s) and _may_flip(state, h):
            chain.tried[s] += 1
            return place, drop
    return NONE, 0.0


@inner
def _add(state, h, s, score, drop):
    """Write down what `h`, as the flip after `s` others, gains as ranked and as judged."""
    chain = state.chain
    chain.flipped[s] = h
    chain.gain[s + 1] = chain.gain[s] + score
    chain.drop[s + 1] = chain.drop[s] + drop
    if state.rules.monotone:
        chain.willmore[s + 1] = chain.willmore[s] + willmore.cost_reduction(state.mesh, h)


@inner
def _better(state, length, best):
    """Return the better one of the prefix `best` and the whole chain of `length` flips."""
    chain, rules = state.chain, state.rules
    largest = 0.0
    for s in range(length):
        largest = max(largest, abs(chain.drop[s + 1]))
    if not chain.drop[length] > best.drop + max(rules.tolerance, ROUNDING * largest):
        return best
    if rules.monotone and chain.willmore[length] < -rules.tie:
        return best
    for s in range(length):
        chain.best[s] = chain.flipped[s]
    return Prefix(length, chain.gain[length], chain.drop[length])


@inner
def _do(state, s):
    """Make the flip of step `s`."""
    mesh, chain = state.mesh, state.chain
    h = chain.flipped[s]
    t = mesh.twin[h]
    a, b = apex(mesh, h), apex(mesh, t)
    chain.joined[s, 0], chain.joined[s, 1] = min(a, b), max(a, b)
    for c in range(3):
        chain.corner[s, c] = mesh.corner[h - h % 3 + c]
        chain.corner[s, 3 + c] = mesh.corner[t - t % 3 + c]
    chain.deviation[s, 0] = mesh.deviation[h // 3]
    chain.deviation[s, 1] = mesh.deviation[t // 3]
    flip(mesh, h)
    add_deviation(mesh, h)
    refit(mesh, state.bvh, h)


@inner
def _undo(state, s):
    """Take the flip of step `s` back: the mesh is the same as before it, bit for bit."""
    mesh, chain = state.mesh, state.chain
    h = chain.flipped[s]
    t = mesh.twin[h]
    # A flip turns the diagonal by a quarter.
    flip(mesh, h)
    flip(mesh, h)
    flip(mesh, h)
    refit(mesh, state.bvh, h)
    for c in range(3):
        mesh.corner[h - h % 3 + c] = chain.corner[s, c]
        mesh.corner[t - t % 3 + c] = chain.corner[s, 3 + c]
    mesh.deviation[h // 3] = chain.deviation[s, 0]
    mesh.deviation[t // 3] = chain.deviation[s, 1]


@inner
def _finish(state, count, s, best):
    """Return the best prefix when step `s`, the last one, is any of `count` edges of the ring.

    Nothing comes after these flips, so they need not be made to know what they are worth, and
    whether they are allowed is asked only where they are worth enough.
    """
    mesh, chain, rules = state.mesh, state.chain, state.rules
    free = _score_ring(mesh, state.energy, rules.virtualpoint, chain.ring, count, chain.ring_gain)
    for place in range(free):
        h, score = np.int64(chain.ring[place]), chain.ring_gain[place]
        if not score > -np.inf:
            continue
        drop = score if state.judges else willmore.cost_reduction(mesh, h)
        if not chain.drop[s] + drop > best.drop + rules.tolerance:
            continue
        if not _is_joined(state.mesh.origin, h, chain.joined, s) and _may_flip(state, h):
            _add(state, h, s, score, drop)
            best = _better(state, s + 1, best)
    return best


@inner
def find_chain(state, start):
    """Find a chain that starts with the flip of `start` and lowers the energy.

    Parameters
    ----------
    state : ChainState
        The mesh is the same afterwards. ``chain.best`` is overwritten.
    start : int
        Half-edge with a twin.

    Returns
    -------
    best : Prefix
        Of length 0 if there is none.
    work : int
        Number of scored edges.
    """
    chain = state.chain
    best = Prefix(0, 0.0, 0.0)
    depth = len(chain.flipped)
    chain.ring[0] = start
    s, count, work, is_new = 0, 1, 0, True
    while True:
        if is_new:
            work += count
            _find_candidates(state, count, s)
            is_new = False
        place, drop = NONE, 0.0
        if work < MOST_WORK:
            place, drop = _next_candidate(state, s)
        if place != NONE:
            h = np.int64(chain.candidate[s, place])
            _add(state, h, s, chain.score[s, place], drop)
            best = _better(state, s + 1, best)
            if s + 1 == depth:
                continue
            _do(state, s)
            count = find_ring(state.mesh, h, chain.ring, chain.ring_size)
            s += 1
            if s + 1 < depth:
                is_new = True
                continue
            work += count
            best = _finish(state, count, s, best)
        elif s == 0:
            return best, work
        # This way is explored: one step back, or all the way once it was worth it.
        s -= 1
        _undo(state, s)
        while s > 0 and best.length > 0:
            s -= 1
            _undo(state, s)
