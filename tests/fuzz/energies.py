"""The energies in long double, as plain sums, each with what rounding may do to it in double.

A sum that is not finite (a face without area, an edge between coincident points) has no value.
"""

import numpy as np

from tests import reference

# Some roundings in double precision.
EPS = 2.0**-48


def _corners(vertices, faces):
    return np.asarray(vertices, np.longdouble)[np.asarray(faces)]


def _dot(a, b):
    return np.sum(a * b, axis=-1)


def _size(a):
    return np.sqrt(_dot(a, a))


def _twice_areas(vertices, faces):
    """Twice the areas, from the corner where rounding harms least: opposite to the longest side."""
    corners = _corners(vertices, faces)
    sides = np.stack([corners[:, (c + 2) % 3] - corners[:, (c + 1) % 3] for c in range(3)], axis=1)
    longest = np.argmax(_dot(sides, sides), axis=1)
    rows = np.arange(len(sides))
    return _size(np.cross(sides[rows, (longest + 1) % 3], sides[rows, (longest + 2) % 3])), sides


def intersection_angles(vertices, faces):
    """The angles of the circumcircles at the edges with two faces, by the cross-ratio."""
    rows = reference.diamonds(faces)
    a, b, p, q = _corners(vertices, rows).transpose(1, 0, 2)
    c1, n1 = _dot(a - p, b - p)[:, None], np.cross(a - p, b - p)
    c2, n2 = _dot(b - q, a - q)[:, None], np.cross(b - q, a - q)
    s = _size(c1 * n2 + c2 * n1 - np.cross(n1, n2))
    r = _dot(n1, n2) - (c1 * c2)[:, 0]
    # Where an end coincides with a corner opposite there is no circle.
    return np.where((r == 0) & (s == 0), np.nan, np.arctan2(s, r))


def willmore(vertices, faces):
    angles = intersection_angles(vertices, faces)
    return 2 * np.nansum(angles), EPS * (1 + len(angles))


def uniform(vertices, faces):
    value, error = willmore(vertices, faces)
    excess = np.maximum(reference.corner_angles(vertices, faces) - np.pi / 2, 0)
    value = 2 * value + 2 * np.pi * len(faces) + 8 * np.nansum(excess)
    return value, 2 * error + EPS * len(faces)


def area(vertices, faces):
    twice, sides = _twice_areas(vertices, faces)
    return twice.sum() / 2, EPS * _dot(sides, sides).sum()


def mean_curvature(vertices, faces):
    i, j, k, l = _corners(vertices, reference.diamonds(faces)).transpose(1, 0, 2)
    one, other = np.cross(j - i, k - i), np.cross(l - i, j - i)
    length = _size(j - i)
    angle = np.arctan2(_size(np.cross(one, other)), _dot(one, other))
    scale = _dot(k - i, k - i) + _dot(l - i, l - i) + length**2
    # As far as a normal turns by rounding.
    turn = EPS * scale / np.minimum(_size(one), _size(other))
    return (length * angle).sum(), (length * np.minimum(turn, np.pi)).sum() + EPS * length.sum()


def gaussian_curvature(vertices, faces):
    defects = reference.angle_defects(vertices, faces)
    return np.abs(defects).sum(), EPS * (1 + len(faces))


def delaunay(vertices, faces):
    twice, sides = _twice_areas(vertices, faces)
    with np.errstate(divide="ignore"):
        cotangents = _dot(sides, sides).sum(axis=1) / (2 * twice)
    return cotangents.sum(), EPS * (cotangents.sum() + (cotangents**2).sum())


ENERGIES = {
    "virtual willmore": willmore,
    "willmore": willmore,
    "uniform virtual willmore": uniform,
    "area": area,
    "mean curvature": mean_curvature,
    "gaussian curvature": gaussian_curvature,
    "delaunay": delaunay,
}
LENGTH_POWER = {"area": 2, "mean curvature": 1}


def dihedral_angles(vertices, faces):
    """The edges with two faces as rows, their dihedral angles in degrees, the worse shape there."""
    rows = reference.diamonds(faces)
    i, j, k, l = _corners(vertices, rows).transpose(1, 0, 2)
    one, other = np.cross(j - i, k - i), np.cross(l - i, j - i)
    angle = np.degrees(np.arctan2(_size(np.cross(one, other)), _dot(one, other)))
    shapes = [
        2 * np.sqrt(3) * _size(normal) / (_dot(a, a) + _dot(b, b) + _dot(a - b, a - b))
        for normal, a, b in ((one, j - i, k - i), (other, l - i, j - i))
    ]
    return rows[:, :2], angle.astype(float), np.minimum(*shapes).astype(float)
