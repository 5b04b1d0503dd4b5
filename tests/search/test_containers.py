"""The containers of the searches against those of Python."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshlab_willmore.search.containers import (
    NEVER,
    NONE,
    contains,
    empty_fifo,
    empty_heap,
    empty_pair_set,
    empty_watch_lists,
    first,
    insert,
    pop,
    push,
    reserve,
    unwatch,
    update,
    watch,
)

ITEMS, FACES = 30, 6
LARGEST = 2**31 - 2
PRIORITIES = st.sampled_from([NEVER, 0.0, 0.5, 1.0, 1.5, np.inf])


def check(heap, wanted):
    """The heap property, the places, and the order of equal priorities."""
    size = heap.size[0]
    assert size == len(wanted)
    for item in range(ITEMS):
        if item in wanted:
            assert heap.item[heap.place[item]] == item
            assert heap.priority[heap.place[item]] == wanted[item]
        else:
            assert heap.place[item] == NONE
    keys = list(zip(-heap.priority[:size], heap.item[:size], strict=True))
    assert all(keys[(p - 1) // 2] < keys[p] for p in range(1, size))


@settings(max_examples=40)
@given(st.lists(st.tuples(st.integers(0, ITEMS - 1), PRIORITIES), max_size=120))
def test_any_sequence_of_updates_keeps_the_heap(updates):
    heap, wanted = empty_heap(ITEMS), {}
    for item, priority in updates:
        update(heap, item, priority)
        wanted.pop(item, None)
        if priority != NEVER:
            wanted[item] = priority
        check(heap, wanted)


@pytest.mark.parametrize("seed", range(3))
def test_items_come_out_by_priority_then_by_number(seed):
    rng = np.random.default_rng(seed)
    priorities = rng.integers(0, 8, ITEMS).astype(float)
    heap = empty_heap(ITEMS)
    for item in rng.permutation(ITEMS):
        update(heap, item, priorities[item])
    order = []
    while heap.size[0]:
        order.append(int(first(heap)))
        update(heap, order[-1], NEVER)
    assert order == sorted(range(ITEMS), key=lambda item: (-priorities[item], item))


def test_a_queue_gives_each_item_back_once_first_in_first_out():
    rng = np.random.default_rng(0)
    fifo, model = empty_fifo(ITEMS), []
    for item in rng.integers(0, ITEMS, 400).tolist():
        if rng.random() < 0.5:
            push(fifo, item)
            model += [] if item in model else [item]
        elif model:
            assert pop(fifo) == model.pop(0)
        assert fifo.ends[1] == len(model)
        assert np.flatnonzero(fifo.is_queued).tolist() == sorted(model)


def test_pairs_against_a_python_set():
    rng = np.random.default_rng(0)
    pairs, wanted = empty_pair_set(), set()
    for a, b in rng.integers(0, 60, (900, 2)).tolist():
        assert contains(pairs, a, b) == (frozenset((a, b)) in wanted)
        pairs = reserve(pairs, 1)
        insert(pairs, a, b)
        wanted.add(frozenset((a, b)))
        assert contains(pairs, b, a)
        assert pairs.used[0] == len(wanted)
    assert len(pairs.slots) > len(empty_pair_set().slots)
    for a in range(60):
        for b in range(60):
            assert contains(pairs, a, b) == (frozenset((a, b)) in wanted)


def test_the_largest_indices_work():
    pairs = empty_pair_set()
    insert(pairs, LARGEST, LARGEST - 1)
    assert contains(pairs, LARGEST - 1, LARGEST)
    assert not contains(pairs, LARGEST, LARGEST)


def test_room_is_made_only_when_needed():
    pairs = empty_pair_set()
    half = len(pairs.slots) // 2
    assert reserve(pairs, half) is pairs
    larger = reserve(pairs, half + 1)
    assert len(larger.slots) == 2 * len(pairs.slots)
    assert len(reserve(pairs, 10 * half).slots) >= 20 * half


def test_neighbouring_pairs_spread_over_the_table():
    """The edges of a mesh have close indices; long chains of full slots would be slow."""
    pairs = reserve(empty_pair_set(), 6000)
    for v in range(3000):
        insert(pairs, v, v + 1)
        insert(pairs, v, v + 55)
    full = pairs.slots[:, 0] >= 0
    breaks = np.flatnonzero(~full)
    assert np.diff(breaks).max() < 40


def members(lists, face):
    h, found = lists.first[face], []
    while h != NONE:
        assert lists.face[h] == face
        found.append(int(h))
        h = lists.ahead[h]
    backwards = [int(lists.behind[h]) for h in found]
    assert backwards == [NONE, *found][: len(found)]
    return found


def test_an_edge_watches_one_face_at_a_time():
    rng = np.random.default_rng(0)
    lists = empty_watch_lists(FACES)
    model = {face: [] for face in range(FACES)}
    for _ in range(600):
        h, face = int(rng.integers(3 * FACES)), int(rng.integers(FACES))
        for listed in model.values():
            if h in listed:
                listed.remove(h)
        if rng.random() < 0.6:
            watch(lists, h, face)
            model[face].insert(0, h)
        else:
            unwatch(lists, h)
        assert {face: members(lists, face) for face in model} == model
        assert sorted(np.flatnonzero(lists.face != NONE).tolist()) == sorted(
            h for listed in model.values() for h in listed
        )
