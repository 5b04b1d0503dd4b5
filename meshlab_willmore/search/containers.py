"""Data structures of the searches: a priority queue, a queue, a set of vertex pairs, watch lists.

All are tuples of preallocated arrays that kernels change in place.
"""

import math
from typing import NamedTuple

import numpy as np

from ..mesh.jit import at, inlined, inner, jit

NONE = -1
NEVER = -math.inf

# --- a priority queue ----------------------------------------------------------------------------


class Heap(NamedTuple):
    """A binary heap of half-edges, largest priority first.

    It knows where each half-edge is, so a changed priority moves its one entry.

    Attributes
    ----------
    priority : (c,) float64
        Priority of each entry; the children of entry p are 2 p + 1 and 2 p + 2.
    item : (c,) int32
        Half-edge of each entry.
    place : (items,) int32
        Entry of each half-edge, or `NONE`.
    size : (1,) int64
        Number of entries.
    """

    priority: np.ndarray
    item: np.ndarray
    place: np.ndarray
    size: np.ndarray


def empty_heap(items):
    """Return an empty heap with room for `items` half-edges."""
    return Heap(
        np.empty(items, np.float64),
        np.empty(items, np.int32),
        np.full(items, NONE, np.int32),
        np.zeros(1, np.int64),
    )


@inner
def first(heap):
    """Return the half-edge of the largest priority; the heap must not be empty."""
    return np.int64(heap.item[0])


@inner
def update(heap, item, priority):
    """Set the priority of `item` in place: insert it, move it, or, with `NEVER`, take it out."""
    p = np.int64(heap.place[item])
    if priority == NEVER:
        if p != NONE:
            _remove(heap, p)
        return
    if p == NONE:
        p = heap.size[0]
        heap.size[0] += 1
    _settle(heap, p, priority, item)


@inner
def _remove(heap, p):
    heap.place[heap.item[p]] = NONE
    heap.size[0] -= 1
    last = heap.size[0]
    if p < last:
        _settle(heap, p, heap.priority[last], heap.item[last])


@inner
def _goes_before(priority, item, other_priority, other_item):
    """Whether an entry goes before another; equal ones go by number, so that runs repeat."""
    return priority > other_priority or (priority == other_priority and item < other_item)


@inner
def _put(heap, p, priority, item):
    heap.priority[p] = priority
    heap.item[p] = item
    heap.place[item] = p


@inner
def _settle(heap, p, priority, item):
    """Write an entry into the free place `p`, then let it rise or sink to where it belongs."""
    while p > 0:
        parent = (p - 1) // 2
        if not _goes_before(priority, item, heap.priority[parent], heap.item[parent]):
            break
        _put(heap, p, heap.priority[parent], heap.item[parent])
        p = parent
    child = _leading_child(heap, p)
    while child != NONE and _goes_before(heap.priority[child], heap.item[child], priority, item):
        _put(heap, p, heap.priority[child], heap.item[child])
        p = child
        child = _leading_child(heap, p)
    _put(heap, p, priority, item)


@inner
def _leading_child(heap, p):
    """Return the child of `p` that goes before the other, or `NONE`."""
    left, right = 2 * p + 1, 2 * p + 2
    if left >= heap.size[0]:
        return NONE
    if right < heap.size[0] and _goes_before(
        heap.priority[right], heap.item[right], heap.priority[left], heap.item[left]
    ):
        return right
    return left


# --- a queue -------------------------------------------------------------------------------------


class Fifo(NamedTuple):
    """A queue of half-edges, first in, first out, in a ring buffer.

    Attributes
    ----------
    item : (items,) int32
    is_queued : (items,) bool
        Which half-edges are in the queue.
    ends : (2,) int64
        Place of the first one, and their number.
    """

    item: np.ndarray
    is_queued: np.ndarray
    ends: np.ndarray


def empty_fifo(items):
    """Return an empty queue with room for `items` half-edges."""
    return Fifo(np.empty(items, np.int32), np.zeros(items, np.bool_), np.zeros(2, np.int64))


@inner
def push(fifo, h):
    """Put `h` last into the queue, unless it is in it already."""
    if not fifo.is_queued[h]:
        fifo.is_queued[h] = True
        fifo.item[(fifo.ends[0] + fifo.ends[1]) % len(fifo.item)] = h
        fifo.ends[1] += 1


@inner
def pop(fifo):
    """Take the first half-edge out of the queue, which must not be empty."""
    h = np.int64(fifo.item[fifo.ends[0]])
    fifo.is_queued[h] = False
    fifo.ends[0] = (fifo.ends[0] + 1) % len(fifo.item)
    fifo.ends[1] -= 1
    return h


# --- a set of vertex pairs -----------------------------------------------------------------------

FIRST_CAPACITY = 1024
# Knuth's multiplier (2**32 / golden ratio): its product with a vertex index fits into int64.
MULTIPLIER = 2654435761
FOLD_BITS = 15


class PairSet(NamedTuple):
    """A hash table with open addressing, at most half full.

    Attributes
    ----------
    slots : (c, 2) int32
        Lower and higher vertex, or `NONE`; c is a power of two.
    used : (1,) int64
        Number of pairs.
    """

    slots: np.ndarray
    used: np.ndarray


def empty_pair_set(capacity=FIRST_CAPACITY):
    """Return an empty set."""
    return PairSet(np.full((capacity, 2), NONE, np.int32), np.zeros(1, np.int64))


@inner
def _slot(slots, a, b):
    """Return the slot that holds the pair, or the free one where it belongs."""
    low, high = np.int64(min(a, b)), np.int64(max(a, b))
    mask = len(slots) - 1
    key = low * MULTIPLIER + high
    slot = (key ^ (key >> FOLD_BITS)) & mask
    while slots[at(slot), 0] != NONE:
        if slots[at(slot), 0] == low and slots[at(slot), 1] == high:
            break
        slot = (slot + 1) & mask
    return slot


@inlined
def contains(pairs, a, b):
    """Whether the unordered pair is in the set."""
    return pairs.slots[at(_slot(pairs.slots, a, b)), 0] != NONE


@inner
def insert(pairs, a, b):
    """Add the unordered pair in place; `reserve` must have made room for it."""
    slot = at(_slot(pairs.slots, a, b))
    if pairs.slots[slot, 0] == NONE:
        pairs.slots[slot, 0] = min(a, b)
        pairs.slots[slot, 1] = max(a, b)
        pairs.used[0] += 1


@jit
def _insert_all(pairs, others):
    for slot in range(len(others.slots)):
        if others.slots[slot, 0] != NONE:
            insert(pairs, others.slots[slot, 0], others.slots[slot, 1])


def reserve(pairs, room):
    """Return the set, moved to a larger table if need be, with room for so many more pairs."""
    capacity = len(pairs.slots)
    needed = 2 * (int(pairs.used[0]) + room)
    if needed <= capacity:
        return pairs
    while capacity < needed:
        capacity *= 2
    larger = empty_pair_set(capacity)
    _insert_all(larger, pairs)
    return larger


# --- watch lists ---------------------------------------------------------------------------------


class WatchLists(NamedTuple):
    """For each of m faces a list of the edges that its next change may free.

    The lists are linked both ways, so that an edge can be moved to another one at once. All is
    empty where no flip is ever refused for a face.

    Attributes
    ----------
    first : (m,) int32
        First half-edge of each face's list, or `NONE`.
    ahead, behind : (3 m,) int32
        The next and the previous half-edge of the list, or `NONE`; of those that watch a face.
    face : (3 m,) int32
        The face that each half-edge watches, or `NONE`.
    """

    first: np.ndarray
    ahead: np.ndarray
    behind: np.ndarray
    face: np.ndarray


def empty_watch_lists(faces):
    """Return empty lists for so many faces."""
    # What follows a half-edge is written when it begins to watch a face.
    ahead, behind = np.empty(3 * faces, np.int32), np.empty(3 * faces, np.int32)
    first, face = (np.full(size, NONE, np.int32) for size in (faces, 3 * faces))
    return WatchLists(first, ahead, behind, face)


@inner
def watch(lists, h, face):
    """Let `h` watch `face` instead of what it watched, in place."""
    unwatch(lists, h)
    following = lists.first[face]
    lists.first[face], lists.face[h] = h, face
    lists.ahead[h], lists.behind[h] = following, NONE
    if following != NONE:
        lists.behind[following] = h


@inner
def unwatch(lists, h):
    """Let `h` watch nothing any more, in place."""
    face = lists.face[h]
    if face == NONE:
        return
    before, behind = lists.behind[h], lists.ahead[h]
    if before == NONE:
        lists.first[face] = behind
    else:
        lists.ahead[before] = behind
    if behind != NONE:
        lists.behind[behind] = before
    lists.face[h] = NONE
