"""Snapshots of a search: states of a mesh to which several ways lead; the best one counts."""

import functools
from typing import NamedTuple

from ..guards.bvh import Bvh, inactive_bvh, refitted
from ..mesh.halfedge import Mesh
from ..mesh.jit import allocating_jit
from . import greedy
from .rules import WORKING, Progress, rest_of

# The part of an energy below which a difference may be rounding.
ROUNDING = 1e-12


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


@allocating_jit
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
    left = rules._replace(maxflips=rest_of(rules.maxflips, snapshot.flips))
    progress = search(mesh, left, bvh)
    return Snapshot(mesh, bvh, snapshot.flips + progress.flips, progress.state)


def descend(kernels, snapshot, rules):
    """Return the snapshot that greedy descent reaches."""
    return extend(snapshot, functools.partial(greedy.run, kernels), rules)


def better(kernels, rules, one, other):
    """Return the snapshot of the lower energy; the first one unless `other` is lower for sure."""
    before, after = kernels.total(one.mesh), kernels.total(other.mesh)
    return other if before - after > max(rules.tolerance, ROUNDING * abs(before)) else one


def finish(kernels, mesh, snapshot):
    """Bring `mesh`, the start, in place to a snapshot; return the way as Progress."""
    before = kernels.total(mesh)
    assign(mesh, snapshot.mesh)
    drop = float(before - kernels.total(mesh))
    return Progress(len(mesh.origin), snapshot.flips, drop, snapshot.state)
