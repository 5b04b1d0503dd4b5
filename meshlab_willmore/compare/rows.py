"""The rows of a comparison: our filter's presets, searches and energies, and MeshLab's flips."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from ..demo.models import dented_cube, set_of
from ..meshset.filters import BY_NAME
from ..options import FILTER
from ..presets import decided_by

PLANAR = "meshing_edge_flip_by_planar_optimization"
CURVATURE = "meshing_edge_flip_by_curvature_optimization"

# All rows flip the whole mesh. Only positions and faces are compared, so other data may be lost.
_SAME_FOR_ALL = {"selection": False, "allowloss": True}


class Row(NamedTuple):
    """One way to flip the edges of a mesh."""

    name: str
    # Empty for the initial mesh.
    filter: str
    # The parameters of the filter that differ from their defaults.
    given: dict[str, Any]
    # Those of our filter.
    search: str | None = None
    energy: str | None = None
    preset: str | None = None


INITIAL = Row("initial", "", {})

# MeshLab's default also smooths, which moves vertices.
PEERS = (
    *(
        Row(
            f"MeshLab planar, {degrees:g} deg",
            PLANAR,
            {"planartype": "delaunay", "pthreshold": degrees, "iterations": 0},
        )
        for degrees in (1.0, 60.0)
    ),
    *(
        Row(f"MeshLab curvature, {kind}", CURVATURE, {"curvtype": kind})
        for kind in ("mean", "absolute")
    ),
)


def own_rows(
    searches: Iterable[str], energies: Iterable[str], given: Mapping[str, Any]
) -> list[Row]:
    """A row for each search and energy; `given` are further parameters of the filter, for all."""
    energies = tuple(energies)
    return [
        Row(
            f"{search}, {energy}",
            FILTER,
            {**_SAME_FOR_ALL, **given, "search": search, "energy": energy},
            search,
            energy,
        )
        for search in searches
        for energy in energies
    ]


def preset_rows(presets: Iterable[str], given: Mapping[str, Any]) -> list[Row]:
    """A row for each preset; of the further parameters those that it does not decide itself."""
    rows = []
    for preset in presets:
        decided = decided_by(preset)
        kept = {name: value for name, value in given.items() if name not in decided}
        values = {**_SAME_FOR_ALL, **kept, "preset": preset}
        rows.append(Row(f"preset {preset}", FILTER, values, preset=preset))
    return rows


def warm_up(filter_name: str, given: Mapping[str, Any]) -> None:
    """Compile the kernels of our filter for these parameters, or load them from the cache."""
    if filter_name in BY_NAME:
        set_of(dented_cube()).apply_filter(filter_name, **given)
