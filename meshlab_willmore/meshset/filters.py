"""The filters: what each is called, its parameters, and what it does to the current mesh."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import pymeshlab

from ..mesh.validate import check_degrees
from . import exchange, interrupts, scalars, sides
from .parameters import Parameter
from .snapshot import take

NO_LIMIT = -1


class Filter(NamedTuple):
    """A filter of this package.

    Attributes
    ----------
    name, meshlab_name : str
        The name in PyMeshLab, and the one in MeshLab and its scripts.
    summary : str
        One sentence.
    info : str
        The rest of the help text.
    parameters : tuple of Parameter
        In the order of the dialog.
    returns : tuple of (str, str, str)
        Name, type and meaning of each entry of the returned dict.
    run : callable
        Gets the set and all parameter values; returns the dict and a line for the log.
    """

    name: str
    meshlab_name: str
    summary: str
    info: str
    parameters: tuple[Parameter, ...]
    returns: tuple[tuple[str, str, str], ...]
    run: Callable[[pymeshlab.MeshSet, dict[str, Any]], tuple[dict[str, Any], str]]


def _current_surface(ms: pymeshlab.MeshSet) -> pymeshlab.Mesh:
    """The current mesh, if it has faces."""
    mesh = ms.current_mesh()
    if mesh.vertex_number() == 0:
        raise pymeshlab.PyMeshLabException("The current mesh is empty: it has no vertices.")
    if mesh.face_number() == 0:
        raise pymeshlab.PyMeshLabException(
            "The current mesh has no faces, it is a point cloud. A surface can be made of it "
            "by generate_surface_reconstruction_ball_pivoting, say."
        )
    return mesh


# --- flips -------------------------------------------------------------------------------------


def _has_selected_faces(ms: pymeshlab.MeshSet | None) -> bool:
    return ms is not None and ms.current_mesh().selected_face_number() > 0


def _check_maxflips(name: str, value: int) -> int:
    if value < NO_LIMIT:
        raise ValueError(f"{name} must be {NO_LIMIT} (no limit) or more, it is {value}")
    return value


_FLIP_PARAMETERS = (
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
    _current_surface(ms)
    choices = {p.name: p.choices for p in _FLIP_PARAMETERS}
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


_FLIP_RETURNS = (
    ("flips", "int", "Number of flips."),
    ("gain", "float", "Sum of the energy reductions of the flips, in radians."),
    ("willmore_before", "float", "Willmore energy before, over interior vertices, in radians."),
    ("willmore_after", "float", "Willmore energy after, over interior vertices, in radians."),
    ("converged", "bool", "Whether no allowed flip is left that helps."),
    ("seconds", "float", "Time spent."),
    ("mesh_id", "int", "Id of the current mesh, which can be new where the set has others."),
)


# --- measures ----------------------------------------------------------------------------------


def _measure(ms: pymeshlab.MeshSet, _: dict[str, Any]) -> tuple[dict[str, Any], str]:
    from ..measure import measures

    mesh = _current_surface(ms)
    with interrupts.kept():
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

    mesh = _current_surface(ms)
    with interrupts.kept():
        energy = vertex_willmore_energy(mesh.vertex_matrix(), mesh.face_matrix())
    scalars.write_vertex_scalar(ms, energy)
    return {}, f"Range: {energy.min():g} {energy.max():g}"


# --- the list ----------------------------------------------------------------------------------

FILTERS = (
    Filter(
        "meshing_edge_flip_by_willmore_optimization",
        "Willmore flipping optimization",
        "Mesh optimization by edge flipping, to make the surface locally as near to a sphere as "
        "its vertices allow.",
        "Edges are flipped as long as that lowers a discrete Willmore energy (Bobenko), measured "
        "with virtual points in the middle of the edges, as in 'Mesh optimisation based on "
        "Willmore energy'. Vertices never move. Boundary and non-manifold edges, texture seams "
        "stay, and so do polygons; meshing_poly_to_tri makes triangles of them.",
        _FLIP_PARAMETERS,
        _FLIP_RETURNS,
        _flip,
    ),
    Filter(
        "compute_scalar_by_willmore_energy_per_vertex",
        "Willmore energy per vertex",
        "Write the discrete Willmore energy of each vertex into the vertex scalar.",
        "It is the sum of the angles between the circumcircles of neighbouring faces over the "
        "edges of the vertex, minus 2 pi, in radians: 0 where the vertex is convex and lies with "
        "its neighbours on a sphere or plane. Boundary vertices get 0. The next layer of the set "
        "gets an id that is one higher than it would be otherwise.",
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
