"""The lists of the greedy search in rounds: edges to be scored, candidates, edges to be watched.

They are kept in order, slice by slice, so that nothing depends on how work is shared.
"""

import numpy as np

from ..mesh.halfedge import NONE, previous
from ..mesh.jit import at, jit
from ..mesh.parallel import CHUNK
from . import board as boards
from .board import Pad
from .heap import NEVER
from .pairs import contains
from .touched import visit_around, visit_fans, visit_freed
from .waiting import leave

# Items of work that is done in order between two looks at the keyboard.
SLICE = 16 * CHUNK


@jit
def touch_around(board, start, stop):
    """Touch the edges that the flips from `start` up to `stop` of this round touch.

    All flips of the round must be done: they move edges to other half-edges.
    """
    mesh = board.mesh
    for place in range(start, stop):
        h = np.int64(board.done[at(place)])
        t = np.int64(mesh.twin[at(h)])
        if board.rules.is_wide:
            visit_fans(board, h, boards.touch, None)
            for corner in (h, t, previous(h), previous(t)):
                board.taken[mesh.origin[corner]] = False
        else:
            visit_around(board, h, boards.touch, None)
        i, j = mesh.origin[at(previous(h))], mesh.origin[at(previous(t))]
        if contains(board.awaited, i, j):
            visit_freed(board, h, boards.touch, None)


@jit
def _touch_waiting(board, start, stop, value):
    """Touch the edges that have waited for a change of the faces of these flips."""
    waiting = board.waiting
    for place in range(start, stop):
        flipped = np.int64(board.done[at(place)])
        for face in (flipped // 3, np.int64(board.mesh.twin[at(flipped)]) // 3):
            while waiting.first[face] != NONE:
                h = np.int64(waiting.first[face])
                leave(waiting, h)
                boards.touch(board, h, None)
    return value


@jit
def _list_touched(board):
    """Put the touched edges into their list, by number; return how many there are."""
    size, found = 0, np.empty(boards.BLOCK + 1, np.int32)
    for block in range(len(board.has_touched)):
        if not board.has_touched[at(block)]:
            continue
        board.has_touched[at(block)] = False
        # Without a branch: whether an edge is touched is anyone's guess.
        count, first = 0, block << boards.BLOCK_BITS
        for h in range(first, min(first + boards.BLOCK, len(board.is_touched))):
            found[at(count)] = h
            count += board.is_touched[at(h)]
            board.is_touched[at(h)] = False
        for place in range(count):
            board.touched[at(size + place)] = found[at(place)]
        size += count
    return size


def touch_all(board, flipped, share):
    """List the edges that the `flipped` flips of this round touch; return how many there are."""
    share(touch_around, board, flipped)
    if board.space.active:
        in_slices(_touch_waiting, board, flipped, 0)
    return _list_touched(board)


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
