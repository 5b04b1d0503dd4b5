"""The passes that flip only where the surface is folded, or bent."""

import numpy as np
import pytest

from meshlab_willmore import execution, folds, guards, optimize, optimize_flips
from meshlab_willmore.measure import self_intersections
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import flip
from meshlab_willmore.presets import PRESETS
from studies import parts
from tests import meshes
from tests.connectivity import can_flip, validate_connectivity
from tests.search.ways import locked_edges, scramble

UNGUARDED = {"energy": "mean curvature", "foldangle": 180.0, "minshape": 0.0}


def prism(sides=16):
    turns = 2.0 * np.pi * np.arange(sides) / sides
    return parts.prism(np.column_stack([np.cos(turns), np.sin(turns)]), 0.0, 0.5)


def near_folds(vertices, faces):
    mesh = build(vertices, faces)
    return folds.faces_near_folds(mesh, folds.least_cosines(mesh))


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
    assert not near_folds(vertices, scrambled).any()
    result = optimize_flips(vertices, scrambled, preset="faithful")
    assert result.passes[0].flips > 0
    assert result.passes[1].flips == 0


def test_faces_near_folds_touch_those_bent_by_more_than_a_right_angle():
    # A strip of squares in the plane whose end is folded back.
    vertices = np.array([(x, y, 0.0) for x in range(6) for y in range(2)])
    vertices[10:] += (-1.9, 0.0, 0.4)
    squares = [(2 * x, 2 * x + 2, 2 * x + 3, 2 * x + 1) for x in range(5)]
    faces = np.array([face for a, b, c, d in squares for face in ((a, b, c), (a, c, d))])
    near = near_folds(vertices, faces.astype(np.int32))
    folded = np.isin(faces, (8, 9)).sum(axis=1) == 2
    touching = np.isin(faces, faces[folded]).any(axis=1)
    assert folded.sum() == 2
    assert not touching.all()
    assert near.tolist() == touching.tolist()
    assert not near_folds(*meshes.cube(0.0)).any()


def bent_strip(degrees):
    """A strip of squares, each bent against the one before by so many degrees."""
    turns = np.radians(np.cumsum([0.0, *degrees]))
    steps = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    x, z = np.vstack([np.zeros(2), np.cumsum(steps, axis=0)]).T
    vertices = np.array([(a, y, b) for a, b in zip(x, z, strict=True) for y in range(2)])
    corners = [(2 * s, 2 * s + 2, 2 * s + 3, 2 * s + 1) for s in range(len(turns))]
    faces = [face for a, b, c, d in corners for face in ((a, b, c), (a, c, d))]
    return vertices, np.array(faces, np.int32)


def at_bends(vertices, faces):
    mesh = build(vertices, faces)
    return folds.faces_at_bends(mesh, folds.least_cosines(mesh)).tolist()


def touching_fold(faces, square):
    """The faces that touch one of the two at the edge between a square and the next one."""
    edge = [2 * square + 2, 2 * square + 3]
    at_edge = np.isin(faces, edge).sum(axis=1) == 2
    return np.isin(faces, faces[at_edge]).any(axis=1)


@pytest.mark.parametrize(("degrees", "is_bend"), [(9.9, 0), (10, 1), (30, 1), (59.9, 1), (60, 0)])
def test_faces_at_bends_touch_those_bent_by_10_to_60_degrees(degrees, is_bend):
    vertices, faces = bent_strip([0.0, 0.0, 0.0, degrees, 0.0, 0.0, 0.0])
    touching = touching_fold(faces, 3)
    assert 2 < touching.sum() < len(faces)
    assert at_bends(vertices, faces) == (touching & bool(is_bend)).tolist()


def test_faces_near_creases_are_at_no_bend():
    vertices, faces = bent_strip([30.0] * 5 + [80.0] + [30.0] * 5)
    assert at_bends(vertices, faces) == (~touching_fold(faces, 5)).tolist()


def test_normals_of_rounding_are_no_bends():
    vertices, faces = bent_strip([0.0] * 4)
    vertices[4] = vertices[2] + 1e-9
    mesh = build(vertices, faces)
    assert folds.least_cosines(mesh).tolist() == [1.0] * len(faces)


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
    first = {**UNGUARDED, **PRESETS["faithful"].passes[0].options}
    vertices, faces = meshes.crumpled(6)
    unguarded = optimize_flips(vertices, faces, preset="faithful").passes[0]
    assert unguarded == optimize_flips(vertices, faces, passes=[first]).passes[0]
    guarded = optimize_flips(vertices, faces, preset="faithful", foldangle=20.0).passes[0]
    assert guarded != unguarded
    passes = [{**first, "foldangle": 20.0}]
    assert guarded == optimize_flips(vertices, faces, passes=passes).passes[0]


def cuts(vertices, faces):
    return int(self_intersections(vertices, faces).sum())


def crossing_sheets(seed, count=60, height=0.02, turn=0.1):
    """Two nearly flat patches that cut each other, scrambled."""
    sheets = [meshes.patch(count, seed + 100 * number, height) for number in range(2)]
    (lower, faces), (upper, others) = sheets
    c, s = np.cos(turn), np.sin(turn)
    turned = (upper - upper.mean(axis=0)) @ np.array([(1, 0, 0), (0, c, s), (0, -s, c)])
    vertices = np.vstack([lower, turned + lower.mean(axis=0) + 0.003])
    mesh = build(vertices, np.vstack([faces, others + count]).astype(np.int32))
    return vertices, faces_of(scramble(mesh, seed, 0.3))


@pytest.mark.heavy
def test_no_more_faces_cut_others_where_sheets_cross_without_folds(monkeypatch):
    grew = 0
    for seed in range(8):
        vertices, faces = crossing_sheets(seed)
        with monkeypatch.context() as patch:
            patch.setattr(optimize, "run_keeping_cuts", execution.run_all)
            free = optimize_flips(vertices, faces, preset="faithful")
        before = cuts(vertices, faces)
        is_worse = cuts(vertices, free.faces) > before
        result = optimize_flips(vertices, faces, preset="faithful")
        assert cuts(vertices, result.faces) <= before
        assert np.array_equal(result.faces, free.faces) != is_worse
        grew += is_worse and not near_folds(vertices, faces).any()
    assert grew


@pytest.mark.parametrize("energy", ["area", "mean curvature", "delaunay"])
def test_flips_gain_more_than_the_least_gain(energy):
    vertices, faces = meshes.bumpy_sphere(200, bump=0.05)
    gains = (0.0, 0.4, 1.0) if energy == "delaunay" else (0.0, 0.05, 1.0)
    passes = [{"energy": energy, "mingain": gain} for gain in gains]
    results = [optimize_flips(vertices, faces, passes=[one]) for one in passes]
    flips = [result.flips for result in results]
    assert flips[0] > flips[1] > flips[2]
    corners = vertices[faces]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    power = {"area": 2, "mean curvature": 1, "delaunay": 0}[energy]
    least = gains[1] * np.median(sides) ** power
    gain = results[1].passes[0].gain
    assert gain > flips[1] * least
    # The same of the mesh in other units.
    enlarged = optimize_flips(3.0 * vertices, faces, passes=[passes[1]])
    assert enlarged.flips == flips[1]


def test_normals_of_vertices_bring_faces_nearer_to_a_smooth_surface():
    vertices, faces = meshes.torus(600, 0.3, 1)
    faces = faces_of(scramble(build(vertices, faces), 0, 0.3))

    def error(faces):
        """The mean angle between faces and the torus at their middles, weighted with areas."""
        corners = vertices[faces]
        middles = corners.mean(axis=1)
        rings = 3.0 * middles * (1, 1, 0) / np.linalg.norm(middles[:, :2], axis=1)[:, None]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        areas, wanted = np.linalg.norm(across, axis=1), middles - rings
        sizes = areas * np.linalg.norm(wanted, axis=1)
        angles = np.arccos(np.einsum("nd,nd->n", across, wanted) / sizes)
        return float((areas * angles).sum() / areas.sum())

    bent = optimize_flips(vertices, faces, passes=[UNGUARDED])
    along = optimize_flips(vertices, bent.faces, passes=[{**UNGUARDED, "vertexnormals": True}])
    assert along.flips > 0
    assert along.mean_shape_after > along.mean_shape_before
    assert error(along.faces) < 0.98 * error(bent.faces)


@pytest.mark.heavy
@pytest.mark.slow
def test_the_faithful_preset_never_leaves_more_cut_faces(monkeypatch):
    """On very bumpy spheres, faces come to cut others without the guard."""
    grew = 0
    for seed in range(6):
        vertices, faces = meshes.bumpy_sphere(120, seed, bump=0.7)
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
