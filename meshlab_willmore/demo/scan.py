"""The scan of a face that PyMeshLab's wheel carries: the paper's third model.

Source: section 4 of "Mesh optimisation based on Willmore energy". The paper parameterises the
points of a face and triangulates them by 2D Delaunay; the parameter domain is distorted, and the
mesh gets "vertical" edges that crease it. Here the domain is distorted by a known stretch.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pymeshlab
from numpy.typing import NDArray

from .models import Surface, planar_delaunay, signed_areas

SCAN_IN_WHEEL = Path("tests", "sample_meshes", "rangemaps", "face000.ply")

Filters = tuple[tuple[str, dict[str, Any]], ...]

CLEANING: Filters = (
    ("meshing_remove_duplicate_vertices", {}),
    ("meshing_remove_duplicate_faces", {}),
    ("meshing_remove_null_faces", {}),
    ("meshing_repair_non_manifold_edges", {}),
    ("meshing_repair_non_manifold_vertices", {}),
    ("meshing_remove_connected_component_by_face_number", {"mincomponentsize": 50}),
    ("meshing_remove_unreferenced_vertices", {}),
)
SMOOTHING: Filters = (("apply_coord_taubin_smoothing", {"stepsmoothnum": 5}),)

STRETCH = 3.0
KEEP_ONE_OF = 9
# The scanner's samples are half a millimetre apart: a face that leaves the scan by three of these
# bridges a hole or a step in depth. The deepest creases of the stretched triangulation are lower.
REACH_MM = 1.5
PROBES_PER_SIDE = 4


class ScanNotFoundError(Exception):
    """The installed build of PyMeshLab carries no sample meshes."""


def scan_file() -> Path:
    """Return the path of the scan in the installed PyMeshLab.

    Raises
    ------
    ScanNotFoundError
        If the build comes without its sample meshes.
    """
    path = Path(pymeshlab.__file__).parent / SCAN_IN_WHEEL
    if not path.is_file():
        raise ScanNotFoundError(
            f"this build of PyMeshLab does not carry the face scan {SCAN_IN_WHEEL}"
        )
    return path


def stretched_triangulation(
    scan: Surface, stretch: float = STRETCH, keep_one_of: int = KEEP_ONE_OF
) -> Surface:
    """Triangulate some of the scan's points anew, as the paper does: its model III.

    Parameters
    ----------
    scan
        A cleaned range map, seen from the origin, in millimetres.
    stretch
        The horizontal parameter is scaled by this before the points are triangulated.
    keep_one_of
        The scanner samples on a regular grid, whose Delaunay triangulation is the same however it
        is stretched; one point of about this many, at random, makes scattered data of it.

    Returns
    -------
    Surface
        Vertices are vertices of the scan, bit for bit. Faces that leave the scan are dropped, and
        vertices may be without a face then.
    """
    points = scan.vertices[_thinned(scan, keep_one_of)]
    faces = planar_delaunay(scanner_plane(points), stretch)
    is_off = _distance_to(scan, Surface(points, faces)) > REACH_MM
    return Surface(points, faces[~is_off])


def scanner_plane(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Project points (n, 3) to (n, 2), as seen by the scanner at the origin that looks along -z.

    A scanner at one place sees every direction once: on a range map this parameterisation is
    one-to-one.
    """
    return points[:, :2] / -points[:, 2:]


def _thinned(scan: Surface, keep_one_of: int) -> NDArray[np.intp]:
    """Choose one random vertex in each cell of a grid over the scanner's plane; indices."""
    plane = scanner_plane(scan.vertices)
    area_of_a_vertex = signed_areas(plane, scan.faces).sum() / len(plane)
    cells = np.floor(plane / np.sqrt(keep_one_of * area_of_a_vertex)).astype(np.int64)
    shuffled = np.random.default_rng(0).permutation(len(plane))
    _, first = np.unique(cells[shuffled], axis=0, return_index=True)
    return np.sort(shuffled[first])


def _distance_to(scan: Surface, surface: Surface) -> NDArray[np.float64]:
    """Measure how far (m,) points spread over each face of `surface` leave the scan."""
    steps = range(PROBES_PER_SIDE + 1)
    weights = np.array([(i, j, PROBES_PER_SIDE - i - j) for i in steps for j in steps])
    inside = (weights.min(axis=1) >= 0) & (weights.max(axis=1) < PROBES_PER_SIDE)
    weights = weights[inside] / PROBES_PER_SIDE
    probes = np.einsum("pc,fcx->fpx", weights, surface.vertices[surface.faces])

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(*scan))
    meshes.add_mesh(pymeshlab.Mesh(probes.reshape(-1, 3)))
    meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
        measuremesh=1, refmesh=0, signeddist=False, maxdist=pymeshlab.PureValue(2 * REACH_MM)
    )
    distances = meshes.current_mesh().vertex_scalar_array().reshape(len(surface.faces), -1)
    farthest: NDArray[np.float64] = distances.max(axis=1)
    return farthest
