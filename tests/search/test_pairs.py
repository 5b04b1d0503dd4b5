"""The set of vertex pairs against Python's."""

import numpy as np

from meshlab_willmore.search.pairs import contains, insert, no_pairs, reserve

LARGEST = 2**31 - 2


def test_pairs_against_a_python_set():
    rng = np.random.default_rng(0)
    pairs, wanted = no_pairs(), set()
    for a, b in rng.integers(0, 60, (900, 2)).tolist():
        assert contains(pairs, a, b) == (frozenset((a, b)) in wanted)
        pairs = reserve(pairs, 1)
        insert(pairs, a, b)
        wanted.add(frozenset((a, b)))
        assert contains(pairs, b, a)
        assert pairs.used[0] == len(wanted)
    assert len(pairs.slots) > len(no_pairs().slots)
    for a in range(60):
        for b in range(60):
            assert contains(pairs, a, b) == (frozenset((a, b)) in wanted)


def test_the_largest_indices_work():
    pairs = no_pairs()
    insert(pairs, LARGEST, LARGEST - 1)
    assert contains(pairs, LARGEST - 1, LARGEST)
    assert not contains(pairs, LARGEST, LARGEST)


def test_room_is_made_only_when_needed():
    pairs = no_pairs()
    half = len(pairs.slots) // 2
    assert reserve(pairs, half) is pairs
    larger = reserve(pairs, half + 1)
    assert len(larger.slots) == 2 * len(pairs.slots)
    assert len(reserve(pairs, 10 * half).slots) >= 20 * half


def test_neighbouring_pairs_spread_over_the_table():
    """The edges of a mesh have close indices; long chains of full slots would be slow."""
    pairs = reserve(no_pairs(), 6000)
    for v in range(3000):
        insert(pairs, v, v + 1)
        insert(pairs, v, v + 55)
    full = pairs.slots[:, 0] >= 0
    breaks = np.flatnonzero(~full)
    assert np.diff(breaks).max() < 40
