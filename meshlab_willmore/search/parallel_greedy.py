"""The greedy search in rounds, on all cores.

    score every edge
    while there is an edge that may be flipped and helps (a candidate):
        find the peaks: candidates of a larger cost reduction than all 12 edges around them
        flip all peaks that connectivity, guards and the rules of `greedy` allow
        score the edges that these flips have touched

Two edges conflict if a flip of one changes what the cost reduction of the other is computed from:
the two faces at it, and the four outside. Each edge of these six faces, 13 in all with the edge
itself, has the other one among its own 13. Equal gains go by number, so of two that conflict at
most one is a peak, and there is always a peak. The peaks of a round change nothing that another one
reads: in whatever order they are flipped, each has the cost reduction that it was chosen for. So a
round is a piece of a run of single flips, ordered by gain only where gains matter to each other,
and it ends for the reasons that `greedy` gives. (For an energy whose cost reduction looks round
whole corners, of the peaks with a common corner only the first is flipped.) What connectivity alone
decides (that k-l is no edge yet) is looked up flip by flip, in the order of the candidates, and so
are cuts; that order does not depend on how the work was shared. So the result is the same, bit for
bit, for any number of threads.
"""

import itertools
from typing import NamedTuple

import numpy as np

from .. import guards
from ..energy import willmore
from ..energy.angles import radians
from ..guards import space as spaces
from ..guards.cuts import blocker, would_cut
from ..mesh.halfedge import (
    NONE,
    apex,
    flip,
    following,
    is_free,
    makes_new_edge,
    previous,
)
from ..mesh.jit import at, generic, inlined, jit
from ..mesh.workers import PIECE, crew
from . import board as boards
from .board import Board, Pad, Row, board_of, forbid
from .heap import NEVER
from .lanes import JUDGE, LANES, RANKING, drop_at, empty_lanes, fill, find_drops, is_positive
from .pairs import contains, insert, reserve
from .rules import CONVERGED, STOPPED, WORKING, Progress, brings_back, is_blocked, must_wait
from .scoring import gain_of
from .touched import visit_around, visit_fans, visit_freed
from .waiting import leave

# Items of work that is done in order between two looks at the keyboard.
SLICE = 16 * PIECE
# What becomes of a candidate in a round.
STAYS, IS_PEAK, FOLDS, IS_JOINED, IS_BLOCKED = range(5)
NO_VERDICT = np.empty(0, np.int8)
# An edge and those whose cost reduction its flip changes.
MOST_AROUND = 13
# Edges around one that changed, about.
WATCHED_PER_CHANGE = 13
# Knuth's multiplier (2**32 / golden ratio); odd, so that no two numbers get the same.
SCRAMBLER, LOW_BITS = np.uint64(2654435761), np.uint64(2**32 - 1)
HALF_BITS, MOST_PLACES = 32, 2**32 - 1


# --- scores --------------------------------------------------------------------------------------


@jit
def _note(board, h, gain, change):
    """Write down a cost reduction, and what the flip lowers the Willmore energy by."""
    rules, t = board.rules, board.mesh.twin[at(h)]
    is_allowed = gain > rules.tolerance and not (rules.monotone and change < -rules.tie)
    rank = np.rint(gain / rules.rank_step) if is_allowed else NEVER
    board.rank[at(h)] = board.rank[at(t)] = rank
    if is_allowed:
        board.gain[at(h)] = gain
        loses = not rules.monotone or change <= 2.0 * rules.tie
        board.is_tie[at(h)] = loses and not rules.is_potential


@generic
def score_each(board, start, stop, cost_reduction):
    """Score the touched edges from `start` up to `stop` one by one.

    `cost_reduction` is a jitted function as `gain_of` takes it.
    """
    mesh, rules = board.mesh, board.rules
    for place in range(start, stop):
        h = board.touched[at(place)]
        forbid(board, h)
        if is_free(mesh, h):
            gain = gain_of(cost_reduction, mesh, h, rules)
            if gain > rules.tolerance:
                change = willmore.cost_reduction(mesh, h) if rules.monotone else 0.0
                _note(board, h, gain, change)


@generic
def _score_lanes(board, rows, edges, count, drop, judge):
    """Score the `count` edges that were filled into the lanes."""
    find_drops(rows, drop, RANKING)
    if judge is not None:
        find_drops(rows, judge, JUDGE)
    for lane in range(count):
        angles = drop_at(rows, RANKING, lane)
        if not is_positive(angles):
            continue
        change = 0.0
        if judge is not None:
            change = 2.0 * radians(drop_at(rows, JUDGE, lane))
        _note(board, edges[lane], 2.0 * radians(angles), change)


@generic
def score_in_lanes(board, start, stop, drop, judge):
    """Score the touched edges from `start` up to `stop`, many at once.

    Parameters
    ----------
    board : Board
    start, stop : int
    drop, judge : callable
        What half of the cost reduction is, and half of what the Willmore energy drops by, as
        `meshlab_willmore.energy.willmore.drop`. A judge of None: nothing is asked of that.
    """
    rows, edges, count = empty_lanes(), np.empty(LANES, np.int32), 0
    for place in range(start, stop):
        h = board.touched[at(place)]
        forbid(board, h)
        if not is_free(board.mesh, h):
            continue
        fill(rows, count, board.mesh, h)
        edges[count] = h
        count += 1
        if count == LANES:
            _score_lanes(board, rows, edges, count, drop, judge)
            count = 0
    if count:
        _score_lanes(board, rows, edges, count, drop, judge)


# --- peaks ---------------------------------------------------------------------------------------


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


def _peaks(look, number, flips):
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


# --- flips ---------------------------------------------------------------------------------------


@jit
def _take_corners(board, h):
    """Take the corners of the diamond of `h`, unless one of them is taken; tell whether."""
    mesh, t = board.mesh, board.mesh.twin[h]
    corners = (mesh.origin[h], mesh.origin[t], apex(mesh, h), apex(mesh, t))
    for v in corners:
        if board.taken[v]:
            return False
    for v in corners:
        board.taken[v] = True
    return True


@jit
def _is_blocked_by_now(board, h, verdict, number):
    """Tell whether a new face would cut another one; the verdict tells how it was before."""
    if verdict == IS_BLOCKED:
        return is_blocked(board, h)
    face = blocker(board.mesh, board.space, h, board.changed, number)
    return must_wait(board, h, face)


class Done(NamedTuple):
    """How many peaks were flipped and refused, the cost reductions of the flips, the state."""

    flipped: int
    refused: int
    gain: float
    state: int


@jit
def flip_peaks(look, start, stop, first, left, number, done):
    """Flip the peaks from `start` up to `stop` that are allowed.

    Parameters
    ----------
    look : Look
        From `_peaks`; `gone` and `awaited` of its board must have room for all of them.
    start, stop, first : int
        `first` as from `_peaks`.
    left : int
        How many flips may be made in this round.
    number : int
        Number of the round.
    done : tuple
        The fields of what was done in this round before, as Done.

    Returns
    -------
    tuple
        The fields of Done, these peaks included.
    """
    board, mesh, rules = look.board, look.board.mesh, look.board.rules
    flipped, refused, gain, state = done
    for place in range(start, stop):
        h, verdict = np.int64(look.edges[at(place)]), look.verdict[at(place)]
        is_tie = board.is_tie[at(h)]
        is_joined = verdict == IS_JOINED
        if verdict == IS_PEAK and place >= first:
            is_joined = not makes_new_edge(mesh, h)
        if is_joined:
            insert(board.awaited, apex(mesh, h), apex(mesh, mesh.twin[at(h)]))
        if (
            is_joined
            or verdict == FOLDS
            or (is_tie and brings_back(mesh, board.gone, h))
            or _is_blocked_by_now(board, h, verdict, number)
        ):
            forbid(board, h)
            refused += 1
            board.done[at(len(board.done) - refused)] = h
            continue
        if flipped == left:
            return flipped, refused, gain, STOPPED
        if rules.is_wide and not _take_corners(board, h):
            continue
        if is_tie:
            insert(board.gone, mesh.origin[h], mesh.origin[mesh.twin[h]])
        gain += board.gain[at(h)]
        flip(mesh, h)
        if board.space.active:
            spaces.follow(mesh, board.space, h)
            board.changed[h // 3] = board.changed[mesh.twin[h] // 3] = number
        board.done[at(flipped)] = h
        flipped += 1
    return flipped, refused, gain, state


# --- lists ---------------------------------------------------------------------------------------


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


def _touch_all(board, flipped, share):
    """Touch what the flips of this round have touched; return the number of edges."""
    rows = 0 if board.rules.is_wide else flipped
    slots = Slots(board, np.empty((rows, MOST_AROUND), np.int32))
    share(find_around, slots, rows)
    return _in_slices(touch, slots, flipped, 0)


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


def _in_slices(kernel, task, stop, value):
    """Let a kernel that works in order pass a value on, in slices: interrupts come between."""
    for start in range(0, stop, SLICE):
        value = kernel(task, start, min(start + SLICE, stop), value)
    return value


# --- the search ----------------------------------------------------------------------------------


def _flip_all(board, peaks, first, left, number):
    """Flip all peaks that are allowed; return the board, and what was done."""
    done = Done(0, 0, 0.0, WORKING)
    for start in range(0, len(peaks.edges), SLICE):
        board = board._replace(
            gone=reserve(board.gone, SLICE), awaited=reserve(board.awaited, SLICE)
        )
        stop = min(start + SLICE, len(peaks.edges))
        done = Done(
            *flip_peaks(peaks._replace(board=board), start, stop, first, left, number, tuple(done))
        )
        if done.state == STOPPED:
            break
    return board, done


def _watch_around(board, touched, refused):
    """Return those of which a neighbour, or they themselves, changed in the last round."""
    changed = np.concatenate([board.touched[:touched], board.done[len(board.done) - refused :]])
    size = _in_slices(watch, Look(board, changed, NO_VERDICT), len(changed), 0)
    watched = board.watched[:size].copy()
    board.is_watched[watched] = False
    return watched


def _possible_peaks(board, touched, refused, candidates):
    """Return the candidates that may be peaks, and the new length of their list.

    Who was no peak, and around whom nothing changed, is none now. Where much changed, it is quicker
    to look at all.
    """
    if WATCHED_PER_CHANGE * (touched + refused) < candidates:
        watched = _watch_around(board, touched, refused)
        if len(watched):
            return watched, candidates
    candidates = _in_slices(drop_candidates, board, candidates, 0)
    return board.candidates[:candidates], candidates


def run(kernel, mesh, rules, space=None, threads=None):
    """Flip edges of `mesh` in place until no allowed flip helps, or the limit is reached.

    Parameters
    ----------
    kernel : callable
        `score_each` or `score_in_lanes` for one energy, from `meshlab_willmore.search.entries`.
    mesh : Mesh
    rules : Rules
    space : Space, optional
        As for `meshlab_willmore.search.greedy.run`.
    threads : int, optional
        As many as Numba is set to if left out. The result does not depend on it.

    Returns
    -------
    Progress
        Its state is `CONVERGED` or `STOPPED`.
    """
    space = spaces.without(spaces.no_space() if space is None else space)
    board = board_of(mesh, rules, space)
    progress = Progress(len(mesh.origin), 0, 0.0, WORKING)
    touched, refused, candidates = len(board.touched), 0, 0
    with crew(threads) as share:
        for number in itertools.count(1):
            share(kernel, board, touched)
            candidates = _in_slices(add_candidates, board, touched, candidates)
            edges, candidates = _possible_peaks(board, touched, refused, candidates)
            if not len(edges):
                progress = progress._replace(state=CONVERGED)
                break
            look = Look(board, edges, np.empty(len(edges), np.int8))
            share(find_peaks, look, len(edges))
            peaks, first = _peaks(look, number, progress.flips)
            board, done = _flip_all(board, peaks, first, rules.maxflips - progress.flips, number)
            flips, gain = progress.flips + done.flipped, progress.gain + done.gain
            progress = Progress(progress.scored, flips, gain, done.state)
            if done.state == STOPPED:
                break
            refused = done.refused
            touched = _touch_all(board, done.flipped, share)
    return progress
