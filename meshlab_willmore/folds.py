"""Flips only where the surface is folded: where descent by single flips leaves tangles behind."""

import math
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from . import guards
from .mesh.halfedge import Mesh

# Degrees by which the edge of a fold is bent. The creases of parts are seldom bent by more than a
# right angle, and would be searched for nothing.
FOLD_ANGLE = 100.0


def faces_near_folds(mesh):
    """Return the mask (m,) of faces at edges bent by `FOLD_ANGLE`, and of their neighbours."""
    creased = mesh._replace(locked=np.zeros_like(mesh.locked))
    guards.lock_creases(creased, math.radians(FOLD_ANGLE))
    at_fold = np.zeros(len(mesh.vertices), np.bool_)
    faces = mesh.origin.reshape(-1, 3)
    at_fold[faces[creased.locked.reshape(-1, 3).any(axis=1)]] = True
    return at_fold[faces].any(axis=1)


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
