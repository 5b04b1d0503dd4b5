"""The flip filter: its parameters, and what it does to the current mesh."""

from __future__ import annotations

import time
from typing import Any

import pymeshlab

from ..mesh.validate import check_degrees
from . import exchange, interrupts, sides
from .filter import Filter, current_surface
from .parameters import Parameter
from .snapshot import take

NO_LIMIT = -1


def _has_selected_faces(ms: pymeshlab.MeshSet | None) -> bool:
    return ms is not None and ms.current_mesh().selected_face_number() > 0


def _check_maxflips(name: str, value: int) -> int:
    if value < NO_LIMIT:
        raise ValueError(f"{name} must be {NO_LIMIT} (no limit) or more, it is {value}")
    return value


_PARAMETERS = (
    Parameter(
        "selection",
        bool,
        _has_selected_faces,
        "Only on selection",
        "Flip only edges between two selected faces. On by default where faces are selected.",
    ),
    Parameter(
        "energy",
        str,
        "virtual willmore",
        "Energy",
        "What a flip must lower. 'virtual willmore': the paper's cost, the Willmore energy with a "
        "virtual point in the middle of the edge. 'willmore': the Willmore energy itself.",
        ("virtual willmore", "willmore"),
    ),
    Parameter(
        "search",
        str,
        "greedy",
        "Search",
        "In which order edges are flipped. 'greedy': always the flip that lowers the energy most.",
        ("greedy",),
    ),
    Parameter(
        "monotone",
        bool,
        True,
        "Never raise the Willmore energy",
        "Refuse flips that raise the Willmore energy itself, the sum of the circles' angles over "
        "all edges. Without this rule the virtual energy can make a surface worse; off is for "
        "research.",
    ),
    Parameter(
        "foldangle",
        float,
        90.0,
        "Fold angle (deg)",
        "Refuse a flip if the faces at the new edge would be bent by more than this angle (0 is "
        "flat) and by more than at the old edge, or if it makes a sliver. 180 allows folds.",
        check=check_degrees,
    ),
    Parameter(
        "featuredeg",
        float,
        180.0,
        "Feature angle (deg)",
        "Keep edges whose faces are bent by this angle or more (0 is flat); 180 keeps none. "
        "30 suits technical parts.",
        check=check_degrees,
    ),
    Parameter(
        "maxflips",
        int,
        NO_LIMIT,
        "Most flips",
        f"Stop after this many flips; {NO_LIMIT} sets no limit.",
        check=_check_maxflips,
    ),
    Parameter(
        "allowloss",
        bool,
        False,
        "Allow loss of data",
        "Go on although the mesh has data that PyMeshLab can't put on a mesh with new faces "
        "(principal curvature directions, for one); they are lost. Off: such a mesh is an error.",
    ),
)


def _flip(ms: pymeshlab.MeshSet, values: dict[str, Any]) -> tuple[dict[str, Any], str]:
    from ..optimize import optimize_flips

    start = time.perf_counter()
    current_surface(ms)
    choices = {p.name: p.choices for p in _PARAMETERS}
    snapshot = take(ms)
    if snapshot.unsupported and not values["allowloss"]:
        raise pymeshlab.PyMeshLabException(
            f"The mesh has data that would be lost: {'; '.join(snapshot.unsupported)}. "
            "Nothing was changed. allowloss=True goes ahead without them."
        )
    maxflips = _check_maxflips("maxflips", values["maxflips"])
    with interrupts.kept():
        result = optimize_flips(
            snapshot.vertices,
            snapshot.faces,
            energy=choices["energy"][values["energy"]],
            search=choices["search"][values["search"]],
            monotone=values["monotone"],
            foldangle=values["foldangle"],
            featuredeg=values["featuredeg"],
            selected_faces=snapshot.selected_faces if values["selection"] else None,
            locked_edges=sides.fixed_edges(snapshot),
            maxflips=None if maxflips == NO_LIMIT else maxflips,
        )
    if result.flips:
        records = exchange.with_faces(snapshot.ply, result.faces, result.corners)
        exchange.give(ms, snapshot, records)
    seconds = time.perf_counter() - start
    returned = {
        "flips": result.flips,
        "gain": result.gain,
        "willmore_before": result.willmore_before,
        "willmore_after": result.willmore_after,
        "converged": result.converged,
        "seconds": seconds,
        "mesh_id": ms.current_mesh_id(),
    }
    return returned, f"{result.flips} Willmore edge flips performed in {seconds:.2f} sec."


_RETURNS = (
    ("flips", "int", "Number of flips."),
    ("gain", "float", "Sum of the energy reductions of the flips, in radians."),
    ("willmore_before", "float", "Willmore energy before, over interior vertices, in radians."),
    ("willmore_after", "float", "Willmore energy after, over interior vertices, in radians."),
    ("converged", "bool", "Whether no allowed flip is left that helps."),
    ("seconds", "float", "Time spent."),
    ("mesh_id", "int", "Id of the current mesh, which can be new where the set has others."),
)

FLIPS = Filter(
    "meshing_edge_flip_by_willmore_optimization",
    "Willmore flipping optimization",
    "Mesh optimization by edge flipping, to make the surface locally as near to a sphere as its "
    "vertices allow.",
    "Edges are flipped as long as that lowers a discrete Willmore energy (Bobenko), measured with "
    "virtual points in the middle of the edges, as in 'Mesh optimisation based on Willmore "
    "energy'. Vertices never move. Boundary and non-manifold edges, texture seams stay, and so do "
    "polygons; meshing_poly_to_tri makes triangles of them.",
    _PARAMETERS,
    _RETURNS,
    _flip,
)
