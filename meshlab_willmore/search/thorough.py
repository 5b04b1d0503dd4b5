"""The thorough search: chains of flips from several starts.

    for the mesh itself, and for the mesh after greedy descent on each of some other energies:
        lower the energy by chains of flips
    return the best of these states

Chains of flips (`meshlab_willmore.search.variable_depth`) leave most local minima, but from a bad
triangulation a few places stay tangled. What untangles them is another energy: the harmonic index
and the total absolute mean curvature see where the surface is rough from much further off, and
greedy descent on them takes no time beside the chains. On smooth surfaces that start is the best,
whatever the triangulation; where creases and folds matter, the mesh itself often is. Since the mesh
itself is always among the starts, the result is never worse than that of chains alone.

Random kicks around each edge followed by chains, kept where they helped, were tried too: they found
next to nothing more in ten times the time.
"""

import functools
from collections.abc import Callable
from typing import NamedTuple

from ..guards.bvh import inactive_bvh
from ..mesh.notify import stage
from . import greedy, variable_depth
from .rules import Rules
from .states import better, extend, finish, start_from


class Prelude(NamedTuple):
    """A descent before the search proper: the greedy kernel of an energy, and rules for it."""

    kernel: Callable
    rules: Rules


def run(kernels, preludes, mesh, rules, reach, space=None):
    """Flip edges of `mesh` in place to the best state that chains reach from several starts.

    Parameters
    ----------
    kernels : Kernels
        For one energy.
    preludes : sequence of Prelude
        Each makes one more start of the mesh. Their rules hold for these descents.
    mesh : Mesh
    rules : Rules
        `maxflips` limits the flips on the way to each state. The monotone rule holds from each
        start, and the best state is no worse than the one that it leads to from the mesh itself.
    reach : Reach
        How far chains go.
    space : Bvh, optional
        The guard against self-intersections, up to date with the mesh. It holds for each flip.

    Returns
    -------
    Progress
        `flips` on the way to the result; `gain`: the drop of the energy that judges; the state is
        `CONVERGED` or `STOPPED`.
    """

    def chains(at, left, around):
        return variable_depth.run(kernels.depth, kernels.greedy, at, left, reach, around)

    begin = start_from(mesh, inactive_bvh() if space is None else space)
    starts = 1 + len(preludes)
    with stage(f"start 1 of {starts}"):
        found = extend(begin, chains, rules)
    for number, prelude in enumerate(preludes, start=2):
        descent = functools.partial(greedy.run, prelude.kernel)
        limited = prelude.rules._replace(maxflips=rules.maxflips)
        with stage(f"start {number} of {starts}"):
            start = extend(begin, descent, limited)
            found = better(kernels, rules, found, extend(start, chains, rules))
    return finish(kernels, mesh, found)
