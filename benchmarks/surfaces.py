"""Meshes of any size at once: Delaunay triangulations of ten million points take too long."""

import numpy as np

MAJOR_RADIUS = 3.0
MINOR_RADIUS = 1.0
JITTER = 0.3
# Rings are joined askew, so that most edges want to be flipped, as in a stretched triangulation.
SHIFT = 2


def sheared_torus(faces):
    """A torus of about so many faces: a jittered grid whose rings are joined askew.

    Returns
    -------
    vertices : (n, 3) float64
    faces : (m, 3) int32
        Counter-clockwise, seen from outside.
    """
    points = faces // 2
    rings = round(np.sqrt(3 * points))
    around = points // rings
    vertices = _points(rings, around)
    ring, place = (line.ravel() for line in np.indices((rings, around), dtype=np.int32))
    ahead = (ring + 1) % rings
    a = ring * around + place
    b = ahead * around + (place + SHIFT) % around
    c = ahead * around + (place + SHIFT + 1) % around
    d = ring * around + (place + 1) % around
    triangles = np.empty((2 * len(a), 3), np.int32)
    triangles[::2] = np.stack([a, b, c], 1)
    triangles[1::2] = np.stack([a, c, d], 1)
    return vertices, triangles


def _points(rings, around):
    """The grid's points, each moved by a part of its spacing."""
    scatter = np.random.default_rng(0).uniform(-JITTER, JITTER, (2, rings, around))
    u = 2 * np.pi * ((np.arange(rings)[:, None] + scatter[0]) / rings).ravel()
    v = 2 * np.pi * ((np.arange(around) + scatter[1]) / around).ravel()
    distance = MAJOR_RADIUS + MINOR_RADIUS * np.cos(v)
    return np.stack([distance * np.cos(u), distance * np.sin(u), MINOR_RADIUS * np.sin(v)], 1)
