"""What searches have in common: the rules of a run, how far it is, when a flip is refused."""

from typing import NamedTuple

from .. import guards
from ..guards.intersections import ANY_ROUND, blocking_face
from ..mesh.halfedge import NONE, apex
from ..mesh.jit import inner
from .pairs import contains
from .waiting import wait

WORKING, CONVERGED, STOPPED = range(3)
NO_LIMIT = 2**62
# Ties that go round in circles are made this often.
MOST_PASSES = 10


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
    is_potential, is_wide : bool
        As in `meshlab_willmore.energy.table.Energy`.
    virtualpoint : float
        Place of the virtual points in (0, 1), for the energies that ask for it.
    """

    fold: guards.FoldLimits
    monotone: bool = True
    maxflips: int = NO_LIMIT
    tolerance: float = 1e-7
    tie: float = 1e-12
    rank_step: float = 1e-9
    is_potential: bool = False
    is_wide: bool = False
    virtualpoint: float = 0.5


class Progress(NamedTuple):
    """How far a search is: half-edges scored at first, flips made, their cost reductions, state."""

    scored: int
    flips: int
    gain: float
    state: int


def is_final(rules, progress, flips, kept_away):
    """Tell whether a greedy search is through, or has to go on with no edge kept away any more.

    Parameters
    ----------
    rules : Rules
        Without the monotone rule no edge ever comes back.
    progress : Progress
        At the end of a pass.
    flips : int
        How many there were before that pass.
    kept_away : (1,) bool
        Whether a flip was refused in that pass for an edge that must stay away.
    """
    is_stuck = progress.state == STOPPED or progress.flips == flips
    return is_stuck or not (rules.monotone and kept_away[0])


@inner
def brings_back(mesh, gone, h):
    """Tell whether the flip of `h` makes an edge of `gone`, which has to stay away."""
    return contains(gone, apex(mesh, h), apex(mesh, mesh.twin[h]))


@inner
def is_blocked(task, h):
    """Tell whether a new face would cut another one, and if so, wait until that changes.

    Parameters
    ----------
    task : namedtuple
        Of it the mesh, its index `space` and the edges that are `waiting`.
    h : int
        Half-edge that may be flipped.
    """
    return must_wait(task, h, blocking_face(task.mesh, task.space, h, ANY_ROUND))


@inner
def must_wait(task, h, face):
    """Let `h` wait until the face that blocks it changes, if there is one; tell whether."""
    if not task.space.active or face == NONE:
        return False
    wait(task.waiting, h, face)
    return True
