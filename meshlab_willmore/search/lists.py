"""The lists of the greedy search in rounds: edges to be scored, candidates, edges to be watched.

They are kept in order, slice by slice, so that nothing depends on how work is shared.
"""

from typing import NamedTuple

import numpy as np

from ..mesh.halfedge import NONE, previous
from ..mesh.jit import at, jit
from ..mesh.workers import PIECE
from . import board as boards
from .board import Board, Pad, Row
from .heap import NEVER
from .pairs import contains
from .touched import visit_around, visit_fans, visit_freed
from .waiting import leave

# Items of work that is done in order between two looks at the keyboard.
SLICE = 16 * PIECE
# An edge and those whose cost reduction its flip changes.
MOST_AROUND = 13


@jit
def _touch_waiting(pad, face):
    """Touch the edges that have waited for a change of `face`."""
    waiting = pad.board.waiting
    h = np.int64(waiting.first[face])
    while h != NONE:
        leave(waiting, h)
        boards.touch(pad, h, None)
        h = np.int64(waiting.first[face])


class Slots(NamedTuple):
    """A board and, for each flip of a round, room for the edges around it: (flips, 13) int32."""

    board: Board
    edges: np.ndarray


@jit
def find_around(slots, start, stop):
    """Write down the edges around the flips from `start` up to `stop` of this round.

    All flips of the round must be done: they move edges to other half-edges.
    """
    board, size = slots.board, np.zeros(1, np.int64)
    for place in range(start, stop):
        row = slots.edges[at(place)]
        row[:] = NONE
        size[0] = 0
        visit_around(Row(board.mesh, board, row, size), board.done[at(place)], boards.note, None)


@jit
def touch(slots, start, stop, size):
    """Put the edges that the flips from `start` up to `stop` of this round touch into the list.

    Returns
    -------
    int
        The new `size` of the list.
    """
    board, mesh = slots.board, slots.board.mesh
    pad = Pad(mesh, board, np.array([size]))
    for place in range(start, stop):
        h = np.int64(board.done[at(place)])
        t = np.int64(mesh.twin[at(h)])
        if board.rules.is_wide:
            visit_fans(pad, h, boards.touch, None)
            for corner in (h, t, previous(h), previous(t)):
                board.taken[mesh.origin[corner]] = False
        else:
            for low in slots.edges[at(place)]:
                if low != NONE and not board.is_touched[at(low)]:
                    boards.put(pad, low)
        i, j = mesh.origin[at(previous(h))], mesh.origin[at(previous(t))]
        if contains(board.awaited, i, j):
            visit_freed(pad, h, boards.touch, None)
        if board.space.active:
            _touch_waiting(pad, h // 3)
            _touch_waiting(pad, t // 3)
    return pad.size[0]


def touch_all(board, flipped, share):
    """Touch what the flips of this round have touched; return the number of edges."""
    rows = 0 if board.rules.is_wide else flipped
    slots = Slots(board, np.empty((rows, MOST_AROUND), np.int32))
    share(find_around, slots, rows)
    return in_slices(touch, slots, flipped, 0)


@jit
def drop_candidates(board, start, stop, count):
    """Move the candidates from `start` up to `stop` that are still some to the front of the list.

    Returns
    -------
    int
        How many are there, with the `count` that were before.
    """
    for place in range(start, stop):
        h = board.candidates[at(place)]
        # A flip may have put another edge there, or none.
        if board.rank[at(h)] > NEVER and h < board.mesh.twin[at(h)]:
            board.candidates[at(count)] = h
            count += 1
        else:
            board.is_listed[at(h)] = False
    return count


@jit
def add_candidates(board, start, stop, count):
    """Add the touched edges from `start` up to `stop` that have a rank to `count` candidates.

    Returns
    -------
    int
        How many are in the list then.
    """
    for place in range(start, stop):
        h = board.touched[at(place)]
        board.is_touched[at(h)] = False
        if board.rank[at(h)] > NEVER and not board.is_listed[at(h)]:
            board.is_listed[at(h)] = True
            board.candidates[at(count)] = h
            count += 1
    return count


@jit
def watch(look, start, stop, size):
    """Put the edges around those of `look` from `start` up to `stop` into the list of the watched.

    Returns
    -------
    int
        The new `size` of the list.
    """
    board = look.board
    pad = Pad(board.mesh, board, np.array([size]))
    for place in range(start, stop):
        h = np.int64(look.edges[at(place)])
        if board.mesh.twin[at(h)] != NONE:
            visit_around(pad, h, boards.watch, None)
    return pad.size[0]


def in_slices(kernel, task, stop, value):
    """Let a kernel that works in order pass a value on, in slices: interrupts come between."""
    for start in range(0, stop, SLICE):
        value = kernel(task, start, min(start + SLICE, stop), value)
    return value
