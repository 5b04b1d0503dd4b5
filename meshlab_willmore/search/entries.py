"""The searches for each energy: thin kernels that Numba can keep on disk.

The search itself takes the energy as a parameter, and Numba never finds such a kernel in its cache.
"""

from ..energy import (
    area,
    delaunay,
    gaussian_curvature,
    mean_curvature,
    uniform,
    virtual,
    virtual_at,
    virtual_closest,
    willmore,
)
from ..mesh.jit import jit
from . import annealing, batches, greedy, variable_depth

# --- meshlab_willmore.search.greedy.advance ------------------------------------------------------


@jit
def greedy_virtual(task, progress):
    """Go on with greedy flips that lower the virtual Willmore energy."""
    return greedy.advance(task, progress, virtual.cost_reduction)


@jit
def greedy_virtual_closest(task, progress):
    """Go on with `greedy.advance`, virtual points where the diagonals pass nearest each other."""
    return greedy.advance(task, progress, virtual_closest.cost_reduction)


@jit
def greedy_virtual_at(task, progress):
    """Go on with `greedy.advance`, virtual points at the place that the rules give."""
    return greedy.advance(task, progress, virtual_at.cost_reduction)


@jit
def greedy_willmore(task, progress):
    """Go on with greedy flips that lower the Willmore energy."""
    return greedy.advance(task, progress, willmore.cost_reduction)


@jit
def greedy_uniform(task, progress):
    """Go on with greedy flips that lower the uniform virtual Willmore energy."""
    return greedy.advance(task, progress, uniform.cost_reduction)


@jit
def greedy_area(task, progress):
    """Go on with greedy flips that lower the area."""
    return greedy.advance(task, progress, area.cost_reduction)


@jit
def greedy_mean(task, progress):
    """Go on with greedy flips that lower the absolute mean curvature."""
    return greedy.advance(task, progress, mean_curvature.cost_reduction)


@jit
def greedy_gaussian(task, progress):
    """Go on with greedy flips that lower the absolute Gaussian curvature."""
    return greedy.advance(task, progress, gaussian_curvature.cost_reduction)


@jit
def greedy_delaunay(task, progress):
    """Go on with greedy flips that lower the harmonic index."""
    return greedy.advance(task, progress, delaunay.cost_reduction)


# --- meshlab_willmore.search.batches.score_in_lanes, score_each --------------------------


@jit
def score_virtual(board, start, stop):
    """Score edges by the virtual Willmore energy."""
    batches.score_in_lanes(board, start, stop, virtual.drop, willmore.drop)


@jit
def score_willmore(board, start, stop):
    """Score edges by the Willmore energy."""
    batches.score_in_lanes(board, start, stop, willmore.drop, None)


@jit
def score_virtual_closest(board, start, stop):
    """Score edges by the virtual Willmore energy where the diagonals pass nearest each other."""
    batches.score_each(board, start, stop, virtual_closest.cost_reduction)


@jit
def score_virtual_at(board, start, stop):
    """Score edges by the virtual Willmore energy at the place that the rules give."""
    batches.score_each(board, start, stop, virtual_at.cost_reduction)


@jit
def score_uniform(board, start, stop):
    """Score edges by the uniform virtual Willmore energy."""
    batches.score_each(board, start, stop, uniform.cost_reduction)


@jit
def score_area(board, start, stop):
    """Score edges by the area."""
    batches.score_each(board, start, stop, area.cost_reduction)


@jit
def score_mean(board, start, stop):
    """Score edges by the absolute mean curvature."""
    batches.score_each(board, start, stop, mean_curvature.cost_reduction)


@jit
def score_gaussian(board, start, stop):
    """Score edges by the absolute Gaussian curvature."""
    batches.score_each(board, start, stop, gaussian_curvature.cost_reduction)


@jit
def score_delaunay(board, start, stop):
    """Score edges by the harmonic index."""
    batches.score_each(board, start, stop, delaunay.cost_reduction)


# --- meshlab_willmore.search.variable_depth.advance ----------------------------------------------


@jit
def depth_virtual(task, progress):
    """Go on with chains that are ranked by the virtual, judged by the true Willmore energy."""
    return variable_depth.advance(task, progress, virtual.cost_reduction, willmore.cost_reduction)


@jit
def depth_virtual_closest(task, progress):
    """Go on as `depth_virtual` does, virtual points where the diagonals pass nearest each other."""
    return variable_depth.advance(
        task, progress, virtual_closest.cost_reduction, willmore.cost_reduction
    )


@jit
def depth_virtual_at(task, progress):
    """Go on as `depth_virtual` does, virtual points at the place that the rules give."""
    return variable_depth.advance(
        task, progress, virtual_at.cost_reduction, willmore.cost_reduction
    )


@jit
def depth_willmore(task, progress):
    """Go on with chains of flips that lower the Willmore energy."""
    return variable_depth.advance(task, progress, willmore.cost_reduction, None)


@jit
def depth_uniform(task, progress):
    """Go on with chains of flips that lower the uniform virtual Willmore energy."""
    return variable_depth.advance(task, progress, uniform.cost_reduction, None)


@jit
def depth_area(task, progress):
    """Go on with chains of flips that lower the area."""
    return variable_depth.advance(task, progress, area.cost_reduction, None)


@jit
def depth_mean(task, progress):
    """Go on with chains of flips that lower the absolute mean curvature."""
    return variable_depth.advance(task, progress, mean_curvature.cost_reduction, None)


@jit
def depth_gaussian(task, progress):
    """Go on with chains of flips that lower the absolute Gaussian curvature."""
    return variable_depth.advance(task, progress, gaussian_curvature.cost_reduction, None)


@jit
def depth_delaunay(task, progress):
    """Go on with chains of flips that lower the harmonic index."""
    return variable_depth.advance(task, progress, delaunay.cost_reduction, None)


# --- meshlab_willmore.search.annealing.advance ---------------------------------------------------


@jit
def anneal_willmore(task, walk, draws, temperature):
    """Go on with random flips that the Willmore energy judges."""
    return annealing.advance(task, walk, draws, temperature, willmore.cost_reduction)


@jit
def anneal_uniform(task, walk, draws, temperature):
    """Go on with random flips that the uniform virtual Willmore energy judges."""
    return annealing.advance(task, walk, draws, temperature, uniform.cost_reduction)


@jit
def anneal_area(task, walk, draws, temperature):
    """Go on with random flips that the area judges."""
    return annealing.advance(task, walk, draws, temperature, area.cost_reduction)


@jit
def anneal_mean(task, walk, draws, temperature):
    """Go on with random flips that the absolute mean curvature judges."""
    return annealing.advance(task, walk, draws, temperature, mean_curvature.cost_reduction)


@jit
def anneal_gaussian(task, walk, draws, temperature):
    """Go on with random flips that the absolute Gaussian curvature judges."""
    return annealing.advance(task, walk, draws, temperature, gaussian_curvature.cost_reduction)


@jit
def anneal_delaunay(task, walk, draws, temperature):
    """Go on with random flips that the harmonic index judges."""
    return annealing.advance(task, walk, draws, temperature, delaunay.cost_reduction)


# --- meshlab_willmore.search.annealing.find_losses -----------------------------------------------


@jit
def losses_willmore(mesh, rules, first, losses):
    """Find what the Willmore energy loses by flips."""
    annealing.find_losses(mesh, rules, first, losses, willmore.cost_reduction)


@jit
def losses_uniform(mesh, rules, first, losses):
    """Find what the uniform virtual Willmore energy loses by flips."""
    annealing.find_losses(mesh, rules, first, losses, uniform.cost_reduction)


@jit
def losses_area(mesh, rules, first, losses):
    """Find what the area loses by flips."""
    annealing.find_losses(mesh, rules, first, losses, area.cost_reduction)


@jit
def losses_mean(mesh, rules, first, losses):
    """Find what the absolute mean curvature loses by flips."""
    annealing.find_losses(mesh, rules, first, losses, mean_curvature.cost_reduction)


@jit
def losses_gaussian(mesh, rules, first, losses):
    """Find what the absolute Gaussian curvature loses by flips."""
    annealing.find_losses(mesh, rules, first, losses, gaussian_curvature.cost_reduction)


@jit
def losses_delaunay(mesh, rules, first, losses):
    """Find what the harmonic index loses by flips."""
    annealing.find_losses(mesh, rules, first, losses, delaunay.cost_reduction)
