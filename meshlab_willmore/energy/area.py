"""The area of a mesh, in squared units of its coordinates.

In the plane all triangulations without folds have the same area, so flat parts tie at 0. Source of
the comparison: "Mesh optimisation based on Willmore energy", sections 1 and 2.
"""

import math

from ..mesh.halfedge import diamond
from ..mesh.jit import inner, jit
from .triangles import ROUNDING, corners, has_coincident_corners, twice_area


@inner
def cost_reduction(mesh, h):
    """Return the drop of the area, in squared units of the coordinates."""
    quad = diamond(mesh, h)
    if has_coincident_corners(quad):
        return -math.inf
    i, j, k, l = quad
    before = twice_area(i, j, k) + twice_area(j, i, l)
    after = twice_area(k, i, l) + twice_area(l, j, k)
    gain = 0.5 * (before - after)
    # Beside a small part there may be a huge one: what counts as rounding depends on the faces.
    if abs(gain) <= ROUNDING * (before + after):
        return 0.0
    return gain if math.isfinite(gain) else -math.inf


@jit
def total(mesh):
    """Return the area of the mesh in squared units of the coordinates."""
    twice = 0.0
    for f in range(len(mesh.origin) // 3):
        a, b, c = corners(mesh, f)
        twice += twice_area(a, b, c)
    return 0.5 * twice
