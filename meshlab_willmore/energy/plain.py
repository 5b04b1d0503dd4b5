"""Normals and angles without branches and calls: loops over edges become vector instructions.

They serve triangles that are neither thin nor tiny. Of the others they make NaN, which goes through
all arithmetic, so that one look at the end says whether `meshlab_willmore.mesh.rounding` is needed.
"""

import math
from typing import NamedTuple

from ..mesh.jit import inlined
from ..mesh.points import Point, cross, dot, subtract
from ..mesh.rounding import SHORT_SQUARED

# Square of the least sine between two sides whose product is a normal: eight digits of 53 are lost.
# A sum of such normals' lengths, or of their angles, is off by far less than `triangles.ROUNDING`.
THIN_SQUARED_SINE = 2.0**-16

# Tangents up to that of an eighth of a half-turn have the arctangent t + t u p(u) with u = t * t.
# The polynomial p is the best one by Remez's algorithm: the relative error is 4e-17.
TAN_EIGHTH = math.sqrt(2.0) - 1.0
P = (
    -0.3333333333333022,
    0.19999999999104584,
    -0.1428571419651579,
    0.11111106703038509,
    -0.09090783515840607,
    0.0769008317208625,
    -0.06641244674101313,
    0.05693156741216617,
    -0.043608027494480284,
    0.02127987372348605,
)


class QuadNormals(NamedTuple):
    """Normals of the faces (i, j, k), (j, i, l) before a flip, (k, i, l), (l, j, k) after it.

    They are as long as twice the area, and go by the corner that is not on the diagonal.
    """

    at_k: Point
    at_l: Point
    at_i: Point
    at_j: Point


@inlined
def plain_normal(u, v):
    """Return the product of two sides of a triangle; NaN if it is too thin, or too short."""
    vector = cross(u, v)
    size = dot(vector, vector)
    is_good = (size >= THIN_SQUARED_SINE * (dot(u, u) * dot(v, v))) & (size >= SHORT_SQUARED)
    return Point(vector.x if is_good else math.nan, vector.y, vector.z)


@inlined
def quad_normals(quad):
    """Return the normals of the two faces at an edge before its flip, and after it.

    Parameters
    ----------
    quad : Diamond

    Returns
    -------
    QuadNormals
    """
    i, j, k, l = quad
    i_j, k_l = subtract(j, i), subtract(l, k)
    return QuadNormals(
        plain_normal(i_j, subtract(k, i)),
        plain_normal(subtract(l, i), i_j),
        plain_normal(subtract(i, k), k_l),
        plain_normal(k_l, subtract(j, k)),
    )


@inlined
def _series(u):
    low = P[0] + u * (P[1] + u * (P[2] + u * (P[3] + u * P[4])))
    high = P[5] + u * (P[6] + u * (P[7] + u * (P[8] + u * P[9])))
    return low + (u * u) * (u * u) * (u * high)


@inlined
def arctangent(s, r):
    """Return ``atan2(s, r)``, good to a few roundings; NaN if both are zero or one is infinite."""
    across, along = abs(s), abs(r)
    is_steep = across > along
    least, most = (along, across) if is_steep else (across, along)
    most = most if most > 0.0 else math.nan
    is_far = least > TAN_EIGHTH * most
    t = (least - most if is_far else least) / (least + most if is_far else most)
    u = t * t
    angle = (0.25 * math.pi if is_far else 0.0) + (t + t * (u * _series(u)))
    angle = 0.5 * math.pi - angle if is_steep else angle
    angle = math.pi - angle if r < 0.0 else angle
    return math.copysign(angle, s)
