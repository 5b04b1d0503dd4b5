"""MeshLab's own float predicates, so that the number of faces that *it* counts never grows.

MeshLab finds self-intersections with rounded arithmetic. Faces in nearly the same plane confuse its
tests: about one in thirty of a tilted flat mesh is counted, although none intersects another. So
the guard refuses a flip if either the exact tests or these say that faces intersect. They follow
MeshLab step by step:

- no common vertex: T. Möller, "A fast triangle-triangle intersection test", 1997, DOI
  10.1080/10867651.1997.10487472, without its tolerance;
- one: the side opposite to it, moved halfway towards it, by T. Möller and B. Trumbore, "Fast,
  minimum storage ray/triangle intersection", 1997, DOI 10.1080/10867651.1997.10487468;
- two: never.

MeshLab's further conditions are left out, so that the answer is yes at least as often as there.

MeshLab tests a pair of faces once, the lower number first, but in a process that has run many
filters in both orders: a run marks faces by one of 32 bits, some filters never release theirs, and
without a bit it does not know which pairs it has tested. So the guard tests both orders too.

Coordinates scaled by a power of two give the same answers, but for one absolute limit.
"""

from ..mesh.jit import inner
from ..mesh.points import Point, coordinate, cross, dot, norm, subtract

# MeshLab's limit for determinants, in squared units of the coordinates, and for weights.
LIMIT = 1e-6
HALF = 0.5
# `side_meets` says yes only if the segment and the triangle, no side of which is longer than x,
# come nearer to each other than ROUNDING_OF_POINTS + ROUNDING_OF_AREAS * area_scale * x**3. For the
# weights and the distance that it computes are those of a point up to some 12 roundings of their
# numerators (products of lengths) and of the determinant, over the determinant, which is at least
# LIMIT / area_scale: in all 72 * 1.2e-16 / LIMIT. The points halfway are rounded by themselves.
ROUNDING_OF_AREAS = 1e-7
ROUNDING_OF_POINTS = 1e-14


@inner
def _unit(a):
    length = norm(a)
    if length > 0.0:
        return Point(a.x / length, a.y / length, a.z / length)
    return a


@inner
def _distances(n, offset, a, b, c):
    return Point(dot(n, a) + offset, dot(n, b) + offset, dot(n, c) + offset)


@inner
def _is_on_one_side(distances):
    return distances.x * distances.y > 0.0 and distances.x * distances.z > 0.0


@inner
def _is_coplanar(distances):
    return distances.x == 0.0 and distances.y == 0.0 and distances.z == 0.0


@inner
def _longest_axis(d):
    """Return the axis of the largest component, the first one of equals."""
    x, y, z = abs(d.x), abs(d.y), abs(d.z)
    if y > x:
        return 2 if z > y else 1
    return 2 if z > x else 0


@inner
def _interval(a, b, c, distances):
    """Return the two ends of a triangle on the line of both planes, as start, rises and drops.

    `a`, `b`, `c` are its corners along the line. It is left from the corner that is alone on its
    side of the plane, and each end is start + rise / drop.
    """
    x, y, z = distances.x, distances.y, distances.z
    if x * y > 0.0:
        return c, (a - c) * z, (b - c) * z, z - x, z - y
    if x * z > 0.0:
        return b, (a - b) * y, (c - b) * y, y - x, y - z
    if y * z > 0.0 or x != 0.0:
        return a, (b - a) * x, (c - a) * x, x - y, x - z
    if y != 0.0:
        return b, (a - b) * y, (c - b) * y, y - x, y - z
    return c, (a - c) * z, (b - c) * z, z - x, z - y


@inner
def triangles_meet(a, b, c, p, q, r):
    """Whether MeshLab says that two triangles without a common vertex meet.

    The answer depends, by rounding, on which comes first and on the order of the corners.
    """
    n = _unit(cross(subtract(b, a), subtract(c, a)))
    from_first = _distances(n, -dot(n, a), p, q, r)
    if _is_on_one_side(from_first):
        return False
    m = cross(subtract(q, p), subtract(r, p))
    from_second = _distances(m, -dot(m, p), a, b, c)
    if _is_on_one_side(from_second):
        return False
    if _is_coplanar(from_second) or _is_coplanar(from_first):
        return _coplanar_meet(n, (a, b, c), (p, q, r))
    axis = _longest_axis(cross(n, m))
    start, rise, other_rise, drop, other_drop = _interval(
        coordinate(a, axis), coordinate(b, axis), coordinate(c, axis), from_second
    )
    begin, climb, other_climb, fall, other_fall = _interval(
        coordinate(p, axis), coordinate(q, axis), coordinate(r, axis), from_first
    )
    # All four ends times all four drops, instead of divisions.
    drops, falls = drop * other_drop, fall * other_fall
    both = drops * falls
    one, two = start * both + rise * other_drop * falls, start * both + other_rise * drop * falls
    three = begin * both + climb * drops * other_fall
    four = begin * both + other_climb * drops * fall
    return not (max(one, two) < min(three, four) or max(three, four) < min(one, two))


@inner
def _projected(a, axis):
    """Return the other two coordinates of a point."""
    if axis == 0:
        return a.y, a.z
    return (a.x, a.z) if axis == 1 else (a.x, a.y)


@inner
def _dropped_axis(n):
    x, y, z = abs(n.x), abs(n.y), abs(n.z)
    if x > y:
        return 0 if x > z else 2
    return 1 if z <= y else 2


@inner
def _sides_meet(a, b, p, q):
    """Whether two segments of the plane meet (F. Antonio, Graphics Gems III, 1992)."""
    ax, ay = b[0] - a[0], b[1] - a[1]
    bx, by = p[0] - q[0], p[1] - q[1]
    cx, cy = a[0] - p[0], a[1] - p[1]
    whole, part = ay * bx - ax * by, by * cx - bx * cy
    if whole > 0.0 and 0.0 <= part <= whole:
        return 0.0 <= ax * cy - ay * cx <= whole
    if whole < 0.0 and whole <= part <= 0.0:
        return whole <= ax * cy - ay * cx <= 0.0
    return False


@inner
def _side_of_line(p, a, b):
    x, y = b[1] - a[1], -(b[0] - a[0])
    return x * p[0] + y * p[1] + (-x * a[0] - y * a[1])


@inner
def _is_inside(p, a, b, c):
    first = _side_of_line(p, a, b)
    return first * _side_of_line(p, b, c) > 0.0 and first * _side_of_line(p, c, a) > 0.0


@inner
def _coplanar_meet(n, one, other):
    """Whether two triangles in the plane with the normal `n` meet."""
    axis = _dropped_axis(n)
    a, b, c = _projected(one[0], axis), _projected(one[1], axis), _projected(one[2], axis)
    p, q, r = _projected(other[0], axis), _projected(other[1], axis), _projected(other[2], axis)
    for s, t in ((a, b), (b, c), (c, a)):
        if _sides_meet(s, t, p, q) or _sides_meet(s, t, q, r) or _sides_meet(s, t, r, p):
            return True
    return _is_inside(a, p, q, r) or _is_inside(p, a, b, c)


@inner
def _halfway(s, a):
    return Point(a.x * HALF + s.x * HALF, a.y * HALF + s.y * HALF, a.z * HALF + s.z * HALF)


@inner
def side_meets(s, p, q, a, b, c, area_scale):
    """Whether MeshLab says that the side p-q opposite to `s` meets a triangle that has `s`.

    Parameters
    ----------
    s, p, q, a, b, c : Point
        Corners, each face's in their order round it; one of a, b, c is s.
    area_scale : float
        Area in squared units of the coordinates of what has the area 1 here.
    """
    start, end = _halfway(s, p), _halfway(s, q)
    direction = _unit(subtract(end, start))
    first, second = subtract(b, a), subtract(c, a)
    across = cross(direction, second)
    whole = dot(first, across)
    if not abs(whole) * area_scale > LIMIT:
        return False
    offset = subtract(start, a)
    turned = cross(offset, first)
    u, v = dot(offset, across), dot(direction, turned)
    inverse = 1.0 / whole
    distance = dot(second, turned) * inverse
    u, v = u * inverse, v * inverse
    if not (u > LIMIT and v > LIMIT and u + v < 1.0):
        return False
    return 0.0 <= distance <= norm(subtract(start, end))
