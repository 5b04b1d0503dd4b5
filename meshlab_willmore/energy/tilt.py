"""The mean curvature, and how much faces are tilted against the normals at their corners.

To the total absolute mean curvature (see `meshlab_willmore.energy.mean_curvature`) each face adds
`WEIGHT` times its perimeter, times the angle between its normal and the sum of the unit normals of
its three corners. These normals are the last three of six columns of ``mesh.vertices``. They do not
change with the flips, so the sum is a function of the mesh. Where one of the two vectors is zero,
the angle is 0.

The mean curvature alone compares faces with each other only, so it cannot tell a surface from one
that is as smooth, but tilted. The curvature of N. Dyn, K. Hormann, S.-J. Kim and D. Levin,
"Optimizing 3D triangulations using discrete curvature analysis", 2001, as MeshLab sums it up from
the angles between the normals of faces and of vertices, can.
"""

import math

from ..mesh.halfedge import apex, diamond
from ..mesh.jit import at, inlined, inner, jit
from ..mesh.points import Point, add, angle_between, norm, subtract
from ..mesh.rounding import good_direction
from . import mean_curvature
from .triangles import corners, drop_of

# Of a length times an angle, as those of the mean curvature.
WEIGHT = 2.0


@inlined
def _normal_at(mesh, v):
    """Return the unit normal that belongs to a vertex."""
    row = at(v)
    return Point(mesh.vertices[row, 3], mesh.vertices[row, 4], mesh.vertices[row, 5])


@inner
def _tilt(a, b, c, direction):
    """Return the perimeter of a triangle times the angle between its normal and a vector."""
    perimeter = norm(subtract(b, a)) + norm(subtract(c, b)) + norm(subtract(a, c))
    return perimeter * angle_between(good_direction(a, b, c), direction)


@inner
def cost_reduction(mesh, h):
    """Return the drop of the sum, in units of the coordinates times radians.

    It is minus infinity where the one of the mean curvature is.
    """
    gain = mean_curvature.cost_reduction(mesh, h)
    if not math.isfinite(gain):
        return gain
    i, j, k, l = diamond(mesh, h)
    t = mesh.twin[at(h)]
    at_i, at_j = _normal_at(mesh, mesh.origin[at(h)]), _normal_at(mesh, mesh.origin[at(t)])
    at_k, at_l = _normal_at(mesh, apex(mesh, h)), _normal_at(mesh, apex(mesh, t))
    at_ij, at_kl = add(at_i, at_j), add(at_k, at_l)
    before = _tilt(i, j, k, add(at_ij, at_k)) + _tilt(j, i, l, add(at_ij, at_l))
    after = _tilt(k, i, l, add(at_kl, at_i)) + _tilt(l, j, k, add(at_kl, at_j))
    return gain + WEIGHT * drop_of(before, after)


@jit
def total(mesh):
    """Return the sum, in units of the coordinates times radians."""
    tilts = 0.0
    for f in range(len(mesh.origin) // 3):
        a, b, c = corners(mesh, f)
        first, second = mesh.origin[at(3 * f)], mesh.origin[at(3 * f + 1)]
        direction = add(_normal_at(mesh, first), _normal_at(mesh, second))
        third = _normal_at(mesh, mesh.origin[at(3 * f + 2)])
        tilts += _tilt(a, b, c, add(direction, third))
    return mean_curvature.total(mesh) + WEIGHT * tilts
