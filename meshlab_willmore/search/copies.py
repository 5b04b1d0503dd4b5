"""Copies of functions in which global names mean something else.

Numba never finds a kernel in its cache that takes another one as an argument, or that is a closure.
So what is written once for several energies names the module of an energy as a global of its own
module, and each energy gets a copy in which that name means another module.
"""

from types import FunctionType


def with_globals(template, name, names):
    """Return a copy of a function.

    Parameters
    ----------
    template : function
        Of this package, not compiled.
    name : str
        Of the copy. Numba's cache tells the copies apart by it.
    names : dict of str
        Globals of the template that mean something else in the copy.

    Returns
    -------
    function
        Not compiled.
    """
    copy = FunctionType(template.__code__, {**template.__globals__, **names}, name)
    copy.__qualname__ = name
    return copy
