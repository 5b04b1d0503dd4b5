"""The uniform virtual Willmore energy: the Willmore energy with a virtual vertex on every edge.

Each face is split into four by the middles of its edges; the energy is twice the sum of the
intersection angles over the interior edges of that finer mesh. Unlike the paper's virtual energy,
which subdivides at one edge at a time, it is a function of the mesh alone: descent on it ends.

The finer mesh need not be made. In a face (a, b, c) with the angle gamma at c,

- the corner faces are the face shrunk to half its size towards a, b and c. So at each half of an
  edge two neighbouring faces are the two old ones shrunk towards the same end, and meet at the same
  angle as these;
- the inner edge opposite to c is a diagonal of a plane parallelogram with the angle gamma at both
  apexes: its intersection angle is |pi - 2 gamma|. The three of a face sum to pi, and to
  4 gamma - pi if gamma is obtuse.

With W twice the sum of the intersection angles of the mesh itself, and over all faces,

    energy = 2 W + sum of (2 pi + 8 max(0, largest angle - pi / 2)).

It is the Willmore energy with a penalty on obtuse faces: that is what breaks its ties. A flip
changes W as usual and the penalty of two faces.
"""

import math

from ..mesh.halfedge import diamond
from ..mesh.jit import inner, jit
from ..mesh.points import dot, subtract
from . import willmore
from .angles import NO_ANGLES, ComplexAngle, add, radians
from .triangles import complex_angle_between, corners

WILLMORE_WEIGHT = 2.0
EXCESS_WEIGHT = 8.0
OF_EACH_FACE = 2.0 * math.pi


@inner
def _add_if_obtuse(angles, arriving, leaving):
    """Add what the angle between two successive sides exceeds a right angle by, if it does."""
    if not dot(arriving, leaving) > 0.0:
        return angles
    # Between the directions of the sides is the exterior angle, which is pi / 2 minus the excess.
    exterior = complex_angle_between(arriving, leaving)
    return add(angles, ComplexAngle(exterior.s, exterior.r))


@inner
def _add_excess(angles, a, b, c):
    """Add what the largest angle of the triangle (a, b, c) exceeds a right angle by."""
    ab, bc, ca = subtract(b, a), subtract(c, b), subtract(a, c)
    angles = _add_if_obtuse(angles, ca, ab)
    angles = _add_if_obtuse(angles, ab, bc)
    return _add_if_obtuse(angles, bc, ca)


@inner
def cost_reduction(mesh, h):
    """Return the drop of the energy, in radians."""
    gain = WILLMORE_WEIGHT * willmore.cost_reduction(mesh, h)
    i, j, k, l = diamond(mesh, h)
    before = _add_excess(_add_excess(NO_ANGLES, i, j, k), j, i, l)
    after = _add_excess(_add_excess(NO_ANGLES, k, i, l), l, j, k)
    return gain + EXCESS_WEIGHT * (radians(before) - radians(after))


@jit
def total(mesh):
    """Return the energy of the mesh in radians; edges without a defined angle add nothing."""
    excess = NO_ANGLES
    for f in range(len(mesh.origin) // 3):
        a, b, c = corners(mesh, f)
        excess = _add_excess(excess, a, b, c)
    of_faces = OF_EACH_FACE * (len(mesh.origin) // 3) + EXCESS_WEIGHT * radians(excess)
    return WILLMORE_WEIGHT * willmore.total(mesh) + of_faces
