"""Sides of faces as MeshLab marks them: bits in the flags, and texture seams.

A side is the half-edge from a corner to the next one; its edge may have a mark on either side.
"""

from __future__ import annotations

import numpy as np

from . import ply
from .snapshot import Snapshot

# Bits of a face's flags (vcg/simplex/face/base.h); bit i of a group belongs to side i, i+1.
_BORDER_BIT = 6
_SELECTED_BIT = 15
_FAUX_BIT = 18
_SIDE_BITS = (_BORDER_BIT, _SELECTED_BIT, _FAUX_BIT)
_ALL_SIDES = 0b111


def fixed_edges(snapshot: Snapshot) -> np.ndarray:
    """Edges that no flip may take: those of polygons, inner and outer ones, and texture seams.

    Returns
    -------
    (e, 2) int32 ndarray
        Vertex pairs. A seam is an edge whose two faces have other texture coordinates at one of
        its ends, or another texture.
    """
    flags = snapshot.ply.faces["flags"]
    has_seams = "texcoord" in (snapshot.ply.faces.dtype.names or ())
    if not (has_seams or (flags & _mask(_FAUX_BIT)).any()):
        return np.empty((0, 2), np.int32)
    tails = snapshot.faces
    heads = np.roll(tails, -1, axis=1)
    faux = _side_bits(flags, _FAUX_BIT)
    fixed = faux | faux.any(axis=1, keepdims=True)
    if has_seams:
        fixed |= _seams(snapshot)
    return np.column_stack((tails[fixed], heads[fixed])).astype(np.int32)


def _mask(*first_bits: int) -> np.int32:
    """The bits of all sides, of groups that start at `first_bits`."""
    return np.int32(sum(_ALL_SIDES << bit for bit in first_bits))


def _side_bits(flags: np.ndarray, first_bit: int) -> np.ndarray:
    """(m, 3) bool: the bit of each side, of three that start at `first_bit`."""
    return (flags[:, None] >> (first_bit + np.arange(3)) & 1).astype(bool)


def _seams(snapshot: Snapshot) -> np.ndarray:
    """(m, 3) bool: the side lies on a texture seam. Sides without one partner: False."""
    tails = snapshot.faces.astype(np.int64)
    heads = np.roll(tails, -1, axis=1)
    n = len(snapshot.ply.vertices)
    partner = _partners(tails.ravel() * n + heads.ravel(), heads.ravel() * n + tails.ravel())

    coords = snapshot.ply.faces["texcoord"].reshape(-1, 3, 2)
    at_tail = coords.reshape(-1, 2)
    at_head = np.roll(coords, -1, axis=1).reshape(-1, 2)
    differs = (at_tail != at_head[partner]).any(1) | (at_head != at_tail[partner]).any(1)
    if "texnumber" in (snapshot.ply.faces.dtype.names or ()):
        number = np.repeat(snapshot.ply.faces["texnumber"], 3)
        differs |= number != number[partner]
    return (differs & (partner >= 0)).reshape(-1, 3)


def _partners(keys: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """For each entry of `wanted` an index into `keys` where it stands, -1 if nowhere."""
    order = np.argsort(keys, kind="stable")
    place = np.searchsorted(keys, wanted, sorter=order)
    candidate = order[np.minimum(place, len(keys) - 1)]
    return np.where(keys[candidate] == wanted, candidate, -1)


def carry_side_bits(old: ply.PlyMesh, faces: np.ndarray) -> np.ndarray:
    """The old flags, with the bits of the sides moved to where each side is now."""
    flags = old.faces["flags"].copy()
    mask = _mask(*_SIDE_BITS)
    if not (flags & mask).any():
        return flags
    before = old.faces["vertex_indices"]
    changed = np.flatnonzero((before != faces).any(axis=1))
    n = np.int64(len(old.vertices))
    old_keys = before[changed] * n + np.roll(before[changed], -1, axis=1)
    new_keys = faces[changed] * n + np.roll(faces[changed], -1, axis=1)
    source = _partners(old_keys.ravel(), new_keys.ravel())
    bits = np.zeros(len(changed), np.int32)
    for first_bit in _SIDE_BITS:
        side = _side_bits(flags[changed], first_bit).ravel()[source] & (source >= 0)
        bits |= (side.reshape(-1, 3) << (first_bit + np.arange(3))).sum(axis=1).astype(np.int32)
    flags[changed] = (flags[changed] & ~mask) | bits
    return flags
