"""The guard against self-intersections.

A flip is refused if one of its two new faces would cut any other face of the mesh, or both would
cut each other. Cuts that the mesh has already may stay or go: their number never grows.
"""

import numpy as np
from numba.extending import overload

from ..mesh.halfedge import NONE, apex
from ..mesh.jit import at, jit
from .faces import count_as_cut, cut_exactly, face_of, from_corner, match
from .space import after, faces_at, is_none, next_leaf

ANY = np.empty(0, np.int32)


@jit
def box_around(a, b, c, d):
    """Return least x, y, z and largest x, y, z of four points."""
    return (
        min(a.x, b.x, c.x, d.x),
        min(a.y, b.y, c.y, d.y),
        min(a.z, b.z, c.z, d.z),
        max(a.x, b.x, c.x, d.x),
        max(a.y, b.y, c.y, d.y),
        max(a.z, b.z, c.z, d.z),
    )


@jit
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


@jit
def face_at(mesh, f):
    """Return the face `f` as it is now."""
    first = 3 * f
    u, v, w = mesh.origin[at(first)], mesh.origin[at(first + 1)], mesh.origin[at(first + 2)]
    return face_of(mesh.vertices, u, v, w)


@jit
def box_of(face):
    """Return the box of a face."""
    return box_around(face.a, face.b, face.c, face.c)


@jit
def _are_refused(one, other, area_scale):
    """Tell whether two faces count as cut."""
    common = match(one, other)
    return count_as_cut(one, other, common, area_scale) or cut_exactly(one, other, common)


@jit
def _new_faces(mesh, h):
    """Return the two faces that the flip of `h` makes, each with its corners in their places."""
    t = mesh.twin[h]
    i, j, k, l = mesh.origin[h], mesh.origin[t], apex(mesh, h), apex(mesh, t)
    # In its face, h goes from l to k afterwards, and t back.
    one, other = face_of(mesh.vertices, l, k, i), face_of(mesh.vertices, k, l, j)
    return from_corner(one, (3 - h % 3) % 3), from_corner(other, (3 - t % 3) % 3)


@jit
def _first_cut(mesh, space, new, f, other, changed, number):
    """Return a face that `new`, which is to be face f, cuts, or `NONE`; leave out f and `other`.

    Only faces that have `changed` (m,) in the round `number`; with an empty array any.
    """
    any_will_do = len(changed) == 0
    box = box_of(new)
    node = next_leaf(space, 0, box)
    while node != NONE:
        start, stop = faces_at(space, node)
        for place in range(start, stop):
            e = np.int64(space.order[at(place)])
            if e in (f, other) or not (any_will_do or changed[at(e)] == number):
                continue
            near = face_at(mesh, e)
            if boxes_meet(box_of(near), box) and _are_refused(new, near, space.area_scale):
                return e
        node = next_leaf(space, after(node), box)
    return NONE


@jit
def _blocker(mesh, space, h, changed, number):
    f, g = np.int64(h // 3), np.int64(mesh.twin[h] // 3)
    one, other = _new_faces(mesh, h)
    if _are_refused(one, other, space.area_scale):
        return f
    found = _first_cut(mesh, space, one, f, g, changed, number)
    return found if found != NONE else _first_cut(mesh, space, other, g, f, changed, number)


def blocker(mesh, space, h, changed, number):
    """Return a face that the flip of `h` would make a new face cut.

    Parameters
    ----------
    mesh : Mesh
    space : Space
        Up to date with the mesh. One that is not active refuses nothing.
    h : int
        Half-edge that `can_flip` allows.
    changed : (m,) int32
        The round in which each face last changed. Faces that did not in this one are left out: it
        was asked before this round whether they would be cut. `ANY`: all count.
    number : int
        Number of this round.

    Returns
    -------
    int
        `NONE` if there is none: the flip may be made. The face of `h` if the two new faces would
        cut each other. As long as this face and the two at `h` stay, the answer stays.
    """
    return _blocker(mesh, space, h, changed, number) if space.active else NONE


@overload(blocker)
def _compiled_blocker(mesh, space, h, changed, number):
    return (lambda mesh, space, h, changed, number: NONE) if is_none(space) else blocker


@jit
def would_cut(mesh, space, h):
    """Tell whether the flip of `h` is refused, as `blocker` does; never if nothing is active."""
    return blocker(mesh, space, h, ANY, 0) != NONE


@jit
def mark_cuts(mesh, space, marked, start, stop):
    """Mark, in place, faces that cut others, by the exact tests alone.

    Looks at the pairs of a face from `start` up to `stop` and a face of a higher number.
    """
    for f in range(start, stop):
        one = face_at(mesh, f)
        box = box_of(one)
        node = next_leaf(space, 0, box)
        while node != NONE:
            first, last = faces_at(space, node)
            for place in range(first, last):
                e = np.int64(space.order[at(place)])
                if e <= f or (marked[e] and marked[f]):
                    continue
                near = face_at(mesh, e)
                if boxes_meet(box_of(near), box) and cut_exactly(one, near, match(one, near)):
                    marked[e] = marked[f] = True
            node = next_leaf(space, after(node), box)
