"""Lists of waiting edges against lists in Python."""

import numpy as np

from meshlab_willmore.search.waiting import NONE, leave, nothing_waits, wait

FACES = 6


def members(waiting, face):
    h, found = waiting.first[face], []
    while h != NONE:
        assert waiting.face[h] == face
        found.append(int(h))
        h = waiting.ahead[h]
    backwards = [int(waiting.behind[h]) for h in found]
    assert backwards == [NONE, *found][: len(found)]
    return found


def test_edges_wait_for_one_face_at_a_time():
    rng = np.random.default_rng(0)
    waiting = nothing_waits(FACES)
    model = {face: [] for face in range(FACES)}
    for _ in range(600):
        h, face = int(rng.integers(3 * FACES)), int(rng.integers(FACES))
        for listed in model.values():
            if h in listed:
                listed.remove(h)
        if rng.random() < 0.6:
            wait(waiting, h, face)
            model[face].insert(0, h)
        else:
            leave(waiting, h)
        assert {face: members(waiting, face) for face in model} == model
        assert sorted(np.flatnonzero(waiting.face != NONE).tolist()) == sorted(
            h for listed in model.values() for h in listed
        )
