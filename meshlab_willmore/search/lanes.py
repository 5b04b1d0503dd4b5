"""Drops of an energy for many edges at once, in vector instructions.

The coordinates that a flip looks at are gathered from all over the mesh into rows of one small
array, one lane an edge. On these the arithmetic runs without branches, calls and gathers, so that
the compiler does several lanes in one instruction. Each lane gets the bits that a single edge would
get: nothing is reordered.
"""

import numpy as np

from ..energy.angles import AngleSum
from ..energy.sides import Outside, Sides
from ..mesh.halfedge import NONE, Diamond
from ..mesh.jit import generic, inlined, inner
from ..mesh.points import Point

LANES = 64
# Rows: x, y, z of i, j, k, l and of the four points outside, whether these exist, the drop.
_OUTSIDE = 12
_EXISTS = 24
_DROP = 28
_ROWS = 31


# Unsigned, as an index must be to spare the question whether it counts from the end.
_ONE, _TWO, _THREE = np.uint64(1), np.uint64(2), np.uint64(3)


@inlined
def _following(h):
    return h - _TWO if h % _THREE == _TWO else h + _ONE


@inlined
def _previous(h):
    return h - _ONE if h % _THREE != np.uint64(0) else h + _TWO


@inlined
def _write(rows, row, lane, vertices, v):
    p = np.uint64(v)
    rows[np.uint64(row * LANES) + lane] = vertices[p, np.uint64(0)]
    rows[np.uint64((row + 1) * LANES) + lane] = vertices[p, _ONE]
    rows[np.uint64((row + 2) * LANES) + lane] = vertices[p, _TWO]


@inlined
def _write_outside(rows, place, lane, mesh, side):
    t = mesh.twin[side]
    exists = t != NONE
    rows[np.uint64((_EXISTS + place) * LANES) + lane] = 1.0 if exists else 0.0
    corner = _previous(np.uint64(t)) if exists else side
    _write(rows, _OUTSIDE + 3 * place, lane, mesh.vertices, mesh.origin[corner])


@inner
def empty_lanes():
    """Return rows for `LANES` edges."""
    return np.zeros(_ROWS * LANES)


@inlined
def fill(rows, place, mesh, half_edge):
    """Write what a flip of `half_edge`, which has a twin, looks at into lane `place` of `rows`."""
    lane, h = np.uint64(place), np.uint64(half_edge)
    t = np.uint64(mesh.twin[h])
    j_k, k_i, i_l, l_j = _following(h), _previous(h), _following(t), _previous(t)
    _write(rows, 0, lane, mesh.vertices, mesh.origin[h])
    _write(rows, 3, lane, mesh.vertices, mesh.origin[t])
    _write(rows, 6, lane, mesh.vertices, mesh.origin[k_i])
    _write(rows, 9, lane, mesh.vertices, mesh.origin[l_j])
    _write_outside(rows, 0, lane, mesh, j_k)
    _write_outside(rows, 1, lane, mesh, k_i)
    _write_outside(rows, 2, lane, mesh, i_l)
    _write_outside(rows, 3, lane, mesh, l_j)


@inlined
def _point(rows, row, lane):
    return Point(
        rows[row * LANES + lane], rows[(row + 1) * LANES + lane], rows[(row + 2) * LANES + lane]
    )


@inlined
def _quad(rows, lane):
    return Diamond(
        _point(rows, 0, lane), _point(rows, 3, lane), _point(rows, 6, lane), _point(rows, 9, lane)
    )


@inlined
def _outside(rows, place, lane):
    exists = rows[(_EXISTS + place) * LANES + lane] != 0.0
    return Outside(_point(rows, _OUTSIDE + 3 * place, lane), exists)


@inlined
def _sides(rows, lane):
    return Sides(
        _outside(rows, 0, lane),
        _outside(rows, 1, lane),
        _outside(rows, 2, lane),
        _outside(rows, 3, lane),
    )


@inlined
def copy_lane(rows, lane, others, place):
    """Write what stands in a lane of `rows` into lane `place` of `others`."""
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
        From `empty_lanes`, filled; changed in place. What stands in lanes that were not filled does
        no harm.
    drop : callable
        Jitted function of a Diamond and its Sides, as `meshlab_willmore.energy.willmore.drop`.
    """
    for lane in range(LANES):
        angles = drop(_quad(rows, lane), _sides(rows, lane))
        rows[_DROP * LANES + lane] = angles.r
        rows[(_DROP + 1) * LANES + lane] = angles.s
        rows[(_DROP + 2) * LANES + lane] = angles.half_turns


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
    """Tell whether a difference of two sums is more than nothing; not if it is undefined."""
    return angles.half_turns > 0.0 or (angles.half_turns == 0.0 and angles.s > 0.0)
