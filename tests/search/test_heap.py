"""The queue against a dictionary."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshlab_willmore.search.heap import ABSENT, NEVER, empty_queue, first, update

ITEMS = 30
PRIORITIES = st.sampled_from([NEVER, 0.0, 0.5, 1.0, 1.5, np.inf])


def check(queue, wanted):
    """The heap property, the places, and the order of equal priorities."""
    size = queue.size[0]
    assert size == len(wanted)
    for item in range(ITEMS):
        if item in wanted:
            assert queue.item[queue.place[item]] == item
            assert queue.priority[queue.place[item]] == wanted[item]
        else:
            assert queue.place[item] == ABSENT
    keys = list(zip(-queue.priority[:size], queue.item[:size], strict=True))
    assert all(keys[(p - 1) // 2] < keys[p] for p in range(1, size))


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.lists(st.tuples(st.integers(0, ITEMS - 1), PRIORITIES), max_size=120))
def test_any_sequence_of_updates_keeps_the_heap(updates):
    queue, wanted = empty_queue(ITEMS), {}
    for item, priority in updates:
        update(queue, item, priority)
        wanted.pop(item, None)
        if priority != NEVER:
            wanted[item] = priority
        check(queue, wanted)


@pytest.mark.parametrize("seed", range(3))
def test_items_come_out_by_priority_then_by_number(seed):
    rng = np.random.default_rng(seed)
    priorities = rng.integers(0, 8, ITEMS).astype(float)
    queue = empty_queue(ITEMS)
    for item in rng.permutation(ITEMS):
        update(queue, item, priorities[item])
    order = []
    while queue.size[0]:
        order.append(int(first(queue)))
        update(queue, order[-1], NEVER)
    assert order == sorted(range(ITEMS), key=lambda item: (-priorities[item], item))
