"""The stencil of a flip: the edges whose cost reduction, or permission to flip, it may change.

Each function takes what to do with such an edge: a jitted function of the task (of which only the
mesh is used here), one of the edge's half-edges, and an argument that is handed on. It returns
whether to stop there, which only `visit_ring` and `visit_stencil` do.
"""

from typing import NamedTuple

import numpy as np

from ..mesh.halfedge import NONE, Mesh, apex, following, next_in_fan, previous
from ..mesh.jit import at, generic, inlined, inner

# Most edges of a ring.
RING = 12
# Edges at and opposite to the corners of a diamond where all is regular.
FAN_EDGES = 48


class EdgeList(NamedTuple):
    """A task for `append`: room for edges, (s,) int32, and in `size` (1,) how many there are."""

    mesh: Mesh
    edges: np.ndarray
    size: np.ndarray


@inner
def append(found, h, _):
    """Write `h` into the list, if there is room, and count it."""
    if found.size[0] < len(found.edges):
        found.edges[found.size[0]] = h
    found.size[0] += 1
    return False


@inlined
def visit_ring(task, h, visit, argument):
    """Visit the sides of the diamond of `h`, and the other sides of the faces outside.

    These at most `RING` edges and that of `h` itself are those whose cost reductions the flip of
    `h` changes.

    Returns
    -------
    bool
        Whether a visit said to stop there.
    """
    mesh = task.mesh
    t = mesh.twin[at(h)]
    for side in (following(h), previous(h), following(t), previous(t)):
        if visit(task, side, argument):
            return True
        outside = mesh.twin[at(side)]
        if outside == NONE:
            continue
        if visit(task, following(outside), argument):
            return True
        if visit(task, previous(outside), argument):
            return True
    return False


@generic
def visit_stencil(task, h, visit, argument):
    """Visit the edge of `h`, and those of its ring."""
    return visit(task, h, argument) or visit_ring(task, h, visit, argument)


@generic
def visit_quad(task, h, visit, argument):
    """Visit the edge of `h`, and the sides of its diamond."""
    t = np.int64(task.mesh.twin[at(h)])
    for edge in (h, following(h), previous(h), following(t), previous(t)):
        visit(task, edge, argument)


@generic
def visit_fans(task, h, visit, argument):
    """Visit the edges at, and opposite to, the corners of the diamond of `h`.

    Returns
    -------
    int
        What that costs: each score walks round such a corner again.
    """
    mesh, edges = task.mesh, 0
    t = np.int64(mesh.twin[at(h)])
    for spoke in (h, previous(h), t, previous(t)):
        # A vertex of several fans has no curvature, but its faces still have the other corners.
        x = spoke
        while True:
            # The third side of the face is the next spoke, or has no twin.
            visit(task, x, argument)
            visit(task, following(x), argument)
            edges += 2
            x = next_in_fan(mesh, x)
            if x == spoke:
                break
    return edges * edges // FAN_EDGES


@generic
def _visit_opposite(task, spoke, v, visit, argument):
    """Visit the edge opposite to the origin of `spoke` if the apex on its other side is `v`."""
    side = following(spoke)
    outside = task.mesh.twin[at(side)]
    if outside != NONE and apex(task.mesh, outside) == v:
        visit(task, side, argument)


@generic
def visit_freed(task, h, visit, argument):
    """Visit the edges whose flip was forbidden because it leads to i-j, which `h` was before.

    They lie opposite to i and to j, so it is enough to walk round one of both; as in `are_joined`
    both are walked in step. Where both have several fans, no edge can be flipped to i-j.
    """
    mesh = task.mesh
    a, b = previous(h), previous(mesh.twin[at(h)])
    i, j = mesh.origin[a], mesh.origin[b]
    if mesh.several_fans[i] and mesh.several_fans[j]:
        return
    x, y = a, b
    while True:
        _visit_opposite(task, x, j, visit, argument)
        _visit_opposite(task, y, i, visit, argument)
        x, y = next_in_fan(mesh, x), next_in_fan(mesh, y)
        if (x == a and not mesh.several_fans[i]) or (y == b and not mesh.several_fans[j]):
            break
