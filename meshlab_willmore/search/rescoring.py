"""The rank of an edge in the queue of the greedy search, and keeping it up to date.

`rescore` stands in a module of its own because Numba keeps no kernel on disk that names a function
of its own module as an argument; as an attribute of a module it may.
"""

import numpy as np

from .. import guards
from ..energy import willmore
from ..mesh.halfedge import NONE, is_free, makes_new_edge
from ..mesh.jit import generic
from .heap import NEVER, update
from .scoring import gain_of


@generic
def rank(mesh, h, rules, cost_reduction):
    """Return the rank of `h` in the queue, or `NEVER` where it must not be flipped."""
    if not is_free(mesh, h):
        return NEVER
    gain = gain_of(cost_reduction, mesh, h, rules)
    if not gain > rules.tolerance:
        return NEVER
    if rules.monotone and willmore.cost_reduction(mesh, h) < -rules.tie:
        return NEVER
    if guards.folds(mesh, h, rules.fold):
        return NEVER
    # Last, since it alone takes longer than O(1).
    if not makes_new_edge(mesh, h):
        return NEVER
    return np.rint(gain / rules.rank_step)


@generic
def rescore(task, h, cost_reduction):
    """Bring the queue up to date with the edge of `h`; its entry stands under the lower twin."""
    t = task.mesh.twin[h]
    if t == NONE:
        update(task.queue, h, NEVER)
        return
    low, high = min(h, t), max(h, t)
    update(task.queue, high, NEVER)
    update(task.queue, low, rank(task.mesh, low, task.rules, cost_reduction))
