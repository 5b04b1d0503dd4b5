"""Which flips are allowed beyond what the connectivity says: locks set once, and the fold guard.

Locks are a property of the input and are computed once; flips never change which edges are locked.
The fold guard looks at each flip by itself.
"""

import math
from typing import NamedTuple

import numpy as np

from .mesh.build import sort_by_vertex
from .mesh.halfedge import NONE, diamond, following, previous
from .mesh.jit import jit
from .mesh.points import angle_between, dot, norm, normal, subtract

FLAT_ANGLE = 180.0
# Files hold coordinates in single precision: that far, in radians, the angles of a technical part
# are from the round numbers they were drawn with.
CREASE_SLACK = math.radians(0.01)
# The normal of a face of a lower shape is made of rounding, for the same reason.
CREASE_SHAPE = 1e-5
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
    """Lock, in place, every edge whose dihedral angle is `limit` (radians) or more.

    Both the limit and flatness are met up to `CREASE_SLACK`, so that rounding decides nothing: the
    edges of a cylinder with twelve sides are creases at 30 degrees wherever it stands (to keep an
    edge too many harms no shape, to lose one does), and edges between coplanar faces are none even
    at 0 degrees. Degenerate faces have no creases.
    """
    least = max(limit - CREASE_SLACK, CREASE_SLACK)
    for h in range(len(mesh.origin)):
        if h < mesh.twin[h] and dihedral_angle(mesh, h) >= least and not _is_degenerate(mesh, h):
            _lock(mesh, h)


@jit
def _is_degenerate(mesh, h):
    """Tell whether one of the two faces at `h` has no normal to speak of."""
    i, j, k, l = diamond(mesh, h)
    return min(triangle_shape(i, j, k), triangle_shape(j, i, l)) < CREASE_SHAPE


def lock_edges(mesh, edges):
    """Lock, in place, the edges given as vertex pairs (e, 2) int64.

    Raises
    ------
    ValueError
        Names the first pair that is no edge of the mesh.
    """
    vertex_count = len(mesh.vertices)
    outside = ((edges < 0) | (edges >= vertex_count)).any(axis=1)
    inside = edges[: np.argmax(outside)] if outside.any() else edges
    starts = np.empty(vertex_count + 2, np.int64)
    by_origin = sort_by_vertex(np.arange(len(mesh.origin), dtype=np.int32), mesh.origin, starts)
    first_wrong = _lock_pairs(mesh, inside, by_origin, starts)
    if first_wrong < len(edges):
        a, b = edges[first_wrong]
        raise ValueError(f"locked_edges[{first_wrong}] = ({a}, {b}) is not an edge of the mesh")


@jit
def _lock_pairs(mesh, pairs, by_origin, starts):
    """Lock the edges `pairs` in place; return the number of pairs before the first that is none.

    The half-edges are given by origin, as `sort_by_vertex` leaves them. Not by their twins: edges
    that are not manifold have none, but are edges too.
    """
    for e in range(len(pairs)):
        a, b = pairs[e]
        # The end with fewer faces is the one to search: the other may have a great many.
        if starts[a + 1] - starts[a] > starts[b + 1] - starts[b]:
            a, b = b, a
        found = False
        for h in by_origin[starts[a] : starts[a + 1]]:
            if mesh.origin[following(h)] == b:
                mesh.locked[h] = found = True
            if mesh.origin[previous(h)] == b:
                mesh.locked[previous(h)] = found = True
        if not found:
            return e
    return len(pairs)
