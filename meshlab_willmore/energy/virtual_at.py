"""The virtual Willmore energy with the virtual points at a given part t of the diagonals.

As `meshlab_willmore.energy.virtual`, but v divides i-j, and v' divides k-l, as t to 1 - t. An edge
has no direction, so which end t counts from must not matter: the cost is the mean over both
readings. That holds for each diagonal by itself, so it does not depend either on which end of i-j
goes with which end of k-l. At t = 0.5 it is the paper's cost, and t and 1 - t are the same.

Where to put the virtual points is left open in "Mesh optimisation based on Willmore energy",
section 5.
"""

import math

from ..mesh.halfedge import Diamond, diamond
from ..mesh.jit import inner
from ..mesh.points import from_between
from .angles import difference, radians
from .virtual import virtual_angles
from .wings import wings_of


@inner
def spokes_at(quad, a, b, t):
    """Return the vectors to the corners of the quad from the point ``a + t (b - a)``."""
    return Diamond(
        from_between(a, b, t, quad.i),
        from_between(a, b, t, quad.j),
        from_between(a, b, t, quad.k),
        from_between(a, b, t, quad.l),
    )


@inner
def _drop(quad, wings, a, b, c, d, t):
    """Return the drop, in radians, for the points that divide a-b and c-d as t to 1 - t."""
    before = virtual_angles(quad, wings, spokes_at(quad, a, b, t))
    after = virtual_angles(quad, wings, spokes_at(quad, c, d, t))
    return radians(difference(before, after))


@inner
def cost_reduction(mesh, h, t):
    """Return the drop of the virtual Willmore energy, in radians.

    The virtual points are at the part `t`, in (0, 1), of the diagonals.
    """
    quad, wings = diamond(mesh, h), wings_of(mesh, h)
    i, j, k, l = quad
    # Ends exchanged, and not 1 - t, which is rounded where t is small. Twice the sum of the angles,
    # and half of the sum over both ends: the factors cancel.
    gain = _drop(quad, wings, i, j, k, l, t) + _drop(quad, wings, j, i, l, k, t)
    return gain if math.isfinite(gain) else -math.inf
