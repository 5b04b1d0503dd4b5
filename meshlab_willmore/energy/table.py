"""The energies by name: the module of each, what a search has to know of it, and its help text.

A new energy is a module with `cost_reduction` and `total`, and a row here. Nothing in this module
needs Numba; modules are named as text, and imported where they are compiled.
"""

import math
from typing import NamedTuple

# Radians. Nearly all chains that help lose less, and most of the others more.
MOST_LOSS = 6.0


class Energy(NamedTuple):
    """An energy, seen from outside.

    Attributes
    ----------
    module : str
        Its module in `meshlab_willmore.energy`.
    help : str
        What it is and when to use it, in one line without a full stop.
    is_potential : bool
        Whether each cost reduction is `total` before minus after the flip.
    length_power : int
        The energy is measured in radians, or in no unit, times a length to this power.
    least : float
        What a cost reduction must exceed, in units of the median edge to that power.
    is_wide : bool
        Whether a flip changes the cost reductions of all edges at, and opposite to, the corners of
        its diamond; else only those of its sides and of the other sides of the faces outside.
    is_narrow : bool
        Whether a cost reduction depends on the two faces at the edge alone, so that a flip changes
        only those of the sides of its diamond.
    most_loss : float
        What a chain of flips may lose on its way before it is given up, in the unit of the energy
        that judges it.
    """

    module: str
    help: str
    is_potential: bool = True
    length_power: int = 0
    least: float = 1e-7
    is_wide: bool = False
    is_narrow: bool = False
    most_loss: float = math.inf


# The first is the default.
ENERGIES = {
    "virtual willmore": Energy(
        "virtual",
        "the paper's cost; careful, fit for scans",
        is_potential=False,
        most_loss=MOST_LOSS,
    ),
    "willmore": Energy(
        "willmore",
        "the Willmore energy itself; smooths the creases of bad triangulations away",
        most_loss=MOST_LOSS,
    ),
    "uniform virtual willmore": Energy(
        "uniform", "the same with a virtual vertex in each edge; somewhat smoother"
    ),
    "area": Energy(
        "area",
        "the area; good triangles on smooth surfaces, but it may cut corners at creases, so "
        "check intersections there",
        # The cost reduction itself leaves rounding out, and areas of details are tiny.
        length_power=2,
        least=1e-16,
        is_narrow=True,
    ),
    "mean curvature": Energy(
        "mean_curvature",
        "dihedral angle times length; the least bends, but slivers",
        length_power=1,
    ),
    "gaussian curvature": Energy(
        "gaussian_curvature", "absolute angle defects; for comparison", is_wide=True
    ),
    "delaunay": Energy("delaunay", "the cotangents of all angles; like 'area'", is_narrow=True),
}

# The modules of "virtual willmore" by where the virtual points are; `AT`: at a number.
VIRTUAL_POINTS = {"midpoint": "virtual", "closest": "virtual_closest"}
AT = "virtual_at"
# The module of "mean curvature" in passes that look at the normals of vertices too.
TILT = "tilt"
