"""Exact intersection tests of two triangles, also of triangles without area.

Faces of a mesh intersect if they share a point that their common vertices do not account for:

    no common vertex    any point at all; to touch is to intersect
    one                 any point besides that vertex
    two                 any point besides their edge: one is folded back onto the other
    three               always

Vertices are common by number: coincident ones are two. All cases are reduced to whether a closed
segment meets a closed triangle, either of which may be degenerate.

Coplanar points are compared by their projections along the three axes. At least one of these
projections is one-to-one; the others can only make things meet that do not, and make orientations
vanish. So coplanar segments meet where all their projections do, and an orientation counts if any
projection has it.
"""

from ..mesh.jit import inlined, inner
from ..mesh.points import Point, add, coordinate, norm, subtract
from .predicates import orient3d, projected_orient2d

AXES = 3
# A scalar product of rounded differences is off by less than this part of the sum of sizes, and a
# float that is far above those that have lost digits.
BOUND_PRODUCT, LEAST = 1e-15, 1e-290


@inner
def _coincide(a, b):
    return a.x == b.x and a.y == b.y and a.z == b.z


@inner
def _are_collinear(a, b, c):
    return (
        projected_orient2d(a, b, c, 0) == 0
        and projected_orient2d(a, b, c, 1) == 0
        and projected_orient2d(a, b, c, 2) == 0
    )


@inner
def _is_between(p, a, b):
    """Whether `p` is on the closed segment from `a` to `b`."""
    return (
        min(a.x, b.x) <= p.x <= max(a.x, b.x)
        and min(a.y, b.y) <= p.y <= max(a.y, b.y)
        and min(a.z, b.z) <= p.z <= max(a.z, b.z)
        and _are_collinear(p, a, b)
    )


@inner
def _spans_overlap(p, q, a, b, axis):
    p, q = coordinate(p, axis), coordinate(q, axis)
    a, b = coordinate(a, axis), coordinate(b, axis)
    return max(p, q) >= min(a, b) and max(a, b) >= min(p, q)


@inner
def _projections_meet(p, q, a, b, axis):
    """Whether the projections of two segments along `axis` share a point."""
    if not (
        _spans_overlap(p, q, a, b, (axis + 1) % AXES)
        and _spans_overlap(p, q, a, b, (axis + 2) % AXES)
    ):
        return False
    # With overlapping boxes also right where all four orientations are 0.
    return (
        projected_orient2d(p, q, a, axis) * projected_orient2d(p, q, b, axis) <= 0
        and projected_orient2d(a, b, p, axis) * projected_orient2d(a, b, q, axis) <= 0
    )


@inner
def segments_meet(p, q, a, b):
    """Whether the closed segments p-q and a-b share a point."""
    for axis in range(AXES):
        if not _projections_meet(p, q, a, b, axis):
            return False
    return orient3d(p, q, a, b) == 0


@inner
def _is_inside(p, a, b, c):
    """Whether `p`, in a plane with the triangle, is in its interior."""
    for axis in range(AXES):
        first = projected_orient2d(a, b, p, axis)
        if (
            first != 0
            and projected_orient2d(b, c, p, axis) == first
            and projected_orient2d(c, a, p, axis) == first
        ):
            return True
    return False


@inner
def segment_meets_triangle(p, q, a, b, c):
    """Whether the closed segment p-q and the closed triangle (a, b, c) share a point."""
    at_p, at_q = orient3d(a, b, c, p), orient3d(a, b, c, q)
    if at_p * at_q > 0:
        return False
    if at_p == 0 and at_q == 0:
        return (
            _is_inside(p, a, b, c)
            or segments_meet(p, q, a, b)
            or segments_meet(p, q, b, c)
            or segments_meet(p, q, c, a)
        )
    # The line crosses the plane at one point, inside if it passes all sides on the same side.
    first, second, third = orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a)
    return min(first, second, third) >= 0 or max(first, second, third) <= 0


@inner
def _are_on_one_side(a, b, c, p, q, r):
    """Whether p, q, r are strictly on one side of the plane of (a, b, c)."""
    first = orient3d(a, b, c, p)
    return first != 0 and orient3d(a, b, c, q) == first and orient3d(a, b, c, r) == first


@inner
def triangles_meet(a, b, c, p, q, r):
    """Whether two closed triangles share a point.

    If they do, a side of one of them meets the other.
    """
    if _are_on_one_side(a, b, c, p, q, r) or _are_on_one_side(p, q, r, a, b, c):
        return False
    return (
        segment_meets_triangle(p, q, a, b, c)
        or segment_meets_triangle(q, r, a, b, c)
        or segment_meets_triangle(r, p, a, b, c)
        or segment_meets_triangle(a, b, p, q, r)
        or segment_meets_triangle(b, c, p, q, r)
        or segment_meets_triangle(c, a, p, q, r)
    )


@inner
def _meet_off_vertex(s, a, b, c, d):
    """Do what `meet_off_vertex` does for sides a-b and c-d that `s` is not on.

    A common segment from s ends where it leaves one of the two: there, a side meets the other.
    """
    # With both ends strictly on one side of the other's plane, s is all that there is.
    at_a, at_b = orient3d(s, c, d, a), orient3d(s, c, d, b)
    if at_a * at_b > 0:
        return False
    at_c, at_d = orient3d(s, a, b, c), orient3d(s, a, b, d)
    if at_c * at_d > 0:
        return False
    return segment_meets_triangle(a, b, s, c, d) or segment_meets_triangle(c, d, s, a, b)


@inlined
def _is_surely_ahead(w, a, least):
    """Whether the product of `w` and `a`, a rounded difference, is more than `least` >= 0.

    True only where no rounding can be the cause.
    """
    x, y, z = w.x * a.x, w.y * a.y, w.z * a.z
    return x + y + z > BOUND_PRODUCT * (abs(x) + abs(y) + abs(z)) + least


@inlined
def _extent(a):
    return abs(a.x) + abs(a.y) + abs(a.z)


@inlined
def are_separated(s, a, b, m, c, d, limit, share):
    """Whether a certain plane through `s` clearly has a, b, m on one side and c, d on the other.

    It bisects the angle between the middles of a-b and c-d, and separates nearly all neighbours
    round a vertex. The five points must be farther from it than `limit`, and
    than `share` times the third power of what bounds the sides of the triangles of s and two of
    them on one side.
    """
    a, b, m = subtract(a, s), subtract(b, s), subtract(m, s)
    c, d = subtract(c, s), subtract(d, s)
    one, other = add(a, b), add(c, d)
    size, other_size = norm(one), norm(other)
    w = Point(
        one.x * other_size - other.x * size,
        one.y * other_size - other.y * size,
        one.z * other_size - other.z * size,
    )
    extent = _extent(a) + _extent(b) + _extent(m) + _extent(c) + _extent(d)
    # The length of w is at most the product of the sizes times 2.
    least = (limit + share * extent * extent * extent) * 2.0 * size * other_size + LEAST
    back = Point(-w.x, -w.y, -w.z)
    return (
        _is_surely_ahead(w, a, least)
        & _is_surely_ahead(w, b, least)
        & _is_surely_ahead(w, m, least)
        & _is_surely_ahead(back, c, least)
        & _is_surely_ahead(back, d, least)
    )


@inner
def meet_off_vertex(s, a, b, c, d):
    """Whether the triangles (s, a, b) and (s, c, d) share a point besides `s`."""
    # A triangle with s on its far side is two segments from s.
    one_is_flat, other_is_flat = _is_between(s, a, b), _is_between(s, c, d)
    for first in range(2 if one_is_flat else 1):
        for second in range(2 if other_is_flat else 1):
            one, two, three, four = a, b, c, d
            if one_is_flat:
                one = two = a if first == 0 else b
            if other_is_flat:
                three = four = c if second == 0 else d
            if _coincide(one, two) and _coincide(one, s):
                continue
            if _coincide(three, four) and _coincide(three, s):
                continue
            if _meet_off_vertex(s, one, two, three, four):
                return True
    return False


@inner
def _are_beyond(s, t, a, b):
    """Whether `a` and `b`, on the line of `s` and `t`, are both beyond `t`."""
    for axis in range(AXES):
        x, y = coordinate(s, axis), coordinate(t, axis)
        one, other = coordinate(a, axis), coordinate(b, axis)
        if (x < y and one > y and other > y) or (x > y and one < y and other < y):
            return True
    return False


@inner
def meet_off_edge(s, t, a, b):
    """Whether the triangles (s, t, a) and (s, t, b) share a point off the segment s-t."""
    if orient3d(s, t, a, b) != 0:
        return False
    for axis in range(AXES):
        if projected_orient2d(s, t, a, axis) * projected_orient2d(s, t, b, axis) > 0:
            return True
    if _coincide(s, t):
        return meet_off_vertex(s, a, a, b, b)
    if _are_collinear(s, t, a) and _are_collinear(s, t, b):
        return _are_beyond(s, t, a, b) or _are_beyond(t, s, a, b)
    return False
