"""What the searches have in common: options, progress, and when a flip is refused."""

import math
from typing import NamedTuple

from .. import guards
from ..guards.intersections import blocking_face, would_intersect
from ..mesh.halfedge import NONE, apex, makes_new_edge
from ..mesh.jit import generic, inner
from .containers import contains, watch

WORKING, CONVERGED, STOPPED = range(3)
# Why a flip is refused; `REFUSED`: by a guard that looks at the two faces only.
ALLOWED, REFUSED, EXISTS, INTERSECTS = range(4)
NO_LIMIT = 2**62
# Ties that go round in circles are made this often.
MOST_PASSES = 10
# Scored edges, or tried flips, of one call of a kernel: some hundredths of a second. Interrupts are
# served between two calls.
WORK_PER_CALL = 40_000

# The share of a pass in the time of what is left, where ties may ask for more passes.
PASS_SHARE = 0.95


class Rules(NamedTuple):
    """Which flips are made.

    Attributes
    ----------
    fold : FoldLimits
        The fold guard.
    monotone : bool
        Whether the Willmore energy must not rise.
    maxflips : int
        Number of flips after which to stop.
    tolerance : float
        A cost reduction must exceed this (in units of the energy); planar parallelograms tie at 0.
    tie : float
        A change of the Willmore energy (radians) up to this counts as none.
    rank_step : float
        Cost reductions are ranked in steps of this size (in units of the energy). Edges that are
        equal by symmetry then go by number, and not by rounding, which a rotation would change.
    is_potential, is_wide, is_narrow : bool
        As in `meshlab_willmore.energy.table.Energy`.
    virtualpoint : float
        Place of the virtual points in (0, 1), for the energies that ask for it.
    maxdeviation : float
        How far, at unit scale, flips may take the surface from the input.
    """

    fold: guards.FoldLimits
    monotone: bool = True
    maxflips: int = NO_LIMIT
    tolerance: float = 1e-7
    tie: float = 1e-12
    rank_step: float = 1e-9
    is_potential: bool = False
    is_wide: bool = False
    is_narrow: bool = False
    virtualpoint: float = 0.5
    maxdeviation: float = math.inf


class ChainLimits(NamedTuple):
    """How far chains of flips go.

    Attributes
    ----------
    depth : int
        Most flips of a chain, at least 1.
    breadth : int
        Number of edges, 1 to 12, that are tried for the second flip of a chain; half as many,
        rounded up, for the third, and so on. 1: chains do not branch.
    """

    depth: int = 5
    breadth: int = 3


class Schedule(NamedTuple):
    """How the temperature of the annealing falls.

    Attributes
    ----------
    sweeps : int
        Number of temperatures, at least 1; at each, as many flips are tried as there are edges.
    seed : int
        Of the random numbers, at least 0.
    hot, cold : float
        First and last temperature, as multiples of the median loss of a flip.
    """

    sweeps: int = 200
    seed: int = 0
    hot: float = 0.3
    cold: float = 0.05


class Settings(NamedTuple):
    """What single searches ask for beside the rules.

    Attributes
    ----------
    limits : ChainLimits
        For "variable depth" and "thorough".
    schedule : Schedule
        For "annealing".
    warm_starts : tuple of (Kernels, Rules)
        For "variable depth" and "thorough": the energies along which greedy descent makes one more
        start each.
    threads : int or None
        As many as Numba is set to if None. The result does not depend on it.
    """

    limits: ChainLimits = ChainLimits()
    schedule: Schedule = Schedule()
    warm_starts: tuple = ()
    threads: int | None = None


DEFAULTS = Settings()


class Progress(NamedTuple):
    """How far a search is: half-edges scored at first, flips made, their cost reductions, state."""

    scored: int
    flips: int
    gain: float
    state: int


def rest_of(maxflips, flips):
    """Return how many flips of a limit are left after some; without a limit, `NO_LIMIT`."""
    return maxflips if maxflips == NO_LIMIT else maxflips - flips


def is_finished(rules, progress, flips, tabu_hit):
    """Whether a greedy search is through; else it goes on with an empty tabu set.

    Parameters
    ----------
    rules : Rules
        Without the monotone rule no edge ever comes back.
    progress : Progress
        At the end of a pass.
    flips : int
        How many there were before that pass.
    tabu_hit : (1,) bool
        Whether a flip was refused in that pass for an edge of the tabu set.
    """
    is_stuck = progress.state == STOPPED or progress.flips == flips
    return is_stuck or not (rules.monotone and tabu_hit[0])


def pass_share(rules):
    """Return about what share of the time that is left a pass of a greedy search takes."""
    return PASS_SHARE if rules.monotone else 1.0


@inner
def refusal(mesh, h, rules):
    """Return why the flip of `h`, which is free, is refused, or `ALLOWED`.

    Searches ask whether an edge is free first, then for its cost reduction, then this.
    """
    if guards.folds(mesh, h, rules.fold) or guards.deviates(mesh, h, rules.maxdeviation):
        return REFUSED
    # Last, since it alone takes longer than O(1).
    return ALLOWED if makes_new_edge(mesh, h) else EXISTS


@generic
def refusal_by_all(mesh, bvh, h, rules):
    """Return why the flip of `h`, which is free, is refused, also by the intersection guard."""
    reason = refusal(mesh, h, rules)
    if reason == ALLOWED and would_intersect(mesh, bvh, h):
        return INTERSECTS
    return reason


@inner
def is_tabu(mesh, tabu, h):
    """Whether the flip of `h` makes an edge of the tabu set."""
    return contains(tabu, apex(mesh, h), apex(mesh, mesh.twin[h]))


@inner
def is_blocked(task, h, since):
    """Whether a new face would cut another one; if so, `h` watches that face.

    Parameters
    ----------
    task : namedtuple
        Of it the mesh, its `bvh`, and the `watch_lists`.
    h : int
        Half-edge that may be flipped.
    since : int
        As for `meshlab_willmore.guards.intersections.blocking_face`.
    """
    face = blocking_face(task.mesh, task.bvh, h, since)
    if not task.bvh.active or face == NONE:
        return False
    watch(task.watch_lists, h, face)
    return True
