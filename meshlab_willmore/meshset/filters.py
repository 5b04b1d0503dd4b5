"""The table of our filters, and the two that measure."""

from __future__ import annotations

from typing import Any

import pymeshlab

from . import interrupts, scalars
from .filter import Filter, current_surface
from .flips import FLIPS

# --- measures ----------------------------------------------------------------------------------


def _measure(ms: pymeshlab.MeshSet, _: dict[str, Any]) -> tuple[dict[str, Any], str]:
    from ..measure import measures

    mesh = current_surface(ms)
    with interrupts.preserved():
        totals = measures(mesh.transformed_vertex_matrix(), mesh.face_matrix())._asdict()
    return totals, ", ".join(f"{name} {value:g}" for name, value in totals.items())


_MEASURE_RETURNS = (
    ("area", "float", "Area of the surface."),
    (
        "gaussian_curvature",
        "float",
        "Sum of 2 pi minus the angles, over interior vertices (radians); 2 pi times the Euler "
        "characteristic where the mesh is closed.",
    ),
    ("absolute_gaussian_curvature", "float", "The same sum of absolute values."),
    (
        "absolute_mean_curvature",
        "float",
        "Sum of dihedral angle times length over interior edges.",
    ),
    ("willmore_energy", "float", "Sum of the Willmore energies of interior vertices (radians)."),
)


# --- scalars -----------------------------------------------------------------------------------


def _write_scalar(ms: pymeshlab.MeshSet, _: dict[str, Any]) -> tuple[dict[str, Any], str]:
    from ..measure import vertex_willmore_energy

    mesh = current_surface(ms)
    with interrupts.preserved():
        energy = vertex_willmore_energy(mesh.vertex_matrix(), mesh.face_matrix())
    scalars.write_vertex_scalar(ms, energy)
    return {}, f"Range: {energy.min():g} {energy.max():g}"


# --- the list ----------------------------------------------------------------------------------

FILTERS = (
    FLIPS,
    Filter(
        "compute_scalar_by_willmore_energy_per_vertex",
        "Willmore energy per vertex",
        "Write the discrete Willmore energy of each vertex into the vertex scalar.",
        "It is the sum of the angles between the circumcircles of neighbouring faces over the "
        "edges of the vertex, minus 2 pi, in radians: 0 where the vertex is convex and lies with "
        "its neighbours on a sphere or plane. Boundary vertices get 0.",
        (),
        (),
        _write_scalar,
    ),
    Filter(
        "get_willmore_measures",
        "Willmore measures",
        "Compute area, Gaussian, mean and Willmore energy of the whole surface.",
        "The measures consider the current transformation matrix.",
        (),
        _MEASURE_RETURNS,
        _measure,
    ),
)

BY_NAME = {f.name: f for f in FILTERS}
