"""One fuzzed case: a random mesh, random options, a run, and the whole promise checked."""

import contextlib
import itertools
import math
from unittest import mock

import numpy as np

from meshlab_willmore.execution import SEARCHES
from meshlab_willmore.measure import self_intersections
from meshlab_willmore.mesh import parallel
from meshlab_willmore.optimize import optimize_flips
from meshlab_willmore.progress import Cancelled, listening
from meshlab_willmore.search import parallel_greedy, regions, rounds
from tests.distances import farthest

from . import energies, promise
from .choices import random_options, random_passes
from .shapes import random_mesh

# Edges of slivers of a lower shape are no creases.
CREASE_SHAPE = 1e-5
# Coordinates below this part of the largest one count as zero.
LEAST = 2.0**-74
# What rounding may add to a distance, at unit scale.
SLACK = 2e-12
# What says itself that a second run may find more, by random kicks or several starts, and what to
# run instead.
AGAIN = {"annealing": "greedy", "thorough": "variable depth"}


class Case:
    """The mesh and the options of number `number` of the series `seed`."""

    def __init__(self, seed, number):
        rng = np.random.default_rng([seed, number])
        self.name = f"python -m tests.fuzz --seed {seed} --case {number}"
        self.vertices, self.faces, self.made_by = random_mesh(rng)
        self.options = random_options(rng, self.vertices, self.faces)
        self.parts = int(rng.choice([2, 4, 10**6]))
        self.has_passes = bool(rng.random() < 0.15)
        if self.has_passes:
            self.options = random_passes(rng, self.vertices, self.faces)
        # Whether one more run is stopped, and after which part of the reports.
        self.is_stopped, self.stopped_after = bool(rng.random() < 0.4), float(rng.random())

    def check(self):
        """Run and check; an AssertionError says how to see it again."""
        try:
            self._check()
        except Exception as error:
            shown = {k: v if np.ndim(v) == 0 else v.tolist() for k, v in self.options.items()}
            raise AssertionError(
                f"{type(error).__name__}: {error}\n{self.name}\n{' + '.join(self.made_by)}\n{shown}"
            ) from error

    def _check(self):
        vertices, faces = self.vertices.copy(), self.faces.copy()
        vertices.flags.writeable = faces.flags.writeable = False
        result = self._run(vertices, faces, self.options)
        locked, is_sure = self._locked()
        promise.check_connectivity(faces, result.faces)
        promise.check_kept(result.faces, locked)
        wedge_uv = self.options.get("wedge_uv")
        if wedge_uv is not None:
            promise.check_mapping(wedge_uv, self._carried(result))
        if is_sure:
            promise.check_corners(faces, result.faces, result.corners, locked)
        self._check_numbers(result)
        self._check_deviation(result)
        self._check_cuts(result)
        self._check_repeated(vertices, faces, result)
        if not self.has_passes:
            self._check_energy(result)
            self._check_again(vertices, result, locked, is_sure)

    def _carried(self, result):
        """The texture coordinates of the new faces."""
        return self.options["wedge_uv"].reshape(-1, 2)[result.corners]

    def _run(self, vertices, faces, options, threads=1):
        """Run on so many threads; on several with the work in small pieces."""
        with contextlib.ExitStack() as stack:
            for module, name, value in (
                (parallel, "thread_count", lambda: threads),
                (parallel, "CHUNK", 2048 if threads == 1 else 3),
                (rounds, "CHUNK", 2048 if threads == 1 else 5),
                (parallel_greedy, "ACTIVE_PER_CHANGE", 13 if threads == 1 else 0),
                (regions, "LEAST_FACES", self.parts),
            ):
                stack.enter_context(mock.patch.object(module, name, value))
            return optimize_flips(vertices, faces, **options)

    def _locked(self):
        """The edges that must stay, as sorted pairs, and whether that is clear of all."""
        given = np.asarray(self.options.get("locked_edges", ()), int).reshape(-1, 2)
        locked, is_sure = set(map(tuple, np.sort(given, axis=1).tolist())), True
        if "selected_faces" in self.options:
            left_out = self.faces[~self.options["selected_faces"]]
            locked |= promise.edges(promise.half_edges(left_out))
        if "wedge_uv" in self.options:
            locked |= promise.seams(self.faces, self.options["wedge_uv"])
        limit = self.options.get("featuredeg", 180.0)
        if limit < 180.0 and len(self.faces):
            ends, angles, shapes = self._edges()
            least = max(limit - 0.01, 0.01)
            is_sharp = (angles >= least + 1e-9) & (shapes > 1.01 * CREASE_SHAPE)
            locked |= set(map(tuple, ends[is_sharp].tolist()))
            # On the edge of the limit, or of a sliver that may be one.
            doubt = (np.abs(angles - least) < 1e-6) | (shapes < 1.01 * CREASE_SHAPE)
            is_sure = not doubt.any()
        return locked, is_sure

    def _at_unit_scale(self):
        """The vertices divided by a power of two, without what counts as zero, and that power."""
        used = self.vertices[self.faces] if len(self.faces) else np.ones(1)
        scale = np.ldexp(np.longdouble(1), math.frexp(float(np.abs(used).max()))[1])
        vertices = self.vertices.astype(np.longdouble) / scale
        return np.where(np.abs(vertices) < LEAST, 0, vertices), scale

    def _edges(self):
        """Edges, dihedral angles and shapes, where there are any."""
        with np.errstate(invalid="ignore"):
            found = energies.dihedral_angles(self._at_unit_scale()[0], self.faces)
        return found[0], *(np.nan_to_num(x) for x in found[1:])

    def _check_numbers(self, result):
        limit = self.options.get("maxflips")
        assert np.isfinite(result.willmore_before)
        assert np.isfinite(result.willmore_after)
        assert np.isfinite(result.gain)
        passes = self.options.get("passes", [self.options])
        limits = [limit, *(one.get("maxflips") for one in passes)]
        assert result.converged or any(value is not None for value in limits)
        is_random = any(one.get("search") == "annealing" for one in passes)
        assert limit is None or is_random or result.flips <= limit
        worst, mean = result.worst_shape_after, result.mean_shape_after
        assert 0.0 <= worst <= mean + 1e-12 <= 1.0 + 2e-12
        gone = len(
            promise.edges(promise.half_edges(self.faces))
            - promise.edges(promise.half_edges(result.faces))
        )
        assert gone <= result.flips, f"{gone} edges are gone after {result.flips} flips"
        if "selected_faces" in self.options:
            left_out = ~self.options["selected_faces"]
            np.testing.assert_array_equal(result.faces[left_out], self.faces[left_out])

    def _check_energy(self, result):
        """The energy falls by what the result says, up to what rounding may do.

        For an energy that `energies` does not have, only the result's own number is checked.
        """
        energy, search = self.options["energy"], self.options["search"]
        judge = energies.ENERGIES.get(energy)
        if judge is None:
            assert result.gain >= 0.0, f"{energy} rose by {-result.gain}"
            return
        power = energies.LENGTH_POWER.get(energy, 0)
        vertices, scale = self._at_unit_scale()
        with np.errstate(all="ignore"):
            (before, error), (after, other_error) = (
                judge(vertices, f) if len(f) else (0.0, 0.0) for f in (self.faces, result.faces)
            )
            gain = np.longdouble(result.gain) / scale**power
        slack = error + other_error + 1e-10 * abs(before)
        if not np.isfinite([float(before), float(after), float(slack)]).all():
            return
        if energy == "virtual willmore" and not self.options["monotone"]:
            return
        assert after <= before + slack, f"{energy} rose by {after - before} (rounding: {slack})"
        if energy != "virtual willmore" or "greedy" not in search:
            assert abs(before - after - gain) <= slack, (
                f"{energy} fell by {before - after}, not by {gain} (rounding: {slack})"
            )

    def _check_deviation(self, result):
        """No point is farther from the other surface than the result and the limits say."""
        _, scale = self._at_unit_scale()
        vertices = (self.vertices / scale).astype(float)
        bound = float(result.deviation / scale)
        there, back = farthest(vertices, self.faces, result.faces)
        assert max(there, back) <= bound + SLACK, f"{max(there, back)} away, not {bound}"
        limit = self.options.get("maxdeviation")
        if limit is not None and not self.has_passes:
            assert bound <= float(limit / scale) + SLACK, f"{bound} exceeds the limit"

    def _check_cuts(self, result):
        """No new face cuts another one."""
        passes = self.options.get("passes", [{}])
        if not all({**self.options, **one}["checkintersections"] for one in passes):
            return
        if not result.flips:
            return
        old = set(map(frozenset, self.faces.tolist()))
        is_new = np.array([frozenset(face) not in old for face in result.faces.tolist()])
        cut = self_intersections(self.vertices, result.faces) & is_new
        assert not cut.any(), f"new faces cut others: {np.flatnonzero(cut).tolist()}"

    def _check_repeated(self, vertices, faces, result):
        heard = []
        with listening(lambda fraction, _: heard.append(fraction), seconds=0.0):
            other = self._run(vertices, faces, self.options, threads=2)
        promise.check_progress(heard)
        np.testing.assert_array_equal(other.faces, result.faces)
        np.testing.assert_array_equal(other.corners, result.corners)
        assert other[1:2] + other[3:7] == result[1:2] + result[3:7]
        assert other.deviation == result.deviation
        np.testing.assert_allclose(other.gain, result.gain, rtol=1e-9)
        if self.is_stopped:
            self._check_stop(vertices, faces, result, heard)

    def _check_stop(self, vertices, faces, result, heard):
        """A stop ends the run at once, and the next one does what it did before.

        The arrays can't be written to; what a stop might leave is what the next run would meet.
        """
        left, calls = int(self.stopped_after * (len(heard) - 1)), itertools.count()
        with contextlib.suppress(Cancelled), listening(lambda *_: next(calls) < left, seconds=0.0):
            self._run(vertices, faces, self.options)
            raise AssertionError(f"a stop after {left} of {len(heard)} reports stops nothing")
        assert next(calls) == left + 1, "there were calls after the stop"
        again = self._run(vertices, faces, {**self.options, "progress": lambda *_: None})
        np.testing.assert_array_equal(again.faces, result.faces)
        np.testing.assert_array_equal(again.corners, result.corners)

    def _check_again(self, vertices, result, locked, is_sure):
        """Nothing is left where the first run says so."""
        options = dict(self.options)
        if not (result.converged and is_sure) or "maxdeviation" in options:
            return
        if options["energy"] == "virtual willmore" and not options["monotone"]:
            return
        # Creases of the first mesh need not be creases of the second.
        options.pop("featuredeg", None)
        options["locked_edges"] = np.array(sorted(locked), int).reshape(-1, 2)
        options.pop("maxflips", None)
        if "wedge_uv" in options:
            options["wedge_uv"] = self._carried(result)
        search = options["search"]
        options["search"] = AGAIN.get(search, search)
        # The other descent finds more where flips tie or `maxflips` cut it off before.
        chains_alone = SEARCHES["variable depth"]._replace(warm_starts=())
        with mock.patch.dict(SEARCHES, {"variable depth": chains_alone}):
            again = self._run(vertices, result.faces, options)
        assert again.flips == 0, f"{again.flips} more flips in a second run"


def failure(seed, number):
    """The message of a case that fails, or None."""
    try:
        Case(seed, number).check()
    except AssertionError as error:
        return str(error)
    return None


def failures(seed, numbers):
    """The messages of all cases that fail."""
    return list(filter(None, (failure(seed, number) for number in numbers)))
