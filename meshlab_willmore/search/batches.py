"""Scores for the greedy search in rounds: the rank of each edge of a list, many at a time."""

import numpy as np

from ..energy import willmore
from ..energy.angles import radians
from ..mesh.halfedge import is_free
from ..mesh.jit import at, generic, jit
from .board import forbid
from .heap import NEVER
from .lanes import JUDGE, LANES, RANKING, drop_at, empty_lanes, fill, find_drops, is_positive
from .scoring import gain_of


@jit
def _note(board, h, gain, change):
    """Write down a cost reduction, and what the flip lowers the Willmore energy by."""
    rules, t = board.rules, board.mesh.twin[at(h)]
    is_allowed = gain > rules.tolerance and not (rules.monotone and change < -rules.tie)
    rank = np.rint(gain / rules.rank_step) if is_allowed else NEVER
    board.rank[at(h)] = board.rank[at(t)] = rank
    if is_allowed:
        board.gain[at(h)] = gain
        loses = not rules.monotone or change <= 2.0 * rules.tie
        board.is_tie[at(h)] = loses and not rules.is_potential


@generic
def score_each(board, start, stop, cost_reduction):
    """Score the touched edges from `start` up to `stop` one by one.

    `cost_reduction` is a jitted function as `gain_of` takes it.
    """
    mesh, rules = board.mesh, board.rules
    for place in range(start, stop):
        h = board.touched[at(place)]
        forbid(board, h)
        if is_free(mesh, h):
            gain = gain_of(cost_reduction, mesh, h, rules)
            if gain > rules.tolerance:
                change = willmore.cost_reduction(mesh, h) if rules.monotone else 0.0
                _note(board, h, gain, change)


@generic
def _score_lanes(board, rows, edges, count, drop, judge):
    """Score the `count` edges that were filled into the lanes."""
    find_drops(rows, drop, RANKING)
    if judge is not None:
        find_drops(rows, judge, JUDGE)
    for lane in range(count):
        angles = drop_at(rows, RANKING, lane)
        if not is_positive(angles):
            continue
        change = 0.0
        if judge is not None:
            change = 2.0 * radians(drop_at(rows, JUDGE, lane))
        _note(board, edges[lane], 2.0 * radians(angles), change)


@generic
def score_in_lanes(board, start, stop, drop, judge):
    """Score the touched edges from `start` up to `stop`, many at once.

    Parameters
    ----------
    board : Board
    start, stop : int
    drop, judge : callable
        What half of the cost reduction is, and half of what the Willmore energy drops by, as
        `meshlab_willmore.energy.willmore.drop`. A judge of None: nothing is asked of that.
    """
    rows, edges, count = empty_lanes(), np.empty(LANES, np.int32), 0
    for place in range(start, stop):
        h = board.touched[at(place)]
        forbid(board, h)
        if not is_free(board.mesh, h):
            continue
        fill(rows, count, board.mesh, h)
        edges[count] = h
        count += 1
        if count == LANES:
            _score_lanes(board, rows, edges, count, drop, judge)
            count = 0
    if count:
        _score_lanes(board, rows, edges, count, drop, judge)
