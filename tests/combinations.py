"""Which options tests combine: none that mean the same, and pairs of values for whole products."""

import itertools

import pytest

from meshlab_willmore.energy import table

# Without the JIT, kernels of the others take too long.
BOTH_WILLMORE = ("virtual willmore", "willmore")


def _param(energy, *values):
    marks = () if energy in BOTH_WILLMORE else pytest.mark.heavy
    return pytest.param(energy, *values, marks=marks)


ENERGIES = [_param(energy) for energy in table.ENERGIES]
# `energy` and `monotone`, which means nothing where a cost reduction is the drop of the energy; but
# with it a flip of a narrow energy has to score as many edges as those of the others.
ENERGIES_AND_RULES = [
    _param(energy, monotone)
    for energy, row in table.ENERGIES.items()
    for monotone in ((True, False) if row.is_narrow or not row.is_potential else (True,))
]


def products(*parameters):
    """Parametrize by whole products; by day such rows only that each two values meet in one.

    A value may be one or several with marks: ``pytest.param(value, ..., marks=...)``.
    """
    daily = pairwise(*parameters)
    rows = itertools.product(*(enumerate(map(_marked, values)) for values in parameters))
    found = []
    for numbers, values in (zip(*row, strict=True) for row in rows):
        marks = [mark for value in values for mark in value.marks]
        marks += [] if numbers in daily else [pytest.mark.nightly]
        found.append(pytest.param(*(one for value in values for one in value.values), marks=marks))
    return found


def _marked(value):
    return value if isinstance(value, type(pytest.param())) else pytest.param(value)


def pairwise(*parameters):
    """Choose rows of the product such that each two values of two parameters meet in one.

    Parameters
    ----------
    parameters : sequence
        The values of one parameter.

    Returns
    -------
    set of tuple of int
        For each parameter the number of its value. Always the same ones, and few of all.
    """
    numbers = [range(len(values)) for values in parameters]
    pairs_of = {row: _pairs(row) for row in itertools.product(*numbers)}
    left, rows = set().union(*pairs_of.values()), set()
    while left:
        row = max(pairs_of, key=lambda row: len(pairs_of[row] & left))
        left -= pairs_of[row]
        rows.add(row)
    return rows


def _pairs(row):
    return set(itertools.combinations(enumerate(row), 2))
