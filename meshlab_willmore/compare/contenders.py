"""What is compared: our filter with each search and energy, and MeshLab's own flip filters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import pymeshlab

from ..demo.models import dented_cube
from ..meshset.filters import BY_NAME

FILTER = "meshing_edge_flip_by_willmore_optimization"
PLANAR = "meshing_edge_flip_by_planar_optimization"
CURVATURE = "meshing_edge_flip_by_curvature_optimization"

# All rows flip the whole mesh, and what they lose beside positions and faces is not looked at.
_ALIKE = {"selection": False, "allowloss": True}


class Contender(NamedTuple):
    """One way to flip the edges of a mesh.

    Attributes
    ----------
    name : str
        What its row is called.
    filter : str
        The filter's name; empty for the mesh as it is.
    given : dict
        The filter's parameters that are not left to their defaults.
    search, energy : str or None
        Those of our filter.
    """

    name: str
    filter: str
    given: dict[str, Any]
    search: str | None = None
    energy: str | None = None


INITIAL = Contender("initial", "", {})

# Without iterations of a smoothing that moves vertices, which is MeshLab's default.
PEERS = (
    *(
        Contender(
            f"MeshLab planar, {degrees:g} deg",
            PLANAR,
            {"planartype": "delaunay", "pthreshold": degrees, "iterations": 0},
        )
        for degrees in (1.0, 60.0)
    ),
    *(
        Contender(f"MeshLab curvature, {kind}", CURVATURE, {"curvtype": kind})
        for kind in ("mean", "absolute")
    ),
)


def ours(
    searches: Iterable[str], energies: Iterable[str], given: Mapping[str, Any]
) -> list[Contender]:
    """A contender for each pair; `given` are further parameters of the filter, for all of them."""
    energies = tuple(energies)
    return [
        Contender(
            f"{search}, {energy}",
            FILTER,
            {**_ALIKE, **given, "search": search, "energy": energy},
            search,
            energy,
        )
        for search in searches
        for energy in energies
    ]


def warm_up(filter_name: str, given: Mapping[str, Any]) -> None:
    """Make Numba compile, or fetch from its cache, what our filter needs with these parameters."""
    if filter_name not in BY_NAME:
        return
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(*dented_cube()))
    ms.apply_filter(filter_name, **given)
