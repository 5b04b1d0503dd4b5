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
from ..mesh.jit import inner, jit
from ..progress import report, stage

# Numba keeps no kernel on disk that hands on a function of its own module by its plain name.
from . import greedy
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
from .stencil import visit_fans, visit_freed, visit_quad, visit_stencil

# Edges that a flip scores, about, and so many that are scored at a time.
SCORES_PER_FLIP = 16
ROOM = 64
# The part of the time of a pass until all edges are scored, measured on scans.
SCORING = 0.2


class GreedyState(NamedTuple):
    """State of the search; all but the rules changes in place.

    `energy` is its number in `meshlab_willmore.search.costs`; `tabu_hit` (1,) says whether a flip
    was refused for an edge of the tabu set. `edges` (s,) int32 has room for edges that are to be
    scored, the first `waiting` (1,), and `gains` (s,) for what each gains.
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
    waiting: np.ndarray


@inner
def _becomes_tabu(state, h):
    """Whether the edge of `h` must not come back once flipped: the flip lowers no energy."""
    rules = state.rules
    if rules.is_potential:
        return False
    return not rules.monotone or willmore.cost_reduction(state.mesh, h) <= 2.0 * rules.tie


@inner
def _score_waiting(state):
    """Bring the queue up to date with the edges that wait to be scored."""
    mesh, rules, count = state.mesh, state.rules, state.waiting[0]
    find_gains(state.energy, mesh, state.edges, count, rules.virtualpoint, state.gains)
    for s in range(count):
        h, gain, rank = np.int64(state.edges[s]), state.gains[s], NEVER
        if gain > rules.tolerance and not (
            rules.monotone and willmore.cost_reduction(mesh, h) < -rules.tie
        ):
            rank = np.rint(gain / rules.rank_step) if refusal(mesh, h, rules) == ALLOWED else NEVER
        update(state.queue, h, rank)
    state.waiting[0] = 0


@inner
def rescore(state, h, _):
    """Let the edge of `h` wait to be scored; its entry in the queue is under the lower twin."""
    t = state.mesh.twin[h]
    if t == NONE:
        update(state.queue, h, NEVER)
        return False
    low, high = min(h, t), max(h, t)
    update(state.queue, high, NEVER)
    if not is_free(state.mesh, low):
        update(state.queue, low, NEVER)
        return False
    state.edges[state.waiting[0]] = low
    state.waiting[0] += 1
    if state.waiting[0] == len(state.edges):
        _score_waiting(state)
    return False


@inner
def _rescore_freed(state, face):
    """Rescore the edges that watch `face`."""
    h = np.int64(state.watch_lists.first[face])
    while h != NONE:
        unwatch(state.watch_lists, h)
        rescore(state, h, None)
        h = np.int64(state.watch_lists.first[face])


@inner
def _flip(state, h):
    """Flip `h`, bring everything up to date, and return about how many edges that has scored."""
    work = SCORES_PER_FLIP
    flip(state.mesh, h)
    add_deviation(state.mesh, h)
    if state.rules.is_wide:
        work += visit_fans(state, h, greedy.rescore, None)
    elif state.rules.is_narrow and not state.rules.monotone:
        visit_quad(state, h, greedy.rescore, None)
    else:
        visit_stencil(state, h, greedy.rescore, None)
    visit_freed(state, h, greedy.rescore, None)
    if state.bvh.active:
        refit(state.mesh, state.bvh, h)
        _rescore_freed(state, h // 3)
        _rescore_freed(state, state.mesh.twin[h] // 3)
    _score_waiting(state)
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
        for h in range(scored, stop):
            if h < mesh.twin[h]:
                rescore(state, h, None)
        _score_waiting(state)
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
            waiting=np.zeros(1, np.int64),
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
