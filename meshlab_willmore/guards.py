"""Which flips are allowed beyond what the connectivity says: locks set once, and the fold guard.

Locks are a property of the input and are computed once; flips never change which edges are locked.
The fold guard looks at each flip by itself.
"""

import math
from typing import NamedTuple

import numpy as np

from .mesh.build import edge_ends
from .mesh.halfedge import NONE, diamond
from .mesh.jit import jit
from .mesh.points import angle_between, dot, norm, normal, subtract

FLAT_ANGLE = 180.0
SHAPE_OF_EQUILATERAL = 2.0 * math.sqrt(3.0)


class FoldLimits(NamedTuple):
    """When a flip counts as a fold.

    Attributes
    ----------
    active : bool
        Whether anything is refused at all.
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
    shape: float = 0.05


def fold_limits(foldangle):
    """Return the limits for a largest dihedral angle in degrees; 180 turns the guard off."""
    return FoldLimits(foldangle < FLAT_ANGLE, math.radians(foldangle))


@jit
def triangle_shape(a, b, c):
    """Return 4 sqrt(3) area / (sum of squared sides): 1 if equilateral, 0 if degenerate."""
    ab, bc, ca = subtract(b, a), subtract(c, b), subtract(a, c)
    squares = dot(ab, ab) + dot(bc, bc) + dot(ca, ca)
    if not squares > 0.0:
        return 0.0
    return SHAPE_OF_EQUILATERAL * norm(normal(a, b, c)) / squares


@jit
def dihedral_angle(mesh, h):
    """Return the angle between the normals at `h`, which has a twin; 0 if one is zero."""
    i, j, k, l = diamond(mesh, h)
    return angle_between(normal(i, j, k), normal(j, i, l))


@jit
def folds(mesh, h, limits):
    """Tell whether to flip `h` would fold the surface or make a sliver.

    True if the dihedral angle of the new edge exceeds both the old one and the limit, or if the
    worse shape of the two faces falls below both the old one and the limit.
    """
    if not limits.active:
        return False
    i, j, k, l = diamond(mesh, h)
    before = angle_between(normal(i, j, k), normal(j, i, l))
    after = angle_between(normal(k, i, l), normal(l, j, k))
    if after > max(before, limits.angle) + limits.slack:
        return True
    worse_before = min(triangle_shape(i, j, k), triangle_shape(j, i, l))
    worse_after = min(triangle_shape(k, i, l), triangle_shape(l, j, k))
    return worse_after < min(worse_before, limits.shape)


@jit
def _lock(mesh, h):
    mesh.locked[h] = True
    if mesh.twin[h] != NONE:
        mesh.locked[mesh.twin[h]] = True


@jit
def lock_unselected(mesh, selected):
    """Lock, in place, every edge of a face that the mask `selected` (m,) leaves out."""
    for h in range(len(mesh.origin)):
        if not selected[h // 3]:
            _lock(mesh, h)


@jit
def lock_creases(mesh, limit):
    """Lock, in place, every edge whose dihedral angle exceeds `limit` (radians)."""
    for h in range(len(mesh.origin)):
        if h < mesh.twin[h] and dihedral_angle(mesh, h) > limit:
            _lock(mesh, h)


def lock_edges(mesh, edges):
    """Lock, in place, the edges given as vertex pairs (e, 2).

    Raises
    ------
    ValueError
        Names the first pair that is no edge of the mesh.
    """
    low, high = edge_ends(mesh.origin.reshape(-1, 3))
    present = low.astype(np.int64) * len(mesh.vertices) + high
    wanted_low, wanted_high = edges.min(axis=1), edges.max(axis=1)
    wanted = wanted_low.astype(np.int64) * len(mesh.vertices) + wanted_high
    known = np.isin(wanted, present) & (wanted_low >= 0) & (wanted_high < len(mesh.vertices))
    if not known.all():
        first = int(np.argmin(known))
        a, b = edges[first]
        raise ValueError(f"locked_edges[{first}] = ({a}, {b}) is not an edge of the mesh")
    mesh.locked[np.isin(present, wanted)] = True
