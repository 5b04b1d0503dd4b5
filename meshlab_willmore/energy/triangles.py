"""Triangles as the energies see them: areas, angles between sides, and corners that coincide."""

import math

from ..mesh.jit import inlined, inner
from ..mesh.points import cross, dot, norm, point
from ..mesh.rounding import good_normal
from .angles import ComplexAngle

# A difference of sums below this part of them is made of rounding. The faces themselves say how
# much that is: beside a small part there may be a huge one.
ROUNDING = 1e-13


@inlined
def without_rounding(gain, size):
    """Return a difference of two sums that are `size` in all; 0 if it is made of rounding."""
    return 0.0 if abs(gain) <= ROUNDING * size else gain


@inner
def drop_of(before, after):
    """Return ``before - after``, two sums over faces: 0 if it is rounding, -inf if not finite."""
    gain = without_rounding(before - after, before + after)
    return gain if math.isfinite(gain) else -math.inf


@inner
def corners(mesh, f):
    """Return the three points of the face `f`."""
    return (
        point(mesh.vertices, mesh.origin[3 * f]),
        point(mesh.vertices, mesh.origin[3 * f + 1]),
        point(mesh.vertices, mesh.origin[3 * f + 2]),
    )


@inner
def twice_area(a, b, c):
    """Return twice the area of a triangle; of a thin one, too, all digits are good."""
    return norm(good_normal(a, b, c)[0])


@inner
def complex_angle_between(a, b):
    """Return the angle between two vectors as a ComplexAngle of length 1; 0 if one is zero."""
    r, normal = dot(a, b), cross(a, b)
    s2 = dot(normal, normal)
    size = math.sqrt(r * r + s2)
    if not size > 0.0:
        return ComplexAngle(1.0, 0.0)
    return ComplexAngle(r / size, math.sqrt(s2) / size)


@inner
def _coincide(a, b):
    return a.x == b.x and a.y == b.y and a.z == b.z


@inner
def has_coincident_corners(quad):
    """Whether two corners of the diamond are the same point: no energy judges such a flip."""
    i, j, k, l = quad
    ends = _coincide(i, j) or _coincide(k, l)
    return ends or _coincide(i, k) or _coincide(i, l) or _coincide(j, k) or _coincide(j, l)
