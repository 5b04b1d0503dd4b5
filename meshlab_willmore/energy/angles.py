"""The intersection angle beta of the circumcircles of two neighbouring faces, and sums of it.

For the edge a-b with the faces (a, b, p) and (b, a, q) let c1, n1 be the scalar and the vector
product of the two sides at p, and c2, n2 those at q. The quaternionic cross-ratio of the four
points has, up to a positive factor, the real part r and an imaginary part of the length s in

    r = n1 . n2 - c1 c2        s = | c1 n2 + c2 n1 - n1 x n2 |        beta = atan2(s, r)

(A. I. Bobenko, "A conformal energy for simplicial surfaces", 2005). Both are off by a few
roundings of ``hypot(r, s)`` only, so beta is good to some 1e-15 everywhere, also near 0 and pi,
where an `acos` or a square root of ``1 - r * r`` would lose half of the digits.

A sum of angles takes a single `atan2`: the complex numbers (r, s) are multiplied, and since each
angle lies in [0, pi] it is enough to count the half-turns on the way. So does the difference of two
sums. None of this has branches, so that loops over many edges become vector instructions.
"""

import math
from typing import NamedTuple

from ..mesh.jit import inlined, inner
from ..mesh.points import cross, dot, subtract

# An angle of which the sign is clear without an `atan2` is farther from zero than this (radians).
CLEAR = 1e-6


class ComplexAngle(NamedTuple):
    """An angle in [0, pi] as a complex number r + i s with s >= 0, of any length but zero."""

    r: float
    s: float


class AngleSum(NamedTuple):
    """A sum of angles: `half_turns` times pi plus the argument of r + i s.

    The argument is in [0, pi), that of a difference of two sums in (-pi, pi).
    """

    r: float
    s: float
    half_turns: float


NO_ANGLES = AngleSum(1.0, 0.0, 0.0)


@inlined
def complex_angle(a_p, b_p, a_q, b_q):
    """Return the intersection angle at the edge a-b of the faces (a, b, p) and (b, a, q).

    Parameters
    ----------
    a_p, b_p, a_q, b_q : Point
        The vectors between these points; those of a pair point the same way, to the apex or from
        it. Differences, and not points, since they keep the digits that matter far from the origin.

    Returns
    -------
    ComplexAngle
        Of a length between 0.7 and 1; NaN if one of a, b coincides with one of p, q.
    """
    c1, n1 = dot(a_p, b_p), cross(a_p, b_p)
    c2, n2 = dot(b_q, a_q), cross(b_q, a_q)
    n3 = cross(n1, n2)
    x = c1 * n2.x + c2 * n1.x - n3.x
    y = c1 * n2.y + c2 * n1.y - n3.y
    z = c1 * n2.z + c2 * n1.z - n3.z
    r, s = dot(n1, n2) - c1 * c2, math.sqrt(x * x + y * y + z * z)
    # The 1-norm is cheaper than the length, and as good to keep products of angles in range.
    size = abs(r) + s
    # Divisions, since the inverse of the least numbers is out of range.
    size = size if size > 0.0 else math.nan
    return ComplexAngle(r / size, s / size)


@inner
def angle(a, b, p, q):
    """Return in radians what `complex_angle` returns as a complex number, for four points."""
    beta = complex_angle(subtract(a, p), subtract(b, p), subtract(a, q), subtract(b, q))
    return math.atan2(beta.s, beta.r)


@inlined
def add(total, beta):
    """Return the sum `total` with the angle `beta` added."""
    r = total.r * beta.r - total.s * beta.s
    s = total.r * beta.s + total.s * beta.r
    is_past = (s < 0.0) | ((s == 0.0) & (r < 0.0))
    sign = -1.0 if is_past else 1.0
    return AngleSum(sign * r, sign * s, total.half_turns + (1.0 if is_past else 0.0))


@inlined
def difference(one, other):
    """Return the sum `one` minus the sum `other`."""
    r = one.r * other.r + one.s * other.s
    s = one.s * other.r - one.r * other.s
    return AngleSum(r, s, one.half_turns - other.half_turns)


@inlined
def radians(total):
    """Return the value of a sum of angles, or of a difference of two."""
    return math.pi * total.half_turns + math.atan2(total.s, total.r)


@inlined
def rough(total):
    """Return a number that compares as `radians` does with numbers between -CLEAR and CLEAR.

    It is the same number where it is not farther from zero than that.
    """
    if total.half_turns == 0.0:
        sine = total.s / (abs(total.r) + abs(total.s))
        if abs(sine) > CLEAR:
            return sine
    return radians(total)
