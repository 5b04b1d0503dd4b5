"""Technical parts with random diagonals: every search keeps their shape."""

import numpy as np
import pytest

from meshlab_willmore.measure import measures
from meshlab_willmore.optimize import optimize_flips
from meshlab_willmore.options import ENERGY, SEARCH
from tests import reference
from tests.combinations import products

LIMIT = 30.0
# What says nothing about flat sides.
FLAT = ("area", "mean curvature", "gaussian curvature")
# Corners of a cell's side towards each neighbour, counter-clockwise from outside.
SIDES = {
    (1, 0, 0): [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
    (-1, 0, 0): [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)],
    (0, 1, 0): [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)],
    (0, -1, 0): [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
    (0, 0, 1): [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
    (0, 0, -1): [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
}


def halved(quads, seed=0):
    """Triangles of quads, each cut along a random diagonal."""
    turns = np.random.default_rng(seed).integers(0, 2, len(quads))
    turned = [np.roll(quad, turn) for quad, turn in zip(quads, turns, strict=True)]
    return np.array([face for a, b, c, d in turned for face in ((a, b, c), (a, c, d))], np.int32)


def solid(cells):
    """The surface of a set of unit cells."""
    numbers, quads = {}, []
    for cell in sorted(cells):
        for step, corners in SIDES.items():
            if tuple(np.add(cell, step)) not in cells:
                at = [tuple(np.add(cell, corner)) for corner in corners]
                quads.append([numbers.setdefault(point, len(numbers)) for point in at])
    return np.array(list(numbers), float), halved(quads)


def cube():
    return solid({(x, y, z) for x in range(4) for y in range(4) for z in range(4)})


def block():
    """A step with a slot through it: convex and concave edges."""
    cells = {(x, y, z) for x in range(6) for y in range(4) for z in range(4)}
    step = {(x, y, z) for x in range(3, 6) for y in range(4) for z in range(2, 4)}
    slot = {(1, y, 3) for y in range(4)}
    return solid(cells - step - slot)


def cylinder(sides=12, rings=4):
    """Its edges are bent by exactly 30 degrees; each lid has a point in its middle."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    rows = [np.column_stack([circle, np.full(sides, 0.7 * z)]) for z in range(rings + 1)]
    vertices = np.vstack([*rows, [(0.0, 0.0, 0.0), (0.0, 0.0, 0.7 * rings)]])
    here, ahead = np.arange(sides), np.roll(np.arange(sides), -1)
    quads = [
        (z * sides + a, z * sides + b, (z + 1) * sides + b, (z + 1) * sides + a)
        for z in range(rings)
        for a, b in zip(here, ahead, strict=True)
    ]
    low, high = len(vertices) - 2, len(vertices) - 1
    lids = [(b, a, low) for a, b in zip(here, ahead, strict=True)]
    lids += [(rings * sides + a, rings * sides + b, high) for a, b in zip(here, ahead, strict=True)]
    return vertices, np.vstack([halved(quads), lids]).astype(np.int32)


def moved(vertices, faces, most=0.3, seed=0):
    """The same shape, each vertex moved at random within all planes and edges that it lies on."""
    rng = np.random.default_rng(seed)
    a, b, c = vertices[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    result = vertices.copy()
    for v in range(len(vertices)):
        held = normals[(faces == v).any(axis=1)]
        _, sizes, axes = np.linalg.svd(held)
        free = axes[np.append(sizes, np.zeros(3))[:3] < 1e-6]
        result[v] += rng.uniform(-most, most, len(free)) @ free
    return result, faces


PARTS = {"cube": moved(*cube()), "block": moved(*block()), "cylinder": moved(*cylinder())}


def features(vertices, faces):
    """The edges, as vertex pairs, whose faces are bent by the limit or more."""
    i, j, k, l = vertices[reference.diamonds(faces)].transpose(1, 0, 2)
    one, other = np.cross(j - i, k - i), np.cross(l - i, j - i)
    sine = np.linalg.norm(np.cross(one, other), axis=1)
    bend = np.degrees(np.arctan2(sine, np.einsum("ij,ij->i", one, other)))
    ends = np.sort(_ends(faces), axis=1)
    return set(map(tuple, ends[bend > LIMIT - 0.01].tolist()))


def _ends(faces):
    """The end vertices of the edges, in the order of `reference.diamonds`."""
    return reference.diamonds(faces)[:, :2]


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("search", "energy", "part"), products(SEARCH.choices, ENERGY.choices, PARTS)
)
@pytest.mark.slow
def test_feature_edges_stay_and_so_does_the_shape(search, energy, part):
    vertices, faces = PARTS[part]
    wanted = features(vertices, faces)
    assert len(wanted) > 40
    options = {"search": search, "energy": energy, "sweeps": 5, "featuredeg": LIMIT}
    for guarded in (False, True):
        result = optimize_flips(vertices, faces, checkintersections=guarded, **options)
        assert result.converged
        assert result.flips > 3 or energy in FLAT
        assert features(vertices, result.faces) == wanted
        before, after = measures(vertices, faces), measures(vertices, result.faces)
        assert after.area == pytest.approx(before.area, rel=1e-14)
        curvatures = before.absolute_mean_curvature, before.absolute_gaussian_curvature
        found = after.absolute_mean_curvature, after.absolute_gaussian_curvature
        assert found == pytest.approx(curvatures, rel=1e-9)
    # With the fold guard off, flat sides may fold. Their borders stay all the same.
    folded = optimize_flips(vertices, faces, foldangle=180.0, minshape=0.0, **options)
    assert wanted <= reference.edge_set(folded.faces)


@pytest.mark.parametrize(("height", "is_kept"), [(4e-6, False), (5e-6, True)])
def test_a_sharp_edge_goes_where_one_of_its_faces_is_a_sliver(height, is_kept):
    """It is bent by 75 degrees; the shape of the face above it is 2.3 times the height."""
    bend = np.radians(75.0)
    above = 0.5, height * np.cos(bend), height * np.sin(bend)
    vertices = [(0, 0, 0), (1, 0, 0), above, (0.5, -1, 0), (-1, -0.5, 0), (2, -0.5, 0)]
    faces = [(0, 1, 2), (1, 0, 3), (3, 0, 4), (1, 3, 5)]
    for featuredeg in (0.0, 70.0):
        result = optimize_flips(vertices, faces, energy="delaunay", featuredeg=featuredeg)
        assert ((0, 1) in reference.edge_set(result.faces)) == is_kept
    free = optimize_flips(vertices, faces, energy="delaunay")
    assert (0, 1) not in reference.edge_set(free.faces)


def test_without_a_limit_features_go():
    """Else the test above would say nothing."""
    vertices, faces = PARTS["block"]
    result = optimize_flips(vertices, faces, energy="delaunay", foldangle=180.0, minshape=0.0)
    assert not features(vertices, faces) <= reference.edge_set(result.faces)
