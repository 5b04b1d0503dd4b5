"""Edge flips that lower an energy, on plain arrays: the package's main function."""

from __future__ import annotations

import functools
import logging
import math
import time
from collections.abc import Callable, Sequence
from typing import NamedTuple, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import ahead, guards, options
from .execution import SEARCHES, STOPPED_REASON, run_all, run_keeping_cuts, work_of
from .measure import quality_of
from .mesh.build import build, changed_edges, in_old_slots, interior_vertices, local_order
from .mesh.halfedge import Mesh
from .mesh.validate import (
    check_edges,
    check_mask,
    check_mesh,
    check_wedge_uv,
    diagonal_of,
    in_input_units,
    to_unit_scale,
)
from .options import EnergyName, PassOptions, PresetName, SearchName, VirtualPoint
from .passes import Pass, check_combination, planned
from .presets import PRESETS
from .progress import Listen, listening, logged, report, stage
from .results import FlipResult
from .search.rules import NO_LIMIT

_log = logging.getLogger(__name__)
# About how long the work before and after the passes takes; one by "parallel greedy" takes 1.
BEFORE, AFTER = 0.3, 0.1


class _Locks(NamedTuple):
    """Checked arguments that lock edges."""

    featuredeg: float
    selected_faces: NDArray[np.bool_] | None
    locked_edges: NDArray[np.integer] | None
    wedge_uv: NDArray[np.float64] | None


_P = ParamSpec("_P")
_R = TypeVar("_R")


def _checked_combination(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Let a function refuse options that its preset or passes decide, if they are given at all."""

    @functools.wraps(function)
    def checked(*arrays: _P.args, **given: _P.kwargs) -> _R:
        check_combination(given)
        return function(*arrays, **given)

    return checked


@_checked_combination
def optimize_flips(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    preset: PresetName = options.PRESET.default,
    passes: Sequence[PassOptions] | None = None,
    energy: EnergyName = options.ENERGY.default,
    search: SearchName = options.SEARCH.default,
    depth: int = options.DEPTH.default,
    breadth: int = options.BREADTH.default,
    sweeps: int = options.SWEEPS.default,
    seed: int = options.SEED.default,
    virtualpoint: VirtualPoint = options.VIRTUALPOINT.default,
    monotone: bool = options.MONOTONE.default,
    foldangle: float = options.FOLDANGLE.default,
    minshape: float = options.MINSHAPE.default,
    maxdeviation: float | None = None,
    checkintersections: bool = options.CHECKINTERSECTIONS.default,
    featuredeg: float = options.FEATUREDEG.default,
    selected_faces: ArrayLike | None = None,
    locked_edges: ArrayLike | None = None,
    wedge_uv: ArrayLike | None = None,
    maxflips: int | None = None,
    progress: Listen | None = None,
) -> FlipResult:
    """Flip edges of a triangle mesh until no allowed flip lowers the energy any more.

    The vertices do not move. Never flipped are boundary and non-manifold edges, edges between
    faces of opposite orientation, edges whose flip would make an edge that exists already or a
    vertex of valence below three (so two triangles alone never flip), and edges next to coincident
    vertices.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
        Coordinates. Those below 5e-23 of the largest one count as 0.
    faces : (m, 3) array_like of int
        Vertex indices of each face.
    preset : {"paper", "faithful", "smooth", "shape"}
        What to aim at.

        - "paper": the paper's method, or whatever the other options say.
        - "faithful": the true shape of the surface, and then good triangles. Flips lower "mean
          curvature", which finds creases and smooth parts back, with chains of two flips where the
          surface is folded, and along the normals of vertices where it is bent; then "delaunay"
          without moving the surface by more than `maxdeviation`, 0.03 % of the bounding box's
          diagonal by default (infinity: no limit).
          Until then `foldangle` and `minshape` are 180 and 0, unless they have other values than
          their defaults. Where there would be more faces that cut others than before, all is done
          again with `checkintersections`.
        - "smooth": the lowest Willmore energy.
        - "shape": the best triangles within `maxdeviation` of the input, with the same default.

        All but the first decide the options that choose and guide a search (`energy`, `search`,
        `depth`, `breadth`, `sweeps`, `seed`, `virtualpoint`, `monotone`); to give one of these
        beside them is an error. The other options are for all passes of the preset.
    passes : list of dict, optional
        Passes of your own, one after the other, in place of a preset. Each has options of this
        function: ``[dict(energy="mean curvature"), dict(energy="delaunay", maxdeviation=0.1)]``.
        What a pass leaves out has the default; `foldangle`, `minshape`, `maxdeviation`,
        `checkintersections` and `maxflips` given beside `passes` are for all of them. With
        ``atfolds=True`` a pass flips only faces at edges that are bent by more than 100 degrees,
        and their neighbours. With ``vertexnormals=True`` one of "mean curvature" flips only faces
        at edges bent by 10 to 60 degrees and their neighbours, none of them at a sharper edge, and
        counts the angles too between faces and the normals that their vertices have when the pass
        begins (see `meshlab_willmore.energy.tilt`). With ``mingain=0.05`` a pass makes only flips
        that lower its energy by more than 0.05, where the median edge has length 1.
    energy : str
        What to minimise.

        - "virtual willmore": the paper's virtual Willmore energy. It is not a function of the mesh.
        - "willmore": the Willmore energy itself.
        - "uniform virtual willmore": the Willmore energy of the mesh with a virtual vertex in the
          middle of every edge, a function of the mesh.
        - "area": the area.
        - "mean curvature": dihedral angle times length, summed over the edges.
        - "gaussian curvature": the absolute value of 2 pi minus the angles, summed over vertices.
        - "delaunay": the cotangents of all angles, which Delaunay triangulations minimise. Those of
          a face without area count as 2**60.
    search : {"parallel greedy", "greedy", "variable depth", "annealing", "thorough"}
        How to minimise it.

        - "greedy": one flip after another, always the one with the largest cost reduction.
        - "parallel greedy": at once all flips with a larger cost reduction than any other around
          them, on all cores; much quicker, as good, and the same for any number of threads.
        - "variable depth": "greedy" first, or greedy flips along "delaunay" and then "greedy" if
          that ends lower, then chains of flips that may go through a loss, until no chain helps;
          slower, and depends far less on the initial triangulation. Large meshes are searched in
          parts, on all cores, without `maxflips` and `checkintersections`. With the virtual
          Willmore energy, that energy ranks the flips of a chain, and the Willmore energy decides
          whether the chain helps.
        - "annealing": "greedy" first, then random flips that may go through a loss, less so as the
          temperature falls, then "greedy" again. Never worse than "greedy", but "variable depth"
          gets lower in the same time, on large meshes far lower.
        - "thorough": "variable depth" from the mesh itself, and from the result of greedy flips
          along "mean curvature"; the better result counts.

        With the virtual Willmore energy, the last three compare results by the Willmore energy.
    depth : int
        Most flips of a chain, 1 to 100, for "variable depth" and "thorough"; one more at the few
        places where the triangles are bad. The chains from one edge look at 10,000 edges at most,
        which is all of them up to six flips at the largest `breadth`.
    breadth : int
        How many flips each chain tries as its second one, 1 to 12; half as many as the third, and
        so on; only where chains have helped, and where the triangles are bad. 1 is the quickest;
        larger values, with more depth, leave nearly every local minimum.
    sweeps : int
        Number of temperatures of "annealing"; at each it tries as many flips as there are edges.
        The time grows in proportion.
    seed : int
        Seed of the random numbers of "annealing", at least 0. The same seed gives the same result.
    virtualpoint : {"midpoint", "closest"} or float
        Where on the two diagonals the virtual points are, for the energy "virtual willmore".
        "midpoint": as in the paper. "closest": where the diagonals pass nearest each other, at
        least a tenth of each from its ends. A number t in (0, 1): the mean of the costs at t and at
        1 - t, so that 0.5 is the midpoint.
    monotone : bool
        With "virtual willmore", make no flip that raises the Willmore energy, in the form that
        counts every interior edge: twice the sum of their intersection angles. (With a boundary,
        `willmore_after` of the result may rise all the same.) The paper has no such rule. Without
        it, an edge that was flipped away never comes back, as the search might not end otherwise.
        With "variable depth" the rule holds for each chain as a whole. All flips lower the other
        energies, which need no rule.
    foldangle : float
        Degrees in [0, 180]. Refuse flips to an edge with a larger dihedral angle (0 is flat) than
        this and than the old edge. 180: allow all.
    minshape : float
        In [0, 1]. Refuse flips to a triangle of a lower shape than this and than the worse old one.
        The shape is 4 sqrt(3) area / (sum of the squared sides), 1 for an equilateral triangle. 0:
        allow all.
    maxdeviation : float, optional
        In units of the coordinates. Refuse flips after which a point of the surface could be
        farther from the input than this, or a point of the input from the surface. Each flip counts
        with the distance between the old and the new diagonal, and what it adds to a face is
        summed up (see `meshlab_willmore.guards.deviation`). Rounding may add 1e-12 of the largest
        coordinate. In `passes`, a limit that a pass has itself is counted from the beginning of
        that pass, and so is one for all passes in those after it; else that is counted from the
        input. The preset "faithful" counts it from the beginning of its last pass.
    checkintersections : bool
        Refuse flips after which one of the two new faces intersects another face of the mesh:
        touches it without a common vertex, or has more in common with it than common vertices.
        Existing intersections may stay or go. The number of faces that MeshLab counts as
        self-intersecting never grows either.
    featuredeg : float
        Degrees in [0, 180]. Keep edges whose dihedral angle in the input is this or more, to within
        0.01 degrees: at 30, the sides of a cylinder with twelve of them stay. 0: keep all but those
        between coplanar faces. 180: keep none. The edges of a sliver (shape below 1e-5) are not
        kept: its normal is rounding noise, so that they would be sharp by chance, and the sliver
        could never be flipped away.
    selected_faces : (m,) array_like of bool, optional
        Flip only edges between two selected faces.
    locked_edges : (e, 2) array_like of int, optional
        Vertex pairs of edges to keep.
    wedge_uv : (m, 3, 2) array_like of float, optional
        Texture coordinates of the corners of each face; with (m, 3, 4) those of two mappings, and
        so on. Seams are kept: edges whose two faces have different coordinates at one of the ends.
        No flip inverts a texture triangle or makes it flat: there are never fewer of positive or of
        negative area, and never more flat ones. Faces without a mapping, which have all corners at
        one point, are flipped among themselves; faces with a coordinate that is not finite stay.
        The coordinates of the new faces are ``wedge_uv.reshape(-1, 2)[result.corners]``.
    maxflips : int, optional
        Stop after so many flips, of all passes, or before a chain that would exceed them. With
        "annealing" all random flips count. Every search begins with greedy flips, and ends with
        them if the limit is reached there.
    progress : callable, optional
        Called with the fraction of the work that is done and a text: at the beginning, then at most
        ten times a second, and last with exactly 1. The fraction never falls. On scans it differs
        from the part of the time by 5 to 15 % of the whole in the mean, and by 36 % at most; where
        there is little to flip, the end comes sooner. If the callable returns False, or raises an
        exception, the run stops; other values mean nothing. In the last call there is nothing left
        to stop.

    Returns
    -------
    FlipResult
        New arrays; the input is never changed.

    Raises
    ------
    TypeError
        If arrays or options have a wrong type.
    ValueError
        If shapes, ranges or names are wrong, options contradict each other, coordinates are not
        finite, a face has a repeated vertex, or a locked pair is no edge.
    Cancelled
        If `progress` returns False.

    Notes
    -----
    Source: "Mesh optimisation based on Willmore energy", section 3. O(n log n) time per n flips.

    Examples
    --------
    >>> result = optimize_flips(vertices, faces, energy="willmore")  # doctest: +SKIP
    >>> result.willmore_before - result.willmore_after  # doctest: +SKIP
    """
    preset = options.PRESET.checked(preset)
    vertices, faces = check_mesh(vertices, faces)
    given = {
        "energy": energy,
        "search": search,
        "depth": depth,
        "breadth": breadth,
        "sweeps": sweeps,
        "seed": seed,
        "virtualpoint": virtualpoint,
        "monotone": monotone,
        "foldangle": foldangle,
        "minshape": minshape,
        "maxdeviation": maxdeviation,
        "checkintersections": checkintersections,
        "maxflips": maxflips,
    }
    plan = planned(preset, passes, given, diagonal_of(vertices))
    locks = _Locks(
        options.FEATUREDEG.checked(featuredeg),
        None if selected_faces is None else check_mask(selected_faces, len(faces)),
        None if locked_edges is None else check_edges(locked_edges),
        None if wedge_uv is None else check_wedge_uv(wedge_uv, len(faces)),
    )
    keeps_cuts = passes is None and PRESETS[preset].keeps_cuts
    limit = options.MAXFLIPS.checked(maxflips)
    with listening(progress), logged():
        return _flipped(vertices, faces, plan, locks, limit, keeps_cuts)


def _flipped(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    plan: Sequence[Pass],
    locks: _Locks,
    limit: int | None,
    keeps_cuts: bool,
) -> FlipResult:
    """Return the result for checked arguments."""
    start = time.perf_counter()
    if all(one.search == options.SEARCH.default and not one.checkintersections for one in plan):
        ahead.start()
    report(0.0, "building the half-edges")
    scaled, exponent = to_unit_scale(vertices, faces)
    order = local_order(faces, len(vertices))
    mesh = build(scaled, faces[order])
    mesh = _locked(mesh, locks, order)
    # No flip changes which vertices are.
    interior = interior_vertices(mesh)
    before = quality_of(mesh, interior)
    left = NO_LIMIT if limit is None else min(limit, NO_LIMIT)
    run = run_keeping_cuts if keeps_cuts else run_all
    work = sum(map(work_of, plan))
    report(BEFORE / (BEFORE + work + AFTER), "flipping")
    with stage(work / (work + AFTER)):
        done, deviation = run(plan, mesh, exponent, left)
    report(0.0, "measuring")
    new_faces, corners = in_old_slots(mesh, order)
    after = quality_of(mesh, interior)
    converged = all(one.converged for one in done)
    is_random = any(SEARCHES[one.search].is_random for one in done)
    result = FlipResult(
        faces=new_faces,
        flips=changed_edges(faces, new_faces) if is_random else sum(one.flips for one in done),
        gain=done[0].gain if len(done) == 1 else before.willmore_energy - after.willmore_energy,
        willmore_before=before.willmore_energy,
        willmore_after=after.willmore_energy,
        converged=converged,
        reason=SEARCHES[done[-1].search].converged if converged else STOPPED_REASON,
        corners=corners,
        deviation=in_input_units(deviation, exponent),
        absolute_mean_curvature_before=in_input_units(before.absolute_mean_curvature, exponent),
        absolute_mean_curvature_after=in_input_units(after.absolute_mean_curvature, exponent),
        mean_shape_before=before.mean_shape,
        mean_shape_after=after.mean_shape,
        worst_shape_before=before.worst_shape,
        worst_shape_after=after.worst_shape,
        passes=tuple(done),
        vertices=vertices,
        faces_before=faces,
    )
    _log.info(
        "%d faces: %d flips, Willmore energy %g -> %g, %.3f s",
        len(faces),
        result.flips,
        before.willmore_energy,
        after.willmore_energy,
        time.perf_counter() - start,
    )
    return result


def _locked(mesh: Mesh, locks: _Locks, order: NDArray[np.integer]) -> Mesh:
    """Lock edges of `mesh`, whose faces are those of the input in `order`, in place.

    Returns
    -------
    Mesh
        With the texture coordinates, which no flip must fold.
    """
    if locks.featuredeg < guards.FLAT_ANGLE:
        guards.lock_creases(mesh, math.radians(locks.featuredeg))
    if locks.selected_faces is not None:
        guards.lock_unselected(mesh, locks.selected_faces[order])
    if locks.locked_edges is not None:
        guards.lock_edges(mesh, locks.locked_edges)
    if locks.wedge_uv is None:
        return mesh
    uv = guards.texture_coordinates(locks.wedge_uv, order)
    guards.lock_seams(mesh, uv)
    return mesh._replace(uv=uv)
