"""Edges that stay: a property of the input, computed once.

Flips never change which edges are locked.
"""

import math

import numpy as np

from ..mesh.build import sort_by_vertex
from ..mesh.halfedge import NONE, diamond, following, previous
from ..mesh.jit import at, inner, jit
from .fold import dihedral_angle, triangle_shape

# Files hold coordinates in single precision: that far, in radians, the angles of a technical part
# are from the round numbers they were drawn with.
CREASE_SLACK = math.radians(0.01)
# The normal of a face of a lower shape is made of rounding, for the same reason.
CREASE_SHAPE = 1e-5


@inner
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
    edges of a cylinder with twelve sides are creases at 30 degrees in any position (to keep an
    edge too many harms no shape, to lose one does), and edges between coplanar faces are none even
    at 0 degrees. Degenerate faces have no creases.
    """
    least = max(limit - CREASE_SLACK, CREASE_SLACK)
    for h in range(len(mesh.origin)):
        if h < mesh.twin[h] and dihedral_angle(mesh, h) >= least and not _is_degenerate(mesh, h):
            _lock(mesh, h)


@jit
def lock_seams(mesh, uv):
    """Lock, in place, the seams of texture mappings, and all edges of faces that map nowhere.

    A seam is an edge whose two faces have other coordinates at one of its ends. A face maps nowhere
    if one of its coordinates is not finite.

    Parameters
    ----------
    mesh : Mesh
        Before any flip.
    uv : (3 m, 2 c) float64
        From `meshlab_willmore.guards.texture.texture_coordinates`.
    """
    for h in range(len(uv)):
        t = mesh.twin[h]
        if h < t and (_differ(uv, h, following(t)) or _differ(uv, following(h), t)):
            _lock(mesh, h)
        if not _is_finite(uv, h):
            for side in (h, following(h), previous(h)):
                _lock(mesh, side)


@inner
def _is_finite(uv, a):
    """Whether all texture coordinates of a corner are finite."""
    is_finite = True
    for column in range(uv.shape[1]):
        is_finite &= math.isfinite(uv[at(a), at(column)])
    return is_finite


@inner
def _differ(uv, a, b):
    """Whether two corners have different texture coordinates."""
    differ = False
    for column in range(uv.shape[1]):
        differ |= uv[at(a), at(column)] != uv[at(b), at(column)]
    return differ


@inner
def _is_degenerate(mesh, h):
    """Whether the normal of one of the two faces at `h` is made of rounding."""
    i, j, k, l = diamond(mesh, h)
    return min(triangle_shape(i, j, k), triangle_shape(j, i, l)) < CREASE_SHAPE


def lock_edges(mesh, edges):
    """Lock, in place, the edges given as vertex pairs (e, 2) int64.

    Raises
    ------
    ValueError
        Names the first pair that is no edge of the mesh.
    """
    if len(edges) == 0:
        return
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
