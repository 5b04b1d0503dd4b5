"""Meshes packed for the viewer: small numbers in planes of bytes, deflated, in base64.

Positions are 16-bit numbers on a grid over both meshes. A vertex is written as its step from the
one before, and a corner of a face as how many new vertices there were since its own was new. Where
flips alone made the second mesh of the first, it is written by what differs. `viewer.js` reads what
`packed` writes.
"""

from __future__ import annotations

import zlib
from base64 import b64encode
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..mesh.build import local_order

Array = NDArray[np.float64]
Faces = NDArray[np.int32]
Bytes = NDArray[np.uint8]

# Steps of the grid from the middle to each side.
STEPS = 32767
# W of the palest and of the darkest colour; smaller ones, and vertices without W, have level 0.
LOWEST_ENERGY, HIGHEST_ENERGY = 1e-4, 10.0
LEVELS = 255
HALF_TURN = 180.0
# Of zlib's levels; the highest takes five times as long, and saves 2 %.
COMPRESSION = 6


class Shown(NamedTuple):
    """A mesh as the viewer shows it, with the arrays of `Examined` that it needs for that.

    The sides of faces that the other mesh does not have are `flipped` (m, 3).
    """

    vertices: Array
    faces: Faces
    energy: Array
    dihedral: Array
    flipped: NDArray[np.bool_]


class Grid(NamedTuple):
    """What part of space the viewer shows: the middle, and the distance from it to the sides."""

    centre: Array
    half: float

    def on_grid(self, points: Array) -> Array:
        """The points (n, 3), with coordinates from -1 to 1."""
        placed: Array = (points - self.centre) / self.half
        return placed


def grid_of(*meshes: Shown) -> Grid:
    """The grid over the faces of meshes."""
    points = np.concatenate([mesh.vertices[used_by(mesh.faces, mesh.vertices)] for mesh in meshes])
    if not len(points):
        return Grid(np.zeros(3), 1.0)
    low, high = points.min(axis=0), points.max(axis=0)
    return Grid(low / 2.0 + high / 2.0, float((high / 2.0 - low / 2.0).max()) or 1.0)


def used_by(faces: Faces, vertices: Array) -> NDArray[np.bool_]:
    """Which of the vertices (n, 3) faces use."""
    is_used = np.zeros(len(vertices), np.bool_)
    is_used[faces] = True
    return is_used


def packed(before: Shown, after: Shown, grid: Grid) -> tuple[dict[str, Any], str]:
    """Pack two meshes.

    Returns
    -------
    head : dict
        The numbers that the viewer needs to read the text.
    text : str
        The base64 of a zlib stream.
    """
    is_same = len(before.faces) == len(after.faces) and np.array_equal(
        before.vertices, after.vertices
    )
    meshes = [_in_order(before, before), _in_order(after, before if is_same else after)]
    streams = [*_own(meshes[0], grid)]
    streams += _differences(*meshes) if is_same else _own(meshes[1], grid)
    sizes = [{"vertices": len(mesh.vertices), "faces": len(mesh.faces)} for mesh in meshes]
    data = zlib.compress(b"".join(stream.tobytes() for stream in streams), COMPRESSION)
    return {"meshes": sizes, "isSame": is_same}, b64encode(data).decode("ascii")


def _in_order(mesh: Shown, pattern: Shown) -> Shown:
    """The mesh with its faces, and the vertices that these use, in the order of the pattern's."""
    faces = local_order(pattern.faces, len(pattern.vertices))
    corners = pattern.faces[faces].ravel()
    places = np.arange(len(corners))
    # Of several values for one place the last one stays: where the vertex is first used.
    first = np.full(len(pattern.vertices), len(corners))
    first[corners[::-1]] = places[::-1]
    vertices = corners[first[corners] == places]
    number = np.zeros(len(pattern.vertices), np.int32)
    number[vertices] = np.arange(len(vertices), dtype=np.int32)
    return Shown(
        mesh.vertices[vertices],
        number[mesh.faces[faces]],
        mesh.energy[vertices],
        mesh.dihedral[faces],
        mesh.flipped[faces],
    )


def _own(mesh: Shown, grid: Grid) -> Iterator[Bytes]:
    """The streams of bytes of a mesh."""
    places = np.rint(grid.on_grid(mesh.vertices) * STEPS).astype(np.int64)
    steps = np.diff(places, axis=0, prepend=0) & 0xFFFF
    yield from _planes(steps.T.ravel(), 2)
    yield _energy_levels(mesh)
    corners = mesh.faces.ravel().astype(np.int64)
    seen = np.maximum.accumulate(np.concatenate([[-1], corners]))[:-1] + 1
    yield from _planes(seen - corners, 4)
    yield _dihedral_levels(mesh)
    yield _flip_bits(mesh)


def _differences(before: Shown, after: Shown) -> Iterator[Bytes]:
    """The streams of a mesh that has the vertices and as many faces as the one before."""
    yield _energy_levels(after) - _energy_levels(before)
    steps = after.faces.ravel().astype(np.int64) - before.faces.ravel()
    # Signs are put last: 0, -1, 1, -2 become 0, 1, 2, 3.
    yield from _planes(np.where(steps < 0, -2 * steps - 1, 2 * steps), 4)
    yield _dihedral_levels(after) - _dihedral_levels(before)
    yield _flip_bits(after)


def _planes(numbers: NDArray[np.int64], count: int) -> Iterator[Bytes]:
    """All lowest bytes of numbers, then all second ones, and so on."""
    for place in range(count):
        yield (numbers >> 8 * place).astype(np.uint8)


def _energy_levels(mesh: Shown) -> Bytes:
    """The energies on a logarithmic scale of 1 to `LEVELS`; 0 where there is none to show."""
    lowest, highest = np.log10([LOWEST_ENERGY, HIGHEST_ENERGY])
    is_shown = mesh.energy > LOWEST_ENERGY
    share = (np.log10(np.where(is_shown, mesh.energy, 1.0)) - lowest) / (highest - lowest)
    return np.where(is_shown, 1.0 + np.clip(share, 0.0, 1.0) * (LEVELS - 1), 0.0).astype(np.uint8)


def _dihedral_levels(mesh: Shown) -> Bytes:
    degrees = np.nan_to_num(mesh.dihedral.ravel())
    return np.rint(degrees / HALF_TURN * LEVELS).astype(np.uint8)


def _flip_bits(mesh: Shown) -> Bytes:
    return (mesh.flipped @ np.array([1, 2, 4])).astype(np.uint8)
