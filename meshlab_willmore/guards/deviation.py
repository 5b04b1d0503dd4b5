"""How far flips take the surface from the input, and the guard that limits it.

**Theorem.** Let a flip replace the faces at the edge i-j by those at k-l, and let d be the distance
between the segments i-j and k-l. Then each point of the new faces is at most d away from a point of
the old faces, and each point of the old faces at most d away from one of the new.

*Proof.* Let p be a point of i-j and q one of k-l, as near to each other as possible. Cut a square
into four triangles at its middle, and map its corners, in order, to i, l, j and k. The map that is
linear on each triangle covers both old faces if it takes the middle to p, and both new ones if it
takes it to q. Where the middle has the barycentric coordinate w, the images of a point of the
square are w d apart, which is at most d. Each point of either pair of faces is such an image.

Each face f has a bound ``deviation[f]``, 0 in the input. A flip gives both new faces the larger
bound of the two old ones, plus d. By induction over the flips,

- each point of a face f of the result is at most ``deviation[f]`` away from a point of the input:
  a point of a new face is at most d away from a point of an old one, for which that holds;
- each point of the input is at most ``deviation[f]`` away from a point of some face f of the
  result: if f is flipped, that point is at most d away from one of the new faces.

So the largest bound of all faces bounds the Hausdorff distance between result and input. A flip is
refused if the new bound would exceed the limit. Where the two diagonals cross, seen along their
common normal, d is their distance along it; where they do not cross, the flip folds, and d is more.
"""

import math

from ..mesh.halfedge import diamond
from ..mesh.jit import at, inlined, inner
from ..mesh.points import dot, subtract

# What a bound may exceed the limit by, at unit scale: the rounding of some thousand distances.
# Without it, no edge of a plane that is not parallel to two axes could be flipped at a limit of 0.
SLACK = 1e-12


@inlined
def _within_unit(t):
    return min(max(t, 0.0), 1.0)


@inner
def segment_distance(a, b, c, d):
    """Return the distance between the segments a-b and c-d.

    Rounding makes it the distance between two points of the segments that are not quite the
    nearest, and so too large rather than too small. (C. Ericson, "Real-time collision detection",
    2005, section 5.1.9.)
    """
    one, other, gap = subtract(b, a), subtract(d, c), subtract(a, c)
    one2, other2, product = dot(one, one), dot(other, other), dot(one, other)
    along_one, along_other = dot(one, gap), dot(other, gap)
    spread = one2 * other2 - product * product
    s = 0.0
    if spread > 0.0:
        s = _within_unit((product * along_other - along_one * other2) / spread)
    t = 0.0
    if other2 > 0.0:
        t = _within_unit((product * s + along_other) / other2)
    if one2 > 0.0:
        s = _within_unit((product * t - along_one) / one2)
    x = gap.x + s * one.x - t * other.x
    y = gap.y + s * one.y - t * other.y
    z = gap.z + s * one.z - t * other.z
    return math.sqrt(x * x + y * y + z * z)


@inlined
def _goes_before(a, b):
    return a.x < b.x or (a.x == b.x and (a.y < b.y or (a.y == b.y and a.z <= b.z)))


@inlined
def _in_order(a, b):
    return (a, b) if _goes_before(a, b) else (b, a)


@inlined
def diagonal_distance(mesh, h):
    """Return the distance between i-j and k-l; it has the same bits before and after the flip."""
    i, j, k, l = diamond(mesh, h)
    a, b = _in_order(i, j)
    c, d = _in_order(k, l)
    return segment_distance(a, b, c, d) if _goes_before(a, c) else segment_distance(c, d, a, b)


@inlined
def _bound_with(mesh, h):
    """Return the bound of the faces at `h` with one more distance of their diagonals."""
    one, other = mesh.deviation[at(h // 3)], mesh.deviation[at(mesh.twin[at(h)] // 3)]
    return max(one, other) + diagonal_distance(mesh, h)


@inlined
def deviates(mesh, h, limit):
    """Whether the flip of `h` would bring the new faces' bound over the limit, at unit scale."""
    return limit < math.inf and _bound_with(mesh, h) > limit + SLACK


@inlined
def add_deviation(mesh, h):
    """Bring the bounds of the two faces at `h`, which has just been flipped, up to date."""
    bound = _bound_with(mesh, h)
    mesh.deviation[at(h // 3)] = mesh.deviation[at(mesh.twin[at(h)] // 3)] = bound
