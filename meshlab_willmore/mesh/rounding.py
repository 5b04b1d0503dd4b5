"""What rounding takes away, and normals of triangles that lose nothing by it.

Sources: D. E. Knuth, "The Art of Computer Programming", volume 2, section 4.2.2 (sums), and T. J.
Dekker, "A floating-point technique for extending the available precision", 1971, DOI
10.1007/BF01397083 (products).
"""

from .jit import inner
from .points import Point, cross, dot, subtract

# A factor that splits a float into two halves of 26 bits.
SPLITTER = 2.0**27 + 1.0
# What is left of a difference of two products below this part of them is made of rounding.
ROUNDING_TWICE = 2.0**-98
# Square of twice the area over the sum of the squared sides, below which a few digits are lost.
THIN_SQUARED = 2.0**-20
# Normals shorter than this are made longer where only their direction counts.
SHORT_SQUARED = 2.0**-400


@inner
def tail_of_sum(a, b, rounded):
    """Return exactly what `rounded`, the float a + b, lacks."""
    b_part = rounded - a
    return (a - (rounded - b_part)) + (b - b_part)


@inner
def tail_of_product(a, b, rounded):
    """Return exactly what `rounded`, the float a * b, lacks."""
    a_big = SPLITTER * a
    a_high = a_big - (a_big - a)
    a_low = a - a_high
    b_big = SPLITTER * b
    b_high = b_big - (b_big - b)
    b_low = b - b_high
    return a_low * b_low - (((rounded - a_high * b_high) - a_low * b_high) - a_high * b_low)


@inner
def tails(a, d, rounded):
    """Return what the vector `rounded` from `d` to `a` lacks."""
    return Point(
        tail_of_sum(a.x, -d.x, rounded.x),
        tail_of_sum(a.y, -d.y, rounded.y),
        tail_of_sum(a.z, -d.z, rounded.z),
    )


@inner
def _minor(a, b, c, d):
    """Return a b - c d, where each is a float and what it lacks; 0 where that is but rounding."""
    one, other = a[0] * b[0], c[0] * d[0]
    gap = one - other
    tail = tail_of_sum(one, -other, gap)
    tail += tail_of_product(a[0], b[0], one) - tail_of_product(c[0], d[0], other)
    tail += (a[0] * b[1] + a[1] * b[0]) - (c[0] * d[1] + c[1] * d[0])
    result = gap + tail
    return 0.0 if abs(result) <= ROUNDING_TWICE * (abs(one) + abs(other)) else result


@inner
def _cross_of_sides(p, a, b):
    """Return the vector product of the sides from `p` to `a` and to `b`, all digits good."""
    u, v = subtract(a, p), subtract(b, p)
    u_tail, v_tail = tails(a, p, u), tails(b, p, v)
    ux, uy, uz = (u.x, u_tail.x), (u.y, u_tail.y), (u.z, u_tail.z)
    vx, vy, vz = (v.x, v_tail.x), (v.y, v_tail.y), (v.z, v_tail.z)
    return Point(_minor(uy, vz, uz, vy), _minor(uz, vx, ux, vz), _minor(ux, vy, uy, vx))


@inner
def good_normal(a, b, c):
    """Return the normal of a triangle, however thin that is, and the sum of its squared sides.

    The two shorter sides enclose the angle of the largest sine, so their product is the one that
    rounding harms least: of a needle, all digits are good. Where the three points are nearly in
    line, the product is computed with twice the digits. So the normal hardly depends on the corner
    at which the triangle starts.

    Returns
    -------
    normal : Point
        As long as twice the area; zero if the three points are in line.
    squares : float
    """
    ab, bc, ca = subtract(b, a), subtract(c, b), subtract(a, c)
    ab2, bc2, ca2 = dot(ab, ab), dot(bc, bc), dot(ca, ca)
    squares = ab2 + bc2 + ca2
    if ab2 >= bc2 and ab2 >= ca2:
        vector, p, q, r = cross(bc, ca), c, a, b
    elif bc2 >= ca2:
        vector, p, q, r = cross(ca, ab), a, b, c
    else:
        vector, p, q, r = cross(ab, bc), b, c, a
    if dot(vector, vector) < THIN_SQUARED * squares * squares:
        vector = _cross_of_sides(p, q, r)
    return vector, squares


@inner
def good_direction(a, b, c):
    """Return a normal of a triangle of which only the direction counts, as `good_normal` does."""
    vector, _ = good_normal(a, b, c)
    if dot(vector, vector) < SHORT_SQUARED:
        size = max(abs(vector.x), abs(vector.y), abs(vector.z))
        if size > 0.0:
            return Point(vector.x / size, vector.y / size, vector.z / size)
    return vector
