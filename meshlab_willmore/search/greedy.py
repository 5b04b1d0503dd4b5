"""The greedy search ("Mesh optimisation based on Willmore energy", section 3).

    put every edge that may be flipped into a queue, by cost reduction
    while the queue is not empty:
        take the edge i-j of the largest cost reduction
        unless connectivity forbids the flip, or it would bring back an edge of the tabu set:
            if the flip lowers no true energy: put i-j into the tabu set
            flip i-j to k-l
            rescore k-l, the four sides, and the two other edges of each face outside (13 edges)
            for an energy that looks further: rescore the edges at and opposite to i, j, k and l
            rescore the edges that could not be flipped because i-j was there
            rescore the edges whose flip would have cut one of the two old faces

An edge may be flipped if connectivity and guards allow it, if its cost reduction exceeds a
tolerance and, under the *monotone* rule, if the Willmore energy does not rise. All this depends on
the diamond and the faces around it only, except for the existence of k-l and for the faces that
the new ones would cut, which the last two lines cover: when the queue is empty, no flip is left.
n flips take O(n log n) time. Cuts are dear to find, so that only the edge taken is asked.

**Why it ends.** Where the cost reduction is the drop of an energy, by more than rounding, no
triangulation comes back. That of the virtual Willmore energy is not, and descent on it alone can go
round in circles. *Without the monotone rule* an edge that was flipped away never comes back, so no
vertex pair is flipped away twice. *With it* call a flip strict if it lowers the Willmore energy by
more than 2 tau (tau is far above the rounding of that number), else a tie; a tie raises it by at
most tau. A tie puts its edge into a set A, and no tie may bring back an edge of A. Suppose that a
run never ended: A stops growing, and some triangulation comes back later. In between, each tie
takes an edge of A out of the mesh, and only strict flips bring one back, so there are no more ties
than strict flips. But then the energy has fallen by more than tau for each strict flip: a
contradiction. If an edge of A was refused at the end, A is forgotten and the search goes on, so
that a second run would find nothing either: at most `MOST_PASSES` times, for ties that go round in
circles.
"""

from typing import NamedTuple

import numpy as np

from ..energy import willmore
from ..guards import add_deviation
from ..guards.bvh import Bvh, inactive_bvh, refit
from ..guards.intersections import ANY_ROUND
from ..mesh.halfedge import NONE, Mesh, flip, is_free
from ..mesh.jit import allocating_inner, inner, jit
from ..progress import report, stage
from . import stencil
from .containers import (
    NEVER,
    Heap,
    PairSet,
    WatchLists,
    empty_heap,
    empty_pair_set,
    empty_watch_lists,
    first,
    insert,
    reserve,
    unwatch,
    update,
)
from .costs import find_gains
from .rules import (
    ALLOWED,
    CONVERGED,
    DEFAULTS,
    MOST_PASSES,
    STOPPED,
    WORK_PER_CALL,
    WORKING,
    Progress,
    Rules,
    is_blocked,
    is_finished,
    is_tabu,
    pass_share,
    refusal,
)
from .stencil import EdgeList, visit_fans, visit_freed, visit_quad, visit_stencil

# Edges that a flip scores, about, and so many that are scored at a time.
SCORES_PER_FLIP = 16
ROOM = 128
# The part of the time of a pass until all edges are scored, measured on scans.
SCORING = 0.2


class GreedyState(NamedTuple):
    """State of the search; all but the rules changes in place.

    `energy` is its number in `meshlab_willmore.search.costs`; `tabu_hit` (1,) says whether a flip
    was refused for an edge of the tabu set. `edges` (s,) int32, `size` (1,) and `gains` (s,) are
    room for edges that are to be scored, their number, and what each gains.
    """

    mesh: Mesh
    energy: int
    queue: Heap
    tabu: PairSet
    rules: Rules
    bvh: Bvh
    watch_lists: WatchLists
    tabu_hit: np.ndarray
    edges: np.ndarray
    gains: np.ndarray
    size: np.ndarray


@inner
def _becomes_tabu(state, h):
    """Whether the edge of `h` must not come back once flipped: the flip lowers no energy."""
    rules = state.rules
    if rules.is_potential:
        return False
    return not rules.monotone or willmore.cost_reduction(state.mesh, h) <= 2.0 * rules.tie


class _Scorer(NamedTuple):
    """Of the state what edges are scored with."""

    mesh: Mesh
    energy: int
    rules: Rules
    queue: Heap


@inner
def _score(scorer, edges, count, gains):
    """Bring the queue up to date with the first `count` edges, in place.

    The entry of an edge is under the lower one of its half-edges. `edges` is used for those that
    may be flipped, and `gains` for what these gain.
    """
    mesh, energy, rules, queue = scorer
    free = 0
    for s in range(count):
        h = np.int64(edges[s])
        t = np.int64(mesh.twin[h])
        if t == NONE:
            update(queue, h, NEVER)
            continue
        low, high = min(h, t), max(h, t)
        update(queue, high, NEVER)
        if is_free(mesh, low):
            edges[free] = low
            free += 1
        else:
            update(queue, low, NEVER)
    find_gains(energy, mesh, edges, free, rules.virtualpoint, gains)
    for s in range(free):
        h, gain, rank = np.int64(edges[s]), gains[s], NEVER
        if gain > rules.tolerance:
            rises = rules.monotone and willmore.cost_reduction(mesh, h) < -rules.tie
            if not rises and refusal(mesh, h, rules) == ALLOWED:
                rank = np.rint(gain / rules.rank_step)
        update(queue, h, rank)


@inner
def _rescore_freed(state, scorer, face):
    """Rescore the edges that watch `face`."""
    first, count = state.watch_lists.first, 0
    while first[face] != NONE:
        h = np.int64(first[face])
        unwatch(state.watch_lists, h)
        state.edges[count] = h
        count += 1
        if count == len(state.edges):
            _score(scorer, state.edges, count, state.gains)
            count = 0
    _score(scorer, state.edges, count, state.gains)


@inner
def _find_changed(found, rules, h):
    """List the edges that the flip which made `h` changes; return about how many, but by fans."""
    work = SCORES_PER_FLIP
    found.size[0] = 0
    if rules.is_wide:
        work += visit_fans(found, h, stencil.append, None)
    elif rules.is_narrow and not rules.monotone:
        visit_quad(found, h, stencil.append, None)
    else:
        visit_stencil(found, h, stencil.append, None)
    visit_freed(found, h, stencil.append, None)
    return work


@allocating_inner
def _score_many(scorer, h, size):
    """Score the edges, `size[0]` in number, that the flip which made `h` changes."""
    edges, gains = np.empty(size[0], np.int32), np.empty(size[0])
    _find_changed(EdgeList(scorer.mesh, edges, size), scorer.rules, h)
    _score(scorer, edges, size[0], gains)


@inner
def _flip(state, h):
    """Flip `h`, bring everything up to date, and return about how many edges that has scored."""
    mesh, rules = state.mesh, state.rules
    flip(mesh, h)
    add_deviation(mesh, h)
    scorer = _Scorer(mesh, state.energy, rules, state.queue)
    work = _find_changed(EdgeList(mesh, state.edges, state.size), rules, h)
    if state.size[0] <= len(state.edges):
        _score(scorer, state.edges, state.size[0], state.gains)
    else:
        _score_many(scorer, h, state.size)
    if state.bvh.active:
        refit(mesh, state.bvh, h)
        _rescore_freed(state, scorer, h // 3)
        _rescore_freed(state, scorer, mesh.twin[h] // 3)
    return work


@inner
def _gain_of(state, h):
    state.edges[0] = h
    find_gains(state.energy, state.mesh, state.edges, 1, state.rules.virtualpoint, state.gains)
    return state.gains[0]


@jit
def advance(state, progress):
    """Go on with the search for about `WORK_PER_CALL` scored edges.

    Parameters
    ----------
    state : GreedyState
        Changed in place; `tabu` must have room for ``WORK_PER_CALL // SCORES_PER_FLIP`` more pairs.
    progress : Progress
        Where to go on.

    Returns
    -------
    tuple
        The fields of the new Progress. Not a Progress itself: Numba would call its Python class to
        make one, and an interrupt that is served inside that call crashes the interpreter.
    """
    mesh, queue, rules = state.mesh, state.queue, state.rules
    scored, flips, gain, _ = progress
    if scored < len(mesh.origin):
        stop = min(scored + WORK_PER_CALL, len(mesh.origin))
        scorer, count = _Scorer(mesh, state.energy, rules, queue), 0
        for h in range(scored, stop):
            if h < mesh.twin[h]:
                state.edges[count] = h
                count += 1
            if count == len(state.edges) or h == stop - 1:
                _score(scorer, state.edges, count, state.gains)
                count = 0
        return stop, flips, gain, WORKING
    work = 0
    while work < WORK_PER_CALL:
        if queue.size[0] == 0:
            return scored, flips, gain, CONVERGED
        h = first(queue)
        becomes_tabu = _becomes_tabu(state, h)
        comes_back = becomes_tabu and is_tabu(mesh, state.tabu, h)
        state.tabu_hit[0] |= comes_back
        is_refused = comes_back or refusal(mesh, h, rules) != ALLOWED
        if is_refused or is_blocked(state, h, ANY_ROUND):
            update(queue, h, NEVER)
            work += SCORES_PER_FLIP
            continue
        if flips == rules.maxflips:
            return scored, flips, gain, STOPPED
        if becomes_tabu:
            insert(state.tabu, mesh.origin[h], mesh.origin[mesh.twin[h]])
        flips += 1
        gain += _gain_of(state, h)
        work += _flip(state, h)
    return scored, flips, gain, WORKING


def run(kernels, mesh, rules, bvh=None, settings=DEFAULTS):
    """Flip edges of `mesh` in place until no allowed flip helps, or the limit is reached.

    All searches have these parameters and this result.

    Parameters
    ----------
    kernels : Kernels
        From `meshlab_willmore.search.compiled`, for one energy.
    mesh : Mesh
    rules : Rules
    bvh : Bvh, optional
        The guard against self-intersections, up to date with the mesh, and so it stays. None: there
        is no such guard.
    settings : Settings
        What single searches ask for; not this one.

    Returns
    -------
    Progress
        Its state is `CONVERGED` or `STOPPED`.
    """
    bvh = inactive_bvh() if bvh is None else bvh
    watch_lists, queue = empty_watch_lists(len(bvh.order)), empty_heap(len(mesh.origin))
    progress = Progress(0, 0, 0.0, WORKING)
    for _ in range(MOST_PASSES):
        flips, tabu_hit = progress.flips, np.zeros(1, np.bool_)
        state = GreedyState(
            mesh,
            kernels.number,
            queue,
            empty_pair_set(),
            rules,
            bvh,
            watch_lists,
            tabu_hit,
            edges=np.empty(ROOM, np.int32),
            gains=np.empty(ROOM),
            size=np.zeros(1, np.int64),
        )
        progress = progress._replace(scored=0, state=WORKING)
        with stage(pass_share(rules)):
            most = 0
            while progress.state == WORKING:
                state = state._replace(tabu=reserve(state.tabu, WORK_PER_CALL // SCORES_PER_FLIP))
                progress = Progress(*advance(state, progress))
                left = int(queue.size[0])
                most = max(most, left)
                text = f"greedy, {progress.flips} flips, {left} edges left"
                report(_part_done(mesh, progress, left, most), text)
        if is_finished(rules, progress, flips, tabu_hit):
            break
    return progress


def _part_done(mesh, progress, left, most):
    """Return which part of a pass is done, by the edges `left` in the queue, once `most`.

    On scans that is in proportion to the time, to within some percent.
    """
    if progress.scored < len(mesh.origin):
        return SCORING * progress.scored / len(mesh.origin)
    return SCORING + (1.0 - SCORING) * (1.0 - left / max(most, 1))
