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

The random numbers come from the PCG64 generator of NumPy, drawn ahead of each slice: the same seed
gives the same flips on every machine, up to what rounding decides.
"""

from typing import NamedTuple

import numpy as np

from .. import guards
from ..guards.bvh import Bvh, inactive_bvh, refit, refitted
from ..guards.intersections import would_intersect
from ..mesh.halfedge import NONE, Mesh, flip, is_free, makes_new_edge
from ..mesh.jit import generic, inner
from ..mesh.notify import report
from .rules import CONVERGED, STOPPED, WORKING, Rules
from .states import State, assign, better, copy_of, descend, finish, start_from

# Tries between two looks at the keyboard: some hundredths of a second.
SLICE = 40_000


class Schedule(NamedTuple):
    """How the temperature falls.

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


class Task(NamedTuple):
    """What the search works on; it changes all but the rules in place.

    Attributes
    ----------
    mesh : Mesh
        The state at hand.
    best : Mesh
        The best state seen.
    journal : (s,) int32
        Half-edges flipped since the slice began.
    rules : Rules
    space : Bvh
        The guard against self-intersections, up to date with `mesh`.
    """

    mesh: Mesh
    best: Mesh
    journal: np.ndarray
    rules: Rules
    space: Bvh


class Walk(NamedTuple):
    """How far the annealing is: flips and drop of the judge, here and at the best state; state."""

    flips: int
    drop: float
    best_flips: int
    best_drop: float
    state: int


@inner
def may_flip(mesh, h, rules):
    """Tell whether connectivity, locks and guards allow to flip `h`, energies aside."""
    return is_free(mesh, h) and not guards.folds(mesh, h, rules.fold) and makes_new_edge(mesh, h)


@inner
def _keep_best(task, done, best):
    """Make the state after the first `best` of the `done` flips of the journal the best one."""
    assign(task.best, task.mesh)
    for s in range(done - 1, best - 1, -1):
        # Four flips in a row change nothing, so three take one back.
        for _ in range(3):
            flip(task.best, task.journal[s])


@generic
def advance(task, walk, draws, temperature, judge):
    """Try as many flips as there are rows of random numbers, at one temperature.

    Parameters
    ----------
    task : Task
        Changed in place; the journal has room for as many flips.
    walk : Walk
        Where to go on.
    draws : (s, 2) float64
        Uniform in [0, 1): which half-edge, and whether it is flipped at a loss.
    temperature : float
        Positive, in units of the energy.
    judge : callable
        Jitted function of a mesh and a half-edge: the cost reduction, of a potential.

    Returns
    -------
    tuple
        The fields of the new Walk.
    """
    mesh, rules = task.mesh, task.rules
    flips, drop, best_flips, best_drop, state = walk
    done, best = 0, NONE
    for s in range(len(draws)):
        h = np.int64(draws[s, 0] * len(mesh.origin))
        if not is_free(mesh, h):
            continue
        gain = judge(mesh, h)
        # A cost reduction of minus infinity never passes.
        if not (gain >= 0.0 or draws[s, 1] < np.exp(gain / temperature)):
            continue
        if not may_flip(mesh, h, rules) or would_intersect(mesh, task.space, h):
            continue
        if flips == rules.maxflips:
            state = STOPPED
            break
        flip(mesh, h)
        refit(mesh, task.space, h)
        task.journal[done] = h
        done += 1
        flips += 1
        drop += gain
        if drop > best_drop + rules.tolerance:
            best, best_flips, best_drop = done, flips, drop
    if best != NONE:
        _keep_best(task, done, best)
    return flips, drop, best_flips, best_drop, state


@generic
def find_losses(mesh, rules, first, losses, judge):
    """Write the losses of the allowed flips of half-edges from `first` on into `losses`.

    Parameters
    ----------
    losses : (s,) float64
        Overwritten, for s half-edges: 0 where a flip is not allowed or no loss.
    """
    for place in range(len(losses)):
        h = first + place
        losses[place] = 0.0
        if h < mesh.twin[h] and is_free(mesh, h):
            gain = judge(mesh, h)
            if -np.inf < gain < 0.0 and may_flip(mesh, h, rules):
                losses[place] = -gain


def _median_loss(kernels, mesh, rules):
    """Return the median of the losses of the allowed flips, or 0 if there are none."""
    found = [np.empty(0)]
    for first in range(0, len(mesh.origin), SLICE):
        losses = np.empty(min(SLICE, len(mesh.origin) - first))
        kernels.losses(mesh, rules, first, losses)
        found.append(losses[losses > 0.0])
    losses = np.concatenate(found)
    return float(np.median(losses)) if len(losses) else 0.0


def _sweep(kernel, task, schedule, loss):
    """Try the flips of all sweeps, slice by slice, until the limit of flips is reached."""
    random = np.random.default_rng(schedule.seed)
    edges = len(task.mesh.origin) // 2
    walk = Walk(0, 0.0, 0, 0.0, WORKING)
    for sweep in range(schedule.sweeps):
        share = sweep / max(schedule.sweeps - 1, 1)
        temperature = loss * schedule.hot * (schedule.cold / schedule.hot) ** share
        for tried in range(0, edges, SLICE):
            draws = random.random((min(SLICE, edges - tried), 2))
            walk = Walk(*kernel(task, walk, draws, temperature))
            report(f"temperature {sweep + 1} of {schedule.sweeps}, {walk.flips} flips")
            if walk.state == STOPPED:
                return walk
    return walk._replace(state=CONVERGED)


def _anneal(kernels, begin, rules, schedule, loss):
    """Return the last and the best state of the annealing that begins at the state `begin`."""
    mesh, best = copy_of(begin.mesh), copy_of(begin.mesh)
    space, journal = refitted(begin.space, mesh), np.empty(SLICE, np.int32)
    left = rules._replace(maxflips=rules.maxflips - begin.flips)
    walk = _sweep(kernels.anneal, Task(mesh, best, journal, left, space), schedule, loss)
    at_best = refitted(space, best)
    return (
        State(mesh, space, begin.flips + walk.flips, walk.state),
        State(best, at_best, begin.flips + walk.best_flips, walk.state),
    )


def run(kernels, mesh, rules, schedule, space=None):
    """Flip edges of `mesh` in place to the best state that annealing and descents find.

    Parameters
    ----------
    kernels : Kernels
        For one energy.
    mesh : Mesh
    rules : Rules
        `maxflips` limits the flips on the way to each state, those that others take back counted
        too. `monotone` holds for the descents.
    schedule : Schedule
    space : Bvh, optional
        The guard against self-intersections, up to date with the mesh. It holds for each flip.

    Returns
    -------
    Progress
        `flips` on the way to the result; `gain`: the drop of the energy that judges; the state is
        `CONVERGED` or `STOPPED`.
    """
    begin = start_from(mesh, inactive_bvh() if space is None else space)
    found = descend(kernels, begin, rules)
    loss = 0.0 if found.state == STOPPED else _median_loss(kernels, found.mesh, rules)
    if loss > 0.0:
        for state in _anneal(kernels, found, rules, schedule, loss):
            ended = state if state.state == STOPPED else descend(kernels, state, rules)
            found = better(kernels, rules, found, ended)
    return finish(kernels, mesh, found)
