"""The rows that `pairwise` chooses, and products of values with marks."""

import itertools

import pytest

from tests.combinations import pairwise, products


def test_each_two_values_meet_in_few_rows():
    parameters = range(8), range(7), range(5), range(2)
    rows = pairwise(*parameters)
    assert len(rows) <= 60
    for i, j in itertools.combinations(range(len(parameters)), 2):
        met = {(row[i], row[j]) for row in rows}
        assert met == set(itertools.product(parameters[i], parameters[j]))


def test_the_rows_are_always_the_same():
    assert pairwise("abc", [1, 2], (3,)) == pairwise("xyz", [4, 5], (6,))


def test_values_of_a_product_keep_their_marks():
    both = pytest.param("b", 2, marks=pytest.mark.heavy)
    rows = products(["a", both], "xy", "xy")
    names = {row.values: sorted(mark.name for mark in row.marks) for row in rows}
    assert len(names) == 8
    daily = [values for values, marks in names.items() if "nightly" not in marks]
    assert 4 <= len(daily) < 8
    assert all(("heavy" in marks) == (values[:2] == ("b", 2)) for values, marks in names.items())
