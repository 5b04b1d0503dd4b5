"""The passes that flip only where the surface is folded."""

import numpy as np
import pytest

from meshlab_willmore import execution, folds, guards, optimize, optimize_flips
from meshlab_willmore.measure import self_intersections
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import flip
from studies import parts
from tests import meshes
from tests.connectivity import can_flip, validate_connectivity
from tests.search.ways import locked_edges, scramble

UNGUARDED = {"energy": "mean curvature", "foldangle": 180.0, "minshape": 0.0}


def prism(sides=16):
    turns = 2.0 * np.pi * np.arange(sides) / sides
    return parts.prism(np.column_stack([np.cos(turns), np.sin(turns)]), 0.0, 0.5)


def curvature(vertices, faces):
    return optimize_flips(vertices, faces, maxflips=0).absolute_mean_curvature_before


def test_a_tangle_that_single_flips_leave_is_undone():
    vertices, faces = prism()
    scrambled = faces_of(scramble(build(vertices, faces), 9, 0.5))
    wanted = curvature(vertices, faces)
    stuck = optimize_flips(vertices, scrambled, passes=[UNGUARDED])
    assert stuck.absolute_mean_curvature_after > 1.2 * wanted
    result = optimize_flips(vertices, scrambled, preset="faithful")
    assert result.absolute_mean_curvature_after == pytest.approx(wanted)
    assert [one.flips > 0 for one in result.passes[:2]] == [True, True]


def test_nothing_is_searched_where_nothing_is_folded():
    vertices, faces = meshes.sphere_hull(200)
    scrambled = faces_of(scramble(build(vertices, faces), 0, 0.1))
    assert not folds.faces_near_folds(build(vertices, scrambled)).any()
    result = optimize_flips(vertices, scrambled, preset="faithful")
    assert result.passes[0].flips > 0
    assert result.passes[1].flips == 0


def test_faces_near_folds_touch_those_bent_by_more_than_a_right_angle():
    # A strip of squares in the plane whose end is folded back.
    vertices = np.array([(x, y, 0.0) for x in range(6) for y in range(2)])
    vertices[10:] += (-1.9, 0.0, 0.4)
    squares = [(2 * x, 2 * x + 2, 2 * x + 3, 2 * x + 1) for x in range(5)]
    faces = np.array([face for a, b, c, d in squares for face in ((a, b, c), (a, c, d))])
    near = folds.faces_near_folds(build(vertices, faces.astype(np.int32)))
    folded = np.isin(faces, (8, 9)).sum(axis=1) == 2
    touching = np.isin(faces, faces[folded]).any(axis=1)
    assert folded.sum() == 2
    assert not touching.all()
    assert near.tolist() == touching.tolist()
    assert not folds.faces_near_folds(build(*meshes.cube(0.0))).any()


def test_locks_are_as_before_when_a_part_has_been_flipped():
    mesh = build(*meshes.bumpy_sphere(60, 3, bump=0.6))
    faces = mesh.origin.reshape(-1, 3)
    guards.lock_edges(mesh, faces[:9, :2].astype(np.int64))
    locked, outside = locked_edges(mesh), faces[40:].copy()
    selected = np.arange(len(faces)) < 40
    flips = 0
    with folds.locked_outside(mesh, selected) as part:
        for h in np.random.default_rng(0).permutation(len(mesh.origin)):
            if can_flip(part, h):
                flip(part, h)
                flips += 1
        assert locked_edges(part) > locked
    assert flips > 20
    validate_connectivity(mesh)
    assert locked_edges(mesh) == locked
    assert mesh.origin.reshape(-1, 3)[40:].tolist() == outside.tolist()


def test_the_guards_of_faithful_give_way_to_those_of_the_caller():
    vertices, faces = meshes.crumpled(6)
    unguarded = optimize_flips(vertices, faces, preset="faithful").passes[0]
    assert unguarded == optimize_flips(vertices, faces, passes=[UNGUARDED]).passes[0]
    guarded = optimize_flips(vertices, faces, preset="faithful", foldangle=20.0).passes[0]
    assert guarded != unguarded
    passes = [{**UNGUARDED, "foldangle": 20.0}]
    assert guarded == optimize_flips(vertices, faces, passes=passes).passes[0]


def cuts(vertices, faces):
    return int(self_intersections(vertices, faces).sum())


@pytest.mark.heavy
@pytest.mark.slow
def test_the_faithful_preset_never_leaves_more_cut_faces(monkeypatch):
    """On very bumpy spheres, faces come to cut others without the guard."""
    grew = 0
    for seed in range(6):
        vertices, faces = meshes.bumpy_sphere(120, seed, bump=0.9)
        before = cuts(vertices, faces)
        with monkeypatch.context() as patch:
            patch.setattr(optimize, "run_keeping_cuts", execution.run_all)
            free = optimize_flips(vertices, faces, preset="faithful")
        result = optimize_flips(vertices, faces, preset="faithful")
        assert cuts(vertices, result.faces) <= before
        if cuts(vertices, free.faces) > before:
            grew += 1
            guarded = optimize_flips(vertices, faces, preset="faithful", checkintersections=True)
            np.testing.assert_array_equal(result.faces, guarded.faces)
            assert result.deviation == guarded.deviation
        else:
            np.testing.assert_array_equal(result.faces, free.faces)
    assert 0 < grew < 6
