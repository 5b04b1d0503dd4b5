"""The four sides of the diamond: where a flip changes intersection angles."""

from typing import NamedTuple

from ..mesh.halfedge import NONE, apex, following, previous
from ..mesh.jit import at, inlined
from ..mesh.points import Point, point, subtract
from .angles import NO_ANGLES, Turn, add, turn


class View(NamedTuple):
    """A side of the diamond seen from inside: vectors from the face's third corner to its ends."""

    start: Point
    end: Point


class Views(NamedTuple):
    """The four sides of the diamond, each seen from the face inside the quad that has it."""

    j_k: View
    k_i: View
    i_l: View
    l_j: View


class Outside(NamedTuple):
    """The third corner of the face outside a side, and whether there is such a face."""

    apex: Point
    exists: bool


class Sides(NamedTuple):
    """What is outside the four sides of the diamond."""

    j_k: Outside
    k_i: Outside
    i_l: Outside
    l_j: Outside


@inlined
def _outside(mesh, side):
    t = mesh.twin[at(side)]
    if t == NONE:
        # Any point will do: it does not count.
        return Outside(point(mesh.vertices, mesh.origin[at(side)]), False)
    return Outside(point(mesh.vertices, apex(mesh, t)), True)


@inlined
def sides_of(mesh, h):
    """Return what is outside the diamond of `h`, which must have a twin."""
    t = mesh.twin[at(h)]
    return Sides(
        _outside(mesh, following(h)),
        _outside(mesh, previous(h)),
        _outside(mesh, following(t)),
        _outside(mesh, previous(t)),
    )


@inlined
def _turn_at(a, b, view, outside):
    """Return the turn at the side a-b, seen from inside as `view`; none without a face outside."""
    beta = turn(view.start, view.end, subtract(a, outside.apex), subtract(b, outside.apex))
    return Turn(beta.r if outside.exists else 1.0, beta.s if outside.exists else 0.0)


@inlined
def side_angles(quad, sides, views):
    """Return the sum of the angles at the four sides of a quad.

    Boundary sides have no angle and add nothing.

    Parameters
    ----------
    quad : Diamond
        Its corners.
    sides : Sides
        What is outside.
    views : Views
        The sides as seen from inside the quad.

    Returns
    -------
    AngleSum
    """
    total = add(NO_ANGLES, _turn_at(quad.j, quad.k, views.j_k, sides.j_k))
    total = add(total, _turn_at(quad.k, quad.i, views.k_i, sides.k_i))
    total = add(total, _turn_at(quad.i, quad.l, views.i_l, sides.i_l))
    return add(total, _turn_at(quad.l, quad.j, views.l_j, sides.l_j))
