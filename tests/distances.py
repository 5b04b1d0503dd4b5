"""How far two triangulations of the same vertices are from each other, by brute force."""

import numpy as np

# Barycentric coordinates of the points of each face that are looked at.
_GRID = np.array(
    [(a, b, 6 - a - b) for a in range(7) for b in range(7 - a)],
    float,
)
_SAMPLES = _GRID / 6.0


def _dot(a, b):
    return (a * b).sum(axis=-1)


def _to_segments(points, a, b):
    """Squared distances (p, s) of points (p, 1, 3) to segments (1, s, 3)."""
    along = b - a
    squares = _dot(along, along)
    t = _dot(points - a, along) / np.where(squares > 0.0, squares, 1.0)
    gap = points - a - np.clip(t, 0.0, 1.0)[..., None] * along
    return _dot(gap, gap)


def to_triangles(points, triangles):
    """The distance of each point (p, 3) to the nearest of triangles (t, 3, 3)."""
    a, b, c = triangles.transpose(1, 0, 2)[:, None]
    points = points[:, None]
    least = np.minimum(_to_segments(points, a, b), _to_segments(points, b, c))
    least = np.minimum(least, _to_segments(points, c, a))
    normal = np.cross(b - a, c - a)
    squares = _dot(normal, normal)
    is_inside = np.broadcast_to(squares > 0.0, least.shape).copy()
    for p, q in ((a, b), (b, c), (c, a)):
        is_inside &= _dot(np.cross(q - p, points - p), normal) >= 0.0
    height = _dot(points - a, normal) ** 2 / np.where(squares > 0.0, squares, 1.0)
    least = np.where(is_inside, np.minimum(height, least), least)
    return np.sqrt(least.min(axis=1))


def farthest(vertices, before, after):
    """The largest distances of points of new faces to the old surface, and the other way round.

    Points of faces that both have are on both.
    """
    old, new = set(map(frozenset, before.tolist())), set(map(frozenset, after.tolist()))
    fresh = np.array([f for f in after.tolist() if frozenset(f) not in old]).reshape(-1, 3)
    gone = np.array([f for f in before.tolist() if frozenset(f) not in new]).reshape(-1, 3)
    if not len(fresh):
        return 0.0, 0.0
    return (
        to_triangles(_points(vertices, fresh), vertices[before]).max(),
        to_triangles(_points(vertices, gone), vertices[after]).max(),
    )


def _points(vertices, faces):
    return np.einsum("sc,fcx->fsx", _SAMPLES, vertices[faces]).reshape(-1, 3)
