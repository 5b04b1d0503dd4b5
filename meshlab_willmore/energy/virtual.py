"""The virtual Willmore energy: the cost function of the paper.

A virtual vertex v in the middle of the edge i-j, connected with i, k, j and l, takes the place of
the diagonal; v' in the middle of k-l does the same for the flipped mesh. The cost reduction of an
edge is the Willmore energy with v minus the one with v'. They differ in the angles at the four
spokes of v and at the four sides of the quad. Source: "Mesh optimisation based on Willmore
energy", section 3.

For other places on the diagonals see `virtual_closest` and `virtual_at`.
"""

import math

from ..mesh.halfedge import Diamond, diamond
from ..mesh.jit import inlined, inner
from ..mesh.points import from_middle, subtract
from . import willmore
from .angles import add, complex_angle, difference, radians
from .wings import View, Views, side_angles, wings_of


@inlined
def _spokes(quad, a, b):
    """Return the vectors to the corners of the quad from the middle of a-b."""
    return Diamond(
        from_middle(a, b, quad.i),
        from_middle(a, b, quad.j),
        from_middle(a, b, quad.k),
        from_middle(a, b, quad.l),
    )


@inlined
def _views(spokes):
    """Return the sides of the quad as the virtual vertex sees them."""
    i, j, k, l = spokes
    return Views(View(j, k), View(k, i), View(i, l), View(l, j))


@inlined
def _add_spokes(angles, quad, spokes):
    """Add the angles at the edges from the virtual vertex to the corners of the quad."""
    i, j, k, l = quad
    angles = add(angles, complex_angle(spokes.l, subtract(l, i), spokes.k, subtract(k, i)))
    angles = add(angles, complex_angle(spokes.j, subtract(j, l), spokes.i, subtract(i, l)))
    angles = add(angles, complex_angle(spokes.k, subtract(k, j), spokes.l, subtract(l, j)))
    return add(angles, complex_angle(spokes.i, subtract(i, k), spokes.j, subtract(j, k)))


@inlined
def virtual_angles(quad, wings, spokes):
    """Return the sum of the angles that the place of a virtual vertex decides.

    Parameters
    ----------
    quad, wings : Diamond, Wings
        The points around the edge, and the faces outside.
    spokes : Diamond
        The vectors to the corners from the virtual vertex, wherever on i-j or on k-l it is.

    Returns
    -------
    AngleSum
        Over the four spokes and the four sides of the quad; NaN where an angle is undefined.
    """
    return _add_spokes(side_angles(quad, wings, _views(spokes)), quad, spokes)


@inlined
def drop(quad, wings):
    """Return by how much the sum of the intersection angles drops, as in `willmore.drop`."""
    before = virtual_angles(quad, wings, _spokes(quad, quad.i, quad.j))
    after = virtual_angles(quad, wings, _spokes(quad, quad.k, quad.l))
    return difference(before, after)


@inner
def cost_reduction(mesh, h):
    """Return the drop of the virtual Willmore energy, in radians."""
    gain = 2.0 * radians(drop(diamond(mesh, h), wings_of(mesh, h)))
    return gain if math.isfinite(gain) else -math.inf


# The virtual vertex is in one edge at a time, so the virtual energy is no function of the mesh
# (and greedy descent on it can go in circles). What it is meant to lower is the Willmore energy.
total = willmore.total
