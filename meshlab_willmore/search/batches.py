"""Scores for the greedy search in rounds: the rank of each edge of a list, many at a time."""

from typing import NamedTuple

import numpy as np

from ..energy import willmore
from ..energy.angles import AngleSum, radians, rough
from ..mesh.halfedge import is_free
from ..mesh.jit import at, generic, inner
from .board import forbid
from .heap import NEVER
from .lanes import LANES, copy_lane, drop_at, empty_lanes, fill, find_drops, is_positive
from .scoring import gain_of


@inner
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


class Batch(NamedTuple):
    """Edges in lanes: the rows of `empty_lanes`, the edge of each lane, half of its gain if known.

    Half of the gain is kept as what an `AngleSum` is made of, (LANES, 3): most are never needed.
    """

    rows: np.ndarray
    edges: np.ndarray
    gains: np.ndarray


@inner
def _empty_batch():
    return Batch(empty_lanes(), np.empty(LANES, np.int32), np.empty((LANES, 3)))


@generic
def _rank_batch(board, batch, count, drop, judge, helpful, waiting):
    """Score the first `count` edges of a batch; judge those that help once a batch of them waits.

    Returns
    -------
    int
        How many wait, in the batch `helpful`; there were `waiting`.
    """
    find_drops(batch.rows, drop)
    for lane in range(count):
        angles = drop_at(batch.rows, lane)
        if not is_positive(angles):
            continue
        if judge is None:
            _note(board, batch.edges[lane], 2.0 * radians(angles), 0.0)
            continue
        copy_lane(batch.rows, lane, helpful.rows, waiting)
        helpful.edges[waiting], gain = batch.edges[lane], helpful.gains[waiting]
        gain[0], gain[1], gain[2] = angles.r, angles.s, angles.half_turns
        waiting += 1
        if waiting == LANES:
            _judge_batch(board, helpful, waiting, judge)
            waiting = 0
    return waiting


@generic
def _judge_batch(board, helpful, count, judge):
    """Note the first `count` edges of a batch, of which the gain is known."""
    find_drops(helpful.rows, judge)
    for lane in range(count):
        change = 2.0 * rough(drop_at(helpful.rows, lane))
        if not (board.rules.monotone and change < -board.rules.tie):
            gain = helpful.gains[lane]
            total = AngleSum(gain[0], gain[1], gain[2])
            _note(board, helpful.edges[lane], 2.0 * radians(total), change)


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
    batch, helpful = _empty_batch(), _empty_batch()
    # Of one type from the start, or the compiler would try several.
    count, waiting = np.int64(0), np.int64(0)
    for place in range(start, stop):
        h = board.touched[at(place)]
        forbid(board, h)
        if not is_free(board.mesh, h):
            continue
        fill(batch.rows, count, board.mesh, h)
        batch.edges[count] = h
        count += 1
        if count == LANES:
            waiting = _rank_batch(board, batch, count, drop, judge, helpful, waiting)
            count = 0
    waiting = _rank_batch(board, batch, count, drop, judge, helpful, waiting)
    if judge is not None:
        _judge_batch(board, helpful, waiting, judge)
