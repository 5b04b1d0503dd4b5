"""What the page shows of one mesh: energies, angles and shapes, piece by piece and in total."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..measure import (
    Measures,
    measures,
    self_intersections,
    triangle_shapes,
    vertex_willmore_energy,
)
from ..mesh.build import EDGE_SHIFT, build, edge_ends
from ..mesh.normals import vertex_normals
from ..mesh.validate import check_mesh

Array = NDArray[np.float64]
Faces = NDArray[np.int32]

# Energies, shapes and angles below this are rounding errors, whatever the size of the mesh.
NOISE = 1e-9
# The bits of the higher end in the number of an edge.
_HIGH = (1 << EDGE_SHIFT) - 1


class Examined(NamedTuple):
    """A mesh of n vertices and m faces, and what was measured of it.

    Attributes
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
    energy : (n,) float64
        W of each vertex, as `meshlab_willmore.vertex_willmore_energy`.
    normals : (n, 3) float64
    dihedral : (m, 3) float64
        The dihedral angle in degrees at the side of each face that begins at the corner; 0 is flat,
        NaN on the boundary and where more than two faces meet.
    angles : (m, 3) float64
        The angle in degrees at each corner.
    shapes : (m,) float64
        As `meshlab_willmore.measure.triangle_shapes`.
    edges : (e,) int64
        Their numbers, as `side_numbers` gives them, sorted.
    valences : (n,) int64
        How many edges end at each vertex.
    cuts : int
        How many faces cut or touch others, as `meshlab_willmore.measure.self_intersections`.
    totals : Measures
    """

    vertices: Array
    faces: Faces
    energy: Array
    normals: Array
    dihedral: Array
    angles: Array
    shapes: Array
    edges: NDArray[np.int64]
    valences: NDArray[np.int64]
    cuts: int
    totals: Measures


def examined(vertices: Any, faces: Any) -> Examined:
    """Measure a mesh; raises errors as `meshlab_willmore.mesh.validate.check_mesh`."""
    vertices, faces = check_mesh(vertices, faces)
    scaled = _centred(vertices)
    corners = scaled[faces]
    edges = _edges(faces)
    return Examined(
        vertices,
        faces,
        vertex_willmore_energy(vertices, faces),
        vertex_normals(scaled, faces, np.zeros_like(vertices)),
        _dihedral_angles(scaled, faces, corners),
        _angles(corners),
        triangle_shapes(vertices, faces),
        edges,
        np.bincount(np.concatenate([edges >> EDGE_SHIFT, edges & _HIGH]), minlength=len(vertices)),
        int(np.count_nonzero(self_intersections(vertices, faces))),
        measures(vertices, faces),
    )


def _centred(vertices: Array) -> Array:
    """The vertices at a scale at which products neither overflow nor vanish."""
    if not len(vertices):
        return vertices
    largest = np.abs(vertices).max()
    unit = vertices / largest if largest > 0.0 else vertices
    middle: Array = (unit.min(axis=0) + unit.max(axis=0)) / 2.0
    extent = np.ptp(unit, axis=0).max()
    return (unit - middle) / extent if extent > 0.0 else unit - middle


def _dihedral_angles(vertices: Array, faces: Faces, corners: Array) -> Array:
    normals = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    twin = build(vertices, faces).twin
    angles = np.full(len(twin), np.nan)
    inner = np.flatnonzero(twin >= 0)
    angles[inner] = between(normals[inner // 3], normals[twin[inner] // 3])
    return angles.reshape(-1, 3)


def _angles(corners: Array) -> Array:
    ahead, back = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    return between(_unit(ahead.reshape(-1, 3)), _unit(back.reshape(-1, 3))).reshape(-1, 3)


def between(left: Array, right: Array) -> Array:
    """The angles in degrees between unit vectors, accurate for small ones too."""
    halves = np.arctan2(np.linalg.norm(left - right, axis=1), np.linalg.norm(left + right, axis=1))
    degrees: Array = np.degrees(2.0 * halves)
    # A side or a face without a direction makes no angle.
    degrees[~(left.any(axis=1) & right.any(axis=1))] = np.nan
    return degrees


def _unit(rows: Array) -> Array:
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.divide(rows, lengths, out=np.zeros_like(rows), where=lengths > 0.0)


def side_numbers(faces: Faces) -> NDArray[np.int64]:
    """The number of the edge at each side of faces (m, 3), by its ends: (3 m,)."""
    low, high = edge_ends(faces)
    numbers: NDArray[np.int64] = (low.astype(np.int64) << EDGE_SHIFT) | high
    return numbers


def _edges(faces: Faces) -> NDArray[np.int64]:
    # `np.unique` is far slower.
    sides = np.sort(side_numbers(faces))
    return sides[np.diff(sides, prepend=-1) > 0]


def meaningful(value: float, scale: float = 1.0) -> float:
    """The value, or 0 if rounding errors may be as large; `scale` is that of a mesh's lengths."""
    return 0.0 if abs(value) < NOISE * scale else float(value)
