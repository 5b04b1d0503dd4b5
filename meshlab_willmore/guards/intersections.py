"""Intersection guard: a flip must not make faces that intersect others.

A flip is refused if one of its two new faces would intersect any other face of the mesh, or both
would intersect each other. Pairs that intersect already may stay or go: their number never grows,
nor does the number that MeshLab counts.
"""

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from ..mesh.halfedge import NONE, Diamond, previous
from ..mesh.jit import at, inlined, inner, jit, outlined
from ..mesh.points import Point, point
from . import meshlab_tests, predicates, triangles
from .bvh import box_around, is_no_bvh, leaf_range, next_leaf, skip_subtree

CORNERS = 3
NO_CORNER = -1
# All faces count, whenever they changed; and the number of no round.
ANY_ROUND, NO_ROUND = 0, -1


# --- pairs of triangles --------------------------------------------------------------------------


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
def _rotated(face, corner):
    """Return the same face with this corner first."""
    if corner == 0:
        return face
    if corner == 1:
        return Face(face.v, face.w, face.u, face.b, face.c, face.a)
    return Face(face.w, face.u, face.v, face.c, face.a, face.b)


@inner
def _corner_at(face, u):
    """Return which corner of the face is vertex `u`, or `NO_CORNER`."""
    if face.u == u:
        return 0
    if face.v == u:
        return 1
    return 2 if face.w == u else NO_CORNER


class Shared(NamedTuple):
    """How many vertices two faces share, and a corner of each.

    One shared: the corners that it is at. Two shared: the corners that are left over.
    """

    number: int
    corner: int
    other: int


@inner
def shared_vertices(one, other):
    """Return the common vertices of two faces."""
    u, v, w = _corner_at(other, one.u), _corner_at(other, one.v), _corner_at(other, one.w)
    if u == NO_CORNER and v == NO_CORNER and w == NO_CORNER:
        return Shared(0, NO_CORNER, NO_CORNER)
    count = (u != NO_CORNER) + (v != NO_CORNER) + (w != NO_CORNER)
    if count == 1:
        if u != NO_CORNER:
            return Shared(1, 0, u)
        return Shared(1, 1, v) if v != NO_CORNER else Shared(1, 2, w)
    if count == 2:
        left = 0 if u == NO_CORNER else 1 if v == NO_CORNER else 2
        return Shared(2, left, CORNERS - (u + v + w - NO_CORNER))
    return Shared(CORNERS, NO_CORNER, NO_CORNER)


@inner
def intersect(one, other, shared):
    """Whether two faces intersect, exactly; `shared` is from `shared_vertices`."""
    if shared.number == 0:
        return triangles.triangles_meet(one.a, one.b, one.c, other.a, other.b, other.c)
    if shared.number == CORNERS:
        return True
    p, q = _rotated(one, shared.corner), _rotated(other, shared.other)
    if shared.number == 1:
        return triangles.meet_off_vertex(p.a, p.b, p.c, q.b, q.c)
    return triangles.meet_off_edge(p.b, p.c, p.a, q.a)


@inner
def meshlab_may_count(one, other, shared, area_scale):
    """Whether MeshLab may count two faces as intersecting, whichever it looks at first.

    See `meshlab_willmore.guards.meshlab_tests` for the area scale.
    """
    if shared.number == 2 or _interiors_of_boxes_are_apart(one, other):
        return False
    if shared.number == 0:
        return meshlab_tests.triangles_meet(
            one.a, one.b, one.c, other.a, other.b, other.c
        ) or meshlab_tests.triangles_meet(other.a, other.b, other.c, one.a, one.b, one.c)
    if shared.number == CORNERS:
        return True
    p, q = _rotated(one, shared.corner), _rotated(other, shared.other)
    return meshlab_tests.side_meets(
        p.a, p.b, p.c, other.a, other.b, other.c, area_scale
    ) or meshlab_tests.side_meets(q.a, q.b, q.c, one.a, one.b, one.c, area_scale)


@inner
def _interiors_of_boxes_are_apart(one, other):
    a, b, c, p, q, r = one.a, one.b, one.c, other.a, other.b, other.c
    return (
        _interiors_of_spans_are_apart(a.x, b.x, c.x, p.x, q.x, r.x)
        or _interiors_of_spans_are_apart(a.y, b.y, c.y, p.y, q.y, r.y)
        or _interiors_of_spans_are_apart(a.z, b.z, c.z, p.z, q.z, r.z)
    )


@inner
def _interiors_of_spans_are_apart(a, b, c, p, q, r):
    return max(a, b, c) <= min(p, q, r) or max(p, q, r) <= min(a, b, c)


@inlined
def _surely_apart(s, a, b, m, c, d, area_scale):
    """Whether triangles of `s` and two of a, b, m are apart, but for `s`, from (s, c, d).

    For MeshLab too. True for nearly all that are; for coordinates at unit scale.
    """
    # The points halfway are half as far from a plane.
    limit = 2.0 * meshlab_tests.ROUNDING_OF_POINTS
    share = 2.0 * meshlab_tests.ROUNDING_OF_AREAS * area_scale
    return triangles.are_separated(s, a, b, m, c, d, limit, share)


@inner
def are_clearly_apart(one, other, shared, area_scale):
    """Whether a quick test shows that two faces neither intersect nor count as intersecting.

    True for nearly all pairs with one common vertex, False for all others. For coordinates at unit
    scale.
    """
    if shared.number != 1:
        return False
    p, q = _rotated(one, shared.corner), _rotated(other, shared.other)
    return _surely_apart(p.a, p.b, p.c, p.c, q.b, q.c, area_scale)


@outlined
def _are_refused(one, other, area_scale):
    """Whether two faces intersect, or MeshLab may count them."""
    shared = shared_vertices(one, other)
    if are_clearly_apart(one, other, shared, area_scale):
        return False
    return meshlab_may_count(one, other, shared, area_scale) or intersect(one, other, shared)


# --- flips ---------------------------------------------------------------------------------------

# Which of the two new faces is meant: bits.
NEITHER, ONE, OTHER, BOTH = range(4)
# The corners of a diamond: bits.
I, J, K, L = 1, 2, 4, 8


@inlined
def face_at(vertices, origin, f):
    """Return the face `f` as it is now."""
    first = 3 * f
    u, v, w = origin[at(first)], origin[at(first + 1)], origin[at(first + 2)]
    return face_of(vertices, np.int64(u), np.int64(v), np.int64(w))


@inlined
def box_of(face):
    """Return the box of a face."""
    return box_around(face.a, face.b, face.c, face.c)


@inlined
def boxes_meet(one, other):
    """Whether two closed boxes share a point."""
    return (
        (one[0] <= other[3])
        & (one[1] <= other[4])
        & (one[2] <= other[5])
        & (other[0] <= one[3])
        & (other[1] <= one[4])
        & (other[2] <= one[5])
    )


class Quad(NamedTuple):
    """The two faces that a flip makes, each with its corners in their places, and its diamond."""

    one: Face
    other: Face
    i: int
    j: int
    k: int
    l: int
    corners: Diamond


@inlined
def _quad_of(vertices, origin, h, t):
    """Return what the flip of `h`, with the twin `t`, makes."""
    i, j = np.int64(origin[at(h)]), np.int64(origin[at(t)])
    k, l = np.int64(origin[at(previous(h))]), np.int64(origin[at(previous(t))])
    a, b, c, d = point(vertices, i), point(vertices, j), point(vertices, k), point(vertices, l)
    # In its face, h goes from l to k afterwards, and t back.
    one = _rotated(Face(l, k, i, d, c, a), (3 - h % 3) % 3)
    other = _rotated(Face(k, l, j, c, d, b), (3 - t % 3) % 3)
    return Quad(one, other, i, j, k, l, Diamond(a, b, c, d))


@inlined
def _corner_of_quad(quad, u):
    """Return which corner of a quad is the vertex `u`, or 0."""
    return (u == quad.i) * I | (u == quad.j) * J | (u == quad.k) * K | (u == quad.l) * L


@inlined
def _not_surely_apart(quad, near, area_scale):
    """Return which of the new faces quick tests do not show to be apart from another face.

    They show that of most faces that have one or two vertices of the quad.
    """
    i, j, k, l = quad.corners
    at_u, at_v, at_w = (
        _corner_of_quad(quad, near.u),
        _corner_of_quad(quad, near.v),
        _corner_of_quad(quad, near.w),
    )
    common = at_u | at_v | at_w
    # The new faces have the corners k, l and i, and k, l and j.
    tips, ends = common & (I | J), common & (K | L)
    if common == 0 or tips == I | J or ends == K | L:
        return BOTH
    key = ends if ends else tips
    if at_u & key:
        s, c, d = near.a, near.b, near.c
    elif at_v & key:
        s, c, d = near.b, near.c, near.a
    else:
        s, c, d = near.c, near.a, near.b
    a, b, m = k, l, l
    if ends:
        m = l if ends == K else k
        # Beside a new face of which it has two vertices, the face is compared with the other one.
        a, b = m if tips == I else i, m if tips == J else j
    if not _surely_apart(s, a, b, m, c, d, area_scale):
        return BOTH
    if ends == 0:
        return OTHER if tips == I else ONE
    if tips == 0 or predicates.orient3d(s, c, d, m) != 0:
        return NEITHER
    return ONE if tips == I else OTHER


@inlined
def _is_near_refused(quad, near, one_box, other_box, area_scale):
    """Whether one of the new faces is refused for another face."""
    left = _not_surely_apart(quad, near, area_scale)
    if left == NEITHER:
        return False
    box = box_of(near)
    return (
        left & ONE != 0 and boxes_meet(box, one_box) and _are_refused(quad.one, near, area_scale)
    ) or (
        left & OTHER != 0
        and boxes_meet(box, other_box)
        and _are_refused(quad.other, near, area_scale)
    )


class Obstacles(NamedTuple):
    """What is in the way of a flip: a face, or `NONE`, and whether another flip of the round is."""

    face: int
    flip: bool


@inlined
def _face_after(vertices, origin, twin, e, h):
    """Return the face `e` as the flip of `h`, one of its half-edges or a twin of one, makes it."""
    h = np.int64(h)
    quad = _quad_of(vertices, origin, h, np.int64(twin[at(h)]))
    return quad.one if h // 3 == e else quad.other


@outlined
def _find_obstacles(vertices, origin, twin, bvh, h, since, number, to_flip):
    """Return the Obstacles of the flip of `h`; see `blocking_face` and `obstacles_in_round`."""
    t, meets_flip = np.int64(twin[at(h)]), False
    quad, area_scale = _quad_of(vertices, origin, h, t), bvh.area_scale
    # The pair of the new faces never changes.
    if since == ANY_ROUND and _are_refused(quad.one, quad.other, area_scale):
        return Obstacles(h // 3, False)
    f, g = h // 3, t // 3
    box, one_box, other_box = box_around(*quad.corners), box_of(quad.one), box_of(quad.other)
    node = next_leaf(bvh.box, 0, box)
    while node != NONE:
        start, stop = leaf_range(bvh.box, len(bvh.order), node)
        for place in range(start, stop):
            e = np.int64(bvh.order[at(place)])
            changed = bvh.changed[at(e)]
            if (e == f) | (e == g) | (changed < since):
                continue
            near, is_now = face_at(vertices, origin, e), True
            while True:
                if boxes_meet(box_of(near), box) and _is_near_refused(
                    quad, near, one_box, other_box, area_scale
                ):
                    if is_now:
                        return Obstacles(e, False)
                    meets_flip = True
                if meets_flip or not is_now or changed != number or to_flip[at(e)] == NONE:
                    break
                near, is_now = _face_after(vertices, origin, twin, e, to_flip[at(e)]), False
        node = next_leaf(bvh.box, skip_subtree(node), box)
    return Obstacles(NONE, meets_flip)


def blocking_face(mesh, bvh, h, since):
    """Return a face that the flip of `h` would make a new face intersect.

    Parameters
    ----------
    mesh : Mesh
    bvh : Bvh
        Up to date with the mesh. If it is inactive, no flip is refused.
    h : int
        Half-edge that is free and makes a new edge.
    since : int
        A round of flips. Faces that did not change in it or later are left out, and so is the pair
        of the new faces: these were tested before. `ANY_ROUND`: all count.

    Returns
    -------
    int
        `NONE` if there is none: the flip may be made. The face of `h` if the two new faces would
        intersect each other. As long as this face and the two at `h` stay, the answer stays.
    """
    if not bvh.active:
        return NONE
    arrays = mesh.vertices, mesh.origin, mesh.twin
    return _find_obstacles(*arrays, bvh, np.int64(h), since, NO_ROUND, mesh.twin).face


# Inlined, as Numba would compile it again in each process that compiles a caller.
@overload(blocking_face, inline="always")
def _compiled_blocking_face(mesh, bvh, h, since):
    return (lambda mesh, bvh, h, since: NONE) if is_no_bvh(bvh) else blocking_face


@inner
def would_intersect(mesh, bvh, h):
    """Whether the flip of `h` is refused, as by `blocking_face`; False with an inactive BVH."""
    return blocking_face(mesh, bvh, h, ANY_ROUND) != NONE


@inlined
def obstacles_in_round(mesh, bvh, h, number, to_flip):
    """Return what is in the way of the flip of `h` before a round of flips.

    Parameters
    ----------
    mesh : Mesh
        Before the flips.
    bvh : Bvh
        Active. Its boxes hold the faces before and after; `expand` has noted the round.
    h : int
        Half-edge.
    number : int
        Number of the round, the last one.
    to_flip : (m,) int32
        For each face that is to change in this round the half-edge that is to be flipped, or `NONE`
        if it is not to change after all.

    Returns
    -------
    Obstacles
        The face is that of `blocking_face`. Without one, whether a new face would intersect one
        that another flip of the round makes.
    """
    arrays = mesh.vertices, mesh.origin, mesh.twin
    return _find_obstacles(*arrays, bvh, np.int64(h), ANY_ROUND, number, to_flip)


@jit
def mark_intersecting(mesh, bvh, marked, start, stop):
    """Mark, in place, faces that intersect others, by the exact tests alone.

    Looks at the pairs of a face from `start` up to `stop` and a face of a higher number.
    """
    vertices, origin = mesh.vertices, mesh.origin
    for f in range(start, stop):
        one = face_at(vertices, origin, f)
        box = box_of(one)
        node = next_leaf(bvh.box, 0, box)
        while node != NONE:
            first, last = leaf_range(bvh.box, len(bvh.order), node)
            for place in range(first, last):
                e = np.int64(bvh.order[at(place)])
                if e <= f or (marked[at(e)] and marked[at(f)]):
                    continue
                near = face_at(vertices, origin, e)
                if boxes_meet(box_of(near), box) and intersect(
                    one, near, shared_vertices(one, near)
                ):
                    marked[at(e)] = marked[at(f)] = True
            node = next_leaf(bvh.box, skip_subtree(node), box)
