"""The fold guard, which looks at each flip by itself, and the angles and shapes that it goes by.

It keeps the surface from folding, and texture mappings too (see `texture`).
"""

import math
from typing import NamedTuple

from ..mesh.halfedge import diamond
from ..mesh.jit import inlined, inner
from ..mesh.points import angle_between, dot, norm, normal, subtract
from .texture import inverts_texture

FLAT_ANGLE = 180.0
RIGHT_ANGLE = 0.5 * math.pi
SLIVER = 0.05
SHAPE_OF_EQUILATERAL = 2.0 * math.sqrt(3.0)


class FoldLimits(NamedTuple):
    """When a flip counts as a fold.

    Attributes
    ----------
    active : bool
        Whether any fold of the surface is refused, or any sliver.
    angle : float
        Dihedral angle in radians, 0 between coplanar faces, that a new edge may always have.
    slack : float
        Radians by which rounding may push an angle over its limit (right angles are common).
    shape : float
        Triangle shape in [0, 1] below which a flip must not bring the worse face.
    """

    active: bool
    angle: float
    slack: float = 1e-9
    shape: float = SLIVER


def fold_limits(foldangle, minshape=SLIVER):
    """Return the limits of a flip.

    Parameters
    ----------
    foldangle : float
        Largest dihedral angle in degrees; 180 allows the surface to fold.
    minshape : float
        Least triangle shape; 0 allows slivers.
    """
    is_active = foldangle < FLAT_ANGLE or minshape > 0.0
    return FoldLimits(is_active, math.radians(foldangle), shape=minshape)


@inlined
def triangle_shape(a, b, c):
    """Return 4 sqrt(3) area / (sum of squared sides): 1 if equilateral, 0 if degenerate."""
    ab, bc, ca = subtract(b, a), subtract(c, b), subtract(a, c)
    squares = dot(ab, ab) + dot(bc, bc) + dot(ca, ca)
    # Without a branch: loops over faces become vector instructions.
    return SHAPE_OF_EQUILATERAL * norm(normal(a, b, c)) / (squares if squares > 0.0 else math.inf)


@inner
def dihedral_angle(mesh, h):
    """Return the angle between the normals at `h`, which has a twin; 0 if one is zero."""
    i, j, k, l = diamond(mesh, h)
    return angle_between(normal(i, j, k), normal(j, i, l))


@inlined
def folds(mesh, h, limits):
    """Whether to flip `h` would fold the surface, make a sliver, or fold a texture mapping.

    True if the dihedral angle of the new edge exceeds both the old one and the limit, if the worse
    shape of the two faces falls below both the old one and the limit, or by `inverts_texture`.
    """
    if limits.active and _folds_surface(mesh, h, limits):
        return True
    return len(mesh.uv) > 0 and inverts_texture(mesh, h)


@inner
def _folds_surface(mesh, h, limits):
    i, j, k, l = diamond(mesh, h)
    one, other = normal(k, i, l), normal(l, j, k)
    # Most new edges are blunt enough for every limit that is a right angle or more.
    if limits.angle < RIGHT_ANGLE or not dot(one, other) >= 0.0:
        before = angle_between(normal(i, j, k), normal(j, i, l))
        if angle_between(one, other) > max(before, limits.angle) + limits.slack:
            return True
    worse_after = min(triangle_shape(k, i, l), triangle_shape(l, j, k))
    if worse_after >= limits.shape:
        return False
    return worse_after < min(triangle_shape(i, j, k), triangle_shape(j, i, l))
