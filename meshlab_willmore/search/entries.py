"""The searches for each energy: thin kernels that Numba can keep on disk.

The search itself takes the energy as a parameter, and Numba never finds such a kernel in its cache.
"""

from ..energy import virtual, virtual_at, virtual_closest, willmore
from ..mesh.jit import jit
from . import greedy, variable_depth


@jit
def greedy_virtual(task, progress):
    """Go on with `meshlab_willmore.search.greedy.advance` on the virtual Willmore energy."""
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
    """Go on with `meshlab_willmore.search.greedy.advance` on the Willmore energy."""
    return greedy.advance(task, progress, willmore.cost_reduction)


@jit
def depth_virtual(task, progress):
    """Go on with `variable_depth.advance`, ranked by the virtual, judged by the true energy."""
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
    """Go on with `meshlab_willmore.search.variable_depth.advance` on the Willmore energy."""
    return variable_depth.advance(task, progress, willmore.cost_reduction, None)
