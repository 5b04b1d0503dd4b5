"""The peaks of a round: edges that go before all edges which they conflict with.

See `parallel_greedy` for what a conflict is, and why peaks can be flipped together.
"""

from typing import NamedTuple

import numpy as np

from .. import guards
from ..guards.cuts import would_cut
from ..mesh.halfedge import NONE, apex, following, makes_new_edge, previous
from ..mesh.jit import at, inlined, jit
from .board import Board

# What becomes of a candidate in a round.
STAYS, IS_PEAK, FOLDS, IS_JOINED, IS_BLOCKED = range(5)
# Knuth's multiplier (2**32 / golden ratio); odd, so that no two numbers get the same.
SCRAMBLER, LOW_BITS = np.uint64(2654435761), np.uint64(2**32 - 1)
HALF_BITS, MOST_PLACES = 32, 2**32 - 1


class Look(NamedTuple):
    """Edges, and room for what becomes of each in this round, an int8."""

    board: Board
    edges: np.ndarray
    verdict: np.ndarray


@inlined
def scrambled(h):
    """Return another number for each half-edge, to break ties by.

    By the numbers themselves, edges of equal gain side by side would all wait for the first one.
    """
    return (at(h) * SCRAMBLER) & LOW_BITS


@jit
def _goes_first(board, h, rank, side):
    """Tell whether the edge of the half-edge `side` goes before `h`, the lower of its twins."""
    other = board.rank[at(side)]
    if other != rank:
        return other > rank
    # So it has a rank, and a twin.
    return scrambled(min(side, board.mesh.twin[at(side)])) < scrambled(h)


@jit
def _is_peak(board, h):
    mesh = board.mesh
    t, rank = mesh.twin[at(h)], board.rank[at(h)]
    for side in (following(h), previous(h), following(t), previous(t)):
        if _goes_first(board, h, rank, side):
            return False
        outside = mesh.twin[at(side)]
        if outside == NONE:
            continue
        if _goes_first(board, h, rank, following(outside)):
            return False
        if _goes_first(board, h, rank, previous(outside)):
            return False
    return True


@jit
def find_peaks(look, start, stop):
    """Say of the edges from `start` up to `stop`, which have a rank, what becomes of them."""
    board = look.board
    for place in range(start, stop):
        h = look.edges[at(place)]
        if not _is_peak(board, h):
            verdict = STAYS
        elif guards.folds(board.mesh, h, board.rules.fold):
            verdict = FOLDS
        elif not makes_new_edge(board.mesh, h):
            verdict = IS_JOINED
        else:
            verdict = IS_BLOCKED if would_cut(board.mesh, board.space, h) else IS_PEAK
        look.verdict[at(place)] = verdict


@jit
def find_contested(look, contested, number):
    """Mark, in place, the peaks that may become the same edge as another one of round `number`."""
    board, mesh = look.board, look.board.mesh
    for place in range(len(look.edges)):
        if look.verdict[place] != IS_PEAK:
            continue
        h = look.edges[place]
        lower = at(min(apex(mesh, h), apex(mesh, mesh.twin[at(h)])))
        before = board.new_edge[lower]
        if before >> HALF_BITS == number:
            contested[place] = contested[before & MOST_PLACES] = True
        else:
            board.new_edge[lower] = (np.int64(number) << HALF_BITS) | place


def in_order(look, number, flips):
    """Return the peaks in the order in which they are to be flipped.

    Parameters
    ----------
    look : Look
        After `find_peaks`.
    number : int
        Number of this round.
    flips : int
        How many there were before.

    Returns
    -------
    look : Look
        All edges of which something becomes.
    first : int
        The place from which on it has to be asked whether an edge is there by now.
    """
    board = look.board
    places = np.flatnonzero(look.verdict != STAYS)
    peaks = Look(board, look.edges[places], look.verdict[places])
    # Where peaks can be in each other's way, the larger gain goes first.
    contested = np.zeros(len(places), np.bool_)
    if board.space.active or board.rules.is_wide or flips + len(places) > board.rules.maxflips:
        contested[:] = True
    else:
        find_contested(peaks, contested, number)
    late = np.flatnonzero(contested)
    edges = peaks.edges[late]
    numbers = edges.astype(np.uint64) * SCRAMBLER & LOW_BITS
    late = late[np.lexsort((numbers, -board.rank[edges]))]
    order = np.concatenate([np.flatnonzero(~contested), late])
    return Look(board, peaks.edges[order], peaks.verdict[order]), len(order) - len(late)
