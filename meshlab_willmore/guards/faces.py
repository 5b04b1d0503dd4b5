"""Whether two faces of a mesh cut each other, given what vertices they have in common."""

from typing import NamedTuple

from ..mesh.jit import inner
from ..mesh.points import Point, point
from . import rounded, triangles

CORNERS = 3
NOWHERE = -1


class Face(NamedTuple):
    """A face with the vertices u, v, w at the points a, b, c."""

    u: int
    v: int
    w: int
    a: Point
    b: Point
    c: Point


@inner
def face_of(vertices, u, v, w):
    """Return the face with the corners u, v, w, rows of `vertices` (n, 3)."""
    return Face(u, v, w, point(vertices, u), point(vertices, v), point(vertices, w))


@inner
def from_corner(face, corner):
    """Return the same face, read from another corner on."""
    if corner == 0:
        return face
    if corner == 1:
        return Face(face.v, face.w, face.u, face.b, face.c, face.a)
    return Face(face.w, face.u, face.v, face.c, face.a, face.b)


@inner
def _place(face, u):
    """Return which corner of the face is vertex `u`, or `NOWHERE`."""
    if face.u == u:
        return 0
    if face.v == u:
        return 1
    return 2 if face.w == u else NOWHERE


class Match(NamedTuple):
    """How many vertices two faces share, and a corner of each.

    One shared: the corners that it is at. Two shared: the corners that are left over.
    """

    shared: int
    corner: int
    other: int


@inner
def match(one, other):
    """Return the common vertices of two faces."""
    u, v, w = _place(other, one.u), _place(other, one.v), _place(other, one.w)
    if u == NOWHERE and v == NOWHERE and w == NOWHERE:
        return Match(0, NOWHERE, NOWHERE)
    count = (u != NOWHERE) + (v != NOWHERE) + (w != NOWHERE)
    if count == 1:
        if u != NOWHERE:
            return Match(1, 0, u)
        return Match(1, 1, v) if v != NOWHERE else Match(1, 2, w)
    if count == 2:
        left = 0 if u == NOWHERE else 1 if v == NOWHERE else 2
        return Match(2, left, CORNERS - (u + v + w - NOWHERE))
    return Match(CORNERS, NOWHERE, NOWHERE)


@inner
def cut_exactly(one, other, common):
    """Tell whether two faces cut each other; `common` is their match."""
    if common.shared == 0:
        return triangles.triangles_meet(one.a, one.b, one.c, other.a, other.b, other.c)
    if common.shared == CORNERS:
        return True
    p, q = from_corner(one, common.corner), from_corner(other, common.other)
    if common.shared == 1:
        return triangles.meet_besides(p.a, p.b, p.c, q.b, q.c)
    return triangles.meet_beyond(p.b, p.c, p.a, q.a)


@inner
def _spans_touch_at_most(a, b, c, p, q, r):
    return max(a, b, c) <= min(p, q, r) or max(p, q, r) <= min(a, b, c)


@inner
def _boxes_touch_at_most(one, other):
    """Tell whether the boxes of two faces have no interior point in common."""
    a, b, c, p, q, r = one.a, one.b, one.c, other.a, other.b, other.c
    return (
        _spans_touch_at_most(a.x, b.x, c.x, p.x, q.x, r.x)
        or _spans_touch_at_most(a.y, b.y, c.y, p.y, q.y, r.y)
        or _spans_touch_at_most(a.z, b.z, c.z, p.z, q.z, r.z)
    )


@inner
def count_as_cut(one, other, common, area_scale):
    """Tell whether MeshLab may count two faces as cut, whichever it looks at first.

    See `meshlab_willmore.guards.rounded` for the area scale.
    """
    if common.shared == 2 or _boxes_touch_at_most(one, other):
        return False
    if common.shared == 0:
        return rounded.triangles_meet(
            one.a, one.b, one.c, other.a, other.b, other.c
        ) or rounded.triangles_meet(other.a, other.b, other.c, one.a, one.b, one.c)
    if common.shared == CORNERS:
        return True
    p, q = from_corner(one, common.corner), from_corner(other, common.other)
    return rounded.side_meets(
        p.a, p.b, p.c, other.a, other.b, other.c, area_scale
    ) or rounded.side_meets(q.a, q.b, q.c, one.a, one.b, one.c, area_scale)


@inner
def are_seen_apart(one, other, common, area_scale):
    """Tell, the quick way, that two faces neither cut each other nor count as cut.

    True for nearly all pairs with one common vertex, False for all others. For coordinates at unit
    scale.
    """
    if common.shared != 1:
        return False
    p, q = from_corner(one, common.corner), from_corner(other, common.other)
    # The points halfway are half as far from a plane.
    limit, share = 2.0 * rounded.ROUNDING_OF_POINTS, 2.0 * rounded.ROUNDING_OF_AREAS * area_scale
    return triangles.are_apart(p.a, p.b, p.c, q.b, q.c, limit, share)
