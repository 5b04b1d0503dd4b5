"""The four sides of the diamond: where a flip changes intersection angles."""

from typing import NamedTuple

from ..mesh.halfedge import NONE, apex, following, previous
from ..mesh.jit import jit
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


@jit
def _turn_at(mesh, side, a, b, view):
    """Return the turn at the half-edge `side` from a to b, seen from inside as `view`."""
    t = mesh.twin[side]
    if t == NONE:
        return Turn(1.0, 0.0)
    outside = point(mesh.vertices, apex(mesh, t))
    return turn(view.start, view.end, subtract(a, outside), subtract(b, outside))


@jit
def side_angles(mesh, h, quad, views):
    """Return the sum of the angles at the four sides of the quad around `h`.

    Boundary sides have no angle and add nothing.

    Parameters
    ----------
    mesh : Mesh
    h : int
        Half-edge with a twin.
    quad : Diamond
        The points around it.
    views : Views
        The sides as seen from inside the quad.

    Returns
    -------
    AngleSum
    """
    t = mesh.twin[h]
    total = add(NO_ANGLES, _turn_at(mesh, following(h), quad.j, quad.k, views.j_k))
    total = add(total, _turn_at(mesh, previous(h), quad.k, quad.i, views.k_i))
    total = add(total, _turn_at(mesh, following(t), quad.i, quad.l, views.i_l))
    return add(total, _turn_at(mesh, previous(t), quad.l, quad.j, views.l_j))
