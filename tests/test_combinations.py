"""The rows that `pairwise` chooses."""

import itertools

from tests.combinations import pairwise


def test_each_two_values_meet_in_few_rows():
    parameters = range(8), range(7), range(5), range(2)
    rows = pairwise(*parameters)
    assert len(rows) <= 60
    for i, j in itertools.combinations(range(len(parameters)), 2):
        met = {(row[i], row[j]) for row in rows}
        assert met == set(itertools.product(parameters[i], parameters[j]))


def test_the_rows_are_always_the_same():
    assert pairwise("abc", [1, 2], (3,)) == pairwise("xyz", [4, 5], (6,))
