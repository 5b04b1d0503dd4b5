"""What the greedy search in rounds knows of a mesh, and the list of edges to be scored."""

from typing import NamedTuple

import numpy as np

from ..guards.bvh import Bvh
from ..mesh.halfedge import NONE, Mesh
from ..mesh.jit import at, inner
from .heap import NEVER
from .pairs import Pairs, no_pairs
from .rules import Rules
from .waiting import Waiting, nothing_waits

# Half-edges of a block, of which all are looked through if one is touched.
BLOCK_BITS = 9
BLOCK = 1 << BLOCK_BITS


class Board(NamedTuple):
    """What the search knows of a mesh of 3 m half-edges and n vertices; changed in place.

    An edge with a twin goes by its lower half-edge.

    Attributes
    ----------
    mesh : Mesh
    rules : Rules
    rank : (3 m,) float64
        Rank of the edge of each half-edge, or `NEVER`; twins agree.
    gain : (3 m,) float64
        Cost reduction of each edge that has a rank.
    is_tie : (3 m,) bool
        Edges whose flip lowers no true energy: once flipped, they must not come back.
    candidates : (3 m,) int32
        The edges with a rank, and some that have none any more. Their number is not kept here, nor
        that of the next two.
    touched, watched : (e,) int32
        The edges to be scored; those that may be peaks now.
    is_listed, is_watched : (3 m,) bool
        The edges among the candidates and the watched.
    is_touched : (3 m,) bool
        The edges that are to be put into their list.
    has_touched : (3 m / BLOCK + 1,) bool
        Whether any of each `BLOCK` half-edges is to be.
    done : (m,) int32
        The peaks of this round: from the front those that were flipped, from the back those that
        must not be flipped.
    taken : (n,) bool
        Corners of what was flipped, for an energy that looks round whole corners.
    gone, awaited : Pairs
        The edges that must not come back; those that stood in the way of a flip to them.
    kept_away : (1,) bool
        Whether a flip was refused for an edge that must not come back.
    new_edge : (n,) int64
        The round in which a flip is last to make an edge of which the vertex is the lower end, and
        in the low 32 bits the number of the peak.
    space : Bvh
    waiting : Waiting
    to_flip : (m,) int32
        For each face that is to change in this round the half-edge that is to be flipped; empty if
        the space is not active.
    """

    mesh: Mesh
    rules: Rules
    rank: np.ndarray
    gain: np.ndarray
    is_tie: np.ndarray
    candidates: np.ndarray
    touched: np.ndarray
    watched: np.ndarray
    is_listed: np.ndarray
    is_touched: np.ndarray
    has_touched: np.ndarray
    is_watched: np.ndarray
    done: np.ndarray
    taken: np.ndarray
    gone: Pairs
    awaited: Pairs
    kept_away: np.ndarray
    new_edge: np.ndarray
    space: Bvh
    waiting: Waiting
    to_flip: np.ndarray


def board_of(mesh, rules, space):
    """Return the board at the start: every edge is to be scored.

    What the space knows of rounds, of a run before, is forgotten.
    """
    if space.active:
        space.changed[:] = 0
        space.changed_below[:] = 0
    size, faces = len(mesh.origin), len(mesh.origin) // 3
    edges = np.flatnonzero(np.arange(size, dtype=np.int32) < mesh.twin).astype(np.int32)
    return Board(
        mesh,
        rules,
        rank=np.full(size, NEVER),
        gain=np.zeros(size),
        is_tie=np.zeros(size, np.bool_),
        candidates=np.empty(size, np.int32),
        touched=edges,
        watched=np.empty(len(edges), np.int32),
        is_listed=np.zeros(size, np.bool_),
        is_touched=np.zeros(size, np.bool_),
        has_touched=np.zeros((size >> BLOCK_BITS) + 1, np.bool_),
        is_watched=np.zeros(size, np.bool_),
        done=np.empty(faces, np.int32),
        taken=np.zeros(len(mesh.vertices) if rules.is_wide else 0, np.bool_),
        gone=no_pairs(),
        awaited=no_pairs(),
        kept_away=np.zeros(1, np.bool_),
        new_edge=np.zeros(len(mesh.vertices), np.int64),
        space=space,
        waiting=nothing_waits(len(space.order)),
        to_flip=np.empty(len(space.order), np.int32),
    )


@inner
def forbid(board, h):
    """Take the edge of `h`, if it is one with a twin, out of those that may be flipped."""
    t = board.mesh.twin[at(h)]
    board.rank[at(h)] = NEVER
    if t != NONE:
        board.rank[at(t)] = NEVER


@inner
def touch(board, h, _):
    """Mark the edge of `h` as one to be scored; threads may do that side by side."""
    t = board.mesh.twin[at(h)]
    if t == NONE:
        board.rank[at(h)] = NEVER
        return
    low = min(h, t)
    board.is_touched[at(low)] = True
    board.has_touched[at(low >> BLOCK_BITS)] = True


class Pad(NamedTuple):
    """What `watch` needs: the board, and in `size` (1,) how long the list is."""

    mesh: Mesh
    board: Board
    size: np.ndarray


@inner
def watch(pad, h, _):
    """Put the edge of `h`, if it has a rank, among those that may be peaks."""
    board = pad.board
    if board.rank[at(h)] == NEVER:
        return
    low = min(h, board.mesh.twin[at(h)])
    if not board.is_watched[at(low)]:
        board.is_watched[at(low)] = True
        board.watched[at(pad.size[0])] = low
        pad.size[0] += 1
