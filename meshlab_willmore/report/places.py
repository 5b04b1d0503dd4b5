"""The worst places of a mesh: where the viewer can fly to."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .examine import NOISE, Examined, meaningful

Array = NDArray[np.float64]

# Places of each kind, which are apart by this share of the diagonal, among so many candidates.
COUNT = 5
APART = 0.02
CANDIDATES = 2000
# The picture is so many times as large as the edges at the place.
VIEW = 6.0
# Faces bent by less, and triangles of a better shape, are nothing to look at.
LEAST_BEND = 1.0
GOOD_SHAPE = 0.6


class Place(NamedTuple):
    """A place of a mesh: its point (3,), seen against the normal (3,), and how bad it is there.

    The sides of the picture are `half` from its middle. How bad it `was` before is empty if that is
    not known.
    """

    point: Array
    normal: Array
    half: float
    value: str
    was: str = ""


class Group(NamedTuple):
    """Places of a kind, the worst first."""

    title: str
    places: tuple[Place, ...]


def groups(before: Examined, after: Examined, is_same: bool) -> list[Group]:
    """Find the worst places of the mesh after, and where it got worse.

    Parameters
    ----------
    is_same : bool
        Whether both have the same vertices, and as many faces.
    """
    found = [
        Group("Highest Willmore energy", tuple(_energies(before, after, is_same))),
        Group("Sharpest folds", tuple(_folds(after))),
        Group("Worst triangles", tuple(_triangles(after))),
    ]
    if is_same:
        found.append(Group("Most improved", tuple(_improved(before, after))))
    return [group for group in found if group.places]


def _energies(before: Examined, after: Examined, is_same: bool) -> Iterator[Place]:
    for v in _worst(after, after.energy, after.vertices):
        if after.energy[v] > NOISE:
            was = _was(before, v) if is_same else ""
            yield _at_vertex(after, v, f"W {after.energy[v]:.3g}", was)


def _improved(before: Examined, after: Examined) -> Iterator[Place]:
    drop = before.energy - after.energy
    for v in _worst(after, drop, after.vertices):
        if drop[v] > NOISE:
            energy = meaningful(after.energy[v])
            yield _at_vertex(after, v, f"W {energy:.3g}", _was(before, v))


def _was(before: Examined, v: int) -> str:
    return f"was {meaningful(before.energy[v]):.3g}"


def _folds(mesh: Examined) -> Iterator[Place]:
    bends = np.nan_to_num(mesh.dihedral).ravel()
    ends = np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=-1).reshape(-1, 2)
    middles = mesh.vertices[ends].mean(axis=1)
    for h in _worst(mesh, bends, middles):
        if bends[h] >= LEAST_BEND:
            yield _at_face(mesh, h // 3, middles[h], f"{bends[h]:.1f}°")


def _triangles(mesh: Examined) -> Iterator[Place]:
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    for f in _worst(mesh, -mesh.shapes, middles):
        if mesh.shapes[f] < GOOD_SHAPE:
            yield _at_face(mesh, f, middles[f], f"shape {mesh.shapes[f]:.3f}")


def _worst(mesh: Examined, badness: Array, points: Array) -> list[int]:
    """The numbers of the worst ones that are apart from each other."""
    if not len(mesh.faces):
        return []
    apart = APART * float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    count = min(CANDIDATES, len(badness))
    candidates = np.argpartition(-badness, count - 1)[:count]
    candidates = candidates[np.argsort(-badness[candidates], kind="stable")]
    chosen: list[int] = []
    for one in candidates.tolist():
        if all(np.linalg.norm(points[one] - points[other]) > apart for other in chosen):
            chosen.append(one)
        if len(chosen) == COUNT:
            break
    return chosen


def _at_vertex(mesh: Examined, v: int, value: str, was: str) -> Place:
    around = mesh.vertices[mesh.faces[(mesh.faces == v).any(axis=1)]]
    size = float(np.linalg.norm(np.ptp(around.reshape(-1, 3), axis=0)))
    return Place(mesh.vertices[v], mesh.normals[v], VIEW * size / 2.0, value, was)


def _at_face(mesh: Examined, f: int, point: Array, value: str) -> Place:
    corners = mesh.faces[f]
    size = float(np.linalg.norm(np.ptp(mesh.vertices[corners], axis=0)))
    return Place(point, mesh.normals[corners].sum(axis=0), VIEW * size, value)
