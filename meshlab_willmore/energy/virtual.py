"""The virtual Willmore energy: the cost function of the paper.

A virtual vertex v in the middle of the edge i-j, connected with i, k, j and l, takes the place of
the diagonal; v' in the middle of k-l does the same for the flipped mesh. The cost reduction of an
edge is the Willmore energy with v minus the one with v'. They differ in the angles at the four
spokes of v and at the four sides of the quad. Source: "Mesh optimisation based on Willmore
energy", section 3.
"""

import math

from ..mesh.halfedge import diamond
from ..mesh.jit import jit
from ..mesh.points import middle
from . import willmore
from .angles import add, radians, turn
from .sides import Corners, side_angles


@jit
def _add_spokes(angles, quad, v):
    """Add the angles at the edges from the virtual vertex `v` to the corners of the quad."""
    angles = add(angles, turn(v, quad.i, quad.l, quad.k))
    angles = add(angles, turn(v, quad.l, quad.j, quad.i))
    angles = add(angles, turn(v, quad.j, quad.k, quad.l))
    return add(angles, turn(v, quad.k, quad.i, quad.j))


@jit
def _virtual_angles(mesh, h, quad, v):
    """Return the sum of the angles at the spokes of `v` and at the sides of the quad."""
    return radians(_add_spokes(side_angles(mesh, h, quad, Corners(v, v, v, v)), quad, v))


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
    before = _virtual_angles(mesh, h, quad, middle(quad.i, quad.j))
    after = _virtual_angles(mesh, h, quad, middle(quad.k, quad.l))
    gain = 2.0 * (before - after)
    return gain if math.isfinite(gain) else -math.inf


# The virtual vertex stands in one edge at a time, so the virtual energy is no function of the mesh
# (and greedy descent on it can go in circles). What it is meant to lower is the Willmore energy.
total = willmore.total
