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
    willmore,
)
from ..mesh.jit import jit
from . import greedy, variable_depth

# --- meshlab_willmore.search.greedy.advance ------------------------------------------------------


@jit
def greedy_virtual(task, progress):
    """Go on with greedy flips that lower the virtual Willmore energy."""
    return greedy.advance(task, progress, virtual.cost_reduction)


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


# --- meshlab_willmore.search.variable_depth.advance ----------------------------------------------


@jit
def depth_virtual(task, progress):
    """Go on with chains that are ranked by the virtual, judged by the true Willmore energy."""
    return variable_depth.advance(task, progress, virtual.cost_reduction, willmore.cost_reduction)


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
