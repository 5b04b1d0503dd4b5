"""The energies by name, and what a search has to know about each."""

from collections.abc import Callable
from typing import NamedTuple

from . import (
    area,
    delaunay,
    gaussian_curvature,
    mean_curvature,
    uniform,
    virtual,
    willmore,
)


class Kind(NamedTuple):
    """An energy, seen from outside.

    Attributes
    ----------
    cost_reduction, total : callable
        Jitted functions of a mesh and a half-edge, and of a mesh.
    is_potential : bool
        Whether each cost reduction is `total` before minus after the flip.
    length_power : int
        The energy is measured in radians, or in no unit, times a length to this power.
    least : float
        What a cost reduction must exceed, in units of the median edge to that power.
    is_wide : bool
        Whether a flip changes the cost reductions of all edges at, and opposite to, the corners of
        its diamond; else only those of its sides and of the other sides of the faces outside.
    """

    cost_reduction: Callable
    total: Callable
    is_potential: bool = True
    length_power: int = 0
    least: float = 1e-7
    is_wide: bool = False


def _kind(energy, **properties):
    return Kind(energy.cost_reduction, energy.total, **properties)


KINDS = {
    "virtual willmore": _kind(virtual, is_potential=False),
    "willmore": _kind(willmore),
    "uniform virtual willmore": _kind(uniform),
    # What is but rounding, the cost reduction itself leaves out, and areas of details are tiny.
    "area": _kind(area, length_power=2, least=1e-16),
    "mean curvature": _kind(mean_curvature, length_power=1),
    "gaussian curvature": _kind(gaussian_curvature, is_wide=True),
    "delaunay": _kind(delaunay),
}
