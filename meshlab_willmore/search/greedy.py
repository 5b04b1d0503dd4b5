"""The greedy search ("Mesh optimisation based on Willmore energy", section 3).

    put every edge that may be flipped into a queue, by cost reduction
    while the queue is not empty:
        take the edge i-j of the largest cost reduction
        unless connectivity forbids the flip, or it would bring back an edge that must stay away:
            if the flip lowers no true energy: i-j must stay away
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
from ..guards.bvh import Bvh, inactive_bvh, refit
from ..mesh.halfedge import NONE, Mesh, flip, makes_new_edge
from ..mesh.jit import generic, inner
from ..mesh.notify import report
from . import rescoring
from .heap import NEVER, Queue, empty_queue, first, update
from .pairs import Pairs, insert, no_pairs, reserve
from .rules import (
    CONVERGED,
    MOST_PASSES,
    STOPPED,
    WORKING,
    Progress,
    Rules,
    brings_back,
    is_blocked,
    is_final,
)
from .scoring import gain_of
from .touched import visit_around, visit_fans, visit_freed
from .waiting import Waiting, leave, nothing_waits

# Work between two looks at the keyboard, counted in scored edges: some hundredths of a second.
SLICE = 40_000
SCORES_PER_FLIP = 16


class Task(NamedTuple):
    """What a search works on; it changes all but the rules in place.

    `kept_away` (1,) tells whether a flip was refused for an edge that must stay away.
    """

    mesh: Mesh
    queue: Queue
    gone: Pairs
    rules: Rules
    space: Bvh
    waiting: Waiting
    kept_away: np.ndarray


@inner
def _must_stay_away(task, h):
    """Tell whether the edge of `h` must not come back once flipped: the flip lowers no energy."""
    rules = task.rules
    if rules.is_potential:
        return False
    return not rules.monotone or willmore.cost_reduction(task.mesh, h) <= 2.0 * rules.tie


@generic
def _rescore_waiting(task, face, cost_reduction):
    """Rescore the edges that have waited for a change of `face`."""
    h = np.int64(task.waiting.first[face])
    while h != NONE:
        leave(task.waiting, h)
        rescoring.rescore(task, h, cost_reduction)
        h = np.int64(task.waiting.first[face])


@generic
def _flip(task, h, cost_reduction):
    """Flip `h`, bring everything up to date, and return about how many edges that has scored."""
    work = SCORES_PER_FLIP
    flip(task.mesh, h)
    if task.rules.is_wide:
        work += visit_fans(task, h, rescoring.rescore, cost_reduction)
    else:
        visit_around(task, h, rescoring.rescore, cost_reduction)
    visit_freed(task, h, rescoring.rescore, cost_reduction)
    if task.space.active:
        refit(task.mesh, task.space, h)
        _rescore_waiting(task, h // 3, cost_reduction)
        _rescore_waiting(task, task.mesh.twin[h] // 3, cost_reduction)
    return work


@generic
def advance(task, progress, cost_reduction):
    """Go on with the search for about `SLICE` scored edges.

    Parameters
    ----------
    task : Task
        Changed in place; `gone` must have room for ``SLICE // SCORES_PER_FLIP`` more pairs.
    progress : Progress
        Where to go on.
    cost_reduction : callable
        The energy: a jitted function as `gain_of` takes it.

    Returns
    -------
    tuple
        The fields of the new Progress. Not a Progress itself: Numba would call its Python class to
        make one, and an interrupt that is served inside that call crashes the interpreter.
    """
    mesh, queue = task.mesh, task.queue
    scored, flips, gain, _ = progress
    if scored < len(mesh.origin):
        stop = min(scored + SLICE, len(mesh.origin))
        for h in range(scored, stop):
            if h < mesh.twin[h]:
                update(queue, h, rescoring.rank(mesh, h, task.rules, cost_reduction))
        return stop, flips, gain, WORKING
    work = 0
    while work < SLICE:
        if queue.size[0] == 0:
            return scored, flips, gain, CONVERGED
        h = first(queue)
        keep_away = _must_stay_away(task, h)
        is_back = keep_away and brings_back(mesh, task.gone, h)
        task.kept_away[0] |= is_back
        if is_back or not makes_new_edge(mesh, h) or is_blocked(task, h):
            update(queue, h, NEVER)
            work += SCORES_PER_FLIP
            continue
        if flips == task.rules.maxflips:
            return scored, flips, gain, STOPPED
        if keep_away:
            insert(task.gone, mesh.origin[h], mesh.origin[mesh.twin[h]])
        flips += 1
        gain += gain_of(cost_reduction, mesh, h, task.rules)
        work += _flip(task, h, cost_reduction)
    return scored, flips, gain, WORKING


def run(kernel, mesh, rules, space=None):
    """Flip edges of `mesh` in place until no allowed flip helps, or the limit is reached.

    The kernel works in slices, so that an interrupt is served between two of them.

    Parameters
    ----------
    kernel : callable
        `advance` for one energy, from `meshlab_willmore.search.entries`.
    mesh : Mesh
    rules : Rules
    space : Bvh, optional
        The guard against self-intersections, up to date with the mesh, and so it stays. None: there
        is no such guard.

    Returns
    -------
    Progress
        Its state is `CONVERGED` or `STOPPED`.
    """
    space = inactive_bvh() if space is None else space
    waiting, queue = nothing_waits(len(space.order)), empty_queue(len(mesh.origin))
    progress = Progress(0, 0, 0.0, WORKING)
    for _ in range(MOST_PASSES):
        flips, kept_away = progress.flips, np.zeros(1, np.bool_)
        task = Task(mesh, queue, no_pairs(), rules, space, waiting, kept_away)
        progress = progress._replace(scored=0, state=WORKING)
        while progress.state == WORKING:
            task = task._replace(gone=reserve(task.gone, SLICE // SCORES_PER_FLIP))
            progress = Progress(*kernel(task, progress))
            report(f"greedy, {progress.flips} flips, {queue.size[0]} edges left")
        if is_final(rules, progress, flips, kept_away):
            break
    return progress
