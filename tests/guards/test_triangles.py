"""Which faces intersect, against clipping in fractions."""

import itertools

import numpy as np
import pytest

from meshlab_willmore.guards.intersections import face_of, intersect, shared_vertices
from tests import solids

PATTERNS = {
    "no common vertex": ((0, 1, 2), (3, 4, 5)),
    "one": ((0, 1, 2), (2, 3, 4)),
    "two": ((0, 1, 2), (1, 0, 3)),
    "three": ((0, 1, 2), (1, 2, 0)),
}


def in_a_plane(rng):
    return rng.integers(-2, 3, (6, 2)) @ rng.integers(-2, 3, (2, 3)) * 1.0


def on_a_line(rng):
    return rng.integers(-2, 3, (6, 1)) @ rng.integers(-1, 2, (1, 3)) * 1.0


def nearly_touching(rng):
    """A corner moved onto the other triangle, up to rounding."""
    points = rng.normal(size=(6, 3))
    for target in (2, 3, 4):
        others = [x for x in range(6) if x != target]
        weights = rng.choice([0.0, 1.0, 2.0, -1.0], 2) / 2
        a, b, c = points[rng.choice(others, 3, replace=False)]
        points[target] = a + weights[0] * (b - a) + weights[1] * (c - a)
    return points


FAMILIES = {
    "cube of 8": lambda rng: rng.integers(0, 2, (6, 3)) * 1.0,
    "cube of 27": lambda rng: rng.integers(0, 3, (6, 3)) * 1.0,
    "integers": lambda rng: rng.integers(-4, 5, (6, 3)) * 1.0,
    "in a plane": in_a_plane,
    "in a tilted plane": lambda rng: rng.integers(-2, 3, (6, 2)) @ rng.normal(size=(2, 3)),
    "on a line": on_a_line,
    "few points": lambda rng: rng.integers(-1, 2, (3, 3))[rng.integers(0, 3, 6)] * 1.0,
    "nearly touching": nearly_touching,
    "random": lambda rng: rng.normal(size=(6, 3)),
}


def both_ways(vertices, one, other):
    """The kernel's answer, which must not depend on the order of faces and corners."""
    answers = set()
    for turned in (one, one[1:] + one[:1], one[::-1]):
        for first, second in ((turned, other), (other[2:] + other[:2], turned)):
            p, q = face_of(vertices, *first), face_of(vertices, *second)
            answers.add(bool(intersect(p, q, shared_vertices(p, q))))
    assert len(answers) == 1
    return answers.pop()


@pytest.mark.parametrize("sharing", PATTERNS)
@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.slow
def test_intersections_are_those_of_clipping(family, sharing):
    rng = np.random.default_rng(0)
    one, other = PATTERNS[sharing]
    seen = set()
    for _ in range(400):
        vertices = np.asarray(FAMILIES[family](rng), float)
        wanted = solids.cut(solids.exact(vertices), one, other)
        assert both_ways(vertices, one, other) == wanted, vertices.tolist()
        seen.add(wanted)
    assert len(seen) == 2 or sharing == "three" or (family, sharing) in ONE_ANSWER


# To fold back exactly is rare among random points, and on a line apart is what is rare.
ONE_ANSWER = {("random", "two")}


def test_all_ways_to_share_vertices_are_found():
    vertices = np.zeros((6, 3))
    for one in itertools.permutations(range(4), 3):
        for other in itertools.permutations(range(6), 3):
            found = shared_vertices(face_of(vertices, *one), face_of(vertices, *other))
            shared = set(one) & set(other)
            assert found.number == len(shared)
            if len(shared) == 1:
                assert {one[found.corner]} == {other[found.other]} == shared
            if len(shared) == 2:
                assert {one[found.corner]} == set(one) - shared
                assert {other[found.other]} == set(other) - shared
