"""The compiled searches by the name of the energy."""

from collections.abc import Callable
from typing import NamedTuple

from ..energy.kinds import KINDS
from . import entries


class Kernels(NamedTuple):
    """The compiled searches for one energy.

    Attributes
    ----------
    greedy, depth, anneal : callable
        The slices of the searches.
    score : callable
        Scores many edges, for `meshlab_willmore.search.parallel_greedy`.
    losses : callable
        `meshlab_willmore.search.annealing.find_losses`.
    total : callable
        The energy of a mesh that judges: the Willmore energy for the virtual one, which is no
        function of the mesh, else the energy itself.
    """

    greedy: Callable
    depth: Callable
    anneal: Callable
    score: Callable
    losses: Callable
    total: Callable


KERNELS = {
    "virtual willmore": Kernels(
        entries.greedy_virtual,
        entries.depth_virtual,
        entries.anneal_willmore,
        entries.score_virtual,
        entries.losses_willmore,
        KINDS["virtual willmore"].total,
    ),
    "willmore": Kernels(
        entries.greedy_willmore,
        entries.depth_willmore,
        entries.anneal_willmore,
        entries.score_willmore,
        entries.losses_willmore,
        KINDS["willmore"].total,
    ),
    "uniform virtual willmore": Kernels(
        entries.greedy_uniform,
        entries.depth_uniform,
        entries.anneal_uniform,
        entries.score_uniform,
        entries.losses_uniform,
        KINDS["uniform virtual willmore"].total,
    ),
    "area": Kernels(
        entries.greedy_area,
        entries.depth_area,
        entries.anneal_area,
        entries.score_area,
        entries.losses_area,
        KINDS["area"].total,
    ),
    "mean curvature": Kernels(
        entries.greedy_mean,
        entries.depth_mean,
        entries.anneal_mean,
        entries.score_mean,
        entries.losses_mean,
        KINDS["mean curvature"].total,
    ),
    "gaussian curvature": Kernels(
        entries.greedy_gaussian,
        entries.depth_gaussian,
        entries.anneal_gaussian,
        entries.score_gaussian,
        entries.losses_gaussian,
        KINDS["gaussian curvature"].total,
    ),
    "delaunay": Kernels(
        entries.greedy_delaunay,
        entries.depth_delaunay,
        entries.anneal_delaunay,
        entries.score_delaunay,
        entries.losses_delaunay,
        KINDS["delaunay"].total,
    ),
}
# Those for "virtual willmore" by where the virtual points are; `AT` stands for a number.
AT = "at"
PLACED_KERNELS = {
    "midpoint": KERNELS["virtual willmore"],
    "closest": KERNELS["virtual willmore"]._replace(
        greedy=entries.greedy_virtual_closest,
        depth=entries.depth_virtual_closest,
        score=entries.score_virtual_closest,
    ),
    AT: KERNELS["virtual willmore"]._replace(
        greedy=entries.greedy_virtual_at,
        depth=entries.depth_virtual_at,
        score=entries.score_virtual_at,
    ),
}
