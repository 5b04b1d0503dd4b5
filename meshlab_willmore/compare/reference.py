"""How far a mesh is from the surface that it approximates."""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

import numpy as np
import pymeshlab
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Barycentric coordinates of three points in a triangle; the mean of a quadratic function at these
# is its mean over the triangle.
_SAMPLES = np.array([(4, 1, 1), (1, 4, 1), (1, 1, 4)]) / 6.0
_CENTROID = np.full((1, 3), 1.0 / 3.0)


class Reference(Protocol):
    """A surface that finds its nearest points."""

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Look up the nearest points on the surface.

        Parameters
        ----------
        points : (n, 3) float64

        Returns
        -------
        distances : (n,) float64
        normals : (n, 3) float64
            Outward normals of the surface there, of any length; zero or NaN where there is none.
        """


class Sphere(NamedTuple):
    """The sphere around the origin; without a radius its distances are NaN."""

    radius: float = math.nan

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """See `Reference`."""
        return np.abs(np.linalg.norm(points, axis=1) - self.radius), points


class Torus(NamedTuple):
    """The torus around the origin with the axis z: radius of the ring, and of the tube."""

    ring: float
    tube: float

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """See `Reference`."""
        flat = points * (1.0, 1.0, 0.0)
        with np.errstate(invalid="ignore"):
            middle = self.ring * flat / np.linalg.norm(flat, axis=1, keepdims=True)
        outward = points - middle
        return np.abs(np.linalg.norm(outward, axis=1) - self.tube), outward


class ReferenceMesh(NamedTuple):
    """A triangle mesh: vertices (n, 3) and faces (m, 3)."""

    vertices: Array
    faces: NDArray[np.int32]

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """See `Reference`; the normals are those of faces, not interpolated."""
        ms = pymeshlab.MeshSet()
        # Each face with vertices of its own: then the vertex normals are the face's.
        corners = self.vertices[self.faces].reshape(-1, 3)
        ms.add_mesh(pymeshlab.Mesh(corners, np.arange(len(corners)).reshape(-1, 3)))
        ms.add_mesh(pymeshlab.Mesh(points))
        everything = np.concatenate([corners, points])
        ms.transfer_attributes_per_vertex(
            sourcemesh=0,
            targetmesh=1,
            geomtransfer=True,
            normaltransfer=True,
            colortransfer=False,
            upperbound=pymeshlab.PureValue(float(np.linalg.norm(np.ptp(everything, axis=0)))),
        )
        moved = ms.current_mesh()
        distances = np.linalg.norm(moved.vertex_matrix() - points, axis=1)
        return distances, moved.vertex_normal_matrix()


class Deviation(NamedTuple):
    """How far a mesh is from its reference."""

    # Mean over the faces of the angle between the face's normal and that of the reference where it
    # is nearest to the face's centroid, in degrees. Faces without a normal don't count.
    normal_error: float
    # Root mean square over the area of the mesh of the distance to the reference, from three points
    # in each face.
    distance: float


def deviation(vertices: Array, faces: NDArray[np.int32], reference: Reference) -> Deviation:
    """Compare a mesh with a reference; NaN is unknown.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
        Oriented as the reference is.
    """
    corners = vertices[faces]
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(doubled, axis=1)
    _, normals = reference.nearest(_points(corners, _CENTROID))
    angles = _angles(doubled, normals)
    distances, _ = reference.nearest(_points(corners, _SAMPLES))
    squares = (distances.reshape(len(faces), -1) ** 2).mean(axis=1)
    return Deviation(
        float(np.degrees(_mean(angles[np.isfinite(angles)]))),
        math.sqrt((squares @ areas) / areas.sum()) if areas.any() else math.nan,
    )


def _points(corners: Array, weights: Array) -> Array:
    """The points of faces (m, 3, 3) with the barycentric coordinates (s, 3): (m s, 3)."""
    return np.einsum("si,mid->msd", weights, corners).reshape(-1, 3)


def _angles(left: Array, right: Array) -> Array:
    """The angles between rows of any length; NaN for a row of zeros."""
    left, right = _unit(left), _unit(right)
    sines = np.linalg.norm(np.cross(left, right), axis=1)
    return np.arctan2(sines, np.einsum("md,md->m", left, right))


def _unit(rows: Array) -> Array:
    """The rows with length 1; NaN for zeros."""
    with np.errstate(invalid="ignore"):
        scaled = rows / np.abs(rows).max(axis=1, keepdims=True)
        return scaled / np.linalg.norm(scaled, axis=1, keepdims=True)


def _mean(values: Array) -> float:
    return float(values.mean()) if len(values) else math.nan
