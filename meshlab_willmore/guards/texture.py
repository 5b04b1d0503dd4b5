"""The guard of texture mappings: a flip turns no texture triangle over, and makes none flat.

A corner of a face may have texture coordinates, which map the face to a triangle in the plane. The
sign of that triangle's area is 1, -1, or 0 where it is flat. Within a chart all signs should be the
same: 1, or -1 where the chart is mirrored. A flip takes the texture triangles (i, j, k) and
(j, i, l) and makes (k, i, l) and (l, j, k) of them. It is allowed if

- the new signs are the old ones, in either order: two triangles of one sign stay two of that sign,
  and two flat ones (faces without a mapping have all corners at one point) stay flat; or
- one of the old triangles was flat, and both new ones have the sign of the other one.

So the triangles of either sign never get fewer, nor flat ones more, and none of the wrong sign, of
whichever sign a chart is, is added but for a flat one beside another.

Signs are exact. Besides, a new triangle that is not flat must be so far from it that any formula
for the area gives the right sign in floating point.
"""

import math
from typing import NamedTuple

import numpy as np

from ..mesh.halfedge import previous
from ..mesh.jit import at, inner, jit
from .predicates import orient2d

# Twice an area is computed from differences of coordinates with an error below this part of the
# triangle's width times height, whichever corner they are taken from.
ROUNDING = 2.0**-48


class TexturePoint(NamedTuple):
    """Where the mapping puts a corner."""

    u: float
    v: float


def texture_coordinates(wedge_uv, order):
    """Return texture coordinates by half-edge, each mapping at unit scale.

    Parameters
    ----------
    wedge_uv : (m, 3, 2 c) float64
        For each corner of a face the coordinates in each of c mappings.
    order : (m,) int32
        The faces in the order of the mesh.

    Returns
    -------
    (3 m, 2 c) float64
        Scaled by powers of two, so that products neither overflow nor underflow.
    """
    uv = wedge_uv[order].reshape(-1, wedge_uv.shape[2])
    _bring_to_unit_scale(uv)
    return uv


@jit
def _bring_to_unit_scale(uv):
    """Scale each mapping, in place, so that its largest finite coordinate lies in [0.5, 1)."""
    for first in range(0, uv.shape[1], 2):
        largest = 0.0
        for row in range(len(uv)):
            for column in (first, first + 1):
                size = abs(uv[at(row), at(column)])
                if largest < size < np.inf:
                    largest = size
        _, exponent = math.frexp(largest)
        # Two steps, as 2**-exponent itself may not be a float.
        half = -exponent // 2
        one, other = math.ldexp(1.0, half), math.ldexp(1.0, -exponent - half)
        for row in range(len(uv)):
            for column in (first, first + 1):
                uv[at(row), at(column)] = uv[at(row), at(column)] * one * other


@inner
def _texture_point(mesh, uv, h, first):
    row = at(mesh.corner[at(h)])
    return TexturePoint(uv[row, at(first)], uv[row, at(first + 1)])


@inner
def _clear_sign(a, b, c):
    """Return the sign of the area of a texture triangle, or 0 where rounding could change it."""
    area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u)
    width = max(a.u, b.u, c.u) - min(a.u, b.u, c.u)
    height = max(a.v, b.v, c.v) - min(a.v, b.v, c.v)
    if abs(area) > ROUNDING * width * height:
        return 1 if area > 0.0 else -1
    return 0


@inner
def _sign(a, b, c):
    """Return the sign of the area of a texture triangle."""
    clear = _clear_sign(a, b, c)
    return clear if clear != 0 else orient2d(a.u, a.v, b.u, b.v, c.u, c.v)


@inner
def _inverts_mapping(mesh, h, uv, first):
    """Do what `inverts_texture` does, for the mapping that starts at the column `first`."""
    t = mesh.twin[at(h)]
    i = _texture_point(mesh, uv, h, first)
    j = _texture_point(mesh, uv, t, first)
    k = _texture_point(mesh, uv, previous(h), first)
    l = _texture_point(mesh, uv, previous(t), first)
    one, other = _sign(i, j, k), _sign(j, i, l)
    new_one, new_other = _clear_sign(k, i, l), _clear_sign(l, j, k)
    if one == other and one != 0:
        return not (new_one == one and new_other == one)
    # What is flat only by rounding is refused.
    if new_one != _sign(k, i, l) or new_other != _sign(l, j, k):
        return True
    if one * other == 0 and new_one == new_other == one + other:
        return False
    return not (new_one + new_other == one + other and new_one * new_other == one * other)


@inner
def inverts_texture(mesh, h):
    """Whether the flip of `h` would turn a texture triangle over or make it flat.

    Parameters
    ----------
    mesh : Mesh
        Its `uv` is from `texture_coordinates`; without any, nothing is refused.
    h : int
        Half-edge that is free; its edge is no seam, see `meshlab_willmore.guards.locks.lock_seams`.
    """
    refused = False
    for first in range(0, mesh.uv.shape[1], 2):
        refused = refused or _inverts_mapping(mesh, h, mesh.uv, first)
    return refused
