"""Scripts read, checked and run in Python."""

import os
import subprocess
import sys

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import script
from meshlab_willmore.meshset import native
from meshlab_willmore.script import Fault, Param, Percentage, ScriptError, Step
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, script_of, set_of

FLIPS = Step("Willmore flipping optimization")
BAD = Step("Taubin Smoth")
MATRIX = tuple(float(i) / 7 for i in range(16))


@pytest.fixture
def bumpy():
    return set_of(*meshes.bumpy_sphere(150))


def written(tmp_path, *steps):
    path = tmp_path / "steps.mlx"
    script.write(path, steps)
    return path


def faces(ms):
    return ms.current_mesh().face_matrix()


def test_a_script_runs_and_reports_what_each_step_did(bumpy, tmp_path):
    smooth = Step("Taubin Smooth", (Param("stepSmoothNum", "RichInt", 2),))
    path = written(tmp_path, FLIPS, smooth, Step("Willmore measures"))
    heard = []
    played = script.run(
        path,
        bumpy,
        before=lambda call: heard.append((call.number, call.known.name)),
        after=lambda done: heard.append(done),
    )
    assert [(p.number, p.name) for p in played] == [
        (1, FLIP),
        (2, "apply_coord_taubin_smoothing"),
        (3, "get_willmore_measures"),
    ]
    assert heard == [item for p in played for item in ((p.number, p.name), p)]
    assert played[0].returned["flips"] > 0
    assert played[0].given == {}
    assert played[1].given == {"stepsmoothnum": 2}
    assert played[2].returned["area"] == bumpy.get_willmore_measures()["area"]
    assert all(p.seconds > 0 for p in played)


def test_without_a_set_one_is_made():
    played = script.run([Step("Torus"), Step("Willmore measures")])
    assert played[1].returned["area"] > 0


def test_the_sets_own_script_stays_as_it_is(bumpy, tmp_path, capfd):
    bumpy.set_selection_none()
    script.run([Step("Taubin Smooth"), FLIPS], bumpy)
    path = tmp_path / "own.mlx"
    bumpy.save_filter_script(str(path))
    assert [step.filter for step in script.read(path)] == ["Select None"]


def test_every_kind_of_value_reaches_the_filter(bumpy):
    """Each filter as a step and as a call."""
    bumpy.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()), "other")
    called = set_of(*meshes.bumpy_sphere(150))
    called.add_mesh(pymeshlab.Mesh(*meshes.tetrahedron()), "other")
    for ms in (bumpy, called):
        ms.set_current_mesh(0)
    script.run(
        [
            Step("set_matrix", (Param("TransformMatrix", "RichMatrix44f", MATRIX),)),
            Step(
                "Vertex Color Filling",
                (Param("color1", "RichColor", (10, 20, 30, 40)),),
            ),
            Step(
                "Per Vertex Quality Function",
                (Param("q", "RichString", "x * 2"),),
            ),
            Step(
                "Transform: Rotate",
                (
                    Param("rotAxis", "RichEnum", 3),
                    Param("angle", "RichDynamicFloat", 12.5),
                    Param("customAxis", "RichDirection", (0.1, 0.2, 0.3)),
                ),
            ),
            Step(
                "Vertex Attribute Transfer",
                (
                    Param("SourceMesh", "RichMesh", 0),
                    Param("TargetMesh", "RichMesh", 1),
                    Param("QualityTransfer", "RichBool", True),
                    Param("UpperBound", "RichAbsPerc", Percentage(90.0)),
                ),
            ),
        ],
        bumpy,
    )
    called.set_matrix(transformmatrix=np.reshape(MATRIX, (4, 4)))
    called.set_color_per_vertex(color1=pymeshlab.Color(10, 20, 30, 40))
    called.compute_scalar_by_function_per_vertex(q="x * 2")
    called.compute_matrix_from_rotation(
        rotaxis="custom axis", angle=12.5, customaxis=np.array([0.1, 0.2, 0.3])
    )
    called.transfer_attributes_per_vertex(
        sourcemesh=0,
        targetmesh=1,
        qualitytransfer=True,
        upperbound=pymeshlab.PercentageValue(90),
    )
    for one, other in zip(bumpy, called, strict=True):
        np.testing.assert_array_equal(one.transform_matrix(), other.transform_matrix())
        np.testing.assert_array_equal(one.vertex_matrix(), other.vertex_matrix())
        np.testing.assert_array_equal(one.vertex_scalar_array(), other.vertex_scalar_array())
        np.testing.assert_array_equal(one.vertex_color_matrix(), other.vertex_color_matrix())


def test_a_parameter_can_have_any_keyword(bumpy):
    """`name`, for one, which functions on the way have too."""
    step = Step(
        "compute_new_custom_scalar_attribute_per_vertex",
        (Param("name", "RichString", "height"), Param("expr", "RichString", "z")),
    )
    script.run([step], bumpy)
    z = bumpy.current_mesh().vertex_matrix()[:, 2]
    np.testing.assert_array_equal(
        bumpy.current_mesh().vertex_custom_scalar_attribute_array("height"), z
    )


def test_the_sets_own_script_stays(bumpy):
    bumpy.apply_coord_taubin_smoothing(lambda_=0.123456)
    before = sorted(script_of(bumpy).split())
    script.run([Step("Select None")], bumpy)
    assert sorted(script_of(bumpy).split()) == before


def test_all_faults_are_found_and_nothing_runs(bumpy, tmp_path):
    before = faces(bumpy)
    path = written(tmp_path, FLIPS, BAD, Step("Taubin Smooth", (Param("mut", "RichFloat", 1.0),)))
    found = script.check(path)
    assert [(f.step, f.filter, f.param) for f in found] == [
        (2, "Taubin Smoth", ""),
        (3, "Taubin Smooth", "mut"),
    ]
    with pytest.raises(ScriptError) as caught:
        script.run(path, bumpy)
    assert [fault._replace(source=str(path)) for fault in caught.value.faults] == found
    assert str(caught.value) == "\n".join(map(str, found))
    assert str(found[0]).startswith(f"{path}: step 2 (Taubin Smoth): ")
    np.testing.assert_array_equal(faces(bumpy), before)


def test_check_reports_files_that_cannot_be_read(tmp_path):
    (fault,) = script.check(tmp_path / "nowhere.mlx")
    assert isinstance(fault, Fault)
    assert "no such file" in str(fault).lower()


def test_a_step_that_fails_is_named_and_the_ones_before_it_stay_done(bumpy):
    failing = Step("Harmonic Parametrization")
    with pytest.raises(pymeshlab.PyMeshLabException) as caught:
        script.run([FLIPS, failing, Step("Taubin Smooth")], bumpy)
    assert str(caught.value).startswith(
        "filter script, step 2 (compute_texcoord_parametrization_harmonic): "
    )
    assert "Failed to apply" not in str(caught.value)
    after = set_of(*meshes.bumpy_sphere(150))
    after.apply_filter(FLIP)
    np.testing.assert_array_equal(faces(bumpy), faces(after))


AFTER_A_FAILURE = """
import sys, pymeshlab
from meshlab_willmore import script
ms = pymeshlab.MeshSet()
ms.create_torus()
try:
    script.run([script.Step("Harmonic Parametrization")], ms)
except pymeshlab.PyMeshLabException:
    pass
del ms
for _ in range(3):
    other = pymeshlab.MeshSet()
    other.load_new_mesh(sys.argv[1])
    other.save_current_mesh("saved.ply")
print(other.mesh_number())
"""


@pytest.mark.slow
def test_files_can_be_read_and_written_after_a_step_failed(tmp_path):
    """PyMeshLab keeps a pointer to the log of the set whose filter failed."""
    run = subprocess.run(
        [sys.executable, "-c", AFTER_A_FAILURE, str(SAMPLES / "cube.obj")],
        capture_output=True,
        text=True,
        cwd=tmp_path,
    )
    assert (run.returncode, run.stdout) == (0, "1\n")


def test_native_messages_lose_their_markup():
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(np.random.default_rng(0).random((9, 3))))
    with pytest.raises(pymeshlab.PyMeshLabException) as caught:
        script.run([Step("Montecarlo Sampling")], ms)
    assert str(caught.value).endswith("with faces, it does not work on Point Clouds")
    condition = Step(
        "Conditional Vertex Selection", (Param("condSelect", "RichString", "x < 1 &amp; y"),)
    )
    with pytest.raises(pymeshlab.PyMeshLabException, match="&amp; y"):
        script.run([condition], ms)


def test_a_script_is_written_with_meshlabs_names(tmp_path):
    """PyMeshLab's names are for Python; neither MeshLab nor native scripts know them."""
    step = Step("create_sphere", (Param("subdiv", "", "2"), Param("radius", "RichFloat", 3.0)))
    unknown = Step("Unheard of", (Param("x", "RichInt", 1, (("tooltip", "t"),)),))
    path = written(tmp_path, step, unknown)
    assert script.read(path) == (
        Step("Sphere", (Param("subdiv", "RichInt", 2), Param("radius", "RichFloat", 3.0))),
        unknown,
    )


@pytest.mark.parametrize(
    ("steps", "number"),
    [
        ([Step("Delete Current Mesh"), Step("Taubin Smooth")], 2),
        ([Step("Delete Current Mesh"), Step("Delete Current Mesh")], 2),
        ([Step("Delete Current Mesh"), Step("Torus"), Step("Taubin Smooth")], None),
    ],
)
def test_a_script_that_deletes_its_mesh_leaves_none_for_the_next_step(steps, number):
    assert [fault.step for fault in script.check(steps, [0])] == ([number] if number else [])
    assert script.check(steps) == []


def test_an_empty_script_does_nothing(bumpy):
    assert script.run([], bumpy) == []


def test_ids_of_meshes_are_checked_before_the_first_step(bumpy):
    step = Step("Hausdorff Distance", (Param("SampledMesh", "RichMesh", 5),))
    with pytest.raises(ScriptError, match="there will be no mesh 5"):
        script.run([FLIPS, step], bumpy)
    assert script.check([FLIPS, step]) == []
    assert len(script.check([FLIPS, step], mesh_ids=[0])) == 1
    with pytest.raises(ScriptError):
        script.calls([FLIPS, step], [0])
    assert [call.number for call in script.calls([FLIPS, step], [5])] == [1, 2]


def test_a_step_leaves_the_working_folder_as_it_was(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def move(*_arguments, **_named):
        os.chdir(os.sep)
        raise pymeshlab.PyMeshLabException("no file")

    monkeypatch.setattr(native, "apply", move)
    with pytest.raises(pymeshlab.PyMeshLabException, match="no file"):
        script.run([Step("Box/Cube")])
    assert os.getcwd() == str(tmp_path)
