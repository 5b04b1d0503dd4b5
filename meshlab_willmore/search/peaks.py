"""The peaks of a round: edges that go before all edges which they conflict with.

See `parallel_greedy` for what a conflict is, and why peaks can be flipped together. What becomes of
a candidate is decided on the mesh before the first flip of the round. Only those that may be
flipped then count as peaks here. They are all compared with each other: for the edges that they
make, and for the faces. So whoever was refused must stay refused until the next round, even if a
flip of this one takes away the reason: its new edge and its new faces were compared with nobody's.
"""

from typing import NamedTuple

import numpy as np

from .. import guards
from ..guards.bvh import expand
from ..guards.intersections import intersects_another_flip, would_intersect
from ..mesh.halfedge import NONE, apex, following, makes_new_edge, previous
from ..mesh.jit import at, inlined, inner, jit
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


@inner
def _goes_first(board, h, rank, side):
    """Tell whether the edge of the half-edge `side` goes before `h`, the lower of its twins."""
    other = board.rank[at(side)]
    if other != rank:
        return other > rank
    # So it has a rank, and a twin.
    return scrambled(min(side, board.mesh.twin[at(side)])) < scrambled(h)


@inner
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
            verdict = IS_BLOCKED if would_intersect(board.mesh, board.space, h) else IS_PEAK
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


@jit
def announce(look, number):
    """Let the index of the faces know what the peaks of round `number` would change."""
    board, mesh = look.board, look.board.mesh
    for place in range(len(look.edges)):
        if look.verdict[at(place)] == IS_PEAK:
            h = np.int64(look.edges[at(place)])
            expand(mesh, board.space, h, number)
            board.to_flip[at(h // 3)] = board.to_flip[at(mesh.twin[at(h)] // 3)] = h


class Rivals(NamedTuple):
    """Peaks of round `number`, and a mark for each that another one may be in the way of."""

    look: Look
    contested: np.ndarray
    number: int


@jit
def find_rivals(rivals, start, stop):
    """Mark, in place, the peaks from `start` up to `stop` whose faces would cut those of others."""
    look, board = rivals.look, rivals.look.board
    for place in range(start, stop):
        if look.verdict[at(place)] == IS_PEAK:
            h = np.int64(look.edges[at(place)])
            if intersects_another_flip(board.mesh, board.space, h, rivals.number, board.to_flip):
                rivals.contested[at(place)] = True


def _contested(look, number, is_free_for_all, share):
    """Return which peaks may be in each other's way, or all."""
    contested = np.full(len(look.edges), is_free_for_all)
    if look.board.space.active:
        announce(look, number)
    if is_free_for_all:
        return contested
    find_contested(look, contested, number)
    if look.board.space.active:
        share(find_rivals, Rivals(look, contested, number), len(contested))
    return contested


def in_order(look, number, flips, share):
    """Return the peaks in the order in which they are to be flipped.

    Where peaks can be in each other's way, the larger gain goes first.

    Parameters
    ----------
    look : Look
        After `find_peaks`.
    number : int
        Number of this round.
    flips : int
        How many there were before.
    share : callable
        From `meshlab_willmore.mesh.parallel.thread_pool`.

    Returns
    -------
    look : Look
        All edges of which something becomes: first those that must not be flipped, then the peaks.
    first : int
        The place from which on it has to be asked whether a flip is still allowed.
    """
    board = look.board
    places = np.flatnonzero(look.verdict != STAYS)
    chosen = Look(board, look.edges[places], look.verdict[places])
    is_peak = chosen.verdict == IS_PEAK
    are_many = flips + np.count_nonzero(is_peak) > board.rules.maxflips
    contested = _contested(chosen, number, board.rules.is_wide or are_many, share)
    late = np.flatnonzero(is_peak & contested)
    edges = chosen.edges[late]
    numbers = edges.astype(np.uint64) * SCRAMBLER & LOW_BITS
    late = late[np.lexsort((numbers, -board.rank[edges]))]
    early = np.flatnonzero(~is_peak), np.flatnonzero(is_peak & ~contested)
    order = np.concatenate([*early, late])
    return Look(board, chosen.edges[order], chosen.verdict[order]), len(order) - len(late)
