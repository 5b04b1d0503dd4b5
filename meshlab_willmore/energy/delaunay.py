"""The harmonic index of a mesh: the sum of the cotangents of all its angles.

For a triangle with the sides a, b, c it is (a^2 + b^2 + c^2) / (4 area): no unit, least if
equilateral. In the plane every flip that makes an edge locally Delaunay (the angles opposite to it
sum to more than pi) lowers the sum, so its descent ends at the Delaunay triangulation (O. R. Musin,
"Properties of the Delaunay triangulation", Symposium on Computational Geometry, 1997,
doi:10.1145/262839.263061). Up to a factor it is the sum of the Dirichlet energies of the hat
functions, the trace of the cotangent Laplacian, each of which a Delaunay triangulation minimises
(R. Chen et al., "A spectral characterization of the Delaunay triangulation", 2010,
doi:10.1016/j.cagd.2010.02.002; on surfaces A. I. Bobenko and B. A. Springborn, "A discrete
Laplace-Beltrami operator for simplicial surfaces", 2007, doi:10.1007/s00454-007-9006-1).

On a bent pair of faces the new edge k-l is straight in space, and so shorter than the one that
those sources draw on the surface. The sum stays a function of the mesh, and its descent ends. But
areas have no sign here: where the quad is not convex, the flip that folds the surface may lower the
sum too, and only the fold guard forbids it.
"""

import math

from ..mesh.halfedge import diamond
from ..mesh.jit import inlined, inner, jit
from ..mesh.points import dot, norm, subtract
from ..mesh.rounding import good_normal
from .plain import quad_normals
from .triangles import corners, drop_of, has_coincident_corners, without_rounding
from .wings import wings_of

# A face without area counts as one of this sum: an infinite one would forbid the flip that removes
# it. Flatter than this, and still not quite flat, are hardly any.
FLATTEST = 2.0**60


@inner
def _cotangents(a, b, c):
    """Return the sum of the cotangents of the angles of a triangle, and whether it is larger."""
    normal, squares = good_normal(a, b, c)
    four_areas = 2.0 * norm(normal)
    if four_areas * FLATTEST <= squares:
        return FLATTEST, four_areas > 0.0
    return squares / four_areas, False


@inlined
def _squared_length(a, b):
    side = subtract(b, a)
    return dot(side, side)


@inlined
def quick_reduction(quad, wings):
    """Return the cost reduction in plain arithmetic; NaN where `cost_reduction` looks closer."""
    i, j, k, l = quad
    normals = quad_normals(quad)
    i_j, k_l = _squared_length(i, j), _squared_length(k, l)
    j_k, k_i = _squared_length(j, k), _squared_length(k, i)
    i_l, l_j = _squared_length(i, l), _squared_length(l, j)
    before = (i_j + j_k + k_i) / norm(normals.at_k) + (i_j + i_l + l_j) / norm(normals.at_l)
    after = (k_l + k_i + i_l) / norm(normals.at_i) + (k_l + l_j + j_k) / norm(normals.at_j)
    return 0.5 * without_rounding(before - after, before + after)


@inner
def _careful_reduction(mesh, h):
    quad = diamond(mesh, h)
    if has_coincident_corners(quad):
        return -math.inf
    i, j, k, l = quad
    before, after = 0.0, 0.0
    for old, new in (((i, j, k), (k, i, l)), ((j, i, l), (l, j, k))):
        had, had_more = _cotangents(*old)
        has, has_more = _cotangents(*new)
        if had_more or has_more:
            return -math.inf
        before += had
        after += has
    return drop_of(before, after)


@inner
def cost_reduction(mesh, h):
    """Return the drop of the sum of the cotangents, a pure number.

    It is minus infinity also where a face has more than `FLATTEST` without being flat.
    """
    gain = quick_reduction(diamond(mesh, h), wings_of(mesh, h))
    return gain if math.isfinite(gain) else _careful_reduction(mesh, h)


@jit
def total(mesh):
    """Return the sum of the cotangents of all angles; a face adds `FLATTEST` at most."""
    cotangents = 0.0
    for f in range(len(mesh.origin) // 3):
        a, b, c = corners(mesh, f)
        cotangents += _cotangents(a, b, c)[0]
    return cotangents
