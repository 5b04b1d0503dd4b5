"""No search folds a texture mapping: the signs of the texture triangles, seams, covered areas."""

from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import guards
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import flip
from meshlab_willmore.optimize import optimize_flips
from meshlab_willmore.options import ENERGY, SEARCH
from meshlab_willmore.search import regions
from tests import meshes, reference
from tests.combinations import products
from tests.connectivity import can_flip

BUNNY = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes" / "bunny10k_textured.obj"
# Coordinates are multiples of this, so that areas and their sums are exact.
STEP = 2.0**-10
QUICK = {"depth": 3, "breadth": 2, "sweeps": 5}


def areas(wedges):
    """Twice the area of each texture triangle, with its sign."""
    a, b = wedges[:, 1] - wedges[:, 0], wedges[:, 2] - wedges[:, 0]
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def counts(wedges):
    found = np.sign(areas(wedges))
    return (found > 0).sum(), (found < 0).sum(), (found == 0).sum()


def distorted(vertices, faces, uv, seed):
    """Move each point of a mapping at random, as far as all its triangles stay well apart."""
    rng = np.random.default_rng(seed)
    sign = np.sign(areas(uv[faces]))
    for v in rng.permutation(len(uv)):
        old = uv[v].copy()
        uv[v] = np.round((old + rng.uniform(-0.45, 0.45, 2)) / STEP) * STEP
        if (areas(uv[faces]) * sign < 0.02).any():
            uv[v] = old
    return vertices, faces, uv[faces]


def bumpy_grid():
    vertices, faces = meshes.grid(8, 8)
    vertices[:, 2] = 0.6 * np.random.default_rng(1).random(len(vertices))
    return distorted(vertices, faces, vertices[:, :2].copy(), 2)


def mirrored():
    vertices, faces, wedges = bumpy_grid()
    return vertices, faces, wedges * (-1.0, 1.0)


def folded():
    """Some triangles are turned over already, some are flat, and some have no mapping."""
    vertices, faces = meshes.grid(8, 8)
    rng = np.random.default_rng(3)
    vertices[:, 2] = 0.6 * rng.random(len(vertices))
    wedges = np.round(vertices[:, :2] + rng.uniform(-0.8, 0.8, (len(vertices), 2)))[faces]
    wedges[: len(faces) // 4] = 0.0
    return vertices, faces, wedges


def closed():
    """A closed surface in two charts, the lower one mirrored, with a seam all round."""
    vertices, faces = meshes.bumpy_sphere(80, 1, bump=0.6)
    uv = np.round(vertices[:, :2] / np.linalg.norm(vertices, axis=1)[:, None] / STEP) * STEP
    wedges = uv[faces]
    wedges[vertices[faces].mean(axis=1)[:, 2] < 0.0] += 3.0
    return vertices, faces, wedges


MAPPED = {f.__name__.replace("_", " "): f() for f in (bumpy_grid, mirrored, folded, closed)}


def wedges_of_edges(faces, wedges):
    """For each edge, the coordinates that its faces have at its lower and its higher end."""
    sides = {}
    for face, corners in zip(faces.tolist(), wedges.tolist(), strict=True):
        for c in range(3):
            ends = {face[c]: tuple(corners[c]), face[c - 2]: tuple(corners[c - 2])}
            key = tuple(sorted(ends))
            sides.setdefault(key, set()).add(tuple(ends[v] for v in key))
    return sides


def seams(faces, wedges):
    found = wedges_of_edges(faces, wedges)
    return {edge: sides for edge, sides in found.items() if len(sides) > 1}


def carried(wedges, result):
    return wedges.reshape(-1, wedges.shape[2])[result.corners]


def assert_kept(faces, wedges, result):
    """What flips promise of a mapping."""
    after = carried(wedges, result)
    old, new = counts(wedges), counts(after)
    assert new[0] >= old[0], "fewer triangles of positive area"
    assert new[1] >= old[1], "fewer triangles of negative area"
    assert areas(after).sum() == areas(wedges).sum()
    assert seams(result.faces, after) == seams(faces, wedges)


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("search", "energy", "name"), products(SEARCH.choices, ENERGY.choices, MAPPED)
)
def test_no_texture_triangle_is_turned_over_or_made_flat(search, energy, name):
    vertices, faces, wedges = MAPPED[name]
    options = {"search": search, "energy": energy, **QUICK}
    for more in ({}, {"foldangle": 180.0, "minshape": 0.0, "monotone": False}):
        result = optimize_flips(vertices, faces, wedge_uv=wedges, **options, **more)
        assert result.converged
        assert_kept(faces, wedges, result)
    assert result.flips > 0


@pytest.mark.parametrize("name", ["bumpy grid", "mirrored"])
def test_without_the_guard_triangles_are_turned_over(name):
    vertices, faces, wedges = MAPPED[name]
    result = optimize_flips(vertices, faces, energy="area", foldangle=180.0, minshape=0.0)
    old, new = counts(wedges), counts(carried(wedges, result))
    assert new[0] < old[0] or new[1] < old[1]


@pytest.mark.heavy
@pytest.mark.parametrize("search", SEARCH.choices)
@pytest.mark.parametrize(
    "more",
    [
        {"checkintersections": True},
        {"maxflips": 7},
        {"featuredeg": 20.0},
        {"energy": "virtual willmore", "virtualpoint": 0.1},
    ],
    ids=["intersections", "limit", "features", "place"],
)
def test_other_guards_and_limits_change_nothing_of_that(search, more):
    vertices, faces, wedges = MAPPED["bumpy grid"]
    options = {"search": search, "energy": "willmore", **QUICK, **more}
    result = optimize_flips(vertices, faces, wedge_uv=wedges, **options)
    assert result.flips > 0
    assert_kept(faces, wedges, result)


@pytest.mark.heavy
def test_in_parts_too(monkeypatch):
    monkeypatch.setattr(regions, "LEAST_FACES", 20)
    for vertices, faces, wedges in MAPPED.values():
        result = optimize_flips(
            vertices, faces, wedge_uv=wedges, energy="area", search="variable depth", **QUICK
        )
        assert result.flips > 0
        assert_kept(faces, wedges, result)


def is_fine(faces, wedges, h):
    """Whether a flip keeps the signs of the two texture triangles, or puts a flat one right."""
    mesh = build(np.zeros((faces.max() + 1, 3)), faces)
    pair = [h // 3, mesh.twin[h] // 3]
    before = sorted(np.sign(areas(wedges))[pair])
    flip(mesh, h)
    after = sorted(np.sign(areas(wedges.reshape(-1, 2)[mesh.corner].reshape(-1, 3, 2)))[pair])
    return before == after or (before, after) in (([0, 1], [1, 1]), ([-1, 0], [-1, -1]))


@pytest.mark.parametrize("name", MAPPED)
@pytest.mark.parametrize("search", ["parallel greedy", "greedy"])
def test_every_flip_that_is_left_is_a_fold(search, name):
    """The guard refuses nothing that is fine: else it would have been flipped."""
    vertices, faces, wedges = MAPPED[name]
    fold, left = guards.fold_limits(90.0), 0
    result = optimize_flips(vertices, faces, wedge_uv=wedges, energy="area", search=search)
    after, stay = carried(wedges, result), seams(faces, wedges)
    mesh = build(vertices, result.faces)
    for h in np.flatnonzero(np.arange(len(mesh.origin)) < mesh.twin):
        ends = tuple(sorted((int(mesh.origin[h]), int(mesh.origin[mesh.twin[h]]))))
        if ends in stay or not can_flip(mesh, h) or guards.folds(mesh, h, fold):
            continue
        flipped = build(vertices, result.faces)
        flip(flipped, h)
        drop = reference.area(vertices, result.faces) - reference.area(
            vertices, flipped.origin.reshape(-1, 3)
        )
        if drop > 1e-6:
            left += 1
            assert not is_fine(result.faces, after, h)
    assert left > 0 or name == "closed"


@pytest.mark.heavy
@pytest.mark.parametrize("search", SEARCH.choices)
def test_a_mapping_in_which_all_is_well_changes_nothing(search):
    vertices, faces = meshes.bumpy_sphere(60, bump=0.6)
    options = {"search": search, "energy": "willmore", **QUICK}
    free = optimize_flips(vertices, faces, **options)
    unmapped = optimize_flips(vertices, faces, wedge_uv=np.zeros((len(faces), 3, 2)), **options)
    for one, other in zip(free, unmapped, strict=True):
        np.testing.assert_array_equal(one, other)


def test_several_mappings_are_kept_at_once():
    vertices, faces, wedges = MAPPED["bumpy grid"]
    both = np.concatenate([vertices[faces, :2], wedges], axis=2)
    result = optimize_flips(
        vertices, faces, wedge_uv=both, energy="area", foldangle=180.0, minshape=0.0
    )
    after = carried(both, result)
    assert result.flips > 0
    for columns in (slice(0, 2), slice(2, 4)):
        assert counts(after[:, :, columns]) == counts(both[:, :, columns])


def test_faces_that_map_nowhere_stay():
    vertices, faces, wedges = MAPPED["bumpy grid"]
    lost = wedges.copy()
    lost[::7, 1, 0] = np.nan
    lost[3::7, 2, 1] = np.inf
    result = optimize_flips(vertices, faces, wedge_uv=lost, energy="area")
    assert result.flips > 0
    stay = ~np.isfinite(lost).all(axis=(1, 2))
    np.testing.assert_array_equal(result.faces[stay], faces[stay])
    new = ~np.isfinite(carried(lost, result)).all(axis=(1, 2))
    np.testing.assert_array_equal(new, stay)


def test_the_order_of_the_faces_and_the_kind_of_the_array_do_not_matter():
    vertices, faces, wedges = MAPPED["bumpy grid"]
    wanted = optimize_flips(vertices, faces, wedge_uv=wedges, energy="area")
    single = np.asfortranarray(wedges, np.float32)
    for given in (wedges.tolist(), single, (1024 * wedges).astype(np.int64), wedges * 2.0**900):
        found = optimize_flips(vertices, faces, wedge_uv=given, energy="area")
        np.testing.assert_array_equal(found.faces, wanted.faces)
    order = np.random.default_rng(4).permutation(len(faces))
    found = optimize_flips(vertices, faces[order], wedge_uv=wedges[order], energy="area")
    assert_kept(faces[order], wedges[order], found)
    assert optimize_flips(np.eye(3), np.zeros((0, 3), int), wedge_uv=[]).flips == 0


@pytest.mark.heavy
@pytest.mark.slow
def test_the_textured_bunny():
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(BUNNY))
    mesh = ms.current_mesh()
    vertices, faces = mesh.vertex_matrix(), mesh.face_matrix()
    wedges = mesh.wedge_tex_coord_matrix().reshape(-1, 3, 2)
    for options in (
        {},
        {"search": "greedy", "energy": "delaunay"},
        {"energy": "area", "foldangle": 180.0, "minshape": 0.0, "checkintersections": True},
        {"search": "annealing", "energy": "willmore", "sweeps": 2},
        {"search": "variable depth", "energy": "mean curvature", **QUICK},
    ):
        result = optimize_flips(vertices, faces, wedge_uv=wedges, **options)
        assert result.flips > 100
        old, new = counts(wedges), counts(carried(wedges, result))
        assert new[0] >= old[0]
        assert new[1] >= old[1]
