"""The thorough search: chains of flips from several starts.

    for the mesh itself, and for the mesh after greedy descent on each of some other energies:
        lower the energy by chains of flips
    return the best of these states

Chains of flips (`meshlab_willmore.search.variable_depth`) leave most local minima, but from a bad
triangulation a few places stay tangled. What untangles them is another energy: the harmonic index
and the total absolute mean curvature see where the surface is rough from much further off, and
greedy descent on them takes no time beside the chains. On smooth surfaces that start is the best,
whatever the triangulation; where creases and folds matter, the mesh itself often is. Since the mesh
itself is always among the starts, the result is never worse than that of chains alone.

Random kicks around each edge followed by chains, kept where they helped, were tried too: they found
next to nothing more in ten times the time.
"""

import functools
from typing import NamedTuple

from ..guards.bvh import Bvh, inactive_bvh, refitted
from ..mesh.halfedge import Mesh
from ..mesh.jit import jit
from ..mesh.notify import stage
from . import greedy, variable_depth
from .rules import DEFAULTS, WORKING, Progress

# --- snapshots -----------------------------------------------------------------------------------


class Snapshot(NamedTuple):
    """A state of the mesh and its BVH, the number of flips on the way, and how that way ended."""

    mesh: Mesh
    bvh: Bvh
    flips: int
    state: int


def copy_of(mesh):
    """Return a mesh that shares nothing with `mesh` that flips change."""
    return mesh._replace(
        origin=mesh.origin.copy(),
        twin=mesh.twin.copy(),
        locked=mesh.locked.copy(),
        corner=mesh.corner.copy(),
        deviation=mesh.deviation.copy(),
    )


@jit
def assign(mesh, other):
    """Give `mesh`, in place, the connectivity of `other`, which has the same vertices."""
    mesh.origin[:] = other.origin
    mesh.twin[:] = other.twin
    mesh.locked[:] = other.locked
    mesh.corner[:] = other.corner
    mesh.deviation[:] = other.deviation


def snapshot_of(mesh, bvh):
    """Return the snapshot before the first flip, which shares the arrays."""
    return Snapshot(mesh, inactive_bvh() if bvh is None else bvh, 0, WORKING)


def extend(snapshot, search, rules):
    """Return the snapshot that a search reaches from another one, which is kept.

    Parameters
    ----------
    snapshot : Snapshot
    search : callable
        Takes a mesh, which it changes in place, the rules, and the BVH; returns its Progress.
    rules : Rules
        `maxflips` holds for the whole way.
    """
    mesh = copy_of(snapshot.mesh)
    bvh = refitted(snapshot.bvh, mesh)
    left = rules._replace(maxflips=rules.maxflips - snapshot.flips)
    progress = search(mesh, left, bvh)
    return Snapshot(mesh, bvh, snapshot.flips + progress.flips, progress.state)


def descend(kernels, snapshot, rules):
    """Return the snapshot that greedy descent reaches."""
    return extend(snapshot, functools.partial(greedy.run, kernels), rules)


def better(kernels, rules, one, other):
    """Return the snapshot of the lower energy; the first one unless `other` is lower for sure."""
    drop = kernels.total(one.mesh) - kernels.total(other.mesh)
    return other if drop > rules.tolerance else one


def finish(kernels, mesh, snapshot):
    """Bring `mesh`, the start, in place to a snapshot; return the way as Progress."""
    before = kernels.total(mesh)
    assign(mesh, snapshot.mesh)
    drop = float(before - kernels.total(mesh))
    return Progress(len(mesh.origin), snapshot.flips, drop, snapshot.state)


# --- the search ----------------------------------------------------------------------------------


def run(kernels, mesh, rules, bvh=None, settings=DEFAULTS):
    """Flip edges of `mesh` in place to the best state that chains reach from several starts.

    Parameters and result are those of `meshlab_willmore.search.greedy.run`, but the gain is the
    drop of the energy that judges. `Rules.maxflips` limits the flips on the way to each state. The
    monotone rule holds from each start, and the best state is no worse than the one that it leads
    to from the mesh itself.
    """

    def chains(mesh, rules, bvh):
        return variable_depth.run(kernels, mesh, rules, bvh, settings)

    begin = snapshot_of(mesh, bvh)
    starts = 1 + len(settings.warm_starts)
    with stage(f"start 1 of {starts}"):
        found = extend(begin, chains, rules)
    for number, (warm_kernels, warm_rules) in enumerate(settings.warm_starts, start=2):
        limited = warm_rules._replace(maxflips=rules.maxflips)
        with stage(f"start {number} of {starts}"):
            start = descend(warm_kernels, begin, limited)
            found = better(kernels, rules, found, extend(start, chains, rules))
    return finish(kernels, mesh, found)
