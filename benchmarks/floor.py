"""The scoring pass of the greedy search in rounds, measured against its own arithmetic.

Run by hand, from the top of the repository, on a machine that does nothing else:

    python -m benchmarks.floor

The floor is that arithmetic alone, on the numbers of the same edges, gathered beforehand and one
behind the other in memory: no connectivity, nothing looked up, nothing written but the results. On
one thread and on all of them; medians of wall-clock time, in turns.
"""

import argparse
import functools
import sys
from typing import NamedTuple

import numba
import numpy as np

from benchmarks import machine
from meshlab_willmore import execution, guards
from meshlab_willmore.energy import virtual, willmore
from meshlab_willmore.energy.angles import radians, rough
from meshlab_willmore.energy.table import ENERGIES
from meshlab_willmore.guards.bvh import inactive_bvh
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import is_free
from meshlab_willmore.mesh.jit import allocating_jit, jit
from meshlab_willmore.mesh.parallel import thread_pool
from meshlab_willmore.mesh.validate import check_mesh, to_unit_scale
from meshlab_willmore.search.compiled import KERNELS
from meshlab_willmore.search.rounds import initial_state
from meshlab_willmore.search.rules import Rules
from meshlab_willmore.search.scoring import (
    LANES,
    drop_at,
    empty_rows,
    fill,
    find_drops,
    is_positive,
)
from studies.models import print_table
from tests import meshes

ENERGY = "virtual willmore"
NANO = 1e-9


class Ready(NamedTuple):
    """Numbers of whole blocks of edges, (blocks, rows), and room for results.

    `helpful` has those that the energy is in favour of, which the judge is asked about.
    """

    rows: np.ndarray
    helpful: np.ndarray
    ranks: np.ndarray
    gains: np.ndarray


@jit
def gather(mesh, edges, rows):
    """Write what the flips of `edges`, whole blocks of them, look at into `rows`."""
    for place in range(len(edges)):
        fill(rows[place // LANES], place % LANES, mesh, edges[place])


@allocating_jit
def find_helpful(rows, edges):
    """Return those of the edges, gathered in `rows`, that the energy is in favour of."""
    is_helpful = np.zeros(len(edges), np.bool_)
    for block in range(len(rows)):
        find_drops(rows[block], virtual.drop)
        for lane in range(LANES):
            is_helpful[block * LANES + lane] = is_positive(drop_at(rows[block], lane))
    return edges[is_helpful]


@jit
def compute(ready, start, stop):
    """Find the cost reductions of the edges from `start` up to `stop`, which begins a block."""
    first, last = start // LANES, stop // LANES
    for block in range(first, last):
        rows = ready.rows[block]
        find_drops(rows, virtual.drop)
        for lane in range(LANES):
            ready.ranks[block, lane] = is_positive(drop_at(rows, lane))
    # As large a part of the helpful ones.
    blocks, helpful = len(ready.rows), len(ready.helpful)
    for block in range(first * helpful // blocks, last * helpful // blocks):
        rows = ready.helpful[block]
        find_drops(rows, willmore.drop)
        for lane in range(LANES):
            change = rough(drop_at(rows, lane))
            if change > 0.0:
                ready.gains[block, lane] = radians(drop_at(rows, lane))


@allocating_jit
def free_edges(mesh, edges):
    """Return those of `edges` that may be flipped at all."""
    return np.array([h for h in edges if is_free(mesh, h)], np.int32)


def contenders(state, ready, edges):
    """The pass and its floor, on one thread and on all."""
    threads = {"one thread": 1, f"{numba.config.NUMBA_NUM_THREADS} threads": None}
    found = {}
    for name, count in threads.items():
        found["pass", name] = functools.partial(
            shared, KERNELS[ENERGY].score, state, len(state.dirty), count
        )
        found["floor", name] = functools.partial(shared, compute, ready, len(edges), count)
    return found


def shared(kernel, task, count, threads):
    """Seconds of the work on so many threads, which are there already."""
    with thread_pool(threads) as parallel_for:
        return machine.seconds_of(functools.partial(parallel_for, kernel, task, count))


def prepared(points):
    """The state of the mesh, the same edges ready for the arithmetic, and these edges."""
    vertices, faces = check_mesh(*meshes.torus(points, 0.3, 8))
    mesh = build(to_unit_scale(vertices, faces)[0], faces)
    rules = execution.suited(Rules(guards.fold_limits(90.0)), ENERGIES[ENERGY], mesh)
    state = initial_state(mesh, rules, inactive_bvh())
    edges = free_edges(mesh, state.dirty)
    edges = edges[: len(edges) // LANES * LANES]
    rows = blocks_of(mesh, edges)
    helpful = blocks_of(mesh, find_helpful(rows, edges))
    ranks, gains = np.zeros((len(rows), LANES)), np.zeros((len(helpful), LANES))
    return state, Ready(rows, helpful, ranks, gains), edges


def blocks_of(mesh, edges):
    """Return the numbers of whole blocks of the edges."""
    rows = np.zeros((len(edges) // LANES, len(empty_rows())))
    gather(mesh, edges[: len(rows) * LANES], rows)
    return rows


def main(arguments):
    parser = argparse.ArgumentParser(prog="python -m benchmarks.floor")
    parser.add_argument("--points", type=int, default=200_000, help="of the torus")
    parser.add_argument("--rounds", type=int, default=9)
    options = parser.parse_args(arguments)
    print("\n".join(machine.description()))
    state, ready, edges = prepared(options.points)
    taking_turns = contenders(state, ready, edges)
    # Once, so that nothing is compiled or loaded later.
    machine.interleaved(taking_turns, 1)
    medians = {
        key: figures[0]
        for key, figures in machine.interleaved(taking_turns, options.rounds).items()
    }
    print(f"\n{len(state.dirty)} edges, n = {options.rounds}\n")
    print_table(["", "floor, ns an edge", "pass, ns an edge", "share"], rows(medians, state, edges))
    one, every = (medians["pass", name] for what, name in medians if what == "pass")
    print(f"\nThe pass is {one / every:.2f} times as fast on all threads as on one.")


def rows(medians, state, edges):
    """A line for each number of threads."""
    for what, name in medians:
        if what == "floor":
            floor = medians[what, name] / len(edges) / NANO
            whole = medians["pass", name] / len(state.dirty) / NANO
            yield [name, f"{floor:.1f}", f"{whole:.1f}", f"{floor / whole:.2f}"]


if __name__ == "__main__":
    main(sys.argv[1:])
