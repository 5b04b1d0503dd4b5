"""What a flip gains in a search: the one place that knows which numbers an energy asks for.

An energy is a jitted function of a mesh and a half-edge. One that depends on where the virtual
points stand takes their place as a third argument, which is a number of the rules, so that it is
compiled once for all places. Numba looks at the function when it compiles a search, so nothing of
the choice is left at run time.
"""

from numba.extending import overload

PLACED = 3


def gain_of(energy, mesh, h, rules):
    """Return the cost reduction of `h`.

    Parameters
    ----------
    energy : callable
        Jitted function of a mesh and a half-edge, and of `Rules.virtualpoint` if it has a third
        parameter.
    mesh : Mesh
    h : int
        Half-edge with a twin.
    rules : Rules

    Returns
    -------
    float
        In the unit of the energy.
    """
    if energy.__code__.co_argcount == PLACED:
        return energy(mesh, h, rules.virtualpoint)
    return energy(mesh, h)


@overload(gain_of)
def _compiled_gain_of(energy, mesh, h, rules):
    if energy.dispatcher.py_func.__code__.co_argcount == PLACED:
        return lambda energy, mesh, h, rules: energy(mesh, h, rules.virtualpoint)
    return lambda energy, mesh, h, rules: energy(mesh, h)
