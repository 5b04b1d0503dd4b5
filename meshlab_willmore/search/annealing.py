"""Annealing: random flips that may go through a loss, the less so the colder it gets.

    descend greedily
    for each temperature of a falling geometric series:
        as many times as there are edges:
            take an edge at random
            if its flip is allowed and gains g, make it: always if g >= 0, else with the
            probability exp(g / temperature)
            remember the best state
    descend greedily, from the last state and from the best
    return the best of all these states

It is the rule of N. Metropolis et al. ("Equation of state calculations by fast computing machines",
1953, DOI 10.1063/1.1699114) with the cooling of S. Kirkpatrick, C. D. Gelatt and M. P. Vecchi
("Optimization by simulated annealing", 1983, DOI 10.1126/science.220.4598.671). The temperatures
come from the mesh itself: they are multiples of the median loss among the flips that are allowed
in the greedy result.

The *judge* says what a flip gains here. As in `meshlab_willmore.search.variable_depth` it must be
the difference of a potential; for the virtual Willmore energy, which has none, it is the Willmore
energy, and the virtual one leads the descents only. (Without the monotone rule these may raise what
the annealing has gained; the states after the descents are compared.) The greedy result is one of
the states that the best is chosen from, so annealing is never worse.

The random numbers come from the PCG64 generator of NumPy, drawn ahead of each call: the same
seed gives the same flips on every machine, up to what rounding decides.
"""

from typing import NamedTuple

import numpy as np

from ..energy import willmore
from ..guards import add_deviation
from ..guards.bvh import Bvh, refit, refitted
from ..mesh.halfedge import NONE, Mesh, flip, is_free
from ..mesh.jit import inner
from ..progress import report, stage
from .rules import (
    ALLOWED,
    CONVERGED,
    DEFAULTS,
    STOPPED,
    WORK_PER_CALL,
    WORKING,
    Rules,
    refusal,
    refusal_by_all,
    rest_of,
)
from .snapshots import Snapshot, assign, better, copy_of, descend, finish, snapshot_of

# The judge: `meshlab_willmore.search.compiled` puts the module of each potential in this place.
energy = willmore
# How long the descents before and each one after the sweeps take, in sweeps, measured on scans.
BEFORE, AFTER = 5.0, 2.0


class AnnealingState(NamedTuple):
    """State of the search; all but the rules changes in place.

    Attributes
    ----------
    mesh : Mesh
        The triangulation at hand.
    best : Mesh
        The best one seen.
    journal : (s,) int32
        Half-edges flipped since the call of the kernel began.
    before : (s, 2) float64
        What `Mesh.deviation` was at their two faces.
    rules : Rules
    bvh : Bvh
        The guard against self-intersections, up to date with `mesh`.
    """

    mesh: Mesh
    best: Mesh
    journal: np.ndarray
    before: np.ndarray
    rules: Rules
    bvh: Bvh


class AnnealingProgress(NamedTuple):
    """Flips and drop of the judge, here and at the best triangulation; state."""

    flips: int
    drop: float
    best_flips: int
    best_drop: float
    state: int


@inner
def _keep_best(state, done, best):
    """Make the mesh after the first `best` of the `done` flips of the journal the best one."""
    assign(state.best, state.mesh)
    for s in range(done - 1, best - 1, -1):
        # Four flips in a row change nothing, so three take one back.
        h = state.journal[s]
        for _ in range(3):
            flip(state.best, h)
        state.best.deviation[h // 3] = state.before[s, 0]
        state.best.deviation[state.best.twin[h] // 3] = state.before[s, 1]


def anneal(state, progress, draws, temperature):
    """Try as many flips as there are rows of random numbers, at one temperature.

    Parameters
    ----------
    state : AnnealingState
        Changed in place; the journal has room for as many flips.
    progress : AnnealingProgress
        Where to go on.
    draws : (s, 2) float64
        Uniform in [0, 1): which half-edge, and whether it is flipped at a loss.
    temperature : float
        Positive, in units of the energy.

    Returns
    -------
    tuple
        The fields of the new AnnealingProgress.
    """
    mesh, rules = state.mesh, state.rules
    flips, drop, best_flips, best_drop, outcome = progress
    done, best = 0, NONE
    for s in range(len(draws)):
        h = np.int64(draws[s, 0] * len(mesh.origin))
        if not is_free(mesh, h):
            continue
        gain = energy.cost_reduction(mesh, h)
        # A cost reduction of minus infinity never passes.
        if not (gain >= 0.0 or draws[s, 1] < np.exp(gain / temperature)):
            continue
        if refusal_by_all(mesh, state.bvh, h, rules) != ALLOWED:
            continue
        if flips == rules.maxflips:
            outcome = STOPPED
            break
        state.journal[done] = h
        state.before[done, 0] = mesh.deviation[h // 3]
        state.before[done, 1] = mesh.deviation[mesh.twin[h] // 3]
        flip(mesh, h)
        add_deviation(mesh, h)
        refit(mesh, state.bvh, h)
        done += 1
        flips += 1
        drop += gain
        if drop > best_drop + rules.tolerance:
            best, best_flips, best_drop = done, flips, drop
    if best != NONE:
        _keep_best(state, done, best)
    return flips, drop, best_flips, best_drop, outcome


def find_losses(mesh, rules, first, losses):
    """Write the losses of the allowed flips of half-edges from `first` on into `losses`.

    Parameters
    ----------
    mesh : Mesh
    rules : Rules
    first : int
    losses : (s,) float64
        Overwritten, for s half-edges: 0 where a flip is not allowed or no loss.
    """
    for place in range(len(losses)):
        h = first + place
        losses[place] = 0.0
        if h < mesh.twin[h] and is_free(mesh, h):
            gain = energy.cost_reduction(mesh, h)
            if -np.inf < gain < 0.0 and refusal(mesh, h, rules) == ALLOWED:
                losses[place] = -gain


def _median_loss(kernels, mesh, rules):
    """Return the median of the losses of the allowed flips, or 0 if there are none."""
    found = [np.empty(0)]
    for first in range(0, len(mesh.origin), WORK_PER_CALL):
        losses = np.empty(min(WORK_PER_CALL, len(mesh.origin) - first))
        kernels.losses(mesh, rules, first, losses)
        found.append(losses[losses > 0.0])
    losses = np.concatenate(found)
    return float(np.median(losses)) if len(losses) else 0.0


def _sweep(kernels, state, schedule, loss):
    """Try the flips of all sweeps, call by call, until the limit of flips is reached."""
    random = np.random.default_rng(schedule.seed)
    edges = len(state.mesh.origin) // 2
    progress = AnnealingProgress(0, 0.0, 0, 0.0, WORKING)
    for sweep in range(schedule.sweeps):
        part = sweep / max(schedule.sweeps - 1, 1)
        temperature = loss * schedule.hot * (schedule.cold / schedule.hot) ** part
        for tried in range(0, edges, WORK_PER_CALL):
            draws = random.random((min(WORK_PER_CALL, edges - tried), 2))
            progress = AnnealingProgress(*kernels.anneal(state, progress, draws, temperature))
            done = (sweep + (tried + len(draws)) / edges) / schedule.sweeps
            text = f"temperature {sweep + 1} of {schedule.sweeps}, {progress.flips} flips"
            report(done, text)
            if progress.state == STOPPED:
                return progress
    return progress._replace(state=CONVERGED)


def _anneal(kernels, begin, rules, schedule, loss):
    """Return the last and the best snapshot of the annealing that begins at another one."""
    mesh, best = copy_of(begin.mesh), copy_of(begin.mesh)
    bvh = refitted(begin.bvh, mesh)
    journal, before = np.empty(WORK_PER_CALL, np.int32), np.empty((WORK_PER_CALL, 2))
    left = rules._replace(maxflips=rest_of(rules.maxflips, begin.flips))
    state = AnnealingState(mesh, best, journal, before, left, bvh)
    progress = _sweep(kernels, state, schedule, loss)
    at_best = refitted(bvh, best)
    return (
        Snapshot(mesh, bvh, begin.flips + progress.flips, progress.state),
        Snapshot(best, at_best, begin.flips + progress.best_flips, progress.state),
    )


def run(kernels, mesh, rules, bvh=None, settings=DEFAULTS):
    """Flip edges of `mesh` in place to the best state that annealing and descents find.

    Parameters and result are those of `meshlab_willmore.search.greedy.run`, but the gain is the
    drop of the energy that judges. `Rules.maxflips` limits the flips on the way to each state,
    those that others take back counted too. `Rules.monotone` holds for the descents.
    """
    sweeps = settings.schedule.sweeps
    with stage(BEFORE / (BEFORE + sweeps + 2.0 * AFTER)):
        found = descend(kernels, snapshot_of(mesh, bvh), rules)
    loss = 0.0 if found.state == STOPPED else _median_loss(kernels, found.mesh, rules)
    if loss > 0.0:
        with stage(sweeps / (sweeps + 2.0 * AFTER)):
            snapshots = _anneal(kernels, found, rules, settings.schedule, loss)
        for snapshot, part in zip(snapshots, (0.5, 1.0), strict=True):
            with stage(part):
                ended = snapshot if snapshot.state == STOPPED else descend(kernels, snapshot, rules)
            found = better(kernels, rules, found, ended)
    return finish(kernels, mesh, found)
