"""Running passes on a half-edge mesh: the table of searches, and their rules and limits."""

import logging
import math
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from . import guards
from .energy.table import AT, ENERGIES
from .folds import faces_at_bends, faces_near_folds, least_cosines, locked_outside
from .guards.bvh import build_bvh, inactive_bvh
from .measure import intersecting_faces_of
from .mesh.build import faces_of
from .mesh.halfedge import lengths_of_sides
from .mesh.normals import vertex_normals
from .mesh.validate import in_input_units
from .progress import report, stage
from .results import PassResult
from .search import annealing, greedy, multistart, parallel_greedy, variable_depth
from .search.compiled import KERNELS, PLACED_KERNELS, TILT_KERNELS
from .search.rules import CONVERGED, ChainLimits, Rules, Schedule, Settings, rest_of
from .search.snapshots import assign, copy_of

_log = logging.getLogger(__name__)

NO_FLIP = "no allowed flip lowers the energy any more"
NO_CHAIN = "no allowed chain of flips lowers the energy any more"
STOPPED_REASON = "maxflips reached"
# Cost reductions are ranked in steps of this part of the median edge, to the energy's power.
RANK_STEP = 1e-9
# Steps of the unit of length, and the least median edge that has one.
UNIT_STEP, SHORTEST = 16.0, 1e-30


class Search(NamedTuple):
    """A search.

    Attributes
    ----------
    run : callable
        With the parameters and the result of `meshlab_willmore.search.greedy.run`.
    converged : str
        What it means that it has converged.
    is_random : bool
        Whether flips go to and fro, so that their number says nothing of the result: then the edges
        that have changed are counted.
    warm_starts : tuple of str
        Energies along which greedy descent makes one more start each. Chains begin at the better
        one of the first of them and the mesh itself.
    work, work_per_sweep : float
        About how long it takes, measured on scans; "parallel greedy" takes 1.
    """

    run: Callable
    converged: str
    is_random: bool = False
    warm_starts: tuple[str, ...] = ()
    work: float = 1.0
    work_per_sweep: float = 0.0


SEARCHES = {
    "parallel greedy": Search(parallel_greedy.run, NO_FLIP),
    "greedy": Search(greedy.run, NO_FLIP, work=4.0),
    "variable depth": Search(variable_depth.run, NO_CHAIN, warm_starts=("delaunay",), work=100.0),
    "annealing": Search(annealing.run, NO_FLIP, is_random=True, work=9.0, work_per_sweep=1.5),
    "thorough": Search(
        multistart.run, NO_CHAIN, warm_starts=("delaunay", "mean curvature"), work=300.0
    ),
}
# What the guard against intersections adds to it, and the parts of it that passes at folds and at
# bends take.
GUARD, AT_FOLDS, AT_BENDS = 3.0, 0.002, 0.3
# The share in the time of a pass in which the guard is built.
BUILDING = 0.15
# The share of the passes in the time of all, where they may have to be made again.
FIRST_RUN = 0.65


class Run(NamedTuple):
    """What all passes did, and the deviation at unit scale."""

    done: list[PassResult]
    deviation: float


def run_keeping_cuts(plan, mesh, exponent, left):
    """Do as `run_all`, but again with the guard against intersections if cut faces got more."""
    begin = copy_of(mesh)
    with stage(FIRST_RUN):
        run = run_all(plan, mesh, exponent, left)
    if all(one.checkintersections for one in plan):
        return run
    report(FIRST_RUN, "counting faces that cut others")
    if not _more_are_cut(begin, mesh):
        return run
    assign(mesh, begin)
    guarded = [one._replace(checkintersections=True) for one in plan]
    return run_all(guarded, mesh, exponent, left)


def _more_are_cut(before, after):
    """Whether flips have raised the number of faces that cut others.

    They have not if none of the faces that they have made cuts another one.
    """
    made = (before.origin != after.origin).reshape(-1, 3).any(axis=1)
    if not intersecting_faces_of(after, made).any():
        return False
    counts = [np.count_nonzero(intersecting_faces_of(mesh)) for mesh in (before, after)]
    return counts[1] > counts[0]


def run_all(plan, mesh, exponent, left):
    """Make the flips of all passes, at most `left`, in place."""
    done, deviation, cosines = [], 0.0, None
    work = [work_of(one) for one in plan]
    for number, one in enumerate(plan, start=1):
        start = time.perf_counter()
        if one.counts_anew:
            deviation += mesh.deviation.max(initial=0.0)
            mesh.deviation[:] = 0.0
        part = None
        if one.atfolds or one.vertexnormals:
            cosines = least_cosines(mesh) if cosines is None else cosines
            part = (faces_near_folds if one.atfolds else faces_at_bends)(mesh, cosines)
        name = f"pass {number} of {len(plan)}"
        with stage(work[number - 1] / sum(work[number - 1 :]), name if len(plan) > 1 else ""):
            if part is None:
                done.append(_run(one, mesh, exponent, left))
            elif part.any():
                with locked_outside(mesh, part) as unlocked:
                    done.append(_run(one, unlocked, exponent, left))
            else:
                done.append(PassResult(one.energy, one.search, 0, 0.0, True))
        left = rest_of(left, done[-1].flips)
        cosines = None if done[-1].flips else cosines
        _log.info(
            "%s, %s by %s: %d flips, gain %g, %.3f s",
            name,
            one.energy,
            one.search,
            done[-1].flips,
            done[-1].gain,
            time.perf_counter() - start,
        )
    return Run(done, deviation + mesh.deviation.max(initial=0.0))


def work_of(one):
    """Return about how long a pass takes, in the unit of `Search.work`."""
    search = SEARCHES[one.search]
    work = search.work + search.work_per_sweep * one.sweeps + GUARD * one.checkintersections
    if one.atfolds:
        return work * AT_FOLDS
    return work * AT_BENDS if one.vertexnormals else work


def _run(one, mesh, exponent, left):
    """Make the flips of one pass, at most `left`, in place; return its PassResult."""
    rules = Rules(
        fold=guards.fold_limits(one.foldangle, one.minshape),
        monotone=one.monotone,
        maxflips=left if one.maxflips is None else min(left, one.maxflips),
        maxdeviation=_at_unit_scale(one.maxdeviation, exponent),
    )
    place = one.virtualpoint
    if not isinstance(place, str):
        rules, place = rules._replace(virtualpoint=place), AT
    row = ENERGIES[one.energy]
    kernels = PLACED_KERNELS[place] if one.energy == "virtual willmore" else KERNELS[one.energy]
    rules = suited(rules, row, mesh, one.mingain)
    if one.vertexnormals:
        kernels, mesh = TILT_KERNELS, _with_normals(mesh)
    search = SEARCHES[one.search]
    warm_starts = tuple(
        (KERNELS[name], suited(rules, ENERGIES[name], mesh)) for name in search.warm_starts
    )
    limits, schedule = ChainLimits(one.depth, one.breadth), Schedule(one.sweeps, one.seed)
    bvh = inactive_bvh()
    if one.checkintersections:
        with stage(BUILDING, "building the bounding volume hierarchy"):
            bvh = build_bvh(mesh, exponent)
    progress = search.run(kernels, mesh, rules, bvh, Settings(limits, schedule, warm_starts))
    gain = in_input_units(progress.gain, exponent * row.length_power)
    return PassResult(one.energy, one.search, progress.flips, gain, progress.state == CONVERGED)


def _with_normals(mesh):
    """Return the mesh on the same arrays, but with the normals of its vertices beside them."""
    none = np.zeros_like(mesh.vertices)
    normals = vertex_normals(mesh.vertices, faces_of(mesh), none)
    return mesh._replace(vertices=np.hstack([mesh.vertices, normals]))


def _at_unit_scale(length, exponent):
    return math.inf if length is None else in_input_units(length, -exponent)


def suited(rules, row, mesh, mingain=0.0):
    """Return the rules as an energy needs them, with tolerances in its unit.

    Parameters
    ----------
    rules : Rules
    row : Energy
    mesh : Mesh
    mingain : float
        What a flip must gain at least, where the median edge has length 1.
    """
    rules = rules._replace(
        monotone=rules.monotone and not row.is_potential,
        is_potential=row.is_potential,
        is_wide=row.is_wide,
        is_narrow=row.is_narrow,
    )
    if not (row.length_power and len(mesh.origin)):
        return rules._replace(tolerance=max(rules.tolerance, mingain))
    median = max(float(np.median(lengths_of_sides(mesh))), SHORTEST)
    # In large steps: flips change the median, and the same tolerance has to hold in a second run.
    unit = UNIT_STEP ** (round(math.log(median, UNIT_STEP)) * row.length_power)
    least = max(row.least * unit, mingain * median**row.length_power)
    return rules._replace(tolerance=least, rank_step=RANK_STEP * unit)
