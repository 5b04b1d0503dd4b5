"""Checks at the edge of the public functions: what passes is safe for the kernels."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Half-edges are numbered 3 f + c in int32.
MOST_FACES = (2**31 - 1) // 3
MOST_VERTICES = 2**31 - 1
# Least coordinate at unit scale: the difference of two is above 2**-126, or none, and the squares
# of products of four such lengths, which angles take, are in the range of floats.
LEAST = 2.0**-74


class NotFiniteError(ValueError):
    """A vertex has a coordinate that is not finite."""


class RepeatedVertexError(ValueError):
    """A face has a vertex twice."""


def check_mesh(
    vertices: ArrayLike, faces: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Return vertices and faces as the kernels take them, or raise.

    Parameters
    ----------
    vertices : (n, 3) array_like of real numbers
        Coordinates, all finite.
    faces : (m, 3) array_like of int
        Indices of the three different corners of each face. m may be 0.

    Returns
    -------
    vertices : (n, 3) float64
    faces : (m, 3) int32
        Both may share memory with the input.

    Raises
    ------
    TypeError
        Wrong kind of numbers.
    ValueError
        Wrong shape, or names the first vertex or face that is wrong.
    """
    points = _check_vertices(np.asarray(vertices))
    return points, _check_faces(np.asarray(faces), len(points))


def _check_vertices(vertices: NDArray[Any]) -> NDArray[np.float64]:
    if vertices.dtype.kind not in "fiu":
        raise TypeError(f"vertices must be real numbers, not {vertices.dtype}")
    vertices = _check_rows(vertices, "vertices", 3)
    if len(vertices) > MOST_VERTICES:
        raise ValueError(f"{len(vertices)} vertices are too many, at most {MOST_VERTICES} work")
    # A float32 may be a signalling NaN, such as PyMeshLab leaves where nothing was set.
    with np.errstate(over="ignore", invalid="ignore"):
        converted = np.ascontiguousarray(vertices, np.float64)
    finite = np.isfinite(converted)
    if not finite.all():
        v = int(np.argmin(finite.all(axis=1)))
        values = converted[v].tolist()
        raise NotFiniteError(f"vertex {v} has a coordinate that is not finite: {values}")
    return converted


def _check_rows(array: NDArray[Any], name: str, width: int) -> NDArray[Any]:
    """Check that an array has rows of `width` numbers; an empty list has none and is fine."""
    if array.shape == (0,):
        return array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{name} must have the shape (count, {width}), not {array.shape}")
    return array


def _check_indices(indices: NDArray[Any], name: str, width: int) -> NDArray[Any]:
    """Check that an array has rows of `width` integers; the type of an empty array says nothing."""
    if not indices.size:
        indices = np.empty(indices.shape, np.int64)
    if indices.dtype.kind not in "iu":
        raise TypeError(f"{name} must be integers, not {indices.dtype}")
    return _check_rows(indices, name, width)


def _check_faces(faces: NDArray[Any], vertex_count: int) -> NDArray[np.int32]:
    faces = _check_indices(faces, "faces", 3)
    if len(faces) > MOST_FACES:
        raise ValueError(f"{len(faces)} faces are too many, at most {MOST_FACES} work")
    if faces.size and not 0 <= faces.min() <= faces.max() < vertex_count:
        f = int(np.argmax(((faces < 0) | (faces >= vertex_count)).any(axis=1)))
        last = vertex_count - 1
        allowed = f"not in 0 .. {last}" if vertex_count else "wrong, there are no vertices"
        raise ValueError(f"face {f} has a vertex index that is {allowed}: {faces[f].tolist()}")
    a, b, c = faces.T
    repeated = (a == b) | (b == c) | (c == a)
    if repeated.any():
        f = int(np.argmax(repeated))
        raise RepeatedVertexError(f"face {f} has a repeated vertex: {faces[f].tolist()}")
    return np.ascontiguousarray(faces, np.int32)


def check_edges(edges: ArrayLike) -> NDArray[np.int64]:
    """Return vertex pairs (e, 2) as int64, or raise as `check_mesh` does."""
    return _check_indices(np.asarray(edges), "locked_edges", 2).astype(np.int64, order="C")


def check_mask(mask: ArrayLike, count: int) -> NDArray[np.bool_]:
    """Return the boolean mask (count,) as an array, or raise TypeError or ValueError."""
    array = np.asarray(mask)
    if not array.size:
        array = np.empty(array.shape, np.bool_)
    if array.dtype != np.bool_:
        raise TypeError(f"selected_faces must be a mask of bool, not {array.dtype}")
    if array.shape != (count,):
        raise ValueError(f"selected_faces must have the shape ({count},), not {array.shape}")
    return array


def check_wedge_uv(uv: ArrayLike, faces: int) -> NDArray[np.float64]:
    """Return texture coordinates (faces, 3, 2 c), finite or not, as float64, or raise.

    `faces` is the number of faces.
    """
    array = np.asarray(uv)
    if not array.size and not faces:
        return np.empty((0, 3, 2))
    if array.dtype.kind not in "fiu":
        raise TypeError(f"wedge_uv must be real numbers, not {array.dtype}")
    shape = array.shape
    if array.ndim != 3 or shape[:2] != (faces, 3) or shape[2] == 0 or shape[2] % 2:
        raise ValueError(f"wedge_uv must have the shape ({faces}, 3, 2), not {shape}")
    with np.errstate(over="ignore", invalid="ignore"):
        return np.ascontiguousarray(array, np.float64)


def to_unit_scale(
    vertices: NDArray[np.float64], faces: NDArray[np.integer]
) -> tuple[NDArray[np.float64], int]:
    """Return coordinates scaled by a power of two, so that products of lengths stay in range.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32

    Returns
    -------
    scaled : (n, 3) float64
        A new array, exact, with the largest coordinate of a face's vertex in [0.5, 1); vertices
        of no face are set to 0, and so are coordinates below `LEAST`, since products of even
        smaller lengths leave the range of floats.
    exponent : int
        But for these, ``vertices == scaled * 2**exponent``.
    """
    used = np.zeros(len(vertices), bool)
    used[faces.ravel()] = True
    kept = vertices if used.all() else np.where(used[:, None], vertices, 0.0)
    most = max(kept.max(initial=0.0), -kept.min(initial=0.0))
    _, exponent = math.frexp(float(most))
    # Two steps, as 2**-exponent itself may not be a float.
    half = -exponent // 2
    scaled = kept * math.ldexp(1.0, half)
    scaled *= math.ldexp(1.0, -exponent - half)
    scaled[np.abs(scaled) < LEAST] = 0.0
    return scaled, exponent


def diagonal_of(vertices: NDArray[np.floating]) -> float:
    """Return the diagonal of the bounding box of vertices (n, 3), infinite if it is no float."""
    if not len(vertices):
        return 0.0
    with np.errstate(over="ignore", invalid="ignore"):
        # By columns: along rows of three NumPy takes many times as long.
        return float(math.hypot(*(np.ptp(column.copy()) for column in vertices.T)))


def in_input_units(value: float, exponent: int) -> float:
    """Return ``value * 2**exponent``: a measure at unit scale in the units of the input.

    For a length, `exponent` is that of `to_unit_scale`, for an area twice that. What is too large
    for a float is infinite.
    """
    with np.errstate(over="ignore", under="ignore"):
        return float(np.ldexp(value, exponent))
