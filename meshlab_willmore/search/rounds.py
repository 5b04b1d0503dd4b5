"""State and lists of the greedy search in rounds.

The lists (dirty edges, ranked edges, edges that may be maxima now) are kept in order, chunk by
chunk, so that nothing depends on how work is shared among threads.
"""

from typing import NamedTuple

import numpy as np

from ..guards import add_deviation
from ..guards.bvh import Bvh
from ..mesh.halfedge import NONE, Mesh, previous
from ..mesh.jit import allocating_jit, at, inlined, inner, jit
from ..mesh.parallel import CHUNK

# Numba keeps no kernel on disk that hands on a function of its own module by its plain name.
from . import rounds, stencil
from .containers import (
    NEVER,
    PairSet,
    WatchLists,
    contains,
    empty_pair_set,
    empty_watch_lists,
    unwatch,
)
from .rules import Rules

# Items of work that is done in order by one call of a kernel; interrupts are served between two.
EDGES_PER_CALL = 16 * CHUNK
# Half-edges of a block, of which all are looked through if one is dirty.
BLOCK_BITS = 9
BLOCK = 1 << BLOCK_BITS
BLOCKS_PER_CALL = 64
# Knuth's multiplier (2**32 / golden ratio); odd, so that no two numbers get the same.
SCRAMBLER, LOW_BITS = np.uint64(2654435761), np.uint64(2**32 - 1)


class RoundState(NamedTuple):
    """State of the search on a mesh of 3 m half-edges and n vertices; changed in place.

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
    ranked : (3 m,) int32
        The edges with a rank, and some that have none any more. Their number is not kept here, nor
        that of the next two.
    dirty, active : (e,) int32
        The edges to be scored; those that may be maxima now.
    is_listed, is_active : (3 m,) bool
        The edges among the ranked and the active.
    is_dirty : (3 m,) bool
        The edges that are to be put into their list.
    has_dirty : (3 m / BLOCK + 1,) bool
        Whether any of each `BLOCK` half-edges is to be.
    done : (m,) int32
        The maxima of this round: from the front those that were flipped, from the back those that
        must not be flipped.
    taken : (n,) bool
        Corners of what was flipped, for an energy that looks round whole corners.
    tabu, blocking : PairSet
        The edges that must not come back; those that blocked a flip to them.
    tabu_hit : (1,) bool
        Whether a flip was refused for an edge of `tabu`.
    new_edge : (n,) int64
        The round in which a flip is last to make an edge of which the vertex is the lower end, and
        in the low 32 bits the number of the maximum.
    bvh : Bvh
    watch_lists : WatchLists
        The edges that a face blocks.
    to_flip : (m,) int32
        For each face that is to change in this round the half-edge that is to be flipped; empty if
        the BVH is inactive.
    """

    mesh: Mesh
    rules: Rules
    rank: np.ndarray
    gain: np.ndarray
    is_tie: np.ndarray
    ranked: np.ndarray
    dirty: np.ndarray
    active: np.ndarray
    is_listed: np.ndarray
    is_dirty: np.ndarray
    has_dirty: np.ndarray
    is_active: np.ndarray
    done: np.ndarray
    taken: np.ndarray
    tabu: PairSet
    blocking: PairSet
    tabu_hit: np.ndarray
    new_edge: np.ndarray
    bvh: Bvh
    watch_lists: WatchLists
    to_flip: np.ndarray


def initial_state(mesh, rules, bvh):
    """Return the state at the start: every edge is dirty, and the BVH knows of no rounds."""
    if bvh.active:
        bvh.changed[:] = 0
    size, faces = len(mesh.origin), len(mesh.origin) // 3
    edges = np.flatnonzero(np.arange(size, dtype=np.int32) < mesh.twin).astype(np.int32)
    return RoundState(
        mesh,
        rules,
        rank=np.full(size, NEVER),
        gain=np.zeros(size),
        is_tie=np.zeros(size, np.bool_),
        ranked=np.empty(size, np.int32),
        dirty=edges,
        active=np.empty(len(edges), np.int32),
        is_listed=np.zeros(size, np.bool_),
        is_dirty=np.zeros(size, np.bool_),
        has_dirty=np.zeros((size >> BLOCK_BITS) + 1, np.bool_),
        is_active=np.zeros(size, np.bool_),
        done=np.empty(faces, np.int32),
        taken=np.zeros(len(mesh.vertices) if rules.is_wide else 0, np.bool_),
        tabu=empty_pair_set(),
        blocking=empty_pair_set(),
        tabu_hit=np.zeros(1, np.bool_),
        new_edge=np.zeros(len(mesh.vertices), np.int64),
        bvh=bvh,
        watch_lists=empty_watch_lists(len(bvh.order)),
        to_flip=np.empty(len(bvh.order), np.int32),
    )


class Candidates(NamedTuple):
    """Edges with a rank, and room for what becomes of each in this round, an int8."""

    state: RoundState
    edges: np.ndarray
    verdict: np.ndarray


def in_chunks(kernel, task, stop, value):
    """Let a kernel that works in order pass a value on, chunk by chunk."""
    for start in range(0, stop, EDGES_PER_CALL):
        value = kernel(task, start, min(start + EDGES_PER_CALL, stop), value)
    return value


@inner
def forbid(state, h):
    """Take the edge of `h`, if it is one with a twin, out of those that may be flipped."""
    t = state.mesh.twin[at(h)]
    state.rank[at(h)] = NEVER
    if t != NONE:
        state.rank[at(t)] = NEVER


@inlined
def scrambled(h):
    """Return another number for each half-edge, to break ties by.

    By the numbers themselves, edges of equal gain side by side would all wait for the first one.
    """
    return (at(h) * SCRAMBLER) & LOW_BITS


@inlined
def goes_before(state, other, h):
    """Whether the edge of the half-edge `other` goes before `h`, the lower of its twins."""
    rank, other_rank = state.rank[at(h)], state.rank[at(other)]
    if other_rank != rank:
        return other_rank > rank
    # So it has a rank, and a twin.
    return scrambled(min(other, state.mesh.twin[at(other)])) < scrambled(h)


# --- dirty edges ---------------------------------------------------------------------------------


@inner
def mark_dirty(state, h, _):
    """Mark the edge of `h` as one to be scored; threads may do that side by side."""
    t = state.mesh.twin[at(h)]
    if t == NONE:
        state.rank[at(h)] = NEVER
        return False
    low = min(h, t)
    state.is_dirty[at(low)] = True
    state.has_dirty[at(low >> BLOCK_BITS)] = True
    return False


@jit
def mark_changed(state, start, stop):
    """Mark the edges that the flips from `start` up to `stop` of this round change.

    The bounds of the faces' deviation are brought up to date, too: no face is flipped twice in a
    round. All flips of the round must be done: they move edges to other half-edges.
    """
    mesh = state.mesh
    for place in range(start, stop):
        h = np.int64(state.done[at(place)])
        t = np.int64(mesh.twin[at(h)])
        add_deviation(mesh, h)
        if state.rules.is_wide:
            stencil.visit_fans(state, h, rounds.mark_dirty, None)
            for corner in (h, t, previous(h), previous(t)):
                state.taken[mesh.origin[corner]] = False
        elif state.rules.is_narrow and not state.rules.monotone:
            stencil.visit_quad(state, h, rounds.mark_dirty, None)
        else:
            stencil.visit_stencil(state, h, rounds.mark_dirty, None)
        i, j = mesh.origin[at(previous(h))], mesh.origin[at(previous(t))]
        if contains(state.blocking, i, j):
            stencil.visit_freed(state, h, rounds.mark_dirty, None)


@jit
def _mark_freed(state, start, stop, value):
    """Mark the edges that watch the faces of these flips."""
    lists = state.watch_lists
    for place in range(start, stop):
        flipped = np.int64(state.done[at(place)])
        for face in (flipped // 3, np.int64(state.mesh.twin[at(flipped)]) // 3):
            while lists.first[face] != NONE:
                h = np.int64(lists.first[face])
                unwatch(lists, h)
                mark_dirty(state, h, None)
    return value


class _DirtyBlocks(NamedTuple):
    """The dirty edges of a state, and for each chunk of blocks where its own begin in their list.

    Only what is used: each array of a tuple takes time to compile.
    """

    is_dirty: np.ndarray
    has_dirty: np.ndarray
    dirty: np.ndarray
    starts: np.ndarray


@jit
def _count_dirty(blocks, start, stop):
    """Write, for the next chunk, how many edges are dirty in the blocks of this one."""
    count = 0
    for block in range(start, stop):
        if blocks.has_dirty[at(block)]:
            first = block << BLOCK_BITS
            for h in range(first, min(first + BLOCK, len(blocks.is_dirty))):
                count += blocks.is_dirty[at(h)]
    blocks.starts[start // BLOCKS_PER_CALL + 1] = count


@allocating_jit
def _list_dirty(blocks, start, stop):
    """Put the dirty edges of the blocks from `start` up to `stop` into their list, by number."""
    size, found = blocks.starts[start // BLOCKS_PER_CALL], np.empty(BLOCK + 1, np.int32)
    for block in range(start, stop):
        if not blocks.has_dirty[at(block)]:
            continue
        blocks.has_dirty[at(block)] = False
        # Without a branch: no processor predicts whether an edge is dirty.
        count, first = 0, block << BLOCK_BITS
        for h in range(first, min(first + BLOCK, len(blocks.is_dirty))):
            found[at(count)] = h
            count += blocks.is_dirty[at(h)]
            blocks.is_dirty[at(h)] = False
        for place in range(count):
            blocks.dirty[at(size + place)] = found[at(place)]
        size += count


def list_dirty(state, flipped, parallel_for):
    """List the edges that the `flipped` flips of this round change; return how many there are."""
    parallel_for(mark_changed, state, flipped)
    if state.bvh.active:
        in_chunks(_mark_freed, state, flipped, 0)
    count = len(state.has_dirty)
    starts = np.zeros(-(-count // BLOCKS_PER_CALL) + 1, np.int64)
    blocks = _DirtyBlocks(state.is_dirty, state.has_dirty, state.dirty, starts)
    parallel_for(_count_dirty, blocks, count, BLOCKS_PER_CALL)
    np.cumsum(starts, out=starts)
    parallel_for(_list_dirty, blocks, count, BLOCKS_PER_CALL)
    return int(starts[-1])


# --- ranked and active edges ---------------------------------------------------------------------


class _RankedEdges(NamedTuple):
    """What the list of ranked edges is made of; the fields of a RoundState and its mesh."""

    twin: np.ndarray
    rank: np.ndarray
    ranked: np.ndarray
    is_listed: np.ndarray
    dirty: np.ndarray


def _ranked_edges(state):
    return _RankedEdges(state.mesh.twin, state.rank, state.ranked, state.is_listed, state.dirty)


@jit
def _compact_ranked(edges, start, stop, count):
    """Move the edges from `start` up to `stop` that still have a rank to the front of the list.

    Returns
    -------
    int
        How many are there, with the `count` that were before.
    """
    for place in range(start, stop):
        h = edges.ranked[at(place)]
        # A flip may have put another edge there, or none.
        if edges.rank[at(h)] > NEVER and h < edges.twin[at(h)]:
            edges.ranked[at(count)] = h
            count += 1
        else:
            edges.is_listed[at(h)] = False
    return count


def compact_ranked(state, ranked):
    """Take out of the list of `ranked` edges, in place, those without a rank; return its length."""
    return in_chunks(_compact_ranked, _ranked_edges(state), ranked, 0)


@jit
def _add_ranked(edges, start, stop, count):
    """Add the dirty edges from `start` up to `stop` that have a rank to `count` ranked ones.

    Returns
    -------
    int
        How many are in the list then.
    """
    for place in range(start, stop):
        h = edges.dirty[at(place)]
        if edges.rank[at(h)] > NEVER and not edges.is_listed[at(h)]:
            edges.is_listed[at(h)] = True
            edges.ranked[at(count)] = h
            count += 1
    return count


def add_ranked(state, dirty, ranked):
    """Add those of the `dirty` edges that have a rank to the `ranked` ones; return their number."""
    return in_chunks(_add_ranked, _ranked_edges(state), dirty, ranked)


class Appender(NamedTuple):
    """What `activate` needs: the state, and in `size` (1,) how long the list is."""

    mesh: Mesh
    state: RoundState
    size: np.ndarray


@inner
def activate(appender, h, _):
    """Put the edge of `h`, if it has a rank, among those that may be maxima."""
    state = appender.state
    if state.rank[at(h)] == NEVER:
        return False
    low = min(h, state.mesh.twin[at(h)])
    if not state.is_active[at(low)]:
        state.is_active[at(low)] = True
        state.active[at(appender.size[0])] = low
        appender.size[0] += 1
    return False


@allocating_jit
def _activate_around(changed, start, stop, size):
    """Activate the edges around those from `start` up to `stop`; return the list's new `size`."""
    state = changed.state
    appender = Appender(state.mesh, state, np.array([size]))
    for place in range(start, stop):
        h = np.int64(changed.edges[at(place)])
        if state.mesh.twin[at(h)] != NONE:
            stencil.visit_stencil(appender, h, rounds.activate, None)
    return appender.size[0]


def active_around(state, changed):
    """Return the edges with a rank among `changed` and their neighbours."""
    task = Candidates(state, changed, np.empty(0, np.int8))
    size = in_chunks(_activate_around, task, len(changed), 0)
    active = state.active[:size].copy()
    state.is_active[active] = False
    return active
