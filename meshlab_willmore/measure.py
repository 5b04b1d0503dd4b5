"""Measures of a mesh on plain arrays: Willmore energy, curvatures, area, shapes.

Source: "Mesh optimisation based on Willmore energy", section 2.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .energy import area, mean_curvature
from .energy.angles import AngleSum, ComplexAngle, add
from .energy.gaussian_curvature import angle_defects
from .energy.triangles import corners
from .energy.willmore import edge_angle, quad_angle
from .guards import triangle_shape
from .guards.bvh import build_bvh
from .guards.intersections import mark_intersecting
from .mesh.build import build, interior_vertices
from .mesh.halfedge import Mesh
from .mesh.jit import allocating_jit, at, inlined, inner, jit
from .mesh.lanes import LANES, QUAD_ROWS, fill_quad, point_at, quad_at, write_point
from .mesh.parallel import thread_pool
from .mesh.validate import check_mesh, in_input_units, to_unit_scale

FULL_TURN = 2.0 * math.pi
# Faces of one call of a kernel, which no interrupt ends.
FACES_PER_CALL = 20_000
# Faces of one sum: no lane gets more than 98 angles, of which the product can't get too small.
FACES_PER_SUM = 1024


class Measures(NamedTuple):
    """The totals of the paper's section 2.

    Attributes
    ----------
    area : float
        Total area, in squared units of the coordinates.
    gaussian_curvature : float
        Sum of 2 pi - (sum of the angles) over the interior vertices, in radians; 2 pi times the
        Euler characteristic on a closed mesh.
    absolute_gaussian_curvature : float
        The same with absolute values.
    absolute_mean_curvature : float
        Sum of (angle between the normals) times length over the interior edges, in units of
        length.
    willmore_energy : float
        Sum of W(v) over the interior vertices, in radians.
    """

    area: float
    gaussian_curvature: float
    absolute_gaussian_curvature: float
    absolute_mean_curvature: float
    willmore_energy: float


def willmore_energy(vertices: ArrayLike, faces: ArrayLike) -> float:
    """Return the Willmore energy of a mesh: the sum of W(v) over its interior vertices.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
    faces : (m, 3) array_like of int

    Returns
    -------
    float
        In radians, never negative but for rounding; see `vertex_willmore_energy`.

    Raises
    ------
    TypeError, ValueError
        As `meshlab_willmore.mesh.validate.check_mesh`.
    """
    return willmore_energy_of(_unit_mesh(vertices, faces)[0])


def vertex_willmore_energy(vertices: ArrayLike, faces: ArrayLike) -> NDArray[np.float64]:
    """Return W(v) = (sum of the intersection angles at v) - 2 pi for each vertex.

    It is 0 exactly where v is convex and lies with its neighbours on a sphere or plane, and
    positive everywhere else (A. I. Bobenko, "A conformal energy for simplicial surfaces", 2005).

    Parameters
    ----------
    vertices : (n, 3) array_like of float
    faces : (m, 3) array_like of int

    Returns
    -------
    (n,) float64
        In radians. 0 at vertices where W is undefined: on the boundary, not manifold, of no face,
        or with an angle that coincident points leave undefined.

    Raises
    ------
    TypeError, ValueError
        As `meshlab_willmore.mesh.validate.check_mesh`.
    """
    return _vertex_energy(_unit_mesh(vertices, faces)[0])


def intersection_angles(
    vertices: ArrayLike, faces: ArrayLike
) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """Return the angles between the circumcircles of neighbouring faces.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
    faces : (m, 3) array_like of int

    Returns
    -------
    edges : (e, 2) int32
        Vertex pairs of the edges with exactly two faces of the same orientation.
    beta : (e,) float64
        External angle of intersection in [0, pi] radians; 0 where coincident points leave it
        undefined.

    Raises
    ------
    TypeError, ValueError
        As `meshlab_willmore.mesh.validate.check_mesh`.
    """
    mesh = _unit_mesh(vertices, faces)[0]
    interior = np.flatnonzero(np.arange(len(mesh.twin)) < mesh.twin)
    edges = np.column_stack([mesh.origin[interior], mesh.origin[mesh.twin[interior]]])
    return edges, np.nan_to_num(_lower_angles(mesh)[interior])


def measures(vertices: ArrayLike, faces: ArrayLike) -> Measures:
    """Return all the totals of the paper's section 2.

    Curvatures are summed over interior edges (those with exactly two faces of the same orientation)
    and over interior vertices (those whose faces form one closed fan).

    Parameters
    ----------
    vertices : (n, 3) array_like of float
    faces : (m, 3) array_like of int

    Returns
    -------
    Measures

    Raises
    ------
    TypeError, ValueError
        As `meshlab_willmore.mesh.validate.check_mesh`.
    """
    mesh, exponent = _unit_mesh(vertices, faces)
    gaussian = angle_defects(mesh)
    return Measures(
        area=in_input_units(area.total(mesh), 2 * exponent),
        gaussian_curvature=float(gaussian.sum()),
        absolute_gaussian_curvature=float(np.abs(gaussian).sum()),
        absolute_mean_curvature=in_input_units(mean_curvature.total(mesh), exponent),
        willmore_energy=willmore_energy_of(mesh),
    )


def triangle_shapes(vertices: ArrayLike, faces: ArrayLike) -> NDArray[np.float64]:
    """Return the shape 4 sqrt(3) area / (sum of squared sides) of each face.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
    faces : (m, 3) array_like of int

    Returns
    -------
    (m,) float64
        1 for an equilateral triangle, 0 for a degenerate one.

    Raises
    ------
    TypeError, ValueError
        As `meshlab_willmore.mesh.validate.check_mesh`.
    """
    return _shapes(_unit_mesh(vertices, faces)[0])


def self_intersections(vertices: ArrayLike, faces: ArrayLike) -> NDArray[np.bool_]:
    """Return which faces intersect another one.

    Two faces intersect if they share a point that their common vertices do not account for:
    any point if they have none in common, even if they only touch; any besides the common vertex;
    any besides the common edge, which is the case where one is folded back onto the other. Faces
    with the same three vertices do. This is decided exactly, and holds for faces without area too.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
    faces : (m, 3) array_like of int

    Returns
    -------
    (m,) bool

    Raises
    ------
    TypeError, ValueError
        As `meshlab_willmore.mesh.validate.check_mesh`.

    Notes
    -----
    MeshLab's compute_selection_by_self_intersections_per_face goes by rounded numbers, skips faces
    that share an edge, and may count others.
    """
    return intersecting_faces_of(_unit_mesh(vertices, faces)[0])


def intersecting_faces_of(mesh: Mesh, chosen: NDArray[np.bool_] | None = None) -> NDArray[np.bool_]:
    """Return which faces of a half-edge mesh intersect others, as `self_intersections` does.

    Parameters
    ----------
    mesh : Mesh
    chosen : (m,) bool, optional
        Look only at pairs of which one is among these faces.
    """
    faces = len(mesh.origin) // 3
    if chosen is None:
        chosen = np.ones(faces, np.bool_)
    # All pairs with a face of a higher number are looked at.
    order = np.argsort(~chosen, kind="stable")
    mesh = mesh._replace(origin=mesh.origin.reshape(-1, 3)[order].ravel())
    bvh = build_bvh(mesh)
    marked = np.zeros(faces, np.bool_)
    last = np.count_nonzero(chosen)
    for start in range(0, last, FACES_PER_CALL):
        mark_intersecting(mesh, bvh, marked, start, min(start + FACES_PER_CALL, last))
    found = np.empty_like(marked)
    found[order] = marked
    return found


def willmore_energy_of(mesh: Mesh) -> float:
    """Return the Willmore energy of a half-edge mesh, as `willmore_energy` does."""
    return quality_of(mesh, interior_vertices(mesh)).willmore_energy


class Quality(NamedTuple):
    """What flips are judged by.

    Attributes
    ----------
    willmore_energy, absolute_mean_curvature : float
        As in `Measures`.
    mean_shape, worst_shape : float
        Mean and least of `triangle_shapes`; 1 without faces.
    """

    willmore_energy: float
    absolute_mean_curvature: float
    mean_shape: float
    worst_shape: float


def quality_of(mesh: Mesh, interior: NDArray[np.bool_]) -> Quality:
    """Return the Quality of a half-edge mesh with these interior vertices, in its own units."""
    faces = len(mesh.origin) // 3
    if not faces:
        return Quality(0.0, 0.0, 1.0, 1.0)
    sums = _Sums(mesh, interior, *np.empty((5, -(-faces // FACES_PER_SUM))))
    with thread_pool() as parallel_for:
        parallel_for(_add_up, sums, faces, FACES_PER_SUM)
    half_turns = sums.half_turns.sum() - 2.0 * np.count_nonzero(interior)
    energy = float(math.pi * half_turns + sums.rest.sum())
    return Quality(
        # Undefined angles leave out single vertices.
        energy if math.isfinite(energy) else float(_vertex_energy(mesh).sum()),
        float(sums.bends.sum()),
        math.fsum(sums.shapes) / faces,
        float(sums.worst.min()),
    )


class _Sums(NamedTuple):
    """A mesh, its interior vertices, and for each chunk of its faces what they add up to.

    The intersection angles of the edges of these vertices, at each of them, make ``pi * half_turns
    + rest``. Edges belong to the face that has the lower twin.
    """

    mesh: Mesh
    interior: np.ndarray
    half_turns: np.ndarray
    rest: np.ndarray
    bends: np.ndarray
    shapes: np.ndarray
    worst: np.ndarray


# Rows behind those of the diamond: the edge, how many of its ends are interior, the sum of the
# lane's angles, its bend.
_EDGE, _ENDS, _R, _S, _HALF_TURNS, _BEND, _ROWS = range(QUAD_ROWS, QUAD_ROWS + 7)
# In the place of a fourth point for faces, whose corners are in the rows before.
_SHAPE = 9


@allocating_jit
def _add_up(sums, start, stop):
    """Write the sums of the faces from `start` up to `stop`."""
    rows = np.zeros(_ROWS * LANES)
    _add_shapes(sums, start, stop, rows)
    _add_edges(sums, start, stop, rows)


@inner
def _add_shapes(sums, start, stop, rows):
    mesh, total, worst = sums.mesh, 0.0, 1.0
    for first in range(start, stop, LANES):
        count = min(LANES, stop - first)
        for lane in range(count):
            for c in range(3):
                v = mesh.origin[at(3 * (first + lane) + c)]
                write_point(rows, 3 * c, at(lane), mesh.vertices, v)
        for lane in range(LANES):
            a, b, c = point_at(rows, 0, lane), point_at(rows, 3, lane), point_at(rows, 6, lane)
            rows[_SHAPE * LANES + lane] = triangle_shape(a, b, c)
        for lane in range(count):
            shape = rows[_SHAPE * LANES + lane]
            total += shape
            worst = min(worst, shape)
    chunk = start // FACES_PER_SUM
    sums.shapes[chunk], sums.worst[chunk] = total, worst


@inner
def _add_edges(sums, start, stop, rows):
    mesh, bends, count = sums.mesh, 0.0, 0
    for lane in range(LANES):
        rows[_R * LANES + lane] = 1.0
    for h in range(3 * start, 3 * stop):
        t = mesh.twin[at(h)]
        if h > t:
            continue
        fill_quad(rows, count, mesh, h)
        ends = 1.0 if sums.interior[at(mesh.origin[at(h)])] else 0.0
        ends += 1.0 if sums.interior[at(mesh.origin[at(t)])] else 0.0
        rows[_EDGE * LANES + count], rows[_ENDS * LANES + count] = h, ends
        count += 1
        if count == LANES:
            bends += _add_lanes(mesh, rows, count)
            count = 0
    # What is left of the last lanes counts nowhere.
    for lane in range(count, LANES):
        rows[_ENDS * LANES + lane] = 0.0
    bends += _add_lanes(mesh, rows, count)
    half_turns, rest = 0.0, 0.0
    for lane in range(LANES):
        half_turns += rows[_HALF_TURNS * LANES + lane]
        rest += math.atan2(rows[_S * LANES + lane], rows[_R * LANES + lane])
    chunk = start // FACES_PER_SUM
    sums.bends[chunk], sums.half_turns[chunk], sums.rest[chunk] = bends, half_turns, rest


@inner
def _add_lanes(mesh, rows, count):
    """Add the angles of the lanes to their sums; return the bends of the first `count` together."""
    for lane in range(LANES):
        quad = quad_at(rows, lane)
        beta = quad_angle(quad)
        angles = AngleSum(
            rows[_R * LANES + lane], rows[_S * LANES + lane], rows[_HALF_TURNS * LANES + lane]
        )
        ends = rows[_ENDS * LANES + lane]
        angles = add(angles, _if(ends > 0.0, beta))
        angles = add(angles, _if(ends > 1.0, beta))
        rows[_R * LANES + lane], rows[_S * LANES + lane] = angles.r, angles.s
        rows[_HALF_TURNS * LANES + lane] = angles.half_turns
        rows[_BEND * LANES + lane] = mean_curvature.quick_bend(quad)
    total = 0.0
    for lane in range(count):
        bend = rows[_BEND * LANES + lane]
        if not math.isfinite(bend):
            bend = mean_curvature.careful_bend(mesh, np.int64(rows[_EDGE * LANES + lane]))
        total += bend
    return total


@inlined
def _if(counts, beta):
    """Return an angle, or none."""
    return ComplexAngle(beta.r if counts else 1.0, beta.s if counts else 0.0)


def _unit_mesh(vertices: ArrayLike, faces: ArrayLike) -> tuple[Mesh, int]:
    """Return the half-edge mesh of checked arrays at unit scale, and the exponent of that scale."""
    points, triangles = check_mesh(vertices, faces)
    scaled, exponent = to_unit_scale(points, triangles)
    return build(scaled, triangles), exponent


class _Angles(NamedTuple):
    """A mesh and the intersection angle of each half-edge that is the lower twin, to be found."""

    mesh: Mesh
    beta: np.ndarray


def _lower_angles(mesh: Mesh) -> NDArray[np.float64]:
    """Return the intersection angle at each lower twin (3 m,); what else is there means nothing."""
    task = _Angles(mesh, np.empty(len(mesh.origin)))
    with thread_pool() as parallel_for:
        parallel_for(_find_angles, task, len(mesh.origin))
    return task.beta


@jit
def _find_angles(task, start, stop):
    for h in range(start, stop):
        if h < task.mesh.twin[at(h)]:
            task.beta[at(h)] = edge_angle(task.mesh, h)


def _vertex_energy(mesh: Mesh) -> NDArray[np.float64]:
    sums = _sums_at_ends(mesh, _lower_angles(mesh))
    defined = interior_vertices(mesh) & np.isfinite(sums)
    return np.where(defined, sums - FULL_TURN, 0.0)


@allocating_jit
def _sums_at_ends(mesh, beta):
    """Sum the angles of the edges, given at their lower twins, at their end vertices."""
    sums = np.zeros(len(mesh.vertices))
    for h in range(len(mesh.origin)):
        t = mesh.twin[at(h)]
        if h < t:
            sums[at(mesh.origin[at(h)])] += beta[at(h)]
            sums[at(mesh.origin[at(t)])] += beta[at(h)]
    return sums


@allocating_jit
def _shapes(mesh):
    shapes = np.empty(len(mesh.origin) // 3)
    for f in range(len(shapes)):
        a, b, c = corners(mesh, f)
        shapes[f] = triangle_shape(a, b, c)
    return shapes
