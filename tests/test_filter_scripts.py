"""The scripts of the project, each on real data."""

from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import script
from meshlab_willmore.demo.models import scrambled, technical_part
from meshlab_willmore.measure import measures, triangle_shapes
from meshlab_willmore.options import PRESET
from tests.meshset.conftest import FLIP, SAMPLES, set_of

FOLDER = Path(__file__).parents[1] / "filter_scripts"
SCRIPTS = sorted(FOLDER.glob("*.mlx"))


def loaded(name):
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / name))
    return ms


def run(name, ms):
    """The steps that were run, by PyMeshLab's name."""
    return {played.name: played for played in script.run(FOLDER / name, ms)}


def willmore(ms):
    mesh = ms.current_mesh()
    return measures(mesh.vertex_matrix(), mesh.face_matrix()).willmore_energy


def test_there_are_six():
    assert len(SCRIPTS) == 6


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_each_says_what_it_is_for_and_has_no_fault(path):
    assert script.check(path, mesh_ids=[0]) == []
    comment = path.read_text(encoding="utf-8").split("<!--")[1].split("-->")[0]
    assert len(comment.split()) > 20


@pytest.mark.heavy
@pytest.mark.slow
def test_clean_and_flip_a_face_scan():
    ms = loaded("rangemaps/face000.ply")
    steps = run("clean_and_flip.mlx", ms)
    flips = steps[FLIP].returned
    assert flips["flips"] > 20000
    assert flips["converged"]
    assert flips["willmore_after"] < 0.5 * flips["willmore_before"]
    topology = ms.get_topological_measures()
    assert topology["non_two_manifold_edges"] == topology["non_two_manifold_vertices"] == 0
    assert topology["unreferenced_vertices"] == 0


@pytest.mark.heavy
def test_the_faithful_script_finds_the_creases_of_a_scrambled_part_back():
    part = technical_part(6.0)
    ms = set_of(*scrambled(part))
    bends = measures(*part).absolute_mean_curvature
    flips = run("faithful.mlx", ms)[FLIP].returned
    assert flips["absolute_mean_curvature_before"] > 1.2 * bends
    assert flips["absolute_mean_curvature_after"] < bends
    assert flips["mean_shape_after"] > flips["mean_shape_before"]


@pytest.mark.heavy
def test_flip_a_bunny():
    ms = loaded("bunny10k_textured.obj")
    before, vertices = willmore(ms), ms.current_mesh().vertex_matrix()
    assert run("flip.mlx", ms)[FLIP].returned["flips"] > 0
    assert willmore(ms) < before
    np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), vertices)


@pytest.mark.heavy
@pytest.mark.slow
def test_remesh_and_flip_a_bone():
    ms = loaded("bone.ply")
    remeshed = loaded("bone.ply")
    remeshed.meshing_isotropic_explicit_remeshing(
        iterations=10, targetlen=pymeshlab.PercentageValue(1), featuredeg=30
    )
    assert run("remesh_and_flip.mlx", ms)[FLIP].returned["flips"] > 0
    mesh, before = ms.current_mesh(), remeshed.current_mesh()
    np.testing.assert_array_equal(mesh.vertex_matrix(), before.vertex_matrix())
    assert willmore(ms) < willmore(remeshed)
    assert np.median(triangle_shapes(mesh.vertex_matrix(), mesh.face_matrix())) > 0.9


@pytest.mark.heavy
def test_flip_smooth_and_measure_a_bunny():
    ms = loaded("bunny10k_textured.obj")
    steps = run("flip_smooth_measure.mlx", ms)
    assert list(steps) == [FLIP, "apply_coord_taubin_smoothing", "get_willmore_measures"]
    measured = steps["get_willmore_measures"].returned["willmore_energy"]
    assert measured == pytest.approx(willmore(ms), rel=1e-12)
    assert measured < steps[FLIP].returned["willmore_after"]


def test_flip_the_slivers_of_a_cow():
    ms = loaded("cow.obj")
    before = ms.current_mesh().face_matrix()
    steps = run("flip_technical_part.mlx", ms)
    assert steps[FLIP].given["preset"] == PRESET.choices.index("faithful")
    assert steps[FLIP].returned["flips"] > 0
    assert ms.current_mesh().selected_face_number() == 0
    changed = (ms.current_mesh().face_matrix() != before).any(axis=1)
    other = loaded("cow.obj")
    other.compute_selection_bad_faces(usear=True, aratio=0.1, usenf=False)
    other.apply_selection_dilatation()
    selected = other.current_mesh().face_selection_array()
    assert changed.any()
    assert not (changed & ~selected).any()
