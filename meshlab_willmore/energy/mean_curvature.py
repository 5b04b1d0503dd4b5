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
from ..mesh.jit import inlined, inner, jit
from ..mesh.points import angle_between, dot, norm, point, subtract
from ..mesh.rounding import good_direction
from .plain import arctangent, plain_normal, quad_normals
from .triangles import drop_of, has_coincident_corners, without_rounding
from .wings import wings_of


@inlined
def _at_side(a, b, before, after, wing):
    """Return by how much the curvature at the side a-b falls, and the length of the side.

    Parameters
    ----------
    a, b : Point
        Its ends, as the faces inside have them in order.
    before, after : Point
        Normals of the faces inside; each is perpendicular to the side.
    wing : Wing
        The face outside, which may be missing.

    Returns
    -------
    drop, length : float
        Both 0 without a face outside.

    Notes
    -----
    The two angles with the face outside are those of the complex numbers c1 + i s1 and c2 + i s2,
    and their difference is that of the quotient. For the normal n of a face inside and the outer
    one, o = w x e with the side e, n x o = -(n . w) e, since n . e = 0.
    """
    side, outward = subtract(b, a), subtract(wing.apex, a)
    outside, length = plain_normal(outward, side), norm(side)
    c1, s1 = dot(before, outside), length * abs(dot(before, outward))
    c2, s2 = dot(after, outside), length * abs(dot(after, outward))
    drop = length * arctangent(s1 * c2 - c1 * s2, c1 * c2 + s1 * s2)
    return drop if wing.exists else 0.0, length if wing.exists else 0.0


@inlined
def quick_reduction(quad, wings):
    """Return the cost reduction in plain arithmetic; NaN where `cost_reduction` looks closer."""
    i, j, k, l = quad
    at_k, at_l, at_i, at_j = quad_normals(quad)
    old, new = norm(subtract(j, i)), norm(subtract(l, k))
    # Six times the volume of the tetrahedron: the product of two normals is that times their edge.
    volume = abs(dot(at_k, subtract(l, i)))
    before = arctangent(old * volume, dot(at_k, at_l))
    after = arctangent(new * volume, dot(at_i, at_j))
    j_k = _at_side(j, k, at_k, at_j, wings.j_k)
    k_i = _at_side(k, i, at_k, at_i, wings.k_i)
    i_l = _at_side(i, l, at_l, at_i, wings.i_l)
    l_j = _at_side(l, j, at_l, at_j, wings.l_j)
    drop = (old * before - new * after) + ((j_k[0] + k_i[0]) + (i_l[0] + l_j[0]))
    # Rounding takes a part of a radian from each angle, however small that is.
    return without_rounding(drop, (old + new) + ((j_k[1] + k_i[1]) + (i_l[1] + l_j[1])))


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
def _careful_reduction(mesh, h):
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
def cost_reduction(mesh, h):
    """Return the drop of the curvature, in units of the coordinates times radians.

    It is minus infinity also where a new face has no normal.
    """
    gain = quick_reduction(diamond(mesh, h), wings_of(mesh, h))
    return gain if math.isfinite(gain) else _careful_reduction(mesh, h)


@inner
def careful_bend(mesh, h):
    """Return what `bend` returns, for faces that are thin or tiny."""
    i, j, k, l = diamond(mesh, h)
    angle = angle_between(good_direction(i, j, k), good_direction(j, i, l))
    return angle * norm(subtract(j, i))


@inlined
def quick_bend(quad):
    """Return what `bend` returns in plain arithmetic; NaN where it looks closer."""
    i, j, k, l = quad
    side, outward = subtract(j, i), subtract(l, i)
    at_k, at_l = plain_normal(side, subtract(k, i)), plain_normal(outward, side)
    length = norm(side)
    return length * arctangent(length * abs(dot(at_k, outward)), dot(at_k, at_l))


@inlined
def bend(mesh, h):
    """Return the dihedral angle times the length of `h`, which has a twin."""
    found = quick_bend(diamond(mesh, h))
    return found if math.isfinite(found) else careful_bend(mesh, h)


@jit
def total(mesh):
    """Return the total absolute mean curvature, in units of the coordinates times radians."""
    bends = 0.0
    for h in range(len(mesh.origin)):
        if h < mesh.twin[h]:
            bends += bend(mesh, h)
    return bends
