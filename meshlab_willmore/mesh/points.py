"""Points and vectors of space as small tuples of floats: Numba keeps them in registers."""

import math
from typing import NamedTuple

from .jit import at, inlined


class Point(NamedTuple):
    """A point, or the vector from one point to another."""

    x: float
    y: float
    z: float


@inlined
def point(vertices, v):
    """Return row `v` of the coordinates `vertices` (n, 3)."""
    row = at(v)
    return Point(vertices[row, 0], vertices[row, 1], vertices[row, 2])


@inlined
def coordinate(a, axis):
    """Return x, y or z of a point for the axis 0, 1 or 2."""
    if axis == 0:
        return a.x
    return a.y if axis == 1 else a.z


@inlined
def subtract(a, b):
    """Return the vector from `b` to `a`."""
    return Point(a.x - b.x, a.y - b.y, a.z - b.z)


@inlined
def add(a, b):
    """Return the sum of two vectors."""
    return Point(a.x + b.x, a.y + b.y, a.z + b.z)


@inlined
def from_middle(a, b, p):
    """Return the vector to `p` from the point halfway between `a` and `b`.

    That point itself is not formed: it would be rounded as coarsely as the coordinates are large,
    the differences are not.
    """
    a_p, b_p = subtract(p, a), subtract(p, b)
    return Point(0.5 * (a_p.x + b_p.x), 0.5 * (a_p.y + b_p.y), 0.5 * (a_p.z + b_p.z))


@inlined
def from_between(a, b, t, p):
    """Return the vector to `p` from the point ``a + t (b - a)``, with t in [0, 1].

    As in `from_middle`, with the same bits for t = 0.5, that point itself is not formed.
    """
    a_p, b_p = subtract(p, a), subtract(p, b)
    s = 1.0 - t
    return Point(s * a_p.x + t * b_p.x, s * a_p.y + t * b_p.y, s * a_p.z + t * b_p.z)


@inlined
def dot(a, b):
    """Return the scalar product."""
    return a.x * b.x + a.y * b.y + a.z * b.z


@inlined
def cross(a, b):
    """Return the vector product."""
    return Point(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


@inlined
def norm(a):
    """Return the length of the vector `a`."""
    return math.sqrt(dot(a, a))


@inlined
def normal(a, b, c):
    """Return the normal of the triangle (a, b, c); its length is twice the area."""
    return cross(subtract(b, a), subtract(c, a))


@inlined
def angle_between(a, b):
    """Return the angle between two vectors in [0, pi]; 0 where one of them is zero."""
    # With a zero vector the product may be -0.0, and the angle would be pi.
    return math.atan2(norm(cross(a, b)), dot(a, b) + 0.0)
