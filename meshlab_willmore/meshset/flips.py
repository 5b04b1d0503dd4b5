"""The flip filter: its parameters, and what it does to the current mesh."""

from __future__ import annotations

import time
from typing import Any

import pymeshlab

from ..mesh.validate import check_count, check_degrees, check_place, check_seed
from . import exchange, interrupts, native, numbering, sides
from .filter import Filter, current_surface
from .parameters import Parameter
from .snapshot import take

NO_LIMIT = -1
# As in the core, which takes too long to import for those who only ask for the parameters.
MOST_DEPTH = 100
MOST_BREADTH = 12
MOST_SWEEPS = 10**9


# --- parameters --------------------------------------------------------------------------------

ENERGIES = (
    "virtual willmore",
    "willmore",
    "uniform virtual willmore",
    "area",
    "mean curvature",
    "gaussian curvature",
    "delaunay",
)
SEARCHES = ("parallel greedy", "greedy", "variable depth", "annealing", "thorough")
PLACES = ("midpoint", "closest")


def _has_selected_faces(ms: pymeshlab.MeshSet | None) -> bool:
    return ms is not None and ms.current_mesh().selected_face_number() > 0


def _check_maxflips(name: str, value: int) -> int:
    if value < NO_LIMIT:
        raise ValueError(f"{name} must be {NO_LIMIT} (no limit) or more, it is {value}")
    return value


def _check_depth(name: str, value: int) -> int:
    return check_count(name, value, MOST_DEPTH)


def _check_breadth(name: str, value: int) -> int:
    return check_count(name, value, MOST_BREADTH)


def _check_sweeps(name: str, value: int) -> int:
    return check_count(name, value, MOST_SWEEPS)


def _check_place(name: str, text: str) -> str | float:
    """The place of the virtual points: a name, or the number that the text is."""
    try:
        value: str | float = float(text)
    except ValueError:
        value = text
    return check_place(name, value, PLACES)


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
        ENERGIES[0],
        "Energy",
        "What the flips must lower. 'virtual willmore', the paper's cost: careful, fit for scans. "
        "'willmore': the Willmore energy itself, which smooths creases of bad triangulations away. "
        "'uniform virtual willmore': the same, somewhat smoother. 'delaunay' (the cotangents of "
        "all angles) and 'area': good triangles on smooth surfaces; on creased ones they may cut "
        "corners, so check intersections. 'mean curvature' (angle times length): the least bends, "
        "but slivers. 'gaussian curvature' (angles missing to a full turn): for comparison.",
        ENERGIES,
    ),
    Parameter(
        "search",
        str,
        SEARCHES[0],
        "Search",
        "How it is minimised. 'parallel greedy': all flips at once that gain more than any around "
        "them, on all cores; the quickest. 'greedy': one by one, always the best of all. "
        "'variable depth': then chains of several flips that may go through a loss; much better "
        "where the triangulation is bad. 'annealing': random flips that cool down; slow. "
        "'thorough': chains from several starts, for a result that hardly depends on how the mesh "
        "was triangulated.",
        SEARCHES,
    ),
    Parameter(
        "depth",
        int,
        5,
        "Depth of chains",
        "Most flips of a chain in the searches 'variable depth' and 'thorough'. 3 is quicker, "
        "7 finds a little more.",
        check=_check_depth,
    ),
    Parameter(
        "breadth",
        int,
        3,
        "Breadth of chains",
        "In the searches 'variable depth' and 'thorough': how many ways a chain tries at its "
        f"second flip, 1 to {MOST_BREADTH}; half as many at the third, and so on. 1 is the "
        "quickest.",
        check=_check_breadth,
    ),
    Parameter(
        "sweeps",
        int,
        200,
        "Sweeps of the annealing",
        "At how many temperatures the search 'annealing' tries as many flips as there are edges. "
        "The time grows with it.",
        check=_check_sweeps,
    ),
    Parameter(
        "seed",
        int,
        0,
        "Seed of the annealing",
        "The search 'annealing' draws its random numbers from this seed. The same seed gives the "
        "same mesh.",
        check=check_seed,
    ),
    Parameter(
        "virtualpoint",
        str,
        PLACES[0],
        "Virtual points",
        "Where the energy 'virtual willmore' puts its virtual points on an edge. 'midpoint': as in "
        "the paper. 'closest': where the edge passes nearest the flipped one. Or a number between "
        "0 and 1, the part of the edge from either end: 0.05 makes the greedy search smooth much "
        "more, at twice the time.",
        check=_check_place,
    ),
    Parameter(
        "monotone",
        bool,
        True,
        "Never raise the Willmore energy",
        "For the energy 'virtual willmore': refuse flips that raise the Willmore energy itself, "
        "the sum of the circles' angles over all edges. Without this rule the virtual energy can "
        "make a surface worse; off is for research.",
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
        "checkintersections",
        bool,
        False,
        "No new self-intersections",
        "Refuse flips after which a face would cut or touch another one. Takes longer; worth it "
        "where parts of the surface nearly touch, or folds are allowed. Merge close vertices "
        "before: faces along an unmerged seam touch.",
    ),
    Parameter(
        "featuredeg",
        float,
        180.0,
        "Feature angle (deg)",
        "Keep edges whose faces are bent by this angle or more (0 is flat), but not those of "
        "slivers, which have no normal to speak of; 180 keeps none. 30 suits technical parts.",
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


# --- the action --------------------------------------------------------------------------------


def _flip(ms: pymeshlab.MeshSet, values: dict[str, Any]) -> tuple[dict[str, Any], str]:
    from ..optimize import optimize_flips

    start = time.perf_counter()
    current_surface(ms)
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
            energy=ENERGIES[values["energy"]],
            search=SEARCHES[values["search"]],
            depth=values["depth"],
            breadth=values["breadth"],
            sweeps=values["sweeps"],
            seed=values["seed"],
            virtualpoint=_check_place("virtualpoint", values["virtualpoint"]),
            checkintersections=values["checkintersections"],
            monotone=values["monotone"],
            foldangle=values["foldangle"],
            featuredeg=values["featuredeg"],
            selected_faces=snapshot.selected_faces if values["selection"] else None,
            locked_edges=sides.fixed_edges(snapshot),
            wedge_uv=sides.texture_coordinates(snapshot),
            maxflips=None if maxflips == NO_LIMIT else maxflips,
        )
    if result.flips:
        flipped = exchange.with_faces(snapshot, result.faces, result.corners)
        exchange.give(ms, snapshot, flipped)
    seconds = time.perf_counter() - start
    returned = {
        "flips": result.flips,
        "gain": result.gain,
        "willmore_before": result.willmore_before,
        "willmore_after": result.willmore_after,
        "converged": result.converged,
        "seconds": seconds,
        "mesh_id": numbering.logical_id(ms, native.id_of(native.current_mesh(ms))),
    }
    return returned, f"{result.flips} Willmore edge flips performed in {seconds:.2f} sec."


_RETURNS = (
    ("flips", "int", "Number of flips; with 'annealing' of edges that are new."),
    (
        "gain",
        "float",
        "What the energy has dropped by, in its unit; for 'virtual willmore' the sum over the "
        "flips with the greedy searches and 'variable depth', else the drop of the Willmore "
        "energy.",
    ),
    ("willmore_before", "float", "Willmore energy before, over interior vertices, in radians."),
    ("willmore_after", "float", "Willmore energy after, over interior vertices, in radians."),
    ("converged", "bool", "Whether no allowed flip is left that helps."),
    ("seconds", "float", "Time spent."),
    ("mesh_id", "int", "Id of the current mesh, which the flips leave as it is."),
)

FLIPS = Filter(
    "meshing_edge_flip_by_willmore_optimization",
    "Willmore flipping optimization",
    "Mesh optimization by edge flipping, to make the surface locally as near to a sphere as its "
    "vertices allow.",
    "Edges are flipped as long as that lowers an energy, by default a discrete Willmore energy "
    "(Bobenko), measured with virtual points in the middle of the edges, as in 'Mesh optimisation "
    "based on Willmore energy'. Vertices never move. Boundary and non-manifold edges, texture "
    "seams stay, and so do polygons; meshing_poly_to_tri makes triangles of them. Where faces or "
    "vertices have texture coordinates, no flip turns a texture triangle over or makes it flat. "
    "The flipped mesh keeps its id and its place, but in PyMeshLab's own list it goes to the end: "
    "merging visible meshes then gives another order of vertices and faces.",
    _PARAMETERS,
    _RETURNS,
    _flip,
)
