"""Compilation of everything in advance: each energy with each search, every guard and measure.

Kernels are compiled by calling the public functions on a tiny mesh, with all choices of their
options. So a new energy or search is included.
"""

from __future__ import annotations

import itertools
import multiprocessing
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import ahead, measure
from .guards import fold_limits
from .guards.bvh import inactive_bvh
from .mesh import compiling
from .mesh.build import build
from .mesh.jit import cache_folder, is_off
from .mesh.kernel_cache import write_errors
from .mesh.normals import vertex_normals
from .optimize import optimize_flips
from .options import ENERGY, FOLDANGLE, SEARCH, VIRTUALPOINT
from .passes import BENDS
from .search.compiled import KERNELS
from .search.rules import ChainLimits, Rules
from .search.variable_depth import search_by_chains

VIRTUAL = "virtual willmore"
_CHAINS = "chains of flips"
_WITH_CHAINS = ("variable depth", "thorough")
_GUARDED = ", self-intersections"
_PLACE = 0.3
_ROWS, _SLOPE_ROWS = 7, 30
_HEIGHT = 0.4
_FEATURE = 30.0
_BEND, _SHEAR = 0.002, 0.3


class WarmupStep(NamedTuple):
    """Something to call, and its name."""

    name: str
    run: Callable[[], object]


class Warmed(NamedTuple):
    """What was done: kernels compiled, seconds for that and for all, and where they are kept."""

    compiled: int
    compiling_seconds: float
    seconds: float
    folder: str


def steps() -> list[WarmupStep]:
    """All that a filter or a function of this package may compile; the default comes first."""
    patch, slope = _patch(), _slope()
    # One sweep compiles as much as many.
    flips = partial(optimize_flips, *patch, sweeps=1)
    waves = partial(optimize_flips, *slope, energy="willmore")
    chosen: dict[str, Callable[..., object]] = {
        f"{search}, {energy}": partial(flips, search=search, energy=energy)
        for search, energy in itertools.product(SEARCH.choices, ENERGY.choices)
    }
    for search, place in itertools.product(SEARCH.choices, (*VIRTUALPOINT.choices, _PLACE)):
        chosen[f"{search}, virtual points {place}"] = partial(
            flips, search=search, energy=VIRTUAL, virtualpoint=place
        )
    for search in SEARCH.choices:
        along: Any = {"energy": BENDS, "search": search, "sweeps": 1, "vertexnormals": True}
        chosen[f"{search}, normals of vertices"] = partial(optimize_flips, *patch, passes=[along])
    chosen["waves of flips"] = waves
    guarded = {
        f"{name}{_GUARDED}": partial(run, checkintersections=True) for name, run in chosen.items()
    }
    vertices, faces = patch
    others = {
        "features, selections, locked edges, textures": partial(
            flips,
            featuredeg=_FEATURE,
            selected_faces=np.ones(len(faces), bool),
            locked_edges=faces[:1, :2],
            wedge_uv=vertices[faces, :2],
        ),
        **{
            function.__name__.replace("_", " "): partial(function, *patch)
            for function in (
                measure.measures,
                measure.willmore_energy,
                measure.vertex_willmore_energy,
                measure.intersection_angles,
                measure.triangle_shapes,
                measure.self_intersections,
            )
        },
        _CHAINS: partial(_make_chains, *patch),
        "normals": partial(vertex_normals, *patch, np.zeros((_ROWS**2, 3))),
    }
    return [WarmupStep(name, run) for name, run in (chosen | guarded | others).items()]


def _grid(rows: int) -> tuple[Any, Any, NDArray[np.int32]]:
    """The coordinates of a square grid, and its faces, all cut along the same diagonal."""
    x, y = (line.ravel().astype(np.float64) for line in np.mgrid[:rows, :rows])
    low = np.arange(x.size).reshape(rows, rows)
    a, b, c, d = (
        corner.ravel() for corner in (low[:-1, :-1], low[1:, :-1], low[1:, 1:], low[:-1, 1:])
    )
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return x, y, faces.astype(np.int32)


def _slope() -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """A smooth patch over which flips spread in a wave, so that few edges change at a time."""
    x, y, faces = _grid(_SLOPE_ROWS)
    height = _BEND * (x * x + x * y + 3.0 * y * y)
    return np.stack([x + _SHEAR * y, y, height], 1), faces


def _patch() -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """A rough patch with bad diagonals, on which every search finds something to do."""
    x, y, faces = _grid(_ROWS)
    height = np.random.default_rng(0).uniform(0.0, _HEIGHT, x.size)
    return np.stack([x, y, height], 1), faces


def _make_chains(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> None:
    """Make chains of flips, without what `optimize_flips` does before and after."""
    mesh, rules = build(vertices, faces), Rules(fold_limits(FOLDANGLE.default))
    search_by_chains(KERNELS[ENERGY.default], mesh, rules, inactive_bvh(), ChainLimits())


def warm_up(
    say: Callable[[str], None],
    processes: int = 1,
    end: Callable[[str], object] = lambda name: None,
) -> Warmed:
    """Compile what is not in Numba's cache yet.

    Parameters
    ----------
    say : callable
        Gets a line for each step that compiled something.
    processes : int
        In how many processes; with 1, or where the system has no locks for several (a container
        without shared memory), in this one.
    end : callable
        Gets the name of each of the `steps` when it is done.

    Raises
    ------
    RuntimeError
        Numba's compiler is switched off, or it finds no folder that can be written.
    OSError
        The cache can't be written.
    """
    folder = _folder()
    start = time.perf_counter()
    found: list[compiling.Compiled] = []
    pool = _pool(processes)
    one_by_one = itertools.chain.from_iterable(_run([step]) for step in steps())
    for name, compiled in _in_processes(pool) if pool else one_by_one:
        if compiled:
            say(f"{name}: compiled in {sum(c.seconds for c in compiled):.1f} s")
        found += compiled
        end(name)
    seconds = time.perf_counter() - start
    return Warmed(len(found), sum(c.seconds for c in found), seconds, folder)


_Outcome = tuple[str, list[compiling.Compiled]]


def _run(chosen: list[WarmupStep]) -> list[_Outcome]:
    """Run steps in this process; return their names and what each has compiled."""
    outcomes = []
    with compiling.announced("", silent=True), ahead.prevented():
        for step in chosen:
            with compiling.counted() as compiled:
                step.run()
            if write_errors:
                error = write_errors.pop()
                raise OSError(f"Numba's cache can't be written in {_folder()}: {error}")
            outcomes.append((step.name, compiled))
    return outcomes


def _pool(processes: int) -> ProcessPoolExecutor | None:
    if processes == 1:
        return None
    try:
        # Forked, they would inherit threads' locks.
        return ProcessPoolExecutor(processes, multiprocessing.get_context("spawn"))
    except (ImportError, NotImplementedError, OSError):
        return None


def _in_processes(pool: ProcessPoolExecutor) -> Iterator[_Outcome]:
    """Run all steps in several processes; give the outcomes as they arrive."""
    with pool:
        jobs = [pool.submit(_run, job) for job in _jobs()]
        try:
            for job in as_completed(jobs):
                yield from job.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _jobs() -> list[list[WarmupStep]]:
    """The steps, those together that compile the same kernels.

    The first one compiles chains of flips, which takes as long as half of the others. So the steps
    that need chains come last.
    """
    jobs: dict[str, list[WarmupStep]] = {}
    for step in steps():
        jobs.setdefault(step.name.removesuffix(_GUARDED), []).append(step)
    with_chains = [name for name in jobs if name.startswith(_WITH_CHAINS)]
    others = [name for name in jobs if name not in with_chains and name != _CHAINS]
    return [jobs[name] for name in (_CHAINS, *others, *with_chains)]


def missing() -> list[str]:
    """Names of the steps that would compile something; nothing is compiled."""
    return [step.name for step in steps() if _would_compile(step)]


def _would_compile(step: WarmupStep) -> bool:
    try:
        with compiling.forbidden(), ahead.prevented():
            step.run()
    except compiling.NotCompiledError:
        return True
    return False


def _folder() -> str:
    if is_off():
        raise RuntimeError("NUMBA_DISABLE_JIT is set: the compiler is switched off")
    folder = cache_folder()
    if not folder:
        raise RuntimeError(
            "Numba finds no folder that it can write its cache to; "
            "set NUMBA_CACHE_DIR to one, for this command and for later runs"
        )
    return str(folder)
