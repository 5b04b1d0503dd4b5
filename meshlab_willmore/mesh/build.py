"""From faces to half-edge connectivity, and the check that it is sound."""

import numpy as np

from .halfedge import NONE, Mesh, next_in_fan
from .jit import at, jit


@jit
def sort_by_vertex(order, vertex, starts):
    """Return `order` stably sorted by `vertex[order]`, in O(n + entries) time.

    Parameters
    ----------
    order : (e,) int
        Indices into `vertex`.
    vertex : array of int
        Vertices in 0 .. n - 1.
    starts : (n + 2,) int64
        Overwritten: the entries of v stand from ``starts[v]`` up to ``starts[v + 1]``.
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
def _pair(origin, low, high, order):
    """Return the twins, given half-edges in `order` of their end vertices `low` <= `high`."""
    twin = np.full(len(origin), NONE, np.int32)
    start = 0
    while start < len(order):
        h = order[start]
        stop = start + 1
        while stop < len(order) and low[order[stop]] == low[h] and high[order[stop]] == high[h]:
            stop += 1
        t = order[stop - 1]
        # Two half-edges that start at the same vertex belong to faces of opposite orientation.
        if stop - start == 2 and origin[h] != origin[t]:
            twin[h], twin[t] = t, h
        start = stop
    return twin


@jit
def _fan_counts(mesh, fans):
    """Count the fans of faces around each vertex into `fans` (n,)."""
    seen = np.zeros(len(mesh.origin), np.bool_)
    for start in range(len(mesh.origin)):
        if seen[start]:
            continue
        fans[mesh.origin[start]] += 1
        h = start
        while not seen[h]:
            seen[h] = True
            h = next_in_fan(mesh, h)


def edge_ends(faces):
    """Return the lower and the higher end vertex of each half-edge of `faces` (m, 3)."""
    ahead = np.roll(faces, -1, axis=1)
    return np.minimum(faces, ahead).ravel(), np.maximum(faces, ahead).ravel()


def changed_edges(before, after):
    """Return the number of vertex pairs that faces of `after` (m, 3) join, and none of `before`."""
    return len(np.setdiff1d(_edge_numbers(after), _edge_numbers(before), assume_unique=True))


def _edge_numbers(faces):
    """Return a number for each edge, the same in all meshes, sorted."""
    low, high = edge_ends(faces)
    return np.unique((low.astype(np.int64) << 32) | high)


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
    _put_back(mesh, order, faces, corners)
    return faces, corners


@jit
def _put_back(mesh, order, faces, corners):
    for h in range(len(mesh.origin)):
        f, source = order[at(h // 3)], mesh.corner[at(h)]
        faces[at(f), at(h % 3)] = mesh.origin[at(h)]
        corners[at(f), at(h % 3)] = 3 * order[at(source // 3)] + source % 3


@jit
def _lowest(faces):
    lowest = np.empty(len(faces), np.int32)
    for f in range(len(faces)):
        lowest[f] = min(faces[f, 0], faces[f, 1], faces[f, 2])
    return lowest


def build(vertices, faces):
    """Return the half-edge mesh of checked arrays, with nothing locked.

    Works in O(n + m): two counting sorts bring the half-edges of each edge together.

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
    origin = faces.ravel().copy()
    low, high = edge_ends(faces)
    starts = np.empty(len(vertices) + 2, np.int64)
    corner = np.arange(len(origin), dtype=np.int32)
    order = sort_by_vertex(sort_by_vertex(corner, high, starts), low, starts)
    twin = _pair(origin, low, high, order)
    fans = np.zeros(len(vertices), np.int32)
    locked = np.zeros(len(origin), np.bool_)
    mesh = Mesh(vertices, origin, twin, locked, corner, np.zeros(len(vertices), np.bool_))
    _fan_counts(mesh, fans)
    return mesh._replace(several_fans=fans > 1)


def faces_of(mesh):
    """Return the faces (m, 3) int32 of `mesh` as a new array."""
    return mesh.origin.reshape(-1, 3).copy()


def interior_vertices(mesh):
    """Return the mask (n,) of the vertices whose faces form one closed fan."""
    interior = np.zeros(len(mesh.vertices), bool)
    interior[mesh.origin] = True
    # In a fan as many half-edges without twin start as end: to look at the starts is enough.
    interior[mesh.origin[mesh.twin == NONE]] = False
    return interior & ~mesh.several_fans


def following_all(h):
    """Return the next half-edge in its face for each of the array `h`."""
    return h + 1 - 3 * (h % 3 == 2)


def validate_connectivity(mesh):
    """Check the invariants of `meshlab_willmore.mesh.halfedge` on the whole mesh.

    Raises
    ------
    ValueError
        Names the first half-edge at which an invariant is broken.
    """
    h = np.flatnonzero(mesh.twin != NONE)
    t = mesh.twin[h]
    ahead = mesh.origin[following_all(np.arange(len(mesh.origin)))]
    _refuse(h, mesh.twin[t] != h, "is not the twin of its twin")
    _refuse(h, (mesh.origin[h] != ahead[t]) | (mesh.origin[t] != ahead[h]), "and its twin differ")
    _refuse(h, mesh.locked[h] != mesh.locked[t], "is locked on one side only")
    _refuse(np.arange(len(ahead)), mesh.origin == ahead, "starts and ends at the same vertex")
    rebuilt = build(mesh.vertices, faces_of(mesh))
    _refuse(
        np.arange(len(ahead)), mesh.twin != rebuilt.twin, "has not the twin that the faces give"
    )
    fans = np.flatnonzero(mesh.several_fans != rebuilt.several_fans)
    _refuse(fans, np.ones(len(fans), bool), "as a vertex changed its number of fans")


def _refuse(which, broken, what):
    if broken.any():
        raise ValueError(f"half-edge {which[np.argmax(broken)]} {what}")
