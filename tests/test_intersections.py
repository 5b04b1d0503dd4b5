"""No search makes a surface cut itself: by the exact tests, and as MeshLab counts."""

from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.measure import intersecting_faces_of, self_intersections
from meshlab_willmore.mesh.build import build
from meshlab_willmore.optimize import optimize_flips
from meshlab_willmore.options import ENERGY, SEARCH
from tests import meshes
from tests.combinations import products
from tests.guards.test_meshlab_tests import counted
from tests.test_folds import crossing_sheets

COW = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes" / "cow.obj"


def tilted_patch():
    """A flat patch in a plane where rounding lets MeshLab count faces that only meet."""
    vertices, faces = meshes.patch(150, height=0.0)
    x, y, _ = vertices.T
    # Axis by axis: what a product of matrices is rounded to depends on the machine.
    return np.column_stack([8 * x + 4 * y, 4 * y - x, 4 * x - 7 * y]) / 9.0, faces


def cow():
    ms = pymeshlab.MeshSet(verbose=False)
    ms.load_new_mesh(str(COW))
    return ms.current_mesh().vertex_matrix(), ms.current_mesh().face_matrix()


MESHES = {
    "noisy sphere": lambda: meshes.bumpy_sphere(150, bump=0.6),
    "noisier sphere": lambda: meshes.bumpy_sphere(150, bump=0.95),
    "two sheets": lambda: meshes.two_sheets(100, gap=0.003),
    "crumpled sheet": lambda: meshes.crumpled(11),
    "crumpled to a ball": lambda: meshes.crumpled(11, noise=2.0),
    "tilted patch": tilted_patch,
    "torus": lambda: meshes.torus(200, None, 1),
    "cow": cow,
}

UNGUARDED = {"foldangle": 180.0, "minshape": 0.0, "monotone": False}


def new_faces(before, after):
    """Mask of the faces that were not there, each as a set of vertices."""
    known = set(map(tuple, np.sort(before, axis=1).tolist()))
    return np.array([face not in known for face in map(tuple, np.sort(after, axis=1).tolist())])


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("name", "energy", "search", "options"),
    products(
        MESHES,
        ENERGY.choices,
        SEARCH.choices,
        [{}, {"foldangle": 180.0, "minshape": 0.0, "monotone": False}],
    ),
)
@pytest.mark.slow
def test_no_new_face_cuts_and_meshlab_counts_no_more(name, energy, search, options):
    vertices, faces = MESHES[name]()
    options = {"search": search, "energy": energy, "depth": 3, "breadth": 1, **options}
    options["sweeps"] = 5
    result = optimize_flips(vertices, faces, checkintersections=True, **options)
    assert result.converged
    cutting = self_intersections(vertices, result.faces)
    assert not (cutting & new_faces(faces, result.faces)).any()
    assert counted(vertices, result.faces) <= counted(vertices, faces)
    assert result.flips > 5 or name == "tilted patch" or energy == "gaussian curvature"


@pytest.mark.heavy
def test_without_the_guard_a_noisy_sphere_cuts_itself():
    vertices, faces = meshes.bumpy_sphere(150, bump=0.95)
    options = {"energy": "willmore", "foldangle": 180.0, "minshape": 0.0}
    assert not self_intersections(vertices, faces).any()
    result = optimize_flips(vertices, faces, **options)
    assert self_intersections(vertices, result.faces).any()
    assert counted(vertices, result.faces) > 0
    guarded = optimize_flips(vertices, faces, checkintersections=True, **options)
    assert not self_intersections(vertices, guarded.faces).any()
    assert guarded.flips > 0.8 * result.flips


@pytest.mark.heavy
@pytest.mark.parametrize("search", SEARCH.choices)
@pytest.mark.parametrize(
    "mesh", [meshes.torus(300, 0.3, 8), meshes.patch(200, height=0.02), meshes.grid(8, 8)]
)
@pytest.mark.slow
def test_where_nothing_would_cut_the_guard_changes_nothing(mesh, search):
    options = {"search": search, "energy": "willmore", "depth": 3}
    free = optimize_flips(*mesh, **options)
    guarded = optimize_flips(*mesh, checkintersections=True, **options)
    np.testing.assert_array_equal(guarded.faces, free.faces)
    assert guarded.flips == free.flips


@pytest.mark.heavy
def test_the_scale_of_the_coordinates_changes_no_exact_answer():
    vertices, faces = meshes.crumpled(8, noise=1.0)
    wanted = self_intersections(vertices, faces)
    assert wanted.any()
    for scale in (2.0**-300, 2.0**-20, 2.0**20, 2.0**300):
        np.testing.assert_array_equal(self_intersections(vertices * scale, faces), wanted)


def test_nothing_cuts_in_an_empty_mesh():
    nothing = np.empty((0, 3)), np.empty((0, 3), np.int32)
    assert self_intersections(*nothing).shape == (0,)
    assert optimize_flips(*nothing, checkintersections=True).converged


def test_pairs_with_one_of_the_chosen_faces():
    vertices, faces = crossing_sheets(2)
    mesh = build(vertices, faces)
    every = intersecting_faces_of(mesh)
    np.testing.assert_array_equal(every, self_intersections(vertices, faces))
    upper = faces.min(axis=1) >= len(vertices) // 2
    # The sheets cut each other, so each pair has a face of the upper one.
    assert 0 < every.sum() < len(faces)
    np.testing.assert_array_equal(intersecting_faces_of(mesh, upper), every)
    one = np.arange(len(faces)) == np.flatnonzero(every & upper)[0]
    found = intersecting_faces_of(mesh, one)
    assert found[one].all()
    assert 1 < found.sum() < every.sum()
    assert not (found & ~every).any()
    assert not intersecting_faces_of(mesh, ~every).any()
