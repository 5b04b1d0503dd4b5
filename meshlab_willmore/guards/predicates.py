"""On which side of a plane or line a point lies: signs that rounding never falsifies.

A determinant of the coordinates is computed in floating point together with a bound of its error.
Where that does not settle the sign, it is computed again as an *expansion*: a sum of floats that
do not overlap, which holds every bit. Source: J. R. Shewchuk, "Adaptive precision floating-point
arithmetic and fast robust geometric predicates", 1997, DOI 10.1007/PL00009321. The bounds here are
larger than the ones there, so that they can be checked by counting operations.

All that needs products that neither overflow nor underflow: coordinates at unit scale (see
`meshlab_willmore.mesh.validate.to_unit_scale`) that are 0 or above 1e-90. A smaller one counts as
what is left of it.
"""

import numpy as np

from ..mesh.jit import allocating_inner, inner, outlined
from ..mesh.points import Point, cross, dot, subtract
from ..mesh.rounding import tail_of_product, tail_of_sum, tails

# Half a unit in the last place, relative.
UNIT = 2.0**-53
# Error bounds, as multiples of the same expression with all terms made positive.
BOUND_2D = 4.0 * UNIT
BOUND_3D = 8.0 * UNIT
# The same once only the squares of rounding errors are left out, and what the result itself adds.
BOUND_SQUARES = 128.0 * UNIT * UNIT
BOUND_RESULT = 64.0 * UNIT
# Terms of the determinants, times floats for each product.
ROOM_2D = 6 * 2
ROOM_3D = 24 * 4


@inner
def _add(expansion, count, value):
    """Add `value` to the first `count` floats, in place; return how many there are now.

    They stay sorted by magnitude, do not overlap, and none is 0.
    """
    kept = 0
    for place in range(count):
        total = value + expansion[place]
        tail = tail_of_sum(value, expansion[place], total)
        value = total
        if tail != 0.0:
            expansion[kept] = tail
            kept += 1
    if value != 0.0:
        expansion[kept] = value
        kept += 1
    return kept


@inner
def _add_product(expansion, count, a, b):
    rounded = a * b
    count = _add(expansion, count, tail_of_product(a, b, rounded))
    return _add(expansion, count, rounded)


@inner
def _add_triple(expansion, count, a, b, c):
    rounded = a * b
    count = _add_product(expansion, count, tail_of_product(a, b, rounded), c)
    return _add_product(expansion, count, rounded, c)


@inner
def _add_determinant(expansion, count, a, b, c):
    """Add the determinant of the rows `a`, `b`, `c`."""
    count = _add_triple(expansion, count, a.x, b.y, c.z)
    count = _add_triple(expansion, count, a.y, b.z, c.x)
    count = _add_triple(expansion, count, a.z, b.x, c.y)
    count = _add_triple(expansion, count, -a.z, b.y, c.x)
    count = _add_triple(expansion, count, -a.x, b.z, c.y)
    return _add_triple(expansion, count, -a.y, b.x, c.z)


@inner
def _negative(a):
    return Point(-a.x, -a.y, -a.z)


@inner
def _sign(value):
    if value > 0.0:
        return 1
    return -1 if value < 0.0 else 0


@inner
def _sign_of(expansion, count):
    """Return the sign of the sum, which is that of the largest float."""
    return 0 if count == 0 else _sign(expansion[count - 1])


@inner
def _is_zero(a):
    return a.x == 0.0 and a.y == 0.0 and a.z == 0.0


@allocating_inner
def _orient3d_again(a, b, c, d, size):
    """Do what `orient3d` does, where the error bound times `size` is too large."""
    # Seldom reached: an array of its own costs less than one that every caller carries along.
    expansion = np.empty(ROOM_3D)
    u, v, w = subtract(a, d), subtract(b, d), subtract(c, d)
    count = _add_determinant(expansion, 0, u, v, w)
    u_tail, v_tail, w_tail = tails(a, d, u), tails(b, d, v), tails(c, d, w)
    if _is_zero(u_tail) and _is_zero(v_tail) and _is_zero(w_tail):
        return _sign_of(expansion, count)
    rounded = 0.0
    for place in range(count):
        rounded += expansion[place]
    linear = dot(u_tail, cross(v, w)) + dot(v_tail, cross(w, u)) + dot(w_tail, cross(u, v))
    if abs(rounded + linear) > BOUND_SQUARES * size + BOUND_RESULT * abs(rounded):
        return _sign(rounded + linear)
    count = _add_determinant(expansion, 0, a, b, c)
    count = _add_determinant(expansion, count, _negative(a), b, d)
    count = _add_determinant(expansion, count, a, c, d)
    return _sign_of(expansion, _add_determinant(expansion, count, _negative(b), c, d))


@outlined
def orient3d(a, b, c, d):
    """Return the sign, -1, 0 or 1, of the determinant of the rows a - d, b - d, c - d.

    It is 0 exactly where the four points lie in a plane, and says otherwise on which side of the
    triangle (a, b, c) the point `d` lies: 1 where it sees it go round clockwise.
    """
    u, v, w = subtract(a, d), subtract(b, d), subtract(c, d)
    xy, yx = v.x * w.y, v.y * w.x
    yz, zy = v.y * w.z, v.z * w.y
    zx, xz = v.z * w.x, v.x * w.z
    value = u.x * (yz - zy) + u.y * (zx - xz) + u.z * (xy - yx)
    size = (
        abs(u.x) * (abs(yz) + abs(zy))
        + abs(u.y) * (abs(zx) + abs(xz))
        + abs(u.z) * (abs(xy) + abs(yx))
    )
    # Also where all is 0, which is exact.
    if abs(value) > BOUND_3D * size or size == 0.0:
        return _sign(value)
    return _orient3d_again(a, b, c, d, size)


@allocating_inner
def _orient2d_again(ax, ay, bx, by, cx, cy):
    expansion = np.empty(ROOM_2D)
    count = _add_product(expansion, 0, ax, by)
    count = _add_product(expansion, count, -ax, cy)
    count = _add_product(expansion, count, -cx, by)
    count = _add_product(expansion, count, -ay, bx)
    count = _add_product(expansion, count, ay, cx)
    return _sign_of(expansion, _add_product(expansion, count, cy, bx))


@inner
def orient2d(ax, ay, bx, by, cx, cy):
    """Return 1 where (a, b, c) go round counter-clockwise in the plane, -1 clockwise, 0 in line."""
    left, right = (ax - cx) * (by - cy), (ay - cy) * (bx - cx)
    value, size = left - right, abs(left) + abs(right)
    if abs(value) > BOUND_2D * size or size == 0.0:
        return _sign(value)
    return _orient2d_again(ax, ay, bx, by, cx, cy)


@inner
def projected_orient2d(a, b, c, axis):
    """Return `orient2d` of the projections of three points along the `axis` 0, 1 or 2."""
    if axis == 0:
        return orient2d(a.y, a.z, b.y, b.z, c.y, c.z)
    if axis == 1:
        return orient2d(a.z, a.x, b.z, b.x, c.z, c.x)
    return orient2d(a.x, a.y, b.x, b.y, c.x, c.y)
