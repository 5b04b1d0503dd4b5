"""The flip filter: its parameters, and how it flips the edges of the current mesh."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np
import pymeshlab

from ..mlx.steps import Percentage
from ..options import (
    ALLOWLOSS,
    FILTER,
    MAXDEVIATION,
    OPTIONS,
    PRESET,
    SELECTION,
    UNLIMITED,
    VIRTUALPOINT,
    Option,
)
from ..presets import FULL_DIAGONAL, PRESETS, conflict, decided_by
from ..results import FlipResult
from . import edge_flags, exchange, ids, interrupts, late, native
from .filter import Filter, current_surface
from .parameters import Parameter
from .snapshot import MeshSnapshot, Surface, shown_losses, take

# --- parameters --------------------------------------------------------------------------------


def _has_selected_faces(ms: pymeshlab.MeshSet | None, _: Mapping[str, Any]) -> bool:
    return ms is not None and ms.current_mesh().selected_face_number() > 0


def _preset(values: Mapping[str, Any]) -> str:
    index = values.get(PRESET.name)
    return PRESET.default if index is None else PRESET.choices[index]


def _usual_deviation(_: pymeshlab.MeshSet | None, values: Mapping[str, Any]) -> Percentage:
    return Percentage(PRESETS[_preset(values)].maxdeviation)


def _barred(values: Mapping[str, Any]) -> dict[str, str]:
    """The parameters that the preset decides."""
    preset = _preset(values)
    return {name: conflict(name, preset) for name in decided_by(preset)}


def _deviation(value: float | Percentage) -> float | Percentage:
    if not isinstance(value, Percentage):
        MAXDEVIATION.checked(value)
    return value


def _limit(maxflips: int) -> int | None:
    """The number of flips, or None for no limit."""
    if maxflips < UNLIMITED:
        raise ValueError(f"maxflips must be {UNLIMITED} (no limit) or more, it is {maxflips}")
    return None if maxflips == UNLIMITED else maxflips


def _place(text: str) -> str | float:
    """Where the virtual points are: a name, or a number that was given as text."""
    value: str | float = text
    with suppress(ValueError):
        value = float(text)
    place: str | float = VIRTUALPOINT.checked(value)
    return place


def _parameter(option: Option) -> Parameter:
    """The parameter for an option; names are checked when a value is read."""
    return Parameter(
        option.name,
        option.type,
        option.default,
        option.label,
        option.help,
        option.choices if option.is_choice else (),
        option.checked if option.type in (int, float) else None,
    )


# For these the filter and `optimize_flips` take different values.
_CHANGES: dict[str, dict[str, Any]] = {
    "selection": {"default": _has_selected_faces},
    "virtualpoint": {"check": _place},
    "maxdeviation": {"type": Percentage, "default": _usual_deviation, "check": _deviation},
    "maxflips": {"check": _limit},
}
_PARAMETERS = tuple(
    _parameter(option)._replace(**_CHANGES.get(option.name, {})) for option in OPTIONS
)


_NO_EDGES = np.empty((0, 2), np.int32)

# --- the action --------------------------------------------------------------------------------


def _flip(ms: pymeshlab.MeshSet, values: dict[str, Any]) -> tuple[dict[str, Any], str]:
    start = time.perf_counter()
    # A variable with the mesh would keep it, also in an exception that a caller keeps.
    current_surface(ms)
    if late.can_be_saved_late(ms):
        result = _flip_and_save(ms, values)
    else:
        snapshot = take(ms)
        _refuse(snapshot.unsupported, values)
        result = _flipped(snapshot, edge_flags.fixed_edges(snapshot), values)
        _give(ms, snapshot, result)
    seconds = time.perf_counter() - start
    returned = {
        "flips": result.flips,
        "gain": result.gain,
        "willmore_before": result.willmore_before,
        "willmore_after": result.willmore_after,
        "absolute_mean_curvature_before": result.absolute_mean_curvature_before,
        "absolute_mean_curvature_after": result.absolute_mean_curvature_after,
        "mean_shape_before": result.mean_shape_before,
        "mean_shape_after": result.mean_shape_after,
        "worst_shape_before": result.worst_shape_before,
        "worst_shape_after": result.worst_shape_after,
        "deviation": result.deviation,
        "converged": result.converged,
        "seconds": seconds,
        "mesh_id": ids.logical_id(ms, native.id_of(native.current_mesh(ms))),
    }
    return returned, f"{result.flips} Willmore edge flips performed in {seconds:.2f} sec."


def _flip_and_save(ms: pymeshlab.MeshSet, values: dict[str, Any]) -> FlipResult:
    """Flip edges of a mesh that can be saved late."""
    surface = late.surface_of(ms.current_mesh(), values["selection"])
    _refuse(shown_losses(ms.current_mesh()), values)
    result = _flipped(surface, _NO_EDGES, values)
    if not result.flips:
        return result
    with late.saved(ms, surface, result.faces) as saved:
        _refuse(saved.old.unsupported, values)
        if saved.new is not None:
            exchange.give(ms, saved.old, saved.new, saved.folder)
            return result
        fixed = edge_flags.fixed_edges(saved.old)
        if len(fixed):
            result = _flipped(saved.old, fixed, values)
        _give(ms, saved.old, result)
    return result


def _give(ms: pymeshlab.MeshSet, snapshot: MeshSnapshot, result: FlipResult) -> None:
    if result.flips:
        exchange.give(ms, snapshot, exchange.with_faces(snapshot, result.faces, result.corners))


def _refuse(unsupported: list[str], values: dict[str, Any]) -> None:
    """Raise if data would be lost, and the caller has not allowed it."""
    if unsupported and not values["allowloss"]:
        raise pymeshlab.PyMeshLabException(
            f"The mesh has data that would be lost: {'; '.join(unsupported)}. "
            "Nothing was changed. allowloss=True goes ahead without them."
        )


def _flipped(
    surface: Surface | MeshSnapshot, fixed: np.ndarray, values: dict[str, Any]
) -> FlipResult:
    """Flip edges other than the fixed ones."""
    from ..optimize import optimize_flips

    left_out = {SELECTION.name, ALLOWLOSS.name, *_barred(values)}
    given = {p.name: p.core_value(values[p.name]) for p in _PARAMETERS if p.name not in left_out}
    given[MAXDEVIATION.name] = _length(given[MAXDEVIATION.name], surface.vertices)
    with interrupts.preserved():
        return optimize_flips(
            surface.vertices,
            surface.faces,
            selected_faces=surface.selected_faces if values["selection"] else None,
            locked_edges=fixed,
            wedge_uv=surface.wedge_uv,
            **given,
        )


def _length(limit: float | Percentage, vertices: np.ndarray) -> float:
    """A limit in units of the coordinates; infinite for the whole diagonal, or more."""
    from ..mesh.validate import diagonal_of

    diagonal: float = diagonal_of(vertices)
    if isinstance(limit, Percentage):
        limit = limit.percent / FULL_DIAGONAL * diagonal
    # A preset would take None for its own default.
    return limit if limit < diagonal else math.inf


_RETURNS = (
    ("flips", "int", "Number of flips; with 'annealing', of new edges."),
    (
        "gain",
        "float",
        "How much the energy fell, in its unit; with the presets of several passes, how much the "
        "Willmore energy fell; for 'virtual willmore' the sum over the flips with the greedy "
        "searches, else the drop of the Willmore energy.",
    ),
    ("willmore_before", "float", "Willmore energy before, over interior vertices, in radians."),
    ("willmore_after", "float", "Willmore energy after, over interior vertices, in radians."),
    (
        "absolute_mean_curvature_before",
        "float",
        "Sum of dihedral angle times length over interior edges, before.",
    ),
    ("absolute_mean_curvature_after", "float", "The same after."),
    ("mean_shape_before", "float", "Mean of the triangles' shapes before; 1: all equilateral."),
    ("mean_shape_after", "float", "The same after."),
    ("worst_shape_before", "float", "Least of the triangles' shapes before; 0: one without area."),
    ("worst_shape_after", "float", "The same after."),
    (
        "deviation",
        "float",
        "No point of the surface is farther than this from the surface before, nor the other way "
        "round, in units of the coordinates.",
    ),
    ("converged", "bool", "Whether no allowed flip lowers the energy any more."),
    ("seconds", "float", "Time spent."),
    ("mesh_id", "int", "Id of the current mesh, which the flips do not change."),
)

FLIPS = Filter(
    FILTER,
    "Willmore flipping optimization",
    "Mesh optimization by edge flipping, to make the surface locally as near to a sphere as its "
    "vertices allow.",
    "Edges are flipped as long as this lowers an energy, by default a discrete Willmore energy "
    "(Bobenko), measured with virtual points in the middle of the edges, as in 'Mesh optimisation "
    "based on Willmore energy'. Vertices never move. Boundary and non-manifold edges, texture "
    "seams and polygons stay; meshing_poly_to_tri makes triangles of polygons. Where faces or "
    "vertices have texture coordinates, no flip inverts a texture triangle or makes it flat. The "
    "flipped mesh keeps its id and its place, but in PyMeshLab's own list it goes to the end: "
    "merging visible meshes then gives another order of vertices and faces.",
    _PARAMETERS,
    _RETURNS,
    _flip,
    _barred,
)
