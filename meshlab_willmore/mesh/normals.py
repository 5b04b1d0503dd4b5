"""Normals of vertices as MeshLab's flip filters leave them."""

import numpy as np

from .jit import jit
from .points import normal, point


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
    sums = np.zeros_like(vertices)
    used = np.zeros(len(vertices), np.bool_)
    _add_normals(vertices, faces, sums, used)
    sums[~used] = others[~used]
    # Products of coordinates above 1e77 overflow, as they do in MeshLab.
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.sqrt(np.einsum("ij,ij->i", sums, sums))
        return sums / np.where(lengths > 0.0, lengths, 1.0)[:, None]


@jit
def _add_normals(vertices, faces, sums, used):
    """Add the normal of each face to `sums` at its corners, and mark these in `used`."""
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        n = normal(point(vertices, a), point(vertices, b), point(vertices, c))
        for v in (a, b, c):
            sums[v, 0] += n.x
            sums[v, 1] += n.y
            sums[v, 2] += n.z
            used[v] = True
