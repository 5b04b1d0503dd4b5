"""Fewer faces for the viewer: vertices of a cell of a grid become one, in their middle.

Source: J. Rossignac and P. Borrel, "Multi-resolution 3D approximations for rendering complex
scenes", 1993.
"""

from __future__ import annotations

import numpy as np

from .examine import Examined
from .pack import Shown

# Meshes with more faces are shown with about so many.
MOST_FACES = 1_000_000
WANTED = 400_000
# A grid that cuts a surface has more cells than one that lies in it.
CELLS_PER_AREA = 1.5
COARSER = 1.25


def cell_size(*meshes: Examined) -> float:
    """The side of the cells with which all meshes get about `WANTED` faces at most."""
    area = max(mesh.totals.area for mesh in meshes)
    # Without an area it is a matter of the extent, and the first cell has all.
    extent = max(float(np.ptp(mesh.vertices, axis=0).max()) for mesh in meshes)
    size = float(np.sqrt(2.0 * CELLS_PER_AREA * area / WANTED)) or extent or 1.0
    while max(len(decimated(mesh, size).faces) for mesh in meshes) > COARSER * WANTED:
        size *= COARSER
    return size


def decimated(mesh: Examined, size: float) -> Shown:
    """Return a mesh with one vertex in each cell of a grid; W is the largest of the cell's.

    Parameters
    ----------
    size : float
        The side of a cell.
    """
    low = mesh.vertices.min(axis=0)
    places = np.floor((mesh.vertices - low) / size).astype(np.int64)
    _, cell = np.unique(places, axis=0, return_inverse=True)
    cell = cell.ravel()
    sums = np.stack([np.bincount(cell, axis) for axis in mesh.vertices.T], axis=1)
    vertices = np.asarray(sums / np.bincount(cell)[:, None], np.float64)
    energy = np.zeros(len(vertices))
    np.maximum.at(energy, cell, mesh.energy)
    faces = cell[mesh.faces]
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    # Each triangle once, beginning with its lowest corner.
    first = faces.argmin(axis=1)
    turned = np.take_along_axis(faces, (first[:, None] + np.arange(3)) % 3, axis=1)
    turned = np.unique(turned, axis=0).astype(np.int32)
    none = np.zeros(turned.shape)
    return Shown(vertices, turned, energy, none, none.astype(np.bool_))
