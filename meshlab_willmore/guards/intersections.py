"""Intersection guard: a flip must not make faces that intersect others.

A flip is refused if one of its two new faces would intersect any other face of the mesh, or both
would intersect each other. Pairs that intersect already may stay or go: their number never grows,
nor does the number that MeshLab counts.
"""

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from ..mesh.halfedge import NONE, apex, diamond
from ..mesh.jit import at, inner, jit
from ..mesh.points import Point, point
from . import meshlab_tests, triangles
from .bvh import box_around, is_no_bvh, leaf_range, next_leaf, skip_subtree

CORNERS = 3
NO_CORNER = -1
# All faces count, whenever they changed.
ANY_ROUND = 0


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


@inner
def are_clearly_apart(one, other, shared, area_scale):
    """Whether a quick test shows that two faces neither intersect nor count as intersecting.

    True for nearly all pairs with one common vertex, False for all others. For coordinates at unit
    scale.
    """
    if shared.number != 1:
        return False
    p, q = _rotated(one, shared.corner), _rotated(other, shared.other)
    # The points halfway are half as far from a plane.
    limit = 2.0 * meshlab_tests.ROUNDING_OF_POINTS
    share = 2.0 * meshlab_tests.ROUNDING_OF_AREAS * area_scale
    return triangles.are_separated(p.a, p.b, p.c, q.b, q.c, limit, share)


@inner
def _are_refused(one, other, area_scale):
    """Whether two faces intersect, or MeshLab may count them."""
    shared = shared_vertices(one, other)
    if are_clearly_apart(one, other, shared, area_scale):
        return False
    return meshlab_may_count(one, other, shared, area_scale) or intersect(one, other, shared)


# --- flips ---------------------------------------------------------------------------------------


@inner
def face_at(mesh, f):
    """Return the face `f` as it is now."""
    first = 3 * f
    u, v, w = mesh.origin[at(first)], mesh.origin[at(first + 1)], mesh.origin[at(first + 2)]
    return face_of(mesh.vertices, u, v, w)


@inner
def box_of(face):
    """Return the box of a face."""
    return box_around(face.a, face.b, face.c, face.c)


@inner
def boxes_meet(one, other):
    """Whether two closed boxes share a point."""
    return (
        one[0] <= other[3]
        and one[1] <= other[4]
        and one[2] <= other[5]
        and other[0] <= one[3]
        and other[1] <= one[4]
        and other[2] <= one[5]
    )


@inner
def _new_faces(mesh, h):
    """Return the two faces that the flip of `h` makes, each with its corners in their places."""
    t = mesh.twin[h]
    i, j, k, l = mesh.origin[h], mesh.origin[t], apex(mesh, h), apex(mesh, t)
    # In its face, h goes from l to k afterwards, and t back.
    one, other = face_of(mesh.vertices, l, k, i), face_of(mesh.vertices, k, l, j)
    return _rotated(one, (3 - h % 3) % 3), _rotated(other, (3 - t % 3) % 3)


@inner
def _face_after(mesh, e, to_flip):
    """Return the face `e` as the flips will make it; with None as it is."""
    if to_flip is None:
        return face_at(mesh, e)
    h = np.int64(to_flip[at(e)])
    one, other = _new_faces(mesh, h)
    return one if h // 3 == e else other


@inner
def _first_intersected(mesh, bvh, h, since, to_flip):
    """Return a face besides those at `h` that one of the new faces would intersect, or `NONE`.

    Only of the faces that changed in the round `since` or later, as `_face_after` gives them.
    """
    f, g = np.int64(h // 3), np.int64(mesh.twin[at(h)] // 3)
    one, other = _new_faces(mesh, h)
    box, one_box, other_box = box_around(*diamond(mesh, h)), box_of(one), box_of(other)
    node = next_leaf(bvh, 0, box, since)
    while node != NONE:
        start, stop = leaf_range(bvh, node)
        for place in range(start, stop):
            e = np.int64(bvh.order[at(place)])
            if e in (f, g) or bvh.changed[at(e)] < since:
                continue
            near = _face_after(mesh, e, to_flip)
            near_box = box_of(near)
            if boxes_meet(near_box, one_box) and _are_refused(one, near, bvh.area_scale):
                return e
            if boxes_meet(near_box, other_box) and _are_refused(other, near, bvh.area_scale):
                return e
        node = next_leaf(bvh, skip_subtree(node), box, since)
    return NONE


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
    # The pair of the new faces never changes.
    if since == ANY_ROUND:
        one, other = _new_faces(mesh, h)
        if _are_refused(one, other, bvh.area_scale):
            return np.int64(h // 3)
    return _first_intersected(mesh, bvh, h, since, None)


# Inlined, as Numba would compile it again in each process that compiles a caller.
@overload(blocking_face, inline="always")
def _compiled_blocking_face(mesh, bvh, h, since):
    return (lambda mesh, bvh, h, since: NONE) if is_no_bvh(bvh) else blocking_face


@inner
def would_intersect(mesh, bvh, h):
    """Whether the flip of `h` is refused, as by `blocking_face`; False with an inactive BVH."""
    return blocking_face(mesh, bvh, h, ANY_ROUND) != NONE


@inner
def intersects_another_flip(mesh, bvh, h, number, to_flip):
    """Whether a new face of `h` would intersect one that another flip of the same round makes.

    Parameters
    ----------
    mesh : Mesh
        Before the flips.
    bvh : Bvh
        Its boxes hold the faces before and after; `expand` has noted the round.
    h : int
        Half-edge.
    number : int
        Number of the round, the last one.
    to_flip : (m,) int32
        For each face that is to change in this round the half-edge that is to be flipped.
    """
    return _first_intersected(mesh, bvh, h, number, to_flip) != NONE


@jit
def mark_intersecting(mesh, bvh, marked, start, stop):
    """Mark, in place, faces that intersect others, by the exact tests alone.

    Looks at the pairs of a face from `start` up to `stop` and a face of a higher number.
    """
    for f in range(start, stop):
        one = face_at(mesh, f)
        box = box_of(one)
        node = next_leaf(bvh, 0, box, ANY_ROUND)
        while node != NONE:
            first, last = leaf_range(bvh, node)
            for place in range(first, last):
                e = np.int64(bvh.order[at(place)])
                if e <= f or (marked[e] and marked[f]):
                    continue
                near = face_at(mesh, e)
                if boxes_meet(box_of(near), box) and intersect(
                    one, near, shared_vertices(one, near)
                ):
                    marked[e] = marked[f] = True
            node = next_leaf(bvh, skip_subtree(node), box, ANY_ROUND)
