"""A priority queue of half-edges, largest priority first.

The queue knows where each half-edge stands, so a changed priority moves its one entry. Compared
with a queue of stamped entries in which stale ones are skipped, the order is the same, but the
arrays never have to grow inside a kernel, and what is in the queue is always up to date.
"""

import math
from typing import NamedTuple

import numpy as np

from ..mesh.jit import inner

ABSENT = -1
NEVER = -math.inf


class Queue(NamedTuple):
    """A binary heap.

    Attributes
    ----------
    priority : (c,) float64
        Priority of each entry; the children of entry p are 2 p + 1 and 2 p + 2.
    item : (c,) int32
        Half-edge of each entry.
    place : (items,) int32
        Entry of each half-edge, or `ABSENT`.
    size : (1,) int64
        Number of entries.
    """

    priority: np.ndarray
    item: np.ndarray
    place: np.ndarray
    size: np.ndarray


def empty_queue(items):
    """Return an empty queue with room for `items` half-edges."""
    return Queue(
        np.empty(items, np.float64),
        np.empty(items, np.int32),
        np.full(items, ABSENT, np.int32),
        np.zeros(1, np.int64),
    )


@inner
def first(queue):
    """Return the half-edge of the largest priority; the queue must not be empty."""
    return np.int64(queue.item[0])


@inner
def update(queue, item, priority):
    """Set the priority of `item` in place: insert it, move it, or, with `NEVER`, take it out."""
    p = np.int64(queue.place[item])
    if priority == NEVER:
        if p != ABSENT:
            _remove(queue, p)
        return
    if p == ABSENT:
        p = queue.size[0]
        queue.size[0] += 1
    _settle(queue, p, priority, item)


@inner
def _remove(queue, p):
    queue.place[queue.item[p]] = ABSENT
    queue.size[0] -= 1
    last = queue.size[0]
    if p < last:
        _settle(queue, p, queue.priority[last], queue.item[last])


@inner
def _goes_before(priority, item, other_priority, other_item):
    """Order of the queue; equal priorities go by number, so that runs can be repeated."""
    return priority > other_priority or (priority == other_priority and item < other_item)


@inner
def _put(queue, p, priority, item):
    queue.priority[p] = priority
    queue.item[p] = item
    queue.place[item] = p


@inner
def _settle(queue, p, priority, item):
    """Write an entry into the free place `p`, then let it rise or sink to where it belongs."""
    while p > 0:
        parent = (p - 1) // 2
        if not _goes_before(priority, item, queue.priority[parent], queue.item[parent]):
            break
        _put(queue, p, queue.priority[parent], queue.item[parent])
        p = parent
    child = _leading_child(queue, p)
    while child != ABSENT and _goes_before(
        queue.priority[child], queue.item[child], priority, item
    ):
        _put(queue, p, queue.priority[child], queue.item[child])
        p = child
        child = _leading_child(queue, p)
    _put(queue, p, priority, item)


@inner
def _leading_child(queue, p):
    """Return the child of `p` that goes before the other, or `ABSENT`."""
    left, right = 2 * p + 1, 2 * p + 2
    if left >= queue.size[0]:
        return ABSENT
    if right < queue.size[0] and _goes_before(
        queue.priority[right], queue.item[right], queue.priority[left], queue.item[left]
    ):
        return right
    return left
