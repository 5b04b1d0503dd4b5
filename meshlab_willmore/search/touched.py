"""Which edges a flip touches: those whose cost reduction, or leave to flip, it may change.

Each function takes what to do with such an edge: a jitted function of the task (of which only the
mesh is used here), one of the edge's half-edges, and the energy, which is handed on.
"""

import numpy as np

from ..mesh.halfedge import NONE, apex, following, next_in_fan, previous
from ..mesh.jit import at, generic

# Edges at and opposite to the corners of a diamond where all is regular.
IN_FANS = 72


@generic
def visit_around(task, h, visit, energy):
    """Visit the at most 13 edges whose cost reduction the flip of `h` has changed."""
    mesh = task.mesh
    t = mesh.twin[at(h)]
    visit(task, h, energy)
    for side in (following(h), previous(h), following(t), previous(t)):
        visit(task, side, energy)
        outside = mesh.twin[at(side)]
        if outside != NONE:
            visit(task, following(outside), energy)
            visit(task, previous(outside), energy)


@generic
def visit_fans(task, h, visit, energy):
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
            visit(task, x, energy)
            visit(task, previous(x), energy)
            visit(task, following(x), energy)
            edges += 3
            x = next_in_fan(mesh, x)
            if x == spoke:
                break
    return edges * edges // IN_FANS


@generic
def _visit_opposite(task, spoke, v, visit, energy):
    """Visit the edge opposite to the origin of `spoke` if the apex on its other side is `v`."""
    side = following(spoke)
    outside = task.mesh.twin[at(side)]
    if outside != NONE and apex(task.mesh, outside) == v:
        visit(task, side, energy)


@generic
def visit_freed(task, h, visit, energy):
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
        _visit_opposite(task, x, j, visit, energy)
        _visit_opposite(task, y, i, visit, energy)
        x, y = next_in_fan(mesh, x), next_in_fan(mesh, y)
        if (x == a and not mesh.several_fans[i]) or (y == b and not mesh.several_fans[j]):
            break
