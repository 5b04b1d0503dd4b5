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
from ..mesh.jit import jit
from ..mesh.points import from_middle, subtract
from . import willmore
from .angles import add, radians, turn
from .sides import View, Views, side_angles


@jit
def _spokes(quad, a, b):
    """Return the vectors to the corners of the quad from the middle of a-b."""
    return Diamond(
        from_middle(a, b, quad.i),
        from_middle(a, b, quad.j),
        from_middle(a, b, quad.k),
        from_middle(a, b, quad.l),
    )


@jit
def _views(spokes):
    """Return the sides of the quad as the virtual vertex sees them."""
    i, j, k, l = spokes
    return Views(View(j, k), View(k, i), View(i, l), View(l, j))


@jit
def _add_spokes(angles, quad, spokes):
    """Add the angles at the edges from the virtual vertex to the corners of the quad."""
    i, j, k, l = quad
    angles = add(angles, turn(spokes.l, subtract(l, i), spokes.k, subtract(k, i)))
    angles = add(angles, turn(spokes.j, subtract(j, l), spokes.i, subtract(i, l)))
    angles = add(angles, turn(spokes.k, subtract(k, j), spokes.l, subtract(l, j)))
    return add(angles, turn(spokes.i, subtract(i, k), spokes.j, subtract(j, k)))


@jit
def virtual_angles(mesh, h, quad, spokes):
    """Return the sum of the angles that the place of a virtual vertex decides, in radians.

    Parameters
    ----------
    mesh : Mesh
    h : int
        Half-edge with a twin.
    quad : Diamond
        The points around it.
    spokes : Diamond
        The vectors to these from the virtual vertex, wherever on i-j or on k-l it stands.

    Returns
    -------
    float
        Over the four spokes and the four sides of the quad; NaN where an angle is undefined.
    """
    sides = side_angles(mesh, h, quad, _views(spokes))
    return radians(_add_spokes(sides, quad, spokes))


@jit
def cost_reduction(mesh, h):
    """Return by how much the virtual Willmore energy drops when `h` is flipped.

    Parameters
    ----------
    mesh : Mesh
    h : int
        Half-edge with a twin.

    Returns
    -------
    float
        In radians; positive where the flip helps, minus infinity where an angle is undefined.
    """
    quad = diamond(mesh, h)
    before = virtual_angles(mesh, h, quad, _spokes(quad, quad.i, quad.j))
    after = virtual_angles(mesh, h, quad, _spokes(quad, quad.k, quad.l))
    gain = 2.0 * (before - after)
    return gain if math.isfinite(gain) else -math.inf


# The virtual vertex stands in one edge at a time, so the virtual energy is no function of the mesh
# (and greedy descent on it can go in circles). What it is meant to lower is the Willmore energy.
total = willmore.total
