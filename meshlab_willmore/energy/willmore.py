"""The Willmore energy of a mesh: twice the sum of the intersection angles over interior edges.

On a closed mesh it differs from Bobenko's sum of W(v) = (sum of beta at v) - 2 pi by the constant
2 pi |V|, so it is lowered by the same flips. Boundary edges have no angle and contribute nothing.
Source: "Mesh optimisation based on Willmore energy", section 2, and A. I. Bobenko, "A conformal
energy for simplicial surfaces", 2005.

A flip of i-j leaves the angle at the diagonal alone (beta(i-j) = beta(k-l)) and changes those at
the four sides of the quad: the third corner of the face inside is now an end of the new edge.
"""

import math

from ..mesh.halfedge import diamond
from ..mesh.jit import inlined, inner, jit
from ..mesh.points import subtract
from .angles import angle, complex_angle, difference, radians
from .wings import View, Views, side_angles, wings_of


@inlined
def _views_before(quad):
    """Return the sides as the faces (i, j, k) and (j, i, l) see them."""
    i, j, k, l = quad
    return Views(
        View(subtract(j, i), subtract(k, i)),
        View(subtract(k, j), subtract(i, j)),
        View(subtract(i, j), subtract(l, j)),
        View(subtract(l, i), subtract(j, i)),
    )


@inlined
def _views_after(quad):
    """Return the sides as the faces (k, i, l) and (l, j, k) see them."""
    i, j, k, l = quad
    return Views(
        View(subtract(j, l), subtract(k, l)),
        View(subtract(k, l), subtract(i, l)),
        View(subtract(i, k), subtract(l, k)),
        View(subtract(l, k), subtract(j, k)),
    )


@inlined
def drop(quad, wings):
    """Return by how much the sum of the intersection angles drops in a flip.

    Parameters
    ----------
    quad : Diamond
        The points around the edge.
    wings : Wings
        The faces outside.

    Returns
    -------
    AngleSum
        NaN where an angle is undefined.
    """
    before = side_angles(quad, wings, _views_before(quad))
    after = side_angles(quad, wings, _views_after(quad))
    return difference(before, after)


@inner
def cost_reduction(mesh, h):
    """Return the drop of the energy, in radians."""
    gain = 2.0 * radians(drop(diamond(mesh, h), wings_of(mesh, h)))
    return gain if math.isfinite(gain) else -math.inf


@inlined
def quad_angle(quad):
    """Return the intersection angle at the edge of a diamond, as a complex number."""
    i, j, k, l = quad
    return complex_angle(subtract(i, k), subtract(j, k), subtract(i, l), subtract(j, l))


@inner
def edge_angle(mesh, h):
    """Return the intersection angle at `h`, which has a twin; NaN where it is undefined."""
    quad = diamond(mesh, h)
    return angle(quad.i, quad.j, quad.k, quad.l)


@jit
def total(mesh):
    """Return the energy of the mesh in radians; edges without a defined angle add nothing."""
    angles = 0.0
    for h in range(len(mesh.origin)):
        if h < mesh.twin[h]:
            beta = edge_angle(mesh, h)
            if math.isfinite(beta):
                angles += beta
    return 2.0 * angles
