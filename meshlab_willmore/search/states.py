"""States of a mesh that a search compares, and how it gets from one to the next.

A search that tries several ways keeps what each of them reaches: the mesh, the number of flips on
the way there, and whether that way was gone to its end.
"""

import functools
from typing import NamedTuple

from ..guards.bvh import Bvh, refitted
from ..mesh.halfedge import Mesh
from ..mesh.jit import jit
from . import greedy
from .rules import WORKING, Progress


class State(NamedTuple):
    """A state of the mesh and its index, number of flips on the way, how that way ended."""

    mesh: Mesh
    space: Bvh
    flips: int
    state: int


def copy_of(mesh):
    """Return a mesh that shares nothing with `mesh` that flips change."""
    return mesh._replace(
        origin=mesh.origin.copy(),
        twin=mesh.twin.copy(),
        locked=mesh.locked.copy(),
        corner=mesh.corner.copy(),
    )


@jit
def assign(mesh, other):
    """Give `mesh`, in place, the connectivity of `other`, which has the same vertices."""
    mesh.origin[:] = other.origin
    mesh.twin[:] = other.twin
    mesh.locked[:] = other.locked
    mesh.corner[:] = other.corner


def start_from(mesh, space):
    """Return `mesh` as the state before the first flip."""
    return State(mesh, space, 0, WORKING)


def extend(state, search, rules):
    """Return the state that a search reaches from `state`, which is kept.

    Parameters
    ----------
    state : State
    search : callable
        Takes a mesh and its index, which it changes in place, and the rules; returns its Progress.
    rules : Rules
        `maxflips` holds for the whole way.
    """
    mesh = copy_of(state.mesh)
    space = refitted(state.space, mesh)
    left = rules._replace(maxflips=rules.maxflips - state.flips)
    progress = search(mesh, left, space)
    return State(mesh, space, state.flips + progress.flips, progress.state)


def descend(kernels, state, rules):
    """Return the state that greedy descent reaches from `state`."""
    return extend(state, functools.partial(greedy.run, kernels.greedy), rules)


def better(kernels, rules, one, other):
    """Return the state of the lower energy; the first one unless `other` is lower for sure."""
    drop = kernels.total(one.mesh) - kernels.total(other.mesh)
    return other if drop > rules.tolerance else one


def finish(kernels, mesh, state):
    """Bring `mesh`, the start, in place to a state; return the way as Progress."""
    before = kernels.total(mesh)
    assign(mesh, state.mesh)
    drop = float(before - kernels.total(mesh))
    return Progress(len(mesh.origin), state.flips, drop, state.state)
