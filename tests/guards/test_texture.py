"""The guard of texture mappings: one flip at a time, against areas in fractions."""

from fractions import Fraction

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.guards.texture import texture_coordinates
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import apex, flip
from tests import meshes
from tests.connectivity import can_flip
from tests.search.ways import locked_edges

ALL = guards.fold_limits(180.0, 0.0)
# A square with the diagonal i-j, and what else k and l may be.
I, J = (0.0, 0.0), (4.0, 4.0)
K, L = (0.0, 4.0), (4.0, 0.0)


def mapped(*mappings):
    """Two triangles (i, j, k), (j, i, l), whose vertices have these coordinates."""
    mesh = build(*meshes.two_triangles())
    wedges = np.concatenate([np.array(uv, float)[mesh.origin] for uv in mappings], axis=1)
    order = np.arange(2, dtype=np.int32)
    return mesh._replace(uv=texture_coordinates(wedges.reshape(2, 3, -1), order))


def is_refused(*mappings):
    mesh = mapped(*mappings)
    refused = guards.folds(mesh, 0, ALL)
    assert guards.folds(mesh, mesh.twin[0], ALL) == refused
    return refused


def signs(uv):
    """Signs of the texture triangles before the flip and after it, in fractions."""
    i, j, k, l = ([Fraction(x) for x in point] for point in uv)
    areas = [
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        for a, b, c in ((i, j, k), (j, i, l), (k, i, l), (l, j, k))
    ]
    found = [(area > 0) - (area < 0) for area in areas]
    return sorted(found[:2]), sorted(found[2:])


def is_fine(uv):
    """The rule in plain words: the same signs, or a flat one put right."""
    before, after = signs(uv)
    return before == after or (before, after) in (([0, 1], [1, 1]), ([-1, 0], [-1, -1]))


@pytest.mark.parametrize(
    ("uv", "fine"),
    [
        ([I, J, K, L], True),
        ([I, J, L, K], True),
        ([I, J, K, (4.0, 3.0)], True),
        ([I, J, (-4.0, 0.0), L], False),
        ([J, I, (-4.0, 0.0), L], False),
        ([I, J, (-4.0, 0.0), (4.0, 0.0)], False),
        ([I, J, (1.0, 1.0), L], True),
        ([I, J, (1.0, 1.0), K], True),
        ([I, J, (5.0, 5.0), L], False),
        ([I, J, (5.0, 5.0), (6.0, 6.0)], True),
        ([I, I, I, I], True),
        ([I, I, K, L], False),
        ([I, J, L, L], False),
        ([I, J, (1.0, 3.0), K], False),
    ],
    ids=[
        "convex",
        "mirrored",
        "convex, not quite a square",
        "turns one over",
        "turns one over, mirrored",
        "makes one flat",
        "puts a flat one right",
        "puts a flat one right, mirrored",
        "turns a flat one over",
        "all flat",
        "no mapping",
        "flat ones with one side at a point",
        "makes both flat",
        "spreads a fold",
    ],
)
def test_the_rule(uv, fine):
    assert is_fine(uv) == fine
    assert is_refused(uv) != fine


@pytest.mark.slow
def test_every_quad_of_a_small_grid_is_judged_as_by_fractions():
    """Flat and turned over triangles, and corners at one point, are all among them."""
    rng = np.random.default_rng(0)
    mesh = mapped([I, J, K, L])
    seen = set()
    for _ in range(20_000):
        uv = rng.integers(0, 4, (4, 2)).astype(float)
        mesh.uv[:] = uv[mesh.origin]
        assert guards.folds(mesh, 0, ALL) != is_fine(uv)
        seen.add((*map(tuple, signs(uv)), is_fine(uv)))
    assert len(seen) > 15


def test_what_is_flat_but_for_rounding_is_not_made_but_may_go():
    """A corner a few units in the last place off a line: its sign says little to a user."""
    rng = np.random.default_rng(1)
    for _ in range(300):
        i, j, k = rng.random((3, 2))
        off = k + (i - k) * rng.random()
        l = off + np.spacing(off) * rng.integers(-2, 3, 2)
        before, after = signs([i, j, k, l])
        if before[0] == before[1] != 0:
            assert is_refused([i, j, k, l])
            if before != after:
                continue
            # The other way round: what is nearly flat is put right.
            assert not is_refused([k, l, j, i])


def test_the_scale_of_a_mapping_changes_nothing():
    quads = ([I, J, K, L], [I, J, (-4.0, 0.0), L], [I, J, (1.0, 1.0), L])
    for scale in (1e-300, 1e-150, 1e150, 1e307):
        for uv in quads:
            assert is_refused(np.array(uv) * scale) == is_refused(uv)
        # Beside a mapping of another size, too.
        assert not is_refused(quads[0], np.array(quads[0]) * scale)
        assert is_refused(quads[0], np.array(quads[1]) * scale)


def test_all_mappings_count():
    good, bad = [I, J, K, L], [I, J, (-4.0, 0.0), L]
    assert not is_refused(good, good)
    assert is_refused(good, bad)
    assert is_refused(bad, good)
    assert not guards.folds(build(*meshes.two_triangles()), 0, ALL)


def test_coordinates_go_along_with_flips():
    """After any flips, the guard sees the mapping of a vertex at each corner of the vertex."""
    mesh = build(*meshes.bumpy_sphere(40, bump=0.6))
    uv = np.random.default_rng(0).integers(-3, 4, (40, 2)).astype(float)
    order = np.arange(len(mesh.origin) // 3, dtype=np.int32)
    mesh = mesh._replace(uv=texture_coordinates(uv[mesh.origin].reshape(-1, 3, 2), order))
    verdicts = []
    for h in np.random.default_rng(1).integers(0, len(mesh.origin), 400):
        if can_flip(mesh, h):
            quad = uv[
                [mesh.origin[h], mesh.origin[mesh.twin[h]], apex(mesh, h), apex(mesh, mesh.twin[h])]
            ]
            verdicts.append(guards.folds(mesh, h, ALL))
            assert verdicts[-1] != is_fine(quad)
            flip(mesh, h)
    assert 50 < sum(verdicts) < len(verdicts) - 50


def test_seams_and_faces_that_map_nowhere_are_locked():
    vertices, faces = meshes.grid(3, 3)
    uv = vertices[faces, :2]
    mesh = build(vertices, faces)
    order = np.arange(len(faces), dtype=np.int32)
    guards.lock_seams(mesh, texture_coordinates(uv, order))
    assert not mesh.locked.any()
    guards.lock_seams(mesh, mesh.uv)
    assert not mesh.locked.any()
    # The first square is a chart of its own: only one end of one of its edges stays where it was.
    moved = uv.copy()
    moved[:2][faces[:2] != 1] += 10.0
    guards.lock_seams(mesh, texture_coordinates(moved, order))
    assert locked_edges(mesh) == {frozenset((1, 5)), frozenset((4, 5))}
    for value in (np.nan, np.inf, -np.inf):
        mesh = build(vertices, faces)
        lost = uv.copy()
        lost[7, 1, 0] = value
        guards.lock_seams(mesh, texture_coordinates(lost, order))
        a, b, c = faces[7].tolist()
        assert locked_edges(mesh) == {frozenset((a, b)), frozenset((b, c)), frozenset((c, a))}
