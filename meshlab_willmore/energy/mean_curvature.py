"""The total absolute mean curvature of a mesh: the sum of |theta| |e| over its interior edges.

theta is the angle between the normals of the two faces at e, in [0, pi] and 0 where they are
coplanar or one of them has no area, and so no normal. The sum has the unit of a length. Boundary
edges have no angle and contribute nothing. Source of the definition: "Mesh optimisation based on
Willmore energy", section 2.

A flip changes the angles at five edges: the diagonal and the four sides of the quad. A flip to a
face without a normal, at which bends would be hidden, has no cost reduction.
"""

import math

from ..mesh.halfedge import NONE, apex, diamond, following, previous
from ..mesh.jit import inner, jit
from ..mesh.points import angle_between, norm, point, subtract
from ..mesh.rounding import good_direction
from .triangles import drop_of, has_coincident_corners


@inner
def _is_none(vector):
    return vector.x == 0.0 and vector.y == 0.0 and vector.z == 0.0


@inner
def _side(mesh, side, a, b, before, after):
    """Return what the half-edge `side` from a to b has when its face turns, before and after."""
    t = mesh.twin[side]
    if t == NONE:
        return 0.0, 0.0
    outside = good_direction(b, a, point(mesh.vertices, apex(mesh, t)))
    length = norm(subtract(b, a))
    return length * angle_between(before, outside), length * angle_between(after, outside)


@inner
def cost_reduction(mesh, h):
    """Return the drop of the curvature, in units of the coordinates times radians.

    It is minus infinity also where a new face has no normal.
    """
    quad = diamond(mesh, h)
    if has_coincident_corners(quad):
        return -math.inf
    i, j, k, l = quad
    t = mesh.twin[h]
    at_k, at_l = good_direction(i, j, k), good_direction(j, i, l)
    at_i, at_j = good_direction(k, i, l), good_direction(l, j, k)
    if _is_none(at_i) or _is_none(at_j):
        return -math.inf
    before = angle_between(at_k, at_l) * norm(subtract(j, i))
    after = angle_between(at_i, at_j) * norm(subtract(l, k))
    for had, has in (
        _side(mesh, following(h), j, k, at_k, at_j),
        _side(mesh, previous(h), k, i, at_k, at_i),
        _side(mesh, following(t), i, l, at_l, at_i),
        _side(mesh, previous(t), l, j, at_l, at_j),
    ):
        before += had
        after += has
    return drop_of(before, after)


@inner
def bend(mesh, h):
    """Return the dihedral angle times the length of `h`, which has a twin."""
    i, j, k, l = diamond(mesh, h)
    angle = angle_between(good_direction(i, j, k), good_direction(j, i, l))
    return angle * norm(subtract(j, i))


@jit
def total(mesh):
    """Return the total absolute mean curvature, in units of the coordinates times radians."""
    bends = 0.0
    for h in range(len(mesh.origin)):
        if h < mesh.twin[h]:
            bends += bend(mesh, h)
    return bends
