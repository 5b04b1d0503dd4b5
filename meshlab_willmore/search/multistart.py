"""The thorough search: chains of flips from several starts.

    for the mesh itself, and for the mesh after greedy descent on each of some other energies:
        lower the energy by chains of flips
    return the best of these states

Chains of flips (`meshlab_willmore.search.variable_depth`) leave most local minima, but from a bad
triangulation a few places stay tangled. What untangles them is another energy: the harmonic index,
which that search itself follows first where this ends lower, and the total absolute mean curvature
see where the surface is rough from much further off, and greedy descent on them takes no time
beside the chains. Where creases and folds matter, the mesh itself often is the best start. Since it
is always among the starts, the result is never worse than that of chains alone.

Random kicks around each edge followed by chains, kept where they helped, were tried too: they found
next to nothing more in ten times the time.
"""

from ..progress import stage
from . import variable_depth
from .rules import DEFAULTS
from .snapshots import better, descend, extend, finish, snapshot_of

# The part of the time of a start that greedy descent takes.
DESCENT = 0.05


def run(kernels, mesh, rules, bvh=None, settings=DEFAULTS):
    """Flip edges of `mesh` in place to the best state that chains reach from several starts.

    Parameters and result are those of `meshlab_willmore.search.greedy.run`, but the gain is the
    drop of the energy that judges. `Rules.maxflips` limits the flips on the way to each state. The
    monotone rule holds from each start, and the best state is no worse than the one that it leads
    to from the mesh itself.
    """
    one_way = settings._replace(warm_starts=settings.warm_starts[:1])

    def chains(mesh, rules, bvh):
        return variable_depth.run(kernels, mesh, rules, bvh, one_way)

    begin = snapshot_of(mesh, bvh)
    others = settings.warm_starts[1:]
    starts = 1 + len(others)
    with stage(1 / starts, f"start 1 of {starts}"):
        found = extend(begin, chains, rules)
    for number, (warm_kernels, warm_rules) in enumerate(others, start=2):
        limited = warm_rules._replace(maxflips=rules.maxflips)
        with stage(1 / (starts - number + 1), f"start {number} of {starts}"):
            with stage(DESCENT):
                start = descend(warm_kernels, begin, limited)
            found = better(kernels, rules, found, extend(start, chains, rules))
    return finish(kernels, mesh, found)
