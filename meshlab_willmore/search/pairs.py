"""A set of vertex pairs: the edges that must not come back."""

from typing import NamedTuple

import numpy as np

from ..mesh.jit import at, inlined, inner, jit

FREE = -1
FIRST_CAPACITY = 1024
# Knuth's multiplier (2**32 / golden ratio): its product with a vertex index fits into int64.
MULTIPLIER = 2654435761
FOLD_BITS = 15


class Pairs(NamedTuple):
    """A hash table with open addressing, at most half full.

    Attributes
    ----------
    slots : (c, 2) int32
        Lower and higher vertex, or `FREE`; c is a power of two.
    used : (1,) int64
        Number of pairs.
    """

    slots: np.ndarray
    used: np.ndarray


def no_pairs(capacity=FIRST_CAPACITY):
    """Return an empty set."""
    return Pairs(np.full((capacity, 2), FREE, np.int32), np.zeros(1, np.int64))


@inner
def _slot(slots, a, b):
    """Return the slot that holds the pair, or the free one where it belongs."""
    low, high = np.int64(min(a, b)), np.int64(max(a, b))
    mask = len(slots) - 1
    key = low * MULTIPLIER + high
    slot = (key ^ (key >> FOLD_BITS)) & mask
    while slots[at(slot), 0] != FREE:
        if slots[at(slot), 0] == low and slots[at(slot), 1] == high:
            break
        slot = (slot + 1) & mask
    return slot


@inlined
def contains(pairs, a, b):
    """Tell whether the unordered pair is in the set."""
    return pairs.slots[at(_slot(pairs.slots, a, b)), 0] != FREE


@inner
def insert(pairs, a, b):
    """Add the unordered pair in place; `reserve` must have made room for it."""
    slot = at(_slot(pairs.slots, a, b))
    if pairs.slots[slot, 0] == FREE:
        pairs.slots[slot, 0] = min(a, b)
        pairs.slots[slot, 1] = max(a, b)
        pairs.used[0] += 1


@jit
def _insert_all(pairs, others):
    for slot in range(len(others.slots)):
        if others.slots[slot, 0] != FREE:
            insert(pairs, others.slots[slot, 0], others.slots[slot, 1])


def reserve(pairs, room):
    """Return the set, moved to a larger table if need be, with room for so many more pairs."""
    capacity = len(pairs.slots)
    needed = 2 * (int(pairs.used[0]) + room)
    if needed <= capacity:
        return pairs
    while capacity < needed:
        capacity *= 2
    larger = no_pairs(capacity)
    _insert_all(larger, pairs)
    return larger
