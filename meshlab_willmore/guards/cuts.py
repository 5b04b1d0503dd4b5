"""The guard against self-intersections.

A flip is refused if one of its two new faces would cut any other face of the mesh, or both would
cut each other. Cuts that the mesh has already may stay or go: their number never grows.
"""

import numpy as np
from numba.extending import overload

from ..mesh.halfedge import NONE, apex, diamond
from ..mesh.jit import at, inner, jit
from .bvh import box_around, is_no_bvh, leaf_range, next_leaf, skip_subtree
from .faces import are_seen_apart, count_as_cut, cut_exactly, face_of, from_corner, match

# All faces count, whenever they changed.
EVER = 0


@inner
def boxes_meet(one, other):
    """Tell whether two closed boxes share a point."""
    return (
        one[0] <= other[3]
        and one[1] <= other[4]
        and one[2] <= other[5]
        and other[0] <= one[3]
        and other[1] <= one[4]
        and other[2] <= one[5]
    )


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
def _are_refused(one, other, area_scale):
    """Tell whether two faces count as cut."""
    common = match(one, other)
    if are_seen_apart(one, other, common, area_scale):
        return False
    return count_as_cut(one, other, common, area_scale) or cut_exactly(one, other, common)


@inner
def _new_faces(mesh, h):
    """Return the two faces that the flip of `h` makes, each with its corners in their places."""
    t = mesh.twin[h]
    i, j, k, l = mesh.origin[h], mesh.origin[t], apex(mesh, h), apex(mesh, t)
    # In its face, h goes from l to k afterwards, and t back.
    one, other = face_of(mesh.vertices, l, k, i), face_of(mesh.vertices, k, l, j)
    return from_corner(one, (3 - h % 3) % 3), from_corner(other, (3 - t % 3) % 3)


@inner
def _face_to_be(mesh, e, to_flip):
    """Return the face `e` as the flips will make it; with None as it is."""
    if to_flip is None:
        return face_at(mesh, e)
    h = np.int64(to_flip[at(e)])
    one, other = _new_faces(mesh, h)
    return one if h // 3 == e else other


@inner
def _first_cut(mesh, bvh, h, since, to_flip):
    """Return a face besides those at `h` that one of the new faces would cut, or `NONE`.

    Only of the faces that changed in the round `since` or later, as `_face_to_be` gives them.
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
            near = _face_to_be(mesh, e, to_flip)
            near_box = box_of(near)
            if boxes_meet(near_box, one_box) and _are_refused(one, near, bvh.area_scale):
                return e
            if boxes_meet(near_box, other_box) and _are_refused(other, near, bvh.area_scale):
                return e
        node = next_leaf(bvh, skip_subtree(node), box, since)
    return NONE


@inner
def _blocker(mesh, bvh, h, since):
    # These two are the same as ever.
    if since == EVER and _are_refused(*_new_faces(mesh, h), bvh.area_scale):
        return np.int64(h // 3)
    return _first_cut(mesh, bvh, h, since, None)


def blocker(mesh, bvh, h, since):
    """Return a face that the flip of `h` would make a new face cut.

    Parameters
    ----------
    mesh : Mesh
    bvh : Bvh
        Up to date with the mesh. One that is not active refuses nothing.
    h : int
        Half-edge that `can_flip` allows.
    since : int
        A round of flips. Faces that did not change in it or later are left out: it was asked before
        whether they would be cut, and whether the new faces would cut each other. `EVER`: all
        count.

    Returns
    -------
    int
        `NONE` if there is none: the flip may be made. The face of `h` if the two new faces would
        cut each other. As long as this face and the two at `h` stay, the answer stays.
    """
    return _blocker(mesh, bvh, h, since) if bvh.active else NONE


@inner
def has_rival(mesh, bvh, h, number, to_flip):
    """Tell whether a new face of `h` would cut one that another flip of the same round makes.

    Parameters
    ----------
    mesh : Mesh
        Before the flips.
    bvh : Bvh
        Its boxes hold the faces before and after; `grow` has noted the round.
    h : int
        Half-edge.
    number : int
        Number of the round, the last one.
    to_flip : (m,) int32
        For each face that is to change in this round the half-edge that is to be flipped.
    """
    return _first_cut(mesh, bvh, h, number, to_flip) != NONE


@overload(blocker)
def _compiled_blocker(mesh, bvh, h, since):
    return (lambda mesh, bvh, h, since: NONE) if is_no_bvh(bvh) else blocker


@inner
def would_cut(mesh, bvh, h):
    """Tell whether the flip of `h` is refused, as `blocker` does; never if nothing is active."""
    return blocker(mesh, bvh, h, EVER) != NONE


@jit
def mark_cuts(mesh, bvh, marked, start, stop):
    """Mark, in place, faces that cut others, by the exact tests alone.

    Looks at the pairs of a face from `start` up to `stop` and a face of a higher number.
    """
    for f in range(start, stop):
        one = face_at(mesh, f)
        box = box_of(one)
        node = next_leaf(bvh, 0, box, EVER)
        while node != NONE:
            first, last = leaf_range(bvh, node)
            for place in range(first, last):
                e = np.int64(bvh.order[at(place)])
                if e <= f or (marked[e] and marked[f]):
                    continue
                near = face_at(mesh, e)
                if boxes_meet(box_of(near), box) and cut_exactly(one, near, match(one, near)):
                    marked[e] = marked[f] = True
            node = next_leaf(bvh, skip_subtree(node), box, EVER)
