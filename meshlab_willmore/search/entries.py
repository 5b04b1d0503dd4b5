"""The searches for each energy: thin kernels that Numba can keep on disk.

The search itself takes the energy as a parameter, and Numba never finds such a kernel in its cache.
"""

from ..energy import virtual, willmore
from ..mesh.jit import jit
from .greedy import advance


@jit
def greedy_virtual(task, progress):
    """Go on with `meshlab_willmore.search.greedy.advance` on the virtual Willmore energy."""
    return advance(task, progress, virtual.cost_reduction)


@jit
def greedy_willmore(task, progress):
    """Go on with `meshlab_willmore.search.greedy.advance` on the Willmore energy."""
    return advance(task, progress, willmore.cost_reduction)
