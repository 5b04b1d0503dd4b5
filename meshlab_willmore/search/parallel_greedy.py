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
whole corners, of the peaks with a common corner only the first is flipped.) What the whole mesh
decides, that k-l is no edge yet and that no face is cut, is asked of every peak before the round.

**Why no edge is made twice.** After some flips of a round, the edges of the mesh are among those
before the round and those that these flips have made. k-l is none of the former, or the peak would
have been refused. One of the latter it can be only if another peak makes the same edge. Such peaks
are *contested*: they are flipped after all others, one by one, and each is asked again on the mesh
as it is then. What was refused before the round is never flipped in it, although a flip may free
it: it waits for what was in its way, and is scored for the next round. The same holds for cuts: the
faces are those before the round and those that its flips make, and who would cut one of the latter
is contested. The order of the peaks does not depend on how the work was shared. So the result is
the same, bit for bit, for any number of threads.
"""

from typing import NamedTuple

import numpy as np

from ..guards.bvh import inactive_bvh, specialized
from ..guards.intersections import ANY_ROUND, blocking_face
from ..mesh.halfedge import apex, flip, makes_new_edge
from ..mesh.jit import at, inner, jit
from ..mesh.notify import report
from ..mesh.parallel import thread_pool
from . import lists, peaks
from .board import board_of, forbid
from .pairs import insert, reserve
from .peaks import FOLDS, IS_BLOCKED, IS_JOINED, IS_PEAK, Look
from .rules import (
    CONVERGED,
    MOST_PASSES,
    STOPPED,
    WORKING,
    Progress,
    brings_back,
    is_final,
    must_wait,
)

NO_VERDICT = np.empty(0, np.int8)
# Edges around one that changed, about.
WATCHED_PER_CHANGE = 13


@inner
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


@inner
def _is_refused(board, h, verdict, is_contested, number):
    """Tell whether the edge `h` must not be flipped, and if so, let it wait for what is in its way.

    The verdict tells how that was before the round. Only what is contested is asked again.
    """
    mesh = board.mesh
    is_joined = verdict == IS_JOINED or (is_contested and not makes_new_edge(mesh, h))
    if is_joined:
        insert(board.awaited, apex(mesh, h), apex(mesh, mesh.twin[at(h)]))
    if is_joined or verdict == FOLDS:
        return True
    if verdict == IS_BLOCKED:
        # Nothing was flipped yet in this round, so that the face is still there.
        must_wait(board, h, blocking_face(mesh, board.space, h, ANY_ROUND))
        return True
    if board.is_tie[at(h)] and brings_back(mesh, board.gone, h):
        board.kept_away[0] = True
        return True
    if not is_contested:
        return False
    return must_wait(board, h, blocking_face(mesh, board.space, h, number))


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
        From `peaks.in_order`; `gone` and `awaited` of its board must have room for all of them.
    start, stop, first : int
        `first` as from there.
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
        # Of most nothing is to be asked any more.
        is_settled = verdict == IS_PEAK and place < first and not board.is_tie[at(h)]
        if not is_settled and _is_refused(board, h, verdict, place >= first, number):
            forbid(board, h)
            refused += 1
            board.done[at(len(board.done) - refused)] = h
            continue
        if flipped == left:
            return flipped, refused, gain, STOPPED
        if rules.is_wide and not _take_corners(board, h):
            continue
        if board.is_tie[at(h)]:
            insert(board.gone, mesh.origin[h], mesh.origin[mesh.twin[h]])
        gain += board.gain[at(h)]
        flip(mesh, h)
        board.done[at(flipped)] = h
        flipped += 1
    return flipped, refused, gain, state


def _flip_all(board, chosen, first, left, number):
    """Flip all peaks that are allowed; return the board, and what was done."""
    done = Done(0, 0, 0.0, WORKING)
    for start in range(0, len(chosen.edges), lists.SLICE):
        board = board._replace(
            gone=reserve(board.gone, lists.SLICE), awaited=reserve(board.awaited, lists.SLICE)
        )
        stop = min(start + lists.SLICE, len(chosen.edges))
        done = Done(
            *flip_peaks(chosen._replace(board=board), start, stop, first, left, number, tuple(done))
        )
        if done.state == STOPPED:
            break
    return board, done


def _watch_around(board, touched, refused):
    """Return those of which a neighbour, or they themselves, changed in the last round."""
    changed = np.concatenate([board.touched[:touched], board.done[len(board.done) - refused :]])
    size = lists.in_slices(lists.watch, Look(board, changed, NO_VERDICT), len(changed), 0)
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
    candidates = lists.in_slices(lists.drop_candidates, board, candidates, 0)
    return board.candidates[:candidates], candidates


def run(kernel, mesh, rules, space=None, threads=None):
    """Flip edges of `mesh` in place until no allowed flip helps, or the limit is reached.

    Parameters
    ----------
    kernel : callable
        `score_each` or `score_in_lanes` for one energy, from `meshlab_willmore.search.entries`.
    mesh : Mesh
    rules : Rules
    space : Bvh, optional
        As for `meshlab_willmore.search.greedy.run`.
    threads : int, optional
        As many as Numba is set to if left out. The result does not depend on it.

    Returns
    -------
    Progress
        Its state is `CONVERGED` or `STOPPED`.
    """
    space = specialized(inactive_bvh() if space is None else space)
    progress = Progress(len(mesh.origin), 0, 0.0, WORKING)
    with thread_pool(threads) as share:
        for _ in range(MOST_PASSES):
            flips, board = progress.flips, board_of(mesh, rules, space)
            progress = _make_rounds(kernel, board, progress, share)
            if is_final(rules, progress, flips, board.kept_away):
                break
    return progress


def _make_rounds(kernel, board, progress, share):
    """Make rounds of flips until no allowed flip helps, or the limit is reached."""
    touched, refused, candidates, number = len(board.touched), 0, 0, 0
    while True:
        number += 1
        share(kernel, board, touched)
        candidates = lists.in_slices(lists.add_candidates, board, touched, candidates)
        edges, candidates = _possible_peaks(board, touched, refused, candidates)
        if not len(edges):
            return progress._replace(state=CONVERGED)
        look = Look(board, edges, np.empty(len(edges), np.int8))
        share(peaks.find_peaks, look, len(edges))
        chosen, first = peaks.in_order(look, number, progress.flips, share)
        left = board.rules.maxflips - progress.flips
        board, done = _flip_all(board, chosen, first, left, number)
        flips, gain = progress.flips + done.flipped, progress.gain + done.gain
        progress = Progress(progress.scored, flips, gain, done.state)
        report(f"round {number}, {flips} flips, {len(edges)} edges left")
        if done.state == STOPPED:
            return progress
        refused = done.refused
        touched = lists.touch_all(board, done.flipped, share)
