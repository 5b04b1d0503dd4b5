"""The virtual Willmore energy with the virtual points where the diagonals pass nearest each other.

As `meshlab_willmore.energy.virtual`, but v on i-j and v' on k-l are the closest points of the two
diagonals. Where both are the same point, in every convex planar quad, the cost reduction is 0: the
flip is then judged by how the surface bends alone.

Each diagonal counts as a segment that ends `MARGIN` before its corners, so that no virtual vertex
comes near a corner, where the spoke to it has no direction. Parallel diagonals (only of quads that
are folded flat or degenerate) have no single closest pair: the middle of the stretch where they run
beside each other is taken, or, without such a stretch, the ends that face each other. So the choice
never depends on the order of the corners.

Where to put the virtual points is left open in "Mesh optimisation based on Willmore energy",
section 5. Closest points of segments: C. Ericson, "Real-Time Collision Detection", 2005, section
5.1.9, with vector products in place of the difference of two squares.
"""

import math

from ..mesh.halfedge import diamond
from ..mesh.jit import inner
from ..mesh.points import cross, dot, subtract
from .angles import difference, radians
from .virtual import virtual_angles
from .virtual_at import spokes_at
from .wings import wings_of

# In parts of the diagonal.
MARGIN = 0.1
MIDDLE = 0.5
# Squared sine of the angle between diagonals below which they count as parallel: up to there the
# closest points are good to half of the digits.
PARALLEL = 1e-16


@inner
def _inside(place):
    """Return the place on a segment in [0, 1], moved away from its ends."""
    return min(max(place, MARGIN), 1.0 - MARGIN)


@inner
def _beside_each_other(u, w, r):
    """Return the places of the virtual points on parallel diagonals, given as in `closest`."""
    squared, along = dot(u, u), dot(w, u)
    if squared == 0.0 or along == 0.0:
        # One has no length: such a flip is refused, wherever the points are.
        return MIDDLE, MIDDLE
    start, step = dot(r, u) / squared, along / squared
    one, other = start + MARGIN * step, start + (1.0 - MARGIN) * step
    low, high = max(MARGIN, min(one, other)), min(1.0 - MARGIN, max(one, other))
    middle = 0.5 * (low + high)
    return _inside(middle), _inside((middle - start) / step)


@inner
def closest(quad):
    """Return where on the diagonals i-j and k-l the virtual points are.

    Parameters
    ----------
    quad : Diamond

    Returns
    -------
    a, b : float
        The points i + a (j - i) and k + b (l - k), with a and b from `MARGIN` to 1 - `MARGIN`;
        anything if one of the diagonals has no length.
    """
    u, w, r = subtract(quad.j, quad.i), subtract(quad.l, quad.k), subtract(quad.k, quad.i)
    n = cross(u, w)
    squared = dot(n, n)
    if not squared > PARALLEL * dot(u, u) * dot(w, w):
        return _beside_each_other(u, w, r)
    a = _inside(dot(cross(r, w), n) / squared)
    # From the point on one diagonal to the nearest on the other, and back if that is outside.
    nearest = (a * dot(u, w) - dot(r, w)) / dot(w, w)
    b = _inside(nearest)
    if b != nearest:
        a = _inside((b * dot(u, w) + dot(r, u)) / dot(u, u))
    return a, b


@inner
def cost_reduction(mesh, h):
    """Return the drop of the virtual Willmore energy, in radians."""
    quad, wings = diamond(mesh, h), wings_of(mesh, h)
    a, b = closest(quad)
    before = virtual_angles(quad, wings, spokes_at(quad, quad.i, quad.j, a))
    after = virtual_angles(quad, wings, spokes_at(quad, quad.k, quad.l, b))
    gain = 2.0 * radians(difference(before, after))
    return gain if math.isfinite(gain) else -math.inf
