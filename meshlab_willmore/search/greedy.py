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
contradiction.
"""

from typing import NamedTuple

import numpy as np

from .. import guards
from ..energy import willmore
from ..guards import cuts
from ..guards import space as spaces
from ..guards.space import Space
from ..mesh.halfedge import (
    NONE,
    Mesh,
    apex,
    flip,
    following,
    is_free,
    makes_new_edge,
    next_in_fan,
    previous,
)
from ..mesh.jit import generic, jit
from .heap import NEVER, Queue, empty_queue, first, update
from .pairs import Pairs, contains, insert, no_pairs, reserve
from .scoring import gain_of
from .waiting import Waiting, leave, nothing_waits, wait

WORKING, CONVERGED, STOPPED = range(3)
# Work between two looks at the keyboard, counted in scored edges: some hundredths of a second.
SLICE = 40_000
SCORES_PER_FLIP = 16
# Edges at and opposite to the corners of a diamond where all is regular.
AROUND = 72
NO_LIMIT = 2**62


class Rules(NamedTuple):
    """Which flips are made.

    Attributes
    ----------
    fold : FoldLimits
        The fold guard.
    monotone : bool
        Whether the Willmore energy must not rise.
    maxflips : int
        Number of flips after which to stop.
    tolerance : float
        A cost reduction must exceed this (in units of the energy); planar parallelograms tie at 0.
    tie : float
        A change of the Willmore energy (radians) up to this counts as none.
    rank_step : float
        Cost reductions are ranked in steps of this size (in units of the energy). Edges that are
        equal by symmetry then go by number, and not by rounding, which a rotation would change.
    is_potential, is_wide : bool
        As in `meshlab_willmore.energy.kinds.Kind`.
    virtualpoint : float
        Place of the virtual points in (0, 1), for the energies that ask for it.
    """

    fold: guards.FoldLimits
    monotone: bool = True
    maxflips: int = NO_LIMIT
    tolerance: float = 1e-7
    tie: float = 1e-12
    rank_step: float = 1e-9
    is_potential: bool = False
    is_wide: bool = False
    virtualpoint: float = 0.5


class Task(NamedTuple):
    """What a search works on; it changes all but the rules in place."""

    mesh: Mesh
    queue: Queue
    gone: Pairs
    rules: Rules
    space: Space
    waiting: Waiting


class Progress(NamedTuple):
    """How far a search is: half-edges scored at first, flips made, their cost reductions, state."""

    scored: int
    flips: int
    gain: float
    state: int


@generic
def rank(mesh, h, rules, cost_reduction):
    """Return the rank of `h` in the queue, or `NEVER` where it must not be flipped."""
    if not is_free(mesh, h):
        return NEVER
    gain = gain_of(cost_reduction, mesh, h, rules)
    if not gain > rules.tolerance:
        return NEVER
    if rules.monotone and willmore.cost_reduction(mesh, h) < -rules.tie:
        return NEVER
    if guards.folds(mesh, h, rules.fold):
        return NEVER
    # Last, since it alone takes longer than O(1).
    if not makes_new_edge(mesh, h):
        return NEVER
    return np.rint(gain / rules.rank_step)


@generic
def _rescore(task, h, cost_reduction):
    """Bring the queue up to date with the edge of `h`; its entry stands under the lower twin."""
    t = task.mesh.twin[h]
    if t == NONE:
        update(task.queue, h, NEVER)
        return
    low, high = min(h, t), max(h, t)
    update(task.queue, high, NEVER)
    update(task.queue, low, rank(task.mesh, low, task.rules, cost_reduction))


@generic
def _rescore_around(task, h, cost_reduction):
    """Rescore the at most 13 edges whose cost reduction the flip of `h` has changed."""
    mesh = task.mesh
    t = mesh.twin[h]
    _rescore(task, h, cost_reduction)
    for side in (following(h), previous(h), following(t), previous(t)):
        _rescore(task, side, cost_reduction)
        outside = mesh.twin[side]
        if outside != NONE:
            _rescore(task, following(outside), cost_reduction)
            _rescore(task, previous(outside), cost_reduction)


@generic
def _rescore_fans(task, h, cost_reduction):
    """Rescore the edges at, and opposite to, the corners of the diamond of `h`.

    Returns
    -------
    int
        What that costs: each score walks round such a corner again.
    """
    mesh, edges = task.mesh, 0
    t = np.int64(mesh.twin[h])
    for spoke in (h, previous(h), t, previous(t)):
        # A vertex of several fans has no curvature, but its faces still have the other corners.
        x = spoke
        while True:
            _rescore(task, x, cost_reduction)
            _rescore(task, previous(x), cost_reduction)
            _rescore(task, following(x), cost_reduction)
            edges += 3
            x = next_in_fan(mesh, x)
            if x == spoke:
                break
    return edges * edges // AROUND


@generic
def _rescore_opposite(task, spoke, v, cost_reduction):
    """Rescore the edge opposite to the origin of `spoke` if the apex on its other side is `v`."""
    side = following(spoke)
    outside = task.mesh.twin[side]
    if outside != NONE and apex(task.mesh, outside) == v:
        _rescore(task, side, cost_reduction)


@generic
def _rescore_freed(task, h, cost_reduction):
    """Rescore the edges whose flip was forbidden because it leads to i-j, which `h` was before.

    They lie opposite to i and to j, so it is enough to walk round one of both; as in `are_joined`
    both are walked in step. Where both have several fans, no edge can be flipped to i-j.
    """
    mesh = task.mesh
    a, b = previous(h), previous(mesh.twin[h])
    i, j = mesh.origin[a], mesh.origin[b]
    if mesh.several_fans[i] and mesh.several_fans[j]:
        return
    x, y = a, b
    while True:
        _rescore_opposite(task, x, j, cost_reduction)
        _rescore_opposite(task, y, i, cost_reduction)
        x, y = next_in_fan(mesh, x), next_in_fan(mesh, y)
        if (x == a and not mesh.several_fans[i]) or (y == b and not mesh.several_fans[j]):
            break


@jit
def _must_stay_away(task, h):
    """Tell whether the edge of `h` must not come back once flipped: the flip lowers no energy."""
    rules = task.rules
    if rules.is_potential:
        return False
    return not rules.monotone or willmore.cost_reduction(task.mesh, h) <= 2.0 * rules.tie


@jit
def _brings_back(task, h):
    """Tell whether the flip of `h` makes an edge that has to stay away."""
    mesh = task.mesh
    return contains(task.gone, apex(mesh, h), apex(mesh, mesh.twin[h]))


@jit
def _is_blocked(task, h):
    """Tell whether a new face would cut another one, and if so, wait until that changes."""
    if not task.space.active:
        return False
    face = cuts.blocker(task.mesh, task.space, h)
    if face == NONE:
        return False
    wait(task.waiting, h, face)
    return True


@generic
def _rescore_waiting(task, face, cost_reduction):
    """Rescore the edges that have waited for a change of `face`."""
    h = np.int64(task.waiting.first[face])
    while h != NONE:
        leave(task.waiting, h)
        _rescore(task, h, cost_reduction)
        h = np.int64(task.waiting.first[face])


@generic
def _flip(task, h, cost_reduction):
    """Flip `h`, bring everything up to date, and return about how many edges that has scored."""
    work = SCORES_PER_FLIP
    flip(task.mesh, h)
    if task.rules.is_wide:
        work += _rescore_fans(task, h, cost_reduction)
    else:
        _rescore_around(task, h, cost_reduction)
    _rescore_freed(task, h, cost_reduction)
    if task.space.active:
        spaces.follow(task.mesh, task.space, h)
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
                update(queue, h, rank(mesh, h, task.rules, cost_reduction))
        return stop, flips, gain, WORKING
    work = 0
    while work < SLICE:
        if queue.size[0] == 0:
            return scored, flips, gain, CONVERGED
        h = first(queue)
        keep_away = _must_stay_away(task, h)
        if (
            not makes_new_edge(mesh, h)
            or (keep_away and _brings_back(task, h))
            or _is_blocked(task, h)
        ):
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
    space : Space, optional
        The guard against self-intersections, up to date with the mesh, and so it stays. None: there
        is no such guard.

    Returns
    -------
    Progress
        Its state is `CONVERGED` or `STOPPED`.
    """
    space = spaces.no_space() if space is None else space
    waiting = nothing_waits(len(space.order))
    task = Task(mesh, empty_queue(len(mesh.origin)), no_pairs(), rules, space, waiting)
    progress = Progress(0, 0, 0.0, WORKING)
    while progress.state == WORKING:
        task = task._replace(gone=reserve(task.gone, SLICE // SCORES_PER_FLIP))
        progress = Progress(*kernel(task, progress))
    return progress
