"""The total absolute Gaussian curvature of a mesh: the sum of |2 pi - (sum of the angles)|.

It is summed over the interior vertices, those whose faces form one closed fan; other vertices have
no curvature and contribute nothing. In radians. On a closed mesh it is at least 2 pi times the
Euler characteristic, which the sum without absolute values is. Source of the definition: "Mesh
optimisation based on Willmore energy", section 2.

A flip changes the sums of the angles at i, j, k and l. The absolute value needs the whole sums, so
the fans of the four are walked: O(valence) time, but four pairs of `atan2` whatever the valence.
For the same reason a flip changes the cost reduction of *every* edge whose diamond has one of the
four at a corner: the edges at them, and those opposite to them.
"""

import math

import numpy as np

from ..mesh.halfedge import NONE, apex, diamond, following, previous
from ..mesh.jit import allocating_jit, inner
from ..mesh.points import angle_between, point, subtract
from .angles import NO_ANGLES, add, radians
from .triangles import complex_angle_between, has_coincident_corners

FULL_TURN = 2.0 * math.pi


@inner
def _sides_at(mesh, h):
    """Return the vectors from the origin of `h` along the two sides of its face."""
    v = point(mesh.vertices, mesh.origin[h])
    ahead = subtract(point(mesh.vertices, mesh.origin[following(h)]), v)
    return ahead, subtract(point(mesh.vertices, apex(mesh, h)), v)


@inner
def _angles_outside(mesh, start, stop):
    """Sum the angles in the fan between the faces of two half-edges with the same origin.

    Returns
    -------
    AngleSum
        From the face after that of `start` to the one before that of `stop`.
    bool
        Whether the vertex is interior; if not, the sum is of no use.
    """
    angles = NO_ANGLES
    if mesh.several_fans[mesh.origin[start]]:
        return angles, False
    t = mesh.twin[start]
    while t != NONE and following(t) != stop:
        ahead, behind = _sides_at(mesh, following(t))
        angles = add(angles, complex_angle_between(ahead, behind))
        t = mesh.twin[following(t)]
    return angles, t != NONE


@inner
def _drop(mesh, fan, sides):
    """Return what the absolute curvature at a corner loses when the diagonal there is taken out.

    Parameters
    ----------
    mesh : Mesh
    fan : tuple of int
        The half-edges between which `_angles_outside` sums the other angles at the corner.
    sides : tuple of Point
        The vectors from the corner along the diagonal and along the two sides of the quad.
    """
    outside, is_interior = _angles_outside(mesh, fan[0], fan[1])
    if not is_interior:
        return 0.0
    diagonal, a, b = sides
    halves = add(outside, complex_angle_between(diagonal, a))
    split = radians(add(halves, complex_angle_between(diagonal, b)))
    whole = radians(add(outside, complex_angle_between(a, b)))
    return abs(FULL_TURN - split) - abs(FULL_TURN - whole)


@inner
def cost_reduction(mesh, h):
    """Return the drop of the total absolute Gaussian curvature, in radians."""
    quad = diamond(mesh, h)
    if has_coincident_corners(quad):
        return -math.inf
    i, j, k, l = quad
    t = mesh.twin[h]
    at_i = subtract(j, i), subtract(k, i), subtract(l, i)
    at_j = subtract(i, j), subtract(k, j), subtract(l, j)
    at_k = subtract(l, k), subtract(i, k), subtract(j, k)
    at_l = subtract(k, l), subtract(i, l), subtract(j, l)
    gain = _drop(mesh, (following(t), h), at_i) + _drop(mesh, (following(h), t), at_j)
    gain -= _drop(mesh, (previous(h), previous(h)), at_k)
    gain -= _drop(mesh, (previous(t), previous(t)), at_l)
    return gain if math.isfinite(gain) else -math.inf


@allocating_jit
def angle_defects(mesh):
    """Return 2 pi - (sum of the angles) at each interior vertex (n,), and 0 at the others."""
    defects = np.zeros(len(mesh.vertices))
    defects[mesh.origin] = FULL_TURN
    for h in range(len(mesh.origin)):
        ahead, behind = _sides_at(mesh, h)
        defects[mesh.origin[h]] -= angle_between(ahead, behind)
    for h in range(len(mesh.origin)):
        # In a fan as many half-edges without twin start as end: to look at the starts is enough.
        if mesh.twin[h] == NONE or mesh.several_fans[mesh.origin[h]]:
            defects[mesh.origin[h]] = 0.0
    return defects


@allocating_jit
def total(mesh):
    """Return the total absolute Gaussian curvature of the mesh in radians."""
    return np.abs(angle_defects(mesh)).sum()
