"""What flips gain, for many edges at once, for the greedy search in rounds.

For each energy `meshlab_willmore.search.compiled` makes a copy of one of these: `score_batches` for
energies with a function `drop`, `score_quickly` with `quick_reduction`, else `score_each`. The
first two gather the coordinates that flips look at from all over the mesh into the rows of one
small array, one lane an edge. On these the arithmetic runs without branches, calls and gathers, so
that the compiler does several lanes in one instruction. Each lane gets the bits that a single edge
would get: nothing is reordered.
"""

import math
from typing import NamedTuple

import numpy as np

from ..energy import willmore
from ..energy.angles import AngleSum, radians, rough
from ..energy.wings import Wing, Wings
from ..mesh import lanes
from ..mesh.halfedge import NONE, is_free
from ..mesh.jit import allocating_inner, at, generic, inlined, inner
from ..mesh.lanes import LANES, QUAD_ROWS, fill_quad, point_at, quad_at, write_point
from .containers import NEVER
from .costs import gain_of
from .rounds import forbid

# What ranks the edges, and whether the Willmore energy is asked too (None: it is not):
# `meshlab_willmore.search.compiled` puts the modules of each energy in these places.
energy, judge = willmore, None


@inner
def _note(state, h, gain, change):
    """Write down a cost reduction, and what the flip lowers the Willmore energy by."""
    rules, t = state.rules, state.mesh.twin[at(h)]
    is_allowed = gain > rules.tolerance and not (rules.monotone and change < -rules.tie)
    rank = np.rint(gain / rules.rank_step) if is_allowed else NEVER
    state.rank[at(h)] = state.rank[at(t)] = rank
    if is_allowed:
        state.gain[at(h)] = gain
        loses = not rules.monotone or change <= 2.0 * rules.tie
        state.is_tie[at(h)] = loses and not rules.is_potential


def score_each(state, start, stop):
    """Score the dirty edges from `start` up to `stop` one by one."""
    mesh, rules = state.mesh, state.rules
    for place in range(start, stop):
        h = state.dirty[at(place)]
        forbid(state, h)
        if is_free(mesh, h):
            gain = gain_of(energy.cost_reduction, mesh, h, rules.virtualpoint)
            if gain > rules.tolerance:
                change = willmore.cost_reduction(mesh, h) if rules.monotone else 0.0
                _note(state, h, gain, change)


# --- batches -------------------------------------------------------------------------------------


class Batch(NamedTuple):
    """Edges in lanes: the rows of `empty_rows`, the edge of each lane, half of its gain if known.

    Half of the gain is kept as what an `AngleSum` is made of, (LANES, 3): most are never needed.
    """

    rows: np.ndarray
    edges: np.ndarray
    gains: np.ndarray


@allocating_inner
def _empty_batch():
    return Batch(empty_rows(), np.empty(LANES, np.int32), np.empty((LANES, 3)))


@generic
def _rank_batch(state, batch, count, energy, judge, helpful, queued):
    """Score the first `count` edges of a batch; judge those that help, a batch at a time.

    Returns
    -------
    int
        How many are in the batch `helpful`; there were `queued`.
    """
    find_drops(batch.rows, energy.drop)
    for lane in range(count):
        angles = drop_at(batch.rows, lane)
        if not is_positive(angles):
            continue
        if judge is None:
            _note(state, batch.edges[lane], 2.0 * radians(angles), 0.0)
            continue
        copy_lane(batch.rows, lane, helpful.rows, queued)
        helpful.edges[queued], gain = batch.edges[lane], helpful.gains[queued]
        gain[0], gain[1], gain[2] = angles.r, angles.s, angles.half_turns
        queued += 1
        if queued == LANES:
            _judge_batch(state, helpful, queued, judge)
            queued = 0
    return queued


@generic
def _judge_batch(state, helpful, count, judge):
    """Note the first `count` edges of a batch, of which the gain is known."""
    find_drops(helpful.rows, judge.drop)
    for lane in range(count):
        change = 2.0 * rough(drop_at(helpful.rows, lane))
        if not (state.rules.monotone and change < -state.rules.tie):
            gain = helpful.gains[lane]
            total = AngleSum(gain[0], gain[1], gain[2])
            _note(state, helpful.edges[lane], 2.0 * radians(total), change)


def score_batches(state, start, stop):
    """Score the dirty edges from `start` up to `stop`, many at once."""
    _score_batches(state, start, stop, energy, judge, _empty_batch(), _empty_batch())


@generic
def _score_batches(state, start, stop, energy, judge, batch, helpful):
    """Score the dirty edges from `start` up to `stop`, with two empty batches."""
    # Of one type from the start, or the compiler would try several.
    count, queued = np.int64(0), np.int64(0)
    for place in range(start, stop):
        h = state.dirty[at(place)]
        forbid(state, h)
        if not is_free(state.mesh, h):
            continue
        fill(batch.rows, count, state.mesh, h)
        batch.edges[count] = h
        count += 1
        if count == LANES:
            queued = _rank_batch(state, batch, count, energy, judge, helpful, queued)
            count = 0
    queued = _rank_batch(state, batch, count, energy, judge, helpful, queued)
    if judge is not None:
        _judge_batch(state, helpful, queued, judge)


@generic
def _note_batch(state, batch, count, energy):
    """Note the first `count` edges of a batch; ask one by one of those that need a closer look."""
    find_reductions(batch.rows, energy.quick_reduction)
    rules = state.rules
    for lane in range(count):
        h, gain = batch.edges[lane], batch.rows[_DROP * LANES + lane]
        if not math.isfinite(gain):
            gain = energy.cost_reduction(state.mesh, h)
        if gain > rules.tolerance:
            change = willmore.cost_reduction(state.mesh, h) if rules.monotone else 0.0
            _note(state, h, gain, change)


def score_quickly(state, start, stop):
    """Score the dirty edges from `start` up to `stop`, most of them many at once."""
    _score_quickly(state, start, stop, energy, _empty_batch())


@generic
def _score_quickly(state, start, stop, energy, batch):
    """Score the dirty edges from `start` up to `stop`, with an empty batch."""
    count = np.int64(0)
    for place in range(start, stop):
        h = state.dirty[at(place)]
        forbid(state, h)
        if not is_free(state.mesh, h):
            continue
        fill_quad(batch.rows, count, state.mesh, h)
        if not state.rules.is_narrow:
            fill_wings(batch.rows, count, state.mesh, h)
        batch.edges[count] = h
        count += 1
        if count == LANES:
            _note_batch(state, batch, count, energy)
            count = 0
    _note_batch(state, batch, count, energy)


# --- rows and lanes ------------------------------------------------------------------------------

# Rows behind those of the diamond: x, y, z of the points outside, whether these exist, the drop.
_OUTSIDE = QUAD_ROWS
_EXISTS = 24
_DROP = 28
_ROWS = 31


@inlined
def _write_outside(rows, place, lane, mesh, side):
    t = mesh.twin[side]
    exists = t != NONE
    rows[np.uint64((_EXISTS + place) * LANES) + lane] = 1.0 if exists else 0.0
    corner = lanes.previous(np.uint64(t)) if exists else side
    write_point(rows, _OUTSIDE + 3 * place, lane, mesh.vertices, mesh.origin[corner])


@allocating_inner
def empty_rows():
    """Return rows for `LANES` edges."""
    return np.zeros(_ROWS * LANES)


@inlined
def fill_wings(rows, place, mesh, half_edge):
    """Write the wings of the diamond of `half_edge`, which has a twin, into lane `place`."""
    lane, h = np.uint64(place), np.uint64(half_edge)
    t = np.uint64(mesh.twin[h])
    _write_outside(rows, 0, lane, mesh, lanes.following(h))
    _write_outside(rows, 1, lane, mesh, lanes.previous(h))
    _write_outside(rows, 2, lane, mesh, lanes.following(t))
    _write_outside(rows, 3, lane, mesh, lanes.previous(t))


@inlined
def fill(rows, place, mesh, half_edge):
    """Write what the flip of `half_edge`, which has a twin, looks at into lane `place`."""
    fill_quad(rows, place, mesh, half_edge)
    fill_wings(rows, place, mesh, half_edge)


@inlined
def _wing(rows, place, lane):
    exists = rows[(_EXISTS + place) * LANES + lane] != 0.0
    return Wing(point_at(rows, _OUTSIDE + 3 * place, lane), exists)


@inlined
def _wings(rows, lane):
    return Wings(
        _wing(rows, 0, lane),
        _wing(rows, 1, lane),
        _wing(rows, 2, lane),
        _wing(rows, 3, lane),
    )


@inlined
def copy_lane(rows, lane, others, place):
    """Copy a lane of `rows` to lane `place` of `others`."""
    source, target = np.uint64(lane), np.uint64(place)
    for row in range(_DROP):
        first = np.uint64(row * LANES)
        others[first + target] = rows[first + source]


@generic
def find_drops(rows, drop):
    """Write the drop of each lane into the last three rows.

    Parameters
    ----------
    rows : (rows,) float64
        From `empty_rows`, filled; changed in place. Lanes that were not filled do no harm.
    drop : callable
        Jitted function of a Diamond and its Wings, as `meshlab_willmore.energy.willmore.drop`.
    """
    for lane in range(LANES):
        angles = drop(quad_at(rows, lane), _wings(rows, lane))
        rows[_DROP * LANES + lane] = angles.r
        rows[(_DROP + 1) * LANES + lane] = angles.s
        rows[(_DROP + 2) * LANES + lane] = angles.half_turns


@generic
def find_reductions(rows, quick_reduction):
    """Write the cost reduction of each lane, or NaN, into the first of the last three rows.

    Parameters
    ----------
    rows : (rows,) float64
        From `empty_rows`, filled; changed in place. Lanes that were not filled do no harm.
    quick_reduction : callable
        Jitted function of a Diamond and its Wings.
    """
    for lane in range(LANES):
        rows[_DROP * LANES + lane] = quick_reduction(quad_at(rows, lane), _wings(rows, lane))


@inlined
def drop_at(rows, lane):
    """Return the drop that `find_drops` has found for a lane, as an AngleSum."""
    return AngleSum(
        rows[_DROP * LANES + lane],
        rows[(_DROP + 1) * LANES + lane],
        rows[(_DROP + 2) * LANES + lane],
    )


@inlined
def is_positive(angles):
    """Whether a difference of two sums of angles is positive; not if it is undefined."""
    return angles.half_turns > 0.0 or (angles.half_turns == 0.0 and angles.s > 0.0)
