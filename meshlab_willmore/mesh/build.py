"""From faces to half-edge connectivity, and the check that it is sound."""

from typing import NamedTuple

import numpy as np

from .halfedge import NONE, Mesh, following, next_in_fan
from .jit import allocating_jit, at, inner, jit
from .parallel import thread_pool

# Half-edges of one vertex that are sorted by insertion, which takes quadratic time.
MANY_EDGES = 64
# Bits of the higher end in the number of an edge.
EDGE_SHIFT = 32


@allocating_jit
def sort_by_vertex(order, vertex, starts):
    """Return `order` stably sorted by `vertex[order]`, in O(n + entries) time.

    Parameters
    ----------
    order : (e,) int
        Indices into `vertex`.
    vertex : array of int
        Vertices in 0 .. n - 1.
    starts : (n + 2,) int64
        Overwritten: the entries of v are those from ``starts[v]`` up to ``starts[v + 1]``.
    """
    starts[:] = 0
    for h in order:
        starts[vertex[h] + 2] += 1
    for v in range(1, len(starts)):
        starts[v] += starts[v - 1]
    # Until all entries are in place, starts[v + 1] is where the next one of v goes.
    result = np.empty_like(order)
    for h in order:
        result[starts[vertex[h] + 1]] = h
        starts[vertex[h] + 1] += 1
    return result


@jit
def _count_by_low(faces, starts):
    """Count the half-edges of each lower end vertex v into ``starts[v + 2]``; return the most."""
    starts[:] = 0
    most = np.int64(0)
    for f in range(len(faces)):
        for c in range(3):
            low = min(faces[at(f), at(c)], faces[at(f), at((c + 1) % 3)])
            starts[at(low + 2)] += 1
            most = max(most, starts[at(low + 2)])
    return most


@inner
def _sort_slice(high, half_edge, start, stop):
    """Sort a slice of two arrays by the first, stably; in linear time if it is in order."""
    for place in range(start + 1, stop):
        v, h, hole = high[at(place)], half_edge[at(place)], place
        while hole > start and high[at(hole - 1)] > v:
            high[at(hole)], half_edge[at(hole)] = high[at(hole - 1)], half_edge[at(hole - 1)]
            hole -= 1
        high[at(hole)], half_edge[at(hole)] = v, h


@inner
def _pair_slice(origin, twin, high, half_edge, start, stop):
    """Write the twins of the half-edges from one vertex to higher ones, or back, in order."""
    while start < stop:
        after = start + 1
        while after < stop and high[at(after)] == high[at(start)]:
            after += 1
        h, t = half_edge[at(start)], half_edge[at(after - 1)]
        # Two half-edges that start at the same vertex belong to faces of opposite orientation.
        if after - start == 2 and origin[at(h)] != origin[at(t)]:
            twin[at(h)], twin[at(t)] = t, h
        start = after


class _Stars(NamedTuple):
    """The half-edges of a mesh, by their lower end vertex.

    Attributes
    ----------
    origin, twin : (3 m,) int32
        As of a Mesh; the twins are to be found, and `NONE` before.
    starts : (n + 2,) int64
        Those with the lower end v are from ``starts[v]`` up to ``starts[v + 1]``.
    high, half_edge : (3 m,) int32
        Their higher ends, and the half-edges themselves.
    """

    origin: np.ndarray
    twin: np.ndarray
    starts: np.ndarray
    high: np.ndarray
    half_edge: np.ndarray


@jit
def _fill_stars(stars, order):
    """Write the half-edges, in this order, to their lower end vertices; `starts` has the counts."""
    origin, starts = stars.origin, stars.starts
    for v in range(1, len(starts)):
        starts[at(v)] += starts[at(v - 1)]
    for place in range(len(order)):
        h = order[at(place)]
        u, v = origin[at(h)], origin[at(following(h))]
        slot = starts[at(min(u, v) + 1)]
        stars.high[at(slot)], stars.half_edge[at(slot)] = max(u, v), h
        starts[at(min(u, v) + 1)] = slot + 1


@jit
def _pair(stars, first, last):
    """Write the twins of the half-edges with a lower end from `first` up to `last`."""
    for v in range(first, last):
        start, stop = stars.starts[at(v)], stars.starts[at(v + 1)]
        _sort_slice(stars.high, stars.half_edge, start, stop)
        _pair_slice(stars.origin, stars.twin, stars.high, stars.half_edge, start, stop)


def _stars(faces, vertex_count):
    """Return the half-edges of `faces` (m, 3) by their lower end vertex."""
    starts = np.empty(vertex_count + 2, np.int64)
    order = np.arange(faces.size, dtype=np.int32)
    if _count_by_low(faces, starts) > MANY_EDGES:
        order = sort_by_vertex(order, edge_ends(faces)[1], starts)
        _count_by_low(faces, starts)
    twin = np.full(faces.size, NONE, np.int32)
    stars = _Stars(faces.flatten(), twin, starts, np.empty_like(twin), np.empty_like(twin))
    _fill_stars(stars, order)
    return stars


class _Fans(NamedTuple):
    """A mesh, and of each vertex the number of its corners and one half-edge, or `NONE`."""

    mesh: Mesh
    corners: np.ndarray
    first: np.ndarray


@jit
def _count_corners(fans):
    """Fill in the corners and the half-edge of each vertex."""
    for h in range(len(fans.mesh.origin)):
        v = at(fans.mesh.origin[at(h)])
        fans.corners[v] += 1
        fans.first[v] = h


@jit
def _find_several_fans(fans, start, stop):
    """Mark, in place, those of the vertices from `start` up to `stop` that have several fans."""
    for v in range(start, stop):
        h, left = fans.first[at(v)], fans.corners[at(v)]
        if h == NONE:
            continue
        while True:
            h, left = next_in_fan(fans.mesh, h), left - 1
            if h == fans.first[at(v)]:
                break
        fans.mesh.several_fans[at(v)] = left > 0


def edge_ends(faces):
    """Return the lower and the higher end vertex of each half-edge of `faces` (m, 3)."""
    ahead = np.roll(faces, -1, axis=1)
    return np.minimum(faces, ahead).ravel(), np.maximum(faces, ahead).ravel()


def changed_edges(before, after):
    """Return the number of vertex pairs that faces of `after` (m, 3) join, and none of `before`."""
    return len(np.setdiff1d(edge_numbers(after), edge_numbers(before), assume_unique=True))


def edge_numbers(faces):
    """Return the numbers of all edges, ``low << EDGE_SHIFT | high`` by their ends, sorted."""
    low, high = edge_ends(faces)
    return np.unique((low.astype(np.int64) << EDGE_SHIFT) | high)


def local_order(faces, vertex_count):
    """Return an order (m,) int32 of the faces in which neighbours are near each other.

    It is that of their lowest vertices. Files that scatter their faces make each look at a
    neighbour a walk through memory.
    """
    starts = np.empty(vertex_count + 2, np.int64)
    return sort_by_vertex(np.arange(len(faces), dtype=np.int32), _lowest(faces), starts)


def in_old_slots(mesh, order):
    """Return the faces of a mesh that was built of the faces ``input[order]``, as in the input.

    Parameters
    ----------
    mesh : Mesh
    order : (m,) int32

    Returns
    -------
    faces, corners : (m, 3) int32
        Face ``order[f]`` is face f of the mesh. For each of its corners a corner of the input, as
        `Mesh.corner`, but in the numbers of the input.
    """
    faces, corners = np.empty((2, len(order), 3), np.int32)
    with thread_pool() as parallel_for:
        parallel_for(_put_back, _Slots(mesh, order, faces, corners), len(order))
    return faces, corners


class _Slots(NamedTuple):
    """What `in_old_slots` is given, and what it is to return."""

    mesh: Mesh
    order: np.ndarray
    faces: np.ndarray
    corners: np.ndarray


@jit
def _put_back(slots, start, stop):
    """Write the faces from `start` up to `stop` into their old slots."""
    mesh, order = slots.mesh, slots.order
    for place in range(start, stop):
        f = at(order[at(place)])
        for c in range(3):
            h = at(3 * place + c)
            source = at(mesh.corner[h])
            slots.faces[f, at(c)] = mesh.origin[h]
            slots.corners[f, at(c)] = 3 * order[source // at(3)] + np.int32(source % at(3))


@allocating_jit
def _lowest(faces):
    lowest = np.empty(len(faces), np.int32)
    for f in range(len(faces)):
        lowest[f] = min(faces[f, 0], faces[f, 1], faces[f, 2])
    return lowest


def build(vertices, faces):
    """Return the half-edge mesh of checked arrays, with nothing locked.

    Works in O(n + m): a counting sort brings the half-edges of each edge together.

    Parameters
    ----------
    vertices : (n, 3) float64
        Coordinates; the mesh keeps a reference.
    faces : (m, 3) int32
        Vertex indices, each face with three different ones; copied.

    Returns
    -------
    Mesh
    """
    count = len(vertices)
    with thread_pool() as parallel_for:
        stars = _stars(faces, count)
        parallel_for(_pair, stars, count)
        mesh = Mesh(
            vertices,
            stars.origin,
            stars.twin,
            locked=np.zeros(faces.size, np.bool_),
            corner=np.arange(faces.size, dtype=np.int32),
            several_fans=np.zeros(count, np.bool_),
            uv=np.empty((0, 0)),
            deviation=np.zeros(len(faces)),
        )
        fans = _Fans(mesh, np.zeros(count, np.int32), np.full(count, NONE, np.int32))
        _count_corners(fans)
        parallel_for(_find_several_fans, fans, count)
    return mesh


def faces_of(mesh):
    """Return the faces (m, 3) int32 of `mesh` as a new array."""
    return mesh.origin.reshape(-1, 3).copy()


@allocating_jit
def interior_vertices(mesh):
    """Return the mask (n,) of the vertices whose faces form one closed fan."""
    interior = np.zeros(len(mesh.vertices), np.bool_)
    for v in mesh.origin:
        interior[at(v)] = True
    # In a fan as many half-edges without twin start as end: to look at the starts is enough.
    for h in range(len(mesh.origin)):
        if mesh.twin[at(h)] == NONE:
            interior[at(mesh.origin[at(h)])] = False
    return interior & ~mesh.several_fans
