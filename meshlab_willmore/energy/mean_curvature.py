"""The total absolute mean curvature of a mesh: the sum of |theta| |e| over its interior edges.

theta is the angle between the normals of the two faces at e, in [0, pi] and 0 where they are
coplanar or one of them has no normal. The sum has the unit of a length. Boundary edges have no
angle and contribute nothing. Source of the definition: "Mesh optimisation based on Willmore
energy", section 2.

A flip changes the angles at five edges: the diagonal and the four sides of the quad.
"""

import math

from ..mesh.halfedge import NONE, apex, diamond, following, previous
from ..mesh.jit import jit
from ..mesh.points import angle_between, norm, normal, point, subtract
from .triangles import has_coincident_corners


@jit
def _side(mesh, side, a, b, before, after):
    """Return what the half-edge `side` from a to b loses when its face turns its normal."""
    t = mesh.twin[side]
    if t == NONE:
        return 0.0
    outside = normal(b, a, point(mesh.vertices, apex(mesh, t)))
    turned = angle_between(before, outside) - angle_between(after, outside)
    return turned * norm(subtract(b, a))


@jit
def cost_reduction(mesh, h):
    """Return by how much the total absolute mean curvature drops when `h` is flipped.

    Parameters
    ----------
    mesh : Mesh
    h : int
        Half-edge with a twin.

    Returns
    -------
    float
        In units of the coordinates times radians; positive where the flip helps, minus infinity
        where corners of the diamond coincide. It depends on the two faces at `h` and on the four
        around them.
    """
    quad = diamond(mesh, h)
    if has_coincident_corners(quad):
        return -math.inf
    i, j, k, l = quad
    t = mesh.twin[h]
    at_k, at_l = normal(i, j, k), normal(j, i, l)
    at_i, at_j = normal(k, i, l), normal(l, j, k)
    gain = angle_between(at_k, at_l) * norm(subtract(j, i))
    gain -= angle_between(at_i, at_j) * norm(subtract(l, k))
    gain += _side(mesh, following(h), j, k, at_k, at_j)
    gain += _side(mesh, previous(h), k, i, at_k, at_i)
    gain += _side(mesh, following(t), i, l, at_l, at_i)
    gain += _side(mesh, previous(t), l, j, at_l, at_j)
    return gain if math.isfinite(gain) else -math.inf


@jit
def total(mesh):
    """Return the total absolute mean curvature, in units of the coordinates times radians."""
    bends = 0.0
    for h in range(len(mesh.origin)):
        if h < mesh.twin[h]:
            i, j, k, l = diamond(mesh, h)
            bends += angle_between(normal(i, j, k), normal(j, i, l)) * norm(subtract(j, i))
    return bends
