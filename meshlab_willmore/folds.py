"""Flips only where the surface is folded, or bent but not creased."""

import math
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from . import guards
from .energy.triangles import corners
from .guards.fold import triangle_shape
from .guards.locks import CREASE_SHAPE, CREASE_SLACK
from .mesh.halfedge import Mesh, diamond
from .mesh.jit import allocating_jit, at
from .mesh.points import norm, normal

# Degrees by which the edge of a fold is bent. The creases of parts are seldom bent by more than a
# right angle, and would be searched for nothing.
FOLD_ANGLE = 100.0
# Degrees by which the edges of a crease are bent: the normals of its vertices mean nothing. Where
# edges are bent less than `BEND_ANGLE`, the normals of faces and vertices hardly differ.
CREASE_ANGLE, BEND_ANGLE = 60.0, 10.0


@allocating_jit
def least_cosines(mesh):
    """Return the cosine of the largest bend (dihedral angle) at the edges of each face, (m,).

    Bends of less than `BEND_ANGLE` count as none, and so do those at faces whose normal is made of
    rounding (a shape below `CREASE_SHAPE`). The cosine of none is 1.
    """
    faces = len(mesh.origin) // 3
    normals, sizes, least = np.empty((faces, 3)), np.empty(faces), np.ones(faces)
    for f in range(faces):
        a, b, c = corners(mesh, f)
        n = normal(a, b, c)
        normals[at(f), 0], normals[at(f), 1], normals[at(f), 2] = n.x, n.y, n.z
        sizes[at(f)] = norm(n)
    flat = math.cos(math.radians(BEND_ANGLE) - CREASE_SLACK)
    for h in range(len(mesh.origin)):
        t = mesh.twin[at(h)]
        if h > t:
            continue
        f, g = at(h // 3), at(t // 3)
        product = 0.0
        for axis in range(3):
            product += normals[f, at(axis)] * normals[g, at(axis)]
        size = sizes[f] * sizes[g]
        if product > flat * size:
            continue
        i, j, k, l = diamond(mesh, h)
        if min(triangle_shape(i, j, k), triangle_shape(j, i, l)) >= CREASE_SHAPE:
            cosine = product / size
            least[f], least[g] = min(least[f], cosine), min(least[g], cosine)
    return least


def faces_near_folds(mesh, cosines):
    """Return the mask (m,) of faces at edges bent by `FOLD_ANGLE`, and of their neighbours.

    Parameters
    ----------
    mesh : Mesh
    cosines : (m,) float64
        Of `least_cosines`.
    """
    return _near(mesh, _bent(cosines, FOLD_ANGLE))


def faces_at_bends(mesh, cosines):
    """Return the mask (m,) of faces near edges bent by `BEND_ANGLE`, and by no `CREASE_ANGLE`.

    Parameters
    ----------
    mesh : Mesh
    cosines : (m,) float64
        Of `least_cosines`.
    """
    return _near(mesh, _bent(cosines, BEND_ANGLE)) & ~_near(mesh, _bent(cosines, CREASE_ANGLE))


def _bent(cosines, degrees):
    return cosines <= math.cos(math.radians(degrees) - CREASE_SLACK)


def _near(mesh, chosen):
    """Return the mask of the faces that have a vertex in common with a chosen one."""
    if not chosen.any():
        return chosen
    is_near = np.zeros(len(mesh.vertices), np.bool_)
    faces = mesh.origin.reshape(-1, 3)
    is_near[faces[chosen]] = True
    return is_near[faces].any(axis=1)


@contextmanager
def locked_outside(mesh: Mesh, faces) -> Iterator[Mesh]:
    """Lend a mesh on the same arrays in which all edges but those between `faces` are locked.

    Parameters
    ----------
    mesh : Mesh
        Its locks are brought up to date at the end.
    faces : (m,) bool
    """
    part = mesh._replace(locked=mesh.locked.copy())
    locked = np.unique(_edge_keys(mesh)[mesh.locked])
    guards.lock_unselected(part, faces)
    try:
        yield part
    finally:
        # Flips have moved edges that stay to other places in their faces.
        mesh.locked[:] = np.isin(_edge_keys(mesh), locked) if len(locked) else False


def _edge_keys(mesh):
    """Return a number (3 m,) for each half-edge, which is that of its edge."""
    faces = mesh.origin.reshape(-1, 3).astype(np.int64)
    ends = np.stack([faces, np.roll(faces, -1, axis=1)])
    return (ends.min(axis=0) * len(mesh.vertices) + ends.max(axis=0)).ravel()
