"""The cost reductions of many edges, by the number of their energy.

So a search is compiled once, and not once for each energy: it asks which one it is once for all
edges around a flip. Only where nearly all edges of a mesh are scored at a time
(`meshlab_willmore.search.scoring`), or one edge is (`meshlab_willmore.search.annealing`), each
energy has code of its own.
"""

import functools
import importlib

import numpy as np
from numba.extending import overload

from ..energy.table import AT, ENERGIES, TILT, VIRTUAL_POINTS
from ..mesh.jit import inlined, inner
from .copies import with_globals

# What an energy takes that depends on the place of the virtual points.
PLACED = 3

# The modules of all energies. Their numbers are the places in this list.
_NAMES = dict.fromkeys(
    [*(row.module for row in ENERGIES.values()), *VIRTUAL_POINTS.values(), AT, TILT]
)
MODULES = [importlib.import_module(f"..energy.{name}", __package__) for name in _NAMES]
# `_linked` puts in these places what belongs to a link of the chain.
energy, number_of_energy, own, others = MODULES[0], 0, None, None


def number_of(module):
    """Return the number of the energy of a module."""
    return MODULES.index(module)


def gain_of(cost_reduction, mesh, h, place):
    """Return the cost reduction of `h`, which has a twin, by the function of an energy.

    An energy that depends on where the virtual points are takes `place`, `Rules.virtualpoint`, as a
    third argument. Numba looks at the function when it compiles, so nothing of the choice is left
    at run time.
    """
    if cost_reduction.__code__.co_argcount == PLACED:
        return cost_reduction(mesh, h, place)
    return cost_reduction(mesh, h)


@overload(gain_of)
def _compiled_gain_of(cost_reduction, mesh, h, place):
    if cost_reduction.dispatcher.py_func.__code__.co_argcount == PLACED:
        return lambda cost_reduction, mesh, h, place: cost_reduction(mesh, h, place)
    return lambda cost_reduction, mesh, h, place: cost_reduction(mesh, h)


def _find_own(mesh, edges, count, place, gains):
    """Write what the energy of this link loses by the flip of each edge."""
    for s in range(count):
        gains[s] = gain_of(energy.cost_reduction, mesh, np.int64(edges[s]), place)


def _link(number, mesh, edges, count, place, gains):
    """Ask the energy of this link, or one of the others."""
    if number == number_of_energy:
        own(mesh, edges, count, place, gains)
    else:
        others(number, mesh, edges, count, place, gains)


@inlined
def _end(number, mesh, edges, count, place, gains):
    """No energy has this number."""


def _linked(others, number):
    module = MODULES[number]
    name = module.__name__.rpartition(".")[2]
    own = inner(with_globals(_find_own, f"_find_{name}", {"energy": module}))
    names = {"own": own, "number_of_energy": number, "others": others}
    return inlined(with_globals(_link, f"_link_{name}", names))


# The first is asked first.
_chain = functools.reduce(_linked, reversed(range(len(MODULES))), _end)


@inner
def find_gains(number, mesh, edges, count, place, gains):
    """Write what an energy loses by the flip of each of some edges.

    Parameters
    ----------
    number : int
        From `number_of`.
    mesh : Mesh
    edges : (s,) int32
        The first `count` are half-edges with a twin.
    count : int
    place : float
        `Rules.virtualpoint`, for the energies that ask for it.
    gains : (s,) float64
        Overwritten, in the unit of the energy; -inf or NaN where it is undefined.
    """
    _chain(number, mesh, edges, count, place, gains)
