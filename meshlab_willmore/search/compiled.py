"""The compiled searches, one set of kernels for each energy.

A search is written once, as a plain function that names the modules `energy` and `judge`, globals
of its own module. Numba never finds a kernel in its cache that takes another one as an argument. So
each energy gets a copy of that function in which these names mean other modules, compiled under a
name of its own.
"""

import functools
import importlib
from collections.abc import Callable
from types import FunctionType, ModuleType
from typing import NamedTuple

from ..energy import willmore
from ..energy.table import AT, ENERGIES, VIRTUAL_POINTS
from ..mesh.jit import jit
from . import annealing, greedy, scoring, variable_depth


class Kernels(NamedTuple):
    """The compiled searches for one energy.

    Attributes
    ----------
    energy : module
        With the cost reduction that the greedy flips go by.
    greedy, depth, anneal : callable
        The slices of the searches.
    score : callable
        Scores many edges, for `meshlab_willmore.search.parallel_greedy`.
    losses : callable
        `meshlab_willmore.search.annealing.find_losses`.
    total : callable
        The energy of a mesh that judges: the Willmore energy for the virtual one, which is no
        function of the mesh, else the energy itself.
    most_loss : float
        What chains of flips may lose of it on their way.
    """

    energy: ModuleType
    greedy: Callable
    depth: Callable
    anneal: Callable
    score: Callable
    losses: Callable
    total: Callable
    most_loss: float


def specialised(template, energy, judge=None):
    """Return a copy of a search in which `energy` and `judge` are these modules.

    Parameters
    ----------
    template : function
        Of this package, not compiled.
    energy : module
        With `cost_reduction`; with `drop` where the template asks for it.
    judge : module, optional
        As `energy`; None: nothing is asked of it.

    Returns
    -------
    function
        Not compiled, with a name of its own, by which Numba's cache tells the copies apart.
    """
    modules = [module.__name__.rpartition(".")[2] for module in (energy, judge) if module]
    name = "_".join([template.__name__, *modules])
    names = {**template.__globals__, "energy": energy, "judge": judge}
    copy = FunctionType(template.__code__, names, name)
    copy.__qualname__ = name
    return copy


@functools.cache
def _compiled(template, energy, judge=None):
    return jit(specialised(template, energy, judge))


@functools.cache
def _kernels(module, is_potential, most_loss):
    energy = importlib.import_module(f"..energy.{module}", __package__)
    other = None if is_potential else willmore
    judge = other or energy
    score = scoring.score_batches if hasattr(energy, "drop") else scoring.score_each
    if hasattr(energy, "quick_reduction"):
        score = scoring.score_quickly
    return Kernels(
        energy=energy,
        greedy=_compiled(greedy.advance, energy),
        depth=_compiled(variable_depth.advance, energy, other),
        anneal=_compiled(annealing.anneal, judge),
        score=_compiled(score, energy, other),
        losses=_compiled(annealing.find_losses, judge),
        total=judge.total,
        most_loss=most_loss,
    )


KERNELS = {
    name: _kernels(row.module, row.is_potential, row.most_loss) for name, row in ENERGIES.items()
}
# Those for "virtual willmore" by where the virtual points are; `AT`: at a number.
PLACED_KERNELS = {
    place: _kernels(module, False, ENERGIES["virtual willmore"].most_loss)
    for place, module in {**VIRTUAL_POINTS, AT: AT}.items()
}
