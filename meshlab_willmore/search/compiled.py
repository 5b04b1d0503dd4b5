"""What the searches have to know of each energy: its number, and kernels of its own.

Most of the searches is compiled once for all energies, and asks for one of them by its number. What
scores many edges at once, or single ones, is compiled for each energy: a copy in which the names
`energy` and `judge` mean its modules.
"""

import functools
import importlib
from collections.abc import Callable
from types import ModuleType
from typing import NamedTuple

from ..energy import willmore
from ..energy.table import AT, ENERGIES, TILT, VIRTUAL_POINTS
from ..mesh.jit import allocating_jit, jit
from . import annealing, costs, scoring
from .copies import with_globals


class Kernels(NamedTuple):
    """An energy, as the searches ask for it.

    Attributes
    ----------
    energy : module
        With the cost reduction that the greedy flips go by.
    number : int
        Of this energy, in `meshlab_willmore.search.costs`.
    judges : bool
        Whether it also judges. The virtual Willmore energy, which is no function of the mesh, does
        not: the Willmore energy does.
    anneal : callable
        `meshlab_willmore.search.annealing.anneal` for the energy that judges.
    score : callable
        Scores many edges, for `meshlab_willmore.search.parallel_greedy`.
    losses : callable
        `meshlab_willmore.search.annealing.find_losses`, likewise.
    total : callable
        `total` of the energy that judges.
    most_loss : float
        What chains of flips may lose of it on their way.
    """

    energy: ModuleType
    number: int
    judges: bool
    anneal: Callable
    score: Callable
    losses: Callable
    total: Callable
    most_loss: float


@functools.cache
def compiled(template, energy, judge=None, compiler=jit):
    """Return a copy of a function in which `energy` and `judge` are these modules, compiled.

    Parameters
    ----------
    template : function
        Of this package, not compiled.
    energy : module
        With `cost_reduction`; with `drop` or `quick_reduction` where the template asks for it.
    judge : module, optional
        As `energy`; None: nothing is asked of it.
    compiler : callable
        A decorator of `meshlab_willmore.mesh.jit`.

    Returns
    -------
    callable
        With a name of its own, by which Numba's cache tells the copies apart.
    """
    modules = [module.__name__.rpartition(".")[2] for module in (energy, judge) if module]
    name = "_".join([template.__name__, *modules])
    return compiler(with_globals(template, name, {"energy": energy, "judge": judge}))


@functools.cache
def _kernels(module, is_potential, most_loss):
    energy = importlib.import_module(f"..energy.{module}", __package__)
    other = None if is_potential else willmore
    judge = other or energy
    score, compiler = scoring.score_each, jit
    if hasattr(energy, "quick_reduction"):
        score, compiler = scoring.score_quickly, allocating_jit
    elif hasattr(energy, "drop"):
        score, compiler = scoring.score_batches, allocating_jit
    return Kernels(
        energy=energy,
        number=costs.number_of(energy),
        judges=judge is energy,
        anneal=compiled(annealing.anneal, judge),
        score=compiled(score, energy, other, compiler),
        losses=compiled(annealing.find_losses, judge),
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
# Those for "mean curvature" with the tilts of faces against the normals of vertices.
TILT_KERNELS = _kernels(TILT, True, ENERGIES["mean curvature"].most_loss)
