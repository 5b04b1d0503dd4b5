"""The four sides of the diamond: where a flip changes intersection angles."""

from typing import NamedTuple

from ..mesh.halfedge import NONE, apex, following, previous
from ..mesh.jit import jit
from ..mesh.points import Point, point
from .angles import NO_ANGLES, Turn, add, turn


class Corners(NamedTuple):
    """The third corner of the face that lies at each side of the diamond, inside the quad."""

    j_k: Point
    k_i: Point
    i_l: Point
    l_j: Point


@jit
def _turn_at(mesh, side, a, b, inner):
    """Return the turn at the half-edge `side` from a to b of a face (a, b, inner)."""
    t = mesh.twin[side]
    if t == NONE:
        return Turn(1.0, 0.0)
    return turn(a, b, inner, point(mesh.vertices, apex(mesh, t)))


@jit
def side_angles(mesh, h, quad, corners):
    """Return the sum of the angles at the four sides of the quad around `h`.

    Boundary sides have no angle and add nothing.

    Parameters
    ----------
    mesh : Mesh
    h : int
        Half-edge with a twin.
    quad : Diamond
        The points around it.
    corners : Corners
        What stands inside the quad opposite to each side.

    Returns
    -------
    AngleSum
    """
    t = mesh.twin[h]
    total = add(NO_ANGLES, _turn_at(mesh, following(h), quad.j, quad.k, corners.j_k))
    total = add(total, _turn_at(mesh, previous(h), quad.k, quad.i, corners.k_i))
    total = add(total, _turn_at(mesh, following(t), quad.i, quad.l, corners.i_l))
    return add(total, _turn_at(mesh, previous(t), quad.l, quad.j, corners.l_j))
