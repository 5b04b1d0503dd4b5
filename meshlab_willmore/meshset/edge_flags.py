"""Edge flags: the bits in MeshLab's face flags, and which edges they lock.

A side is the half-edge from a corner to the next one; its edge may have a flag on either side.
"""

from __future__ import annotations

import numpy as np

from . import ply
from .snapshot import MeshSnapshot

# Bits of a face's flags (vcg/simplex/face/base.h); bit i of a group belongs to side i, i+1.
_BORDER_BIT = 6
_SELECTED_BIT = 15
_FAUX_BIT = 18
_SIDE_BITS = (_BORDER_BIT, _SELECTED_BIT, _FAUX_BIT)
_ALL_SIDES = 0b111


def fixed_edges(snapshot: MeshSnapshot) -> np.ndarray:
    """Edges that no flip may take: inner and outer ones of polygons, and seams between textures.

    Returns
    -------
    (e, 2) int32 ndarray
        Vertex pairs.
    """
    flags = snapshot.ply.faces["flags"]
    has_textures = "texnumber" in (snapshot.ply.faces.dtype.names or ())
    if not (has_textures or (flags & _mask(_FAUX_BIT)).any()):
        return np.empty((0, 2), np.int32)
    tails = snapshot.faces
    heads = np.roll(tails, -1, axis=1)
    faux = _side_bits(flags, _FAUX_BIT)
    fixed = faux | faux.any(axis=1, keepdims=True)
    if has_textures:
        fixed |= _between_textures(snapshot)
    return np.column_stack((tails[fixed], heads[fixed])).astype(np.int32)


def _mask(*first_bits: int) -> np.int32:
    """The bits of all sides, of groups that start at `first_bits`."""
    return np.int32(sum(_ALL_SIDES << bit for bit in first_bits))


def _side_bits(flags: np.ndarray, first_bit: int) -> np.ndarray:
    """(m, 3) bool: the bit of each side, of three that start at `first_bit`."""
    return (flags[:, None] >> (first_bit + np.arange(3)) & 1).astype(bool)


def _between_textures(snapshot: MeshSnapshot) -> np.ndarray:
    """Whether the face across each side has another texture, (m, 3); False without such a face."""
    tails = snapshot.faces.astype(np.int64)
    heads = np.roll(tails, -1, axis=1)
    n = len(snapshot.ply.vertices)
    partner = _partners(tails.ravel() * n + heads.ravel(), heads.ravel() * n + tails.ravel())
    number = np.repeat(snapshot.ply.faces["texnumber"], 3)
    return ((number != number[partner]) & (partner >= 0)).reshape(-1, 3)


def _partners(keys: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """For each entry of `wanted` its index in `keys`, -1 if it is not there."""
    order = np.argsort(keys, kind="stable")
    place = np.searchsorted(keys, wanted, sorter=order)
    candidate = order[np.minimum(place, len(keys) - 1)]
    return np.where(keys[candidate] == wanted, candidate, -1)


def carry_side_bits(old: ply.PlyMesh, faces: np.ndarray) -> np.ndarray:
    """The flags of `old`, with the bits of each side moved to its place in `faces`."""
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
