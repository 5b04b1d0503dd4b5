"""The greedy search in rounds, on all cores.

    score every edge
    while there is an edge that may be flipped and helps (a candidate):
        find the local maxima: candidates of a larger cost reduction than all 12 edges around them
        flip all maxima that connectivity, guards and the rules of `greedy` allow
        score the edges that these flips have changed

It is the usual way to find an independent set in parallel (M. Luby, "A simple parallel algorithm
for the maximal independent set problem", 1986, DOI 10.1137/0215074; M. T. Jones and P. E.
Plassmann, "A parallel graph coloring heuristic", 1993, DOI 10.1137/0914041). Two edges conflict if
a flip of one changes what the cost reduction of the other is computed from: the two faces at it,
and the four outside. Each edge of these six faces, 13 in all with the edge itself, has the other
one among its own 13. Equal gains go by number, so of two that conflict at most one is a maximum,
and there is always a maximum. The maxima of a round change nothing that another one reads: in
whatever order they are flipped, each has the cost reduction that it was chosen for. So a round is a
piece of a run of single flips, ordered by gain only where gains matter to each other, and it ends
for the reasons that `greedy` gives. (For an energy whose cost reduction looks round whole corners,
of the maxima with a common corner only the first is flipped.) What the whole mesh decides, that k-l
is no edge yet and that no face is cut, is asked of every maximum before the round (the guard
against intersections only of those that nothing else refuses).

**Why no edge is made twice.** After some flips of a round, the edges of the mesh are among those
before the round and those that these flips have made. k-l is none of the former, or the maximum
would have been refused. One of the latter it can be only if another maximum makes the same edge.
Such maxima are *contested*: they are flipped after all others, one by one, and each is asked again
on the mesh as it is then. What was refused before the round is never flipped in it, although a flip
may free it: its new edge and faces were compared with no others. It is blocked by an edge or a
face, and is scored for the next round once that changes. The same holds for intersections: the
faces are those before the round and those that its flips make, and a maximum that would cut one of
the latter is contested. The order of the maxima does not depend on how the work was shared. So the
result is the same, bit for bit, for any number of threads.
"""

from typing import NamedTuple

import numpy as np

from ..guards.bvh import expand, inactive_bvh, specialized
from ..guards.intersections import ANY_ROUND, obstacles_in_round
from ..mesh.halfedge import NONE, Mesh, apex, flip, makes_new_edge, previous
from ..mesh.jit import at, inner, jit
from ..mesh.parallel import thread_pool
from ..progress import report, stage
from . import rounds, stencil
from .containers import insert, reserve
from .rounds import Candidates, forbid, initial_state
from .rules import (
    ALLOWED,
    CONVERGED,
    DEFAULTS,
    EXISTS,
    INTERSECTS,
    MOST_PASSES,
    REFUSED,
    STOPPED,
    WORKING,
    Progress,
    is_blocked,
    is_finished,
    is_tabu,
    pass_share,
    refusal,
)

# Beside the reasons of `rules.refusal`: a neighbour goes first.
NO_MAXIMUM = -1
HALF_BITS, MOST_PLACES = 32, 2**32 - 1
# Edges around one that changed, about.
ACTIVE_PER_CHANGE = 13
# Flips of which the gains are summed up together.
FLIPS_PER_SUM = 2048
# The part of the time of a pass until all edges are scored, and the power of the part of the edges
# that are left which is nearest to the part of the time, measured on scans.
SCORING, POWER = 0.25, 0.75

# --- the maxima of a round -----------------------------------------------------------------------


@jit
def find_maxima(candidates, start, stop):
    """Write what becomes of the candidates from `start` up to `stop` into `verdict`."""
    state = candidates.state
    for place in range(start, stop):
        h = candidates.edges[at(place)]
        verdict = NO_MAXIMUM
        if not stencil.visit_ring(state, h, rounds.goes_before, h):
            verdict = refusal(state.mesh, h, state.rules)
        candidates.verdict[at(place)] = verdict


class Contest(NamedTuple):
    """Maxima of round `number`, and a mark for each that another one may be in the way of."""

    candidates: Candidates
    contested: np.ndarray
    number: int


class _NewEdges(NamedTuple):
    """What says which edges maxima make: fields of Candidates, of the state and of its mesh."""

    edges: np.ndarray
    verdict: np.ndarray
    origin: np.ndarray
    twin: np.ndarray
    new_edge: np.ndarray


@jit
def _contest_edges(made, number, contested):
    """Mark, in place, the maxima of round `number` that may become the same edge as another one."""
    for place in range(len(made.edges)):
        if made.verdict[at(place)] != ALLOWED:
            continue
        h = made.edges[at(place)]
        k = made.origin[at(previous(h))]
        l = made.origin[at(previous(made.twin[at(h)]))]
        lower = at(min(k, l))
        before = made.new_edge[lower]
        if before >> HALF_BITS == number:
            contested[at(place)] = contested[at(before & MOST_PLACES)] = True
        else:
            made.new_edge[lower] = (np.int64(number) << HALF_BITS) | place


@jit
def _announce(candidates, number):
    """Let the BVH know what the maxima of round `number` would change."""
    state, mesh = candidates.state, candidates.state.mesh
    for place in range(len(candidates.edges)):
        if candidates.verdict[at(place)] == ALLOWED:
            h = np.int64(candidates.edges[at(place)])
            expand(mesh, state.bvh, h, number)
            state.to_flip[at(h // 3)] = state.to_flip[at(mesh.twin[at(h)] // 3)] = h


@jit
def _ask_guard(contest, start, stop):
    """Ask the guard against intersections of the maxima of a range that are allowed so far.

    Those that would cut faces as they are get the verdict, those that would cut the new faces of
    others are contested.
    """
    candidates, state = contest.candidates, contest.candidates.state
    for place in range(start, stop):
        if candidates.verdict[at(place)] == ALLOWED:
            h = np.int64(candidates.edges[at(place)])
            found = obstacles_in_round(state.mesh, state.bvh, h, contest.number, state.to_flip)
            contest.contested[at(place)] = found.flip
            if found.face != NONE:
                candidates.verdict[at(place)] = INTERSECTS


def _guarded(candidates, number, parallel_for):
    """Refuse, in place, maxima that would cut faces; return which would cut those of others."""
    state, contested = candidates.state, np.zeros(len(candidates.edges), np.bool_)
    if not state.bvh.active:
        return contested
    _announce(candidates, number)
    parallel_for(_ask_guard, Contest(candidates, contested, number), len(contested))
    is_refused, again = candidates.verdict == INTERSECTS, np.flatnonzero(contested)
    if is_refused.any() and len(again):
        # The faces of a refused flip are not in the way.
        refused = candidates.edges[is_refused]
        state.to_flip[refused // 3] = state.to_flip[state.mesh.twin[refused] // 3] = NONE
        rest = Candidates(state, candidates.edges[again], candidates.verdict[again])
        still = np.zeros(len(again), np.bool_)
        parallel_for(_ask_guard, Contest(rest, still, number), len(still))
        contested[again] = still
    return contested


def in_order(candidates, number, flips, parallel_for):
    """Return the maxima in the order in which they are to be flipped; ask the guard of them.

    Where maxima can be in each other's way, the larger gain goes first.

    Parameters
    ----------
    candidates : Candidates
        After `find_maxima`.
    number : int
        Number of this round.
    flips : int
        How many there were before.
    parallel_for : callable
        From `meshlab_willmore.mesh.parallel`.

    Returns
    -------
    maxima : Candidates
        First those that must not be flipped, then the others.
    settled, contested : int
        The places from which on nothing has to be asked any more, and from which on it has to be
        asked whether a flip is still allowed.
    """
    state = candidates.state
    places = np.flatnonzero(candidates.verdict != NO_MAXIMUM)
    maxima = Candidates(state, candidates.edges[places], candidates.verdict[places])
    contested = _guarded(maxima, number, parallel_for)
    is_allowed = maxima.verdict == ALLOWED
    are_many = flips + np.count_nonzero(is_allowed) > state.rules.maxflips
    if state.rules.is_wide or are_many:
        contested[:] = True
    else:
        mesh = state.mesh
        made = _NewEdges(maxima.edges, maxima.verdict, mesh.origin, mesh.twin, state.new_edge)
        _contest_edges(made, number, contested)
    late = np.flatnonzero(is_allowed & contested)
    edges = maxima.edges[late]
    numbers = edges.astype(np.uint64) * rounds.SCRAMBLER & rounds.LOW_BITS
    late = late[np.lexsort((numbers, -state.rank[edges]))]
    is_tie, is_early = state.is_tie[maxima.edges], is_allowed & ~contested
    refused, ties = np.flatnonzero(~is_allowed), np.flatnonzero(is_early & is_tie)
    settled = np.flatnonzero(is_early & ~is_tie)
    order = np.concatenate([refused, ties, settled, late])
    found = Candidates(state, maxima.edges[order], maxima.verdict[order])
    return found, len(refused) + len(ties), len(order) - len(late)


# --- flips ---------------------------------------------------------------------------------------


@inner
def _take_corners(state, h):
    """Take the corners of the diamond of `h`; False, and none is taken, if one was before."""
    mesh, t = state.mesh, state.mesh.twin[h]
    corners = (mesh.origin[h], mesh.origin[t], apex(mesh, h), apex(mesh, t))
    for v in corners:
        if state.taken[v]:
            return False
    for v in corners:
        state.taken[v] = True
    return True


@inner
def _is_refused(state, h, verdict, is_contested, number):
    """Whether the edge `h` must not be flipped; if so, note what blocks it.

    The verdict says how that was before the round. Only what is contested is asked again.
    """
    mesh = state.mesh
    is_joined = verdict == EXISTS or (is_contested and not makes_new_edge(mesh, h))
    if is_joined:
        insert(state.blocking, apex(mesh, h), apex(mesh, mesh.twin[at(h)]))
    if is_joined or verdict == REFUSED:
        return True
    if verdict == INTERSECTS:
        # Nothing was flipped yet in this round, so that the face is still there.
        is_blocked(state, h, ANY_ROUND)
        return True
    if state.is_tie[at(h)] and is_tabu(mesh, state.tabu, h):
        state.tabu_hit[0] = True
        return True
    return is_contested and is_blocked(state, h, number)


class RoundResult(NamedTuple):
    """How many maxima were flipped and refused, the cost reductions of the flips, the state."""

    flipped: int
    refused: int
    gain: float
    state: int


@jit
def flip_one_by_one(maxima, start, stop, contested, left, number, done):
    """Flip the maxima from `start` up to `stop` that are allowed.

    Parameters
    ----------
    maxima : Candidates
        From `in_order`; `tabu` and `blocking` of its state must have room for all of them.
    start, stop, contested : int
        `contested` as from there.
    left : int
        How many flips may be made in this round.
    number : int
        Number of the round.
    done : tuple
        The fields of the RoundResult before.

    Returns
    -------
    tuple
        The fields of the RoundResult, these maxima included.
    """
    state, mesh, rules = maxima.state, maxima.state.mesh, maxima.state.rules
    flipped, refused, gain, outcome = done
    for place in range(start, stop):
        h, verdict = np.int64(maxima.edges[at(place)]), maxima.verdict[at(place)]
        if _is_refused(state, h, verdict, place >= contested, number):
            forbid(state, h)
            refused += 1
            state.done[at(len(state.done) - refused)] = h
            continue
        if flipped == left:
            return flipped, refused, gain, STOPPED
        if rules.is_wide and not _take_corners(state, h):
            continue
        if state.is_tie[at(h)]:
            insert(state.tabu, mesh.origin[h], mesh.origin[mesh.twin[h]])
        gain += state.gain[at(h)]
        flip(mesh, h)
        state.done[at(flipped)] = h
        flipped += 1
    return flipped, refused, gain, outcome


class Settled(NamedTuple):
    """Maxima of which nothing is to be asked, and what a flip of them needs.

    Attributes
    ----------
    mesh : Mesh
    gain, done : ndarray
        As in the state.
    edges : (s,) int32
        The maxima.
    flipped : int
        How many were flipped before, in this round.
    gains : (s / FLIPS_PER_SUM,) float64
        The sums of the gains, to be written.
    """

    mesh: Mesh
    gain: np.ndarray
    done: np.ndarray
    edges: np.ndarray
    flipped: int
    gains: np.ndarray


@jit
def flip_settled(settled, start, stop):
    """Flip the maxima from `start` up to `stop`; threads may do that side by side.

    A flip writes to its two faces, and to the sides next to them of the faces outside. No face of
    one maximum is among the six of another one.
    """
    gain = 0.0
    for place in range(start, stop):
        h = np.int64(settled.edges[at(place)])
        gain += settled.gain[at(h)]
        flip(settled.mesh, h)
        settled.done[at(settled.flipped + place)] = h
    settled.gains[at(start // FLIPS_PER_SUM)] = gain


def _flip_all(maxima, settled, contested, left, number, parallel_for):
    """Flip all maxima that are allowed; return the state, and what was done."""

    def one_by_one(state, start, stop, done):
        for first in range(start, stop, rounds.EDGES_PER_CALL):
            state = state._replace(
                tabu=reserve(state.tabu, rounds.EDGES_PER_CALL),
                blocking=reserve(state.blocking, rounds.EDGES_PER_CALL),
            )
            last = min(first + rounds.EDGES_PER_CALL, stop)
            task = maxima._replace(state=state)
            done = flip_one_by_one(task, first, last, contested, left, number, done)
            if done[-1] == STOPPED:
                break
        return state, RoundResult(*done)

    state, done = one_by_one(maxima.state, 0, settled, (0, 0, 0.0, WORKING))
    count = contested - settled
    gains = np.zeros(-(-count // FLIPS_PER_SUM))
    edges = maxima.edges[settled:contested]
    task = Settled(state.mesh, state.gain, state.done, edges, done.flipped, gains)
    parallel_for(flip_settled, task, count, FLIPS_PER_SUM)
    done = done._replace(flipped=done.flipped + count, gain=done.gain + float(gains.sum()))
    return one_by_one(state, contested, len(maxima.edges), tuple(done))


# --- the search ----------------------------------------------------------------------------------


def _possible_maxima(state, dirty, refused, ranked):
    """Return the edges that may be maxima, and the new length of the list of the ranked.

    An edge that was no maximum, and around which nothing changed, is none now. Where much changed,
    it is quicker to look at all.
    """
    if ACTIVE_PER_CHANGE * (dirty + refused) < ranked:
        changed = np.concatenate([state.dirty[:dirty], state.done[len(state.done) - refused :]])
        active = rounds.active_around(state, changed)
        if len(active):
            return active, ranked
    ranked = rounds.compact_ranked(state, ranked)
    return state.ranked[:ranked], ranked


def run(kernels, mesh, rules, bvh=None, settings=DEFAULTS):
    """Flip edges of `mesh` in place until no allowed flip helps, or the limit is reached.

    Parameters and result are those of `meshlab_willmore.search.greedy.run`.
    """
    bvh = specialized(inactive_bvh() if bvh is None else bvh)
    progress = Progress(len(mesh.origin), 0, 0.0, WORKING)
    with thread_pool(settings.threads) as parallel_for:
        for _ in range(MOST_PASSES):
            flips, state = progress.flips, initial_state(mesh, rules, bvh)
            with stage(pass_share(rules)):
                progress = _make_rounds(kernels.score, state, progress, parallel_for)
            if is_finished(rules, progress, flips, state.tabu_hit):
                break
    return progress


def _make_rounds(score, state, progress, parallel_for):
    """Make rounds of flips until no allowed flip helps, or the limit is reached."""
    dirty, refused, ranked, number, most = len(state.dirty), 0, 0, 0, 1
    while True:
        number += 1
        parallel_for(score, state, dirty)
        ranked = rounds.add_ranked(state, dirty, ranked)
        edges, ranked = _possible_maxima(state, dirty, refused, ranked)
        if not len(edges):
            return progress._replace(state=CONVERGED)
        if number == 1:
            report(SCORING, f"{len(edges)} edges to flip")
        candidates = Candidates(state, edges, np.empty(len(edges), np.int8))
        parallel_for(find_maxima, candidates, len(edges))
        maxima, *places = in_order(candidates, number, progress.flips, parallel_for)
        left = state.rules.maxflips - progress.flips
        state, done = _flip_all(maxima, *places, left, number, parallel_for)
        flips, gain = progress.flips + done.flipped, progress.gain + done.gain
        progress = Progress(progress.scored, flips, gain, done.state)
        most = max(most, len(edges))
        part = 1.0 - ((len(edges) - done.flipped) / most) ** POWER
        text = f"round {number}, {flips} flips, {len(edges)} edges left"
        report(SCORING + (1.0 - SCORING) * part, text)
        # It also brings the bounds of the deviation up to date.
        dirty = rounds.list_dirty(state, done.flipped, parallel_for)
        if done.state == STOPPED:
            return progress
        refused = done.refused
