"""Lanes: the points that many edges look at, side by side, for vector instructions.

Points are gathered from all over the mesh into the rows of one small array, one lane an edge or a
face. On these the arithmetic runs without branches, calls and gathers, so that the compiler does
several lanes in one instruction. One array, since it would have to ask of several whether they
overlap.
"""

import numpy as np

from .halfedge import Diamond
from .jit import inlined
from .points import Point

LANES = 64
# Rows of a diamond: x, y, z of i, j, k, l.
QUAD_ROWS = 12
# Unsigned, as an index must be to spare the question whether it counts from the end.
_ONE, _TWO, _THREE = np.uint64(1), np.uint64(2), np.uint64(3)


@inlined
def following(h):
    """Return the next half-edge of the face, as an unsigned number as `h` is."""
    return h - _TWO if h % _THREE == _TWO else h + _ONE


@inlined
def previous(h):
    """Return the previous half-edge of the face, as an unsigned number as `h` is."""
    return h - _ONE if h % _THREE != np.uint64(0) else h + _TWO


@inlined
def write_point(rows, row, lane, vertices, v):
    """Write the vertex `v` into three rows, from `row` on, of an unsigned lane."""
    p = np.uint64(v)
    rows[np.uint64(row * LANES) + lane] = vertices[p, np.uint64(0)]
    rows[np.uint64((row + 1) * LANES) + lane] = vertices[p, _ONE]
    rows[np.uint64((row + 2) * LANES) + lane] = vertices[p, _TWO]


@inlined
def fill_quad(rows, place, mesh, half_edge):
    """Write the diamond of `half_edge`, which has a twin, into lane `place`."""
    lane, h = np.uint64(place), np.uint64(half_edge)
    t = np.uint64(mesh.twin[h])
    write_point(rows, 0, lane, mesh.vertices, mesh.origin[h])
    write_point(rows, 3, lane, mesh.vertices, mesh.origin[t])
    write_point(rows, 6, lane, mesh.vertices, mesh.origin[previous(h)])
    write_point(rows, 9, lane, mesh.vertices, mesh.origin[previous(t)])


@inlined
def point_at(rows, row, lane):
    """Return the point in three rows, from `row` on, of a lane."""
    return Point(
        rows[row * LANES + lane], rows[(row + 1) * LANES + lane], rows[(row + 2) * LANES + lane]
    )


@inlined
def quad_at(rows, lane):
    """Return the diamond of a lane."""
    return Diamond(
        point_at(rows, 0, lane),
        point_at(rows, 3, lane),
        point_at(rows, 6, lane),
        point_at(rows, 9, lane),
    )
