"""The edges at which a chain may start: a queue, first in, first out."""

from typing import NamedTuple

import numpy as np

from ..mesh.halfedge import NONE, following
from ..mesh.jit import inner, jit


class Pending(NamedTuple):
    """The edges at which a chain may start: a queue, first in, first out.

    Attributes
    ----------
    item : (3 m,) int32
        A ring buffer of half-edges, the lower one of twins.
    waits : (3 m,) bool
        Which half-edges are in the queue.
    ends : (2,) int64
        Place of the first one, and their number.
    """

    item: np.ndarray
    waits: np.ndarray
    ends: np.ndarray


def nothing_pending(mesh):
    count = len(mesh.origin)
    return Pending(np.empty(count, np.int32), np.zeros(count, np.bool_), np.zeros(2, np.int64))


@inner
def append(mesh, pending, h):
    """Put the edge of `h` last into the queue, unless it waits already or has one face only."""
    t = mesh.twin[h]
    if t == NONE:
        return
    low = min(h, t)
    if not pending.waits[low]:
        pending.waits[low] = True
        pending.item[(pending.ends[0] + pending.ends[1]) % len(pending.item)] = low
        pending.ends[1] += 1


@inner
def take_first(pending):
    """Take the first half-edge out of the queue, which must not be empty."""
    h = np.int64(pending.item[pending.ends[0]])
    pending.waits[h] = False
    pending.ends[0] = (pending.ends[0] + 1) % len(pending.item)
    pending.ends[1] -= 1
    return h


@jit
def queue_all(mesh, pending):
    """Queue every edge, in the order of the half-edges."""
    for h in range(len(mesh.origin)):
        append(mesh, pending, h)


@jit
def queue_near(mesh, pending, touched, hops):
    """Queue every edge at most `hops` edges away from a marked vertex, and clear the marks."""
    distance = np.where(touched, 0, hops + 1)
    for hop in range(hops):
        for h in range(len(mesh.origin)):
            a, b = mesh.origin[h], mesh.origin[following(h)]
            if distance[a] == hop:
                distance[b] = min(distance[b], hop + 1)
            elif distance[b] == hop:
                distance[a] = min(distance[a], hop + 1)
    for h in range(len(mesh.origin)):
        if min(distance[mesh.origin[h]], distance[mesh.origin[following(h)]]) <= hops:
            append(mesh, pending, h)
    touched[:] = False


@jit
def queue_blocked(mesh, pending, blocked):
    """Queue every edge that is marked, and clear the marks."""
    for h in range(len(blocked)):
        if blocked[h]:
            append(mesh, pending, h)
    blocked[:] = False
