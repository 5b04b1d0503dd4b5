r"""Half-edge connectivity on flat arrays, and the flip.

Half-edge ``h = 3 * f + c`` runs from corner ``c`` of face ``f`` to the next corner of that face, so
the face, the next and the previous half-edge are arithmetic; only the origin and the twin are
stored. Every kernel of the package names the surroundings of a half-edge ``h`` from i to j, with
twin ``t``, by this picture:

            k
          / | \           before: faces (i, j, k), (j, i, l)      edge  i-j
         /  |  \          after:  faces (k, i, l), (l, j, k)      edge  k-l
        i---+---j
         \  |  /          h: i -> j in face (i, j, k)
          \ | /           t: j -> i in face (j, i, l)
            l

Invariants, before and after every flip: ``twin[twin[h]] == h``; twins run between the same two
vertices in opposite directions; a face has three different vertices; no two edges with twins join
the same two vertices.
"""

from typing import NamedTuple

import numpy as np

from .jit import allocating_jit, at, inlined, inner
from .points import Point, norm, point, subtract

NONE = -1
# Steps round a vertex that cost next to nothing.
FEW_EDGES = 16
# Whether two vertices are joined by an edge.
NOT_JOINED, JOINED, UNDECIDED = range(3)


class Mesh(NamedTuple):
    """A triangle mesh of n vertices and m faces, ready for flips.

    Attributes
    ----------
    vertices : (n, 3) or (n, 6) float64
        Coordinates, never changed; with six columns, then a unit normal of each vertex.
    origin : (3 m,) int32
        Vertex at which each half-edge starts: the flattened faces.
    twin : (3 m,) int32
        The half-edge that runs the other way; `NONE` where there is not exactly one half-edge each
        way (boundary, non-manifold edge, neighbours of opposite orientation).
    locked : (3 m,) bool
        Edges that must not be flipped; twins agree.
    corner : (3 m,) int32
        A corner ``3 f + c`` of the *input* faces at the same vertex and on the same side of all
        locked edges: the corner that a corner inherits its wedge data from.
    several_fans : (n,) bool
        Vertices whose faces do not form one fan around them. Flips never change that.
    uv : (3 m, 2 c) float64
        Texture coordinates of the corners of the input faces in each of c mappings, never changed;
        empty without any.
    deviation : (m,) float64
        Bound of the distance between each face and the input, which searches keep up to date (see
        `meshlab_willmore.guards.deviation`).
    """

    vertices: np.ndarray
    origin: np.ndarray
    twin: np.ndarray
    locked: np.ndarray
    corner: np.ndarray
    several_fans: np.ndarray
    uv: np.ndarray
    deviation: np.ndarray


class Diamond(NamedTuple):
    """The corners of the two faces at an edge, as points."""

    i: Point
    j: Point
    k: Point
    l: Point


@inlined
def following(h):
    """Return the next half-edge of the face."""
    return h - 2 if h % 3 == 2 else h + 1


@inlined
def previous(h):
    """Return the previous half-edge of the face."""
    return h + 2 if h % 3 == 0 else h - 1


@inlined
def apex(mesh, h):
    """Return the vertex of the face of `h` that is not on `h`."""
    return mesh.origin[at(previous(h))]


@inlined
def diamond(mesh, h):
    """Return the four points around `h`, which must have a twin."""
    t = mesh.twin[at(h)]
    return Diamond(
        point(mesh.vertices, mesh.origin[at(h)]),
        point(mesh.vertices, mesh.origin[at(t)]),
        point(mesh.vertices, apex(mesh, h)),
        point(mesh.vertices, apex(mesh, t)),
    )


@allocating_jit
def lengths_of_sides(mesh):
    """Return the length of each half-edge (3 m,), an edge with two faces twice."""
    lengths = np.empty(len(mesh.origin))
    for h in range(len(lengths)):
        start = point(mesh.vertices, mesh.origin[h])
        lengths[h] = norm(subtract(point(mesh.vertices, mesh.origin[following(h)]), start))
    return lengths


@inner
def next_in_fan(mesh, h):
    """Return the half-edge after `h` in the fan of faces around its origin.

    An open fan is read as a ring too: its last half-edge is followed by its first.
    """
    t = mesh.twin[at(h)]
    if t != NONE:
        return following(t)
    before = mesh.twin[at(previous(h))]
    while before != NONE:
        h = before
        before = mesh.twin[at(previous(h))]
    return h


@inlined
def _has_corner(mesh, h, v):
    """Whether `v` is one of the two vertices opposite to the origin of `h` in its face."""
    return mesh.origin[at(following(h))] == v or mesh.origin[at(previous(h))] == v


@inner
def _search_fan(twin, origin, a, v):
    """Return whether an edge joins `v` and the origin of `a`, which must have a single fan.

    `UNDECIDED` if the fan is open or has more than `FEW_EDGES` edges. It takes two arrays, as it
    would take longer to pass the mesh than to walk.
    """
    x = a
    for _ in range(FEW_EDGES):
        if origin[at(following(x))] == v:
            return JOINED
        before = twin[at(previous(x))]
        if before == NONE:
            break
        x = np.int64(before)
        if x == a:
            return NOT_JOINED
    return UNDECIDED


@inner
def _search_both_fans(mesh, a, b):
    u, v = mesh.origin[at(a)], mesh.origin[at(b)]
    if mesh.several_fans[at(u)] and mesh.several_fans[at(v)]:
        return True
    x, y = a, b
    while True:
        if _has_corner(mesh, x, v) or _has_corner(mesh, y, u):
            return True
        x, y = next_in_fan(mesh, x), next_in_fan(mesh, y)
        if (x == a and not mesh.several_fans[u]) or (y == b and not mesh.several_fans[v]):
            return False


@inlined
def are_joined(mesh, a, b):
    """Whether an edge joins the origins of the half-edges `a` and `b`; also if in doubt.

    That is exact: where the faces at a vertex form a single fan, each edge of the vertex belongs to
    a face of that fan. If both vertices have several fans, the answer is yes. If the first vertex
    is inside the surface, a few steps round it nearly always suffice. Otherwise the fans of both
    are walked in step until one is complete, so that a vertex with a great many edges does no harm.
    """
    found = UNDECIDED
    if not mesh.several_fans[at(mesh.origin[at(a)])]:
        found = _search_fan(mesh.twin, mesh.origin, np.int64(a), mesh.origin[at(b)])
    if found == UNDECIDED:
        return _search_both_fans(mesh, a, b)
    return found == JOINED


@inner
def is_free(mesh, h):
    """Whether `h` has a twin, is not locked, and leaves i and j enough edges when flipped.

    A fan must not end with fewer than three edges. Only the two faces at `h` are looked at.
    """
    t = mesh.twin[at(h)]
    if t == NONE or mesh.locked[at(h)]:
        return False
    # An interior vertex with three edges needs no test: there, k-l is an edge already.
    k_i, i_l = mesh.twin[at(previous(h))], mesh.twin[at(following(t))]
    j_k, l_j = mesh.twin[at(following(h))], mesh.twin[at(previous(t))]
    return ((k_i != NONE) | (i_l != NONE)) & ((j_k != NONE) | (l_j != NONE))


@inlined
def makes_new_edge(mesh, h):
    """Whether k and l, the ends of `h` if it were flipped, differ and are not joined yet."""
    t = mesh.twin[at(h)]
    return apex(mesh, h) != apex(mesh, t) and not are_joined(mesh, previous(h), previous(t))


@inner
def _glue(mesh, h, outer, is_locked):
    """Make `h` and `outer` (or `NONE`) twins; `outer` knows already whether it is locked."""
    mesh.twin[at(h)] = outer
    mesh.locked[at(h)] = is_locked
    if outer != NONE:
        mesh.twin[at(outer)] = h


@inner
def flip(mesh, h):
    """Flip the edge of `h` in place, which must be free and make a new edge.

    The face (i, j, k) becomes (k, i, l) in its slot, the face (j, i, l) becomes (l, j, k) in its
    slot. `h` and its twin stay the twins on the diagonal, now from l to k and from k to l; the
    four sides move one place round the quad, so four flips give back the same `origin`, `twin` and
    `locked`, bit for bit. (`corner` comes back up to corners that are interchangeable: the two
    faces have two corners at i and at j before the flip, one afterwards.)

    Parameters
    ----------
    mesh : Mesh
        `origin`, `twin`, `locked` and `corner` change in the two faces, `twin` also at the
        half-edges that surround them.
    h : int
        Half-edge.
    """
    t = mesh.twin[h]
    j_k, k_i = following(h), previous(h)
    i_l, l_j = following(t), previous(t)
    i, j = mesh.origin[at(h)], mesh.origin[at(t)]
    k, l = mesh.origin[at(k_i)], mesh.origin[at(l_j)]
    at_i, at_j = mesh.corner[at(h)], mesh.corner[at(t)]
    at_k, at_l = mesh.corner[at(k_i)], mesh.corner[at(l_j)]
    a, b, c, d = at(j_k), at(k_i), at(i_l), at(l_j)
    outer = mesh.twin[a], mesh.twin[b], mesh.twin[c], mesh.twin[d]
    locks = mesh.locked[a], mesh.locked[b], mesh.locked[c], mesh.locked[d]

    mesh.origin[at(h)], mesh.origin[at(j_k)], mesh.origin[at(k_i)] = l, k, i
    mesh.origin[at(t)], mesh.origin[at(i_l)], mesh.origin[at(l_j)] = k, l, j
    mesh.corner[at(h)], mesh.corner[at(j_k)], mesh.corner[at(k_i)] = at_l, at_k, at_i
    mesh.corner[at(t)], mesh.corner[at(i_l)], mesh.corner[at(l_j)] = at_k, at_l, at_j
    _glue(mesh, j_k, outer[1], locks[1])
    _glue(mesh, k_i, outer[2], locks[2])
    _glue(mesh, i_l, outer[3], locks[3])
    _glue(mesh, l_j, outer[0], locks[0])
