"""Normals of vertices as MeshLab's flip filters leave them."""

import math

import numpy as np

from .jit import at, jit
from .points import normal, point

# Below, squares have lost digits.
LEAST = 1e-150


def vertex_normals(vertices, faces, others):
    """Return the unit normals of all vertices.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
    others : (n, 3) float64
        The normals of the vertices without faces, of any length: points have their own.

    Returns
    -------
    (n, 3) float64
        For a vertex with faces the sum of their normals, each as long as twice the face's area,
        scaled to length 1. Zero stays zero.

    Notes
    -----
    The sums and their order are those of ``UpdateNormal::PerVertexNormalizedPerFace`` in VCG
    (``vcg/complex/algorithms/update/normal.h``), which MeshLab's planar flip ends with.
    """
    normals, has_face = np.zeros((len(vertices), 3)), np.zeros(len(vertices), np.bool_)
    _add_normals(vertices, faces, normals, has_face)
    _normalize(normals, has_face, np.ascontiguousarray(others))
    return normals


@jit
def _add_normals(vertices, faces, normals, has_face):
    """Add the normal of each face to those of its corners."""
    for f in range(len(faces)):
        a, b, c = at(faces[at(f), 0]), at(faces[at(f), 1]), at(faces[at(f), 2])
        n = normal(point(vertices, a), point(vertices, b), point(vertices, c))
        for v in (a, b, c):
            normals[v, 0] += n.x
            normals[v, 1] += n.y
            normals[v, 2] += n.z
            has_face[v] = True


@jit
def _normalize(normals, has_face, others):
    """Scale the normals of vertices with faces to length 1, and fill in the other ones."""
    for v in range(len(normals)):
        if not has_face[v]:
            normals[v, 0], normals[v, 1], normals[v, 2] = others[v, 0], others[v, 1], others[v, 2]
        # As Python's floats, which get infinite without a warning where the compiler is off.
        x, y, z = float(normals[v, 0]), float(normals[v, 1]), float(normals[v, 2])
        length = math.sqrt(x * x + y * y + z * z)
        if not LEAST < length < math.inf:
            most = max(abs(x), abs(y), abs(z))
            if not 0.0 < most < math.inf:
                continue
            x, y, z = x / most, y / most, z / most
            length = math.sqrt(x * x + y * y + z * z)
        normals[v, 0], normals[v, 1], normals[v, 2] = x / length, y / length, z / length
