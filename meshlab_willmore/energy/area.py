"""The area of a mesh, in squared units of its coordinates.

In the plane all triangulations without folds have the same area, so flat parts tie at 0. Source of
the comparison: "Mesh optimisation based on Willmore energy", sections 1 and 2.
"""

import math

from ..mesh.halfedge import diamond
from ..mesh.jit import inlined, inner, jit
from ..mesh.points import norm
from .plain import quad_normals
from .triangles import corners, drop_of, has_coincident_corners, twice_area, without_rounding
from .wings import wings_of


@inlined
def quick_reduction(quad, wings):
    """Return the cost reduction in plain arithmetic; NaN where `cost_reduction` looks closer."""
    normals = quad_normals(quad)
    before = norm(normals.at_k) + norm(normals.at_l)
    after = norm(normals.at_i) + norm(normals.at_j)
    return 0.5 * without_rounding(before - after, before + after)


@inner
def _careful_reduction(mesh, h):
    quad = diamond(mesh, h)
    if has_coincident_corners(quad):
        return -math.inf
    i, j, k, l = quad
    before = twice_area(i, j, k) + twice_area(j, i, l)
    after = twice_area(k, i, l) + twice_area(l, j, k)
    return 0.5 * drop_of(before, after)


@inner
def cost_reduction(mesh, h):
    """Return the drop of the area, in squared units of the coordinates."""
    gain = quick_reduction(diamond(mesh, h), wings_of(mesh, h))
    return gain if math.isfinite(gain) else _careful_reduction(mesh, h)


@jit
def total(mesh):
    """Return the area of the mesh in squared units of the coordinates."""
    twice = 0.0
    for f in range(len(mesh.origin) // 3):
        a, b, c = corners(mesh, f)
        twice += twice_area(a, b, c)
    return 0.5 * twice
