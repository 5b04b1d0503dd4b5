"""Values of correct steps: what they become, and what PyMeshLab makes of values of other types."""

import pymeshlab
import pytest

from meshlab_willmore.meshset import catalogue, native
from meshlab_willmore.meshset.check import faults_of, resolve
from meshlab_willmore.mlx.read import read_bytes
from meshlab_willmore.mlx.steps import Param, Percentage, Step
from tests.meshset.conftest import FLIP
from tests.meshset.scripts import (
    FLIP_NAME,
    HAUSDORFF,
    REMESH,
    old_step,
    param,
    percentage,
    step,
    steps_of,
)


def given_of(*steps, ids=None):
    return [call.given for call in resolve(steps_of(*steps), "s.mlx", ids)]


def test_calls_have_keywords_and_values_of_the_filters_own_types():
    (call,) = resolve(
        steps_of(
            step(
                REMESH,
                param("Iterations", "RichInt", value=3),
                param("Adaptive", "RichBool", value="true"),
                percentage("TargetLen", "5%"),
                percentage("maxsurfdist", 2),
                param("FeatureDeg", "RichDynamicFloat", value=30, min=0, max=180),
            )
        ),
        "s.mlx",
    )
    assert call.number == 1
    assert call.known == catalogue.find(REMESH)
    assert call.given == {
        "iterations": 3,
        "adaptive": True,
        "targetlen": Percentage(5.0),
        "maxsurfdist": 2.0,
        "featuredeg": 30.0,
    }
    assert type(call.given["maxsurfdist"]) is type(call.given["featuredeg"]) is float


def test_old_forms_get_the_filters_own_types():
    assert given_of(
        old_step(REMESH, Iterations="3", Adaptive="True", TargetLen="5%", FeatureDeg="30"),
        old_step(FLIP_NAME, energy="willmore"),
        old_step(FLIP_NAME, energy="1"),
        old_step("Transform: Rotate", customAxis="[0, 0, 1]"),
    ) == [
        {"iterations": 3, "adaptive": True, "targetlen": Percentage(5.0), "featuredeg": 30.0},
        {"energy": 1},
        {"energy": 1},
        {"customaxis": (0.0, 0.0, 1.0)},
    ]


@pytest.mark.parametrize("kind", ["RichPoint3f", "RichPosition", "RichDirection"])
def test_points_and_directions_are_the_same(kind):
    axis = param("customAxis", kind, x=0, y=0, z=1)
    assert given_of(step("Transform: Rotate", axis)) == [{"customaxis": (0.0, 0.0, 1.0)}]


def test_whole_numbers_in_python_are_floats_where_the_filter_has_floats():
    (call,) = resolve([Step(FLIP, (Param("foldangle", "RichFloat", 45),))], "here")
    assert call.given == {"foldangle": 45.0}
    assert type(call.given["foldangle"]) is float


def test_cameras_are_left_to_pymeshlab():
    assert given_of(step("Set Mesh Camera", param("Shot", "RichShotf"))) == [{}]


def test_an_enum_may_be_reworded_but_not_reordered():
    old = {"enum_val0": "virtual energy", "enum_val1": "true energy"}
    energy = param("energy", "RichEnum", value=1, enum_cardinality=2, **old)
    assert given_of(step(FLIP_NAME, energy)) == [{"energy": 1}]


def test_ids_of_meshes_that_a_step_may_make():
    distance = step(HAUSDORFF, param("TargetMesh", "RichMesh", value=4))
    assert faults_of(steps_of(step("Box/Cube"), distance), (0, 3)) == []
    assert faults_of(steps_of(step("Box/Cube"), distance), ()) == []
    assert faults_of(steps_of(distance), None) == []
    assert faults_of(steps_of(distance), (4,)) == []
    first = step(HAUSDORFF, param("TargetMesh", "RichMesh", value=0))
    assert faults_of(steps_of(step("Box/Cube"), first), ()) == []


def test_a_script_that_creates_its_mesh_needs_none():
    assert faults_of(steps_of(step("Box/Cube"), step(FLIP_NAME)), ()) == []


def test_an_empty_script_is_no_fault():
    assert resolve((), "s.mlx", ()) == ()


DEFAULTS = {
    "RichBool": True,
    "RichInt": 1,
    "RichEnum": 0,
    "RichMesh": 0,
    "RichFloat": 0.5,
    "RichDynamicFloat": 0.5,
    "RichAbsPerc": Percentage(1.0),
    "RichString": "0.5",
    "RichOpenFile": "x",
    "RichSaveFile": "x",
    "RichPosition": (0.0, 1.0, 2.0),
    "RichDirection": (0.0, 1.0, 2.0),
    "RichColor": (1, 2, 3, 255),
    "RichMatrix44f": tuple(map(float, range(16))),
    "RichShotf": None,
}


@pytest.mark.parametrize("name", ["name", "keyword"])
def test_all_parameters_of_all_filters_go_through(name):
    for known in catalogue.everything():
        params = tuple(Param(getattr(p, name), p.type, DEFAULTS[p.type]) for p in known.params)
        (call,) = resolve([Step(known.meshlab_name, params)], "here", (0,))
        assert call.known == known
        assert call.given == {
            p.keyword: DEFAULTS[p.type] for p in known.params if p.type != "RichShotf"
        }


def test_what_pymeshlab_saves_has_no_fault(bumpy):
    bumpy.clear_filter_script()
    bumpy.meshing_isotropic_explicit_remeshing(iterations=1)
    bumpy.apply_coord_taubin_smoothing(lambda_=0.25)
    bumpy.compute_matrix_from_rotation(rotaxis="custom axis", customaxis=[0, 0, 1])
    bumpy.set_matrix()
    bumpy.set_camera_per_mesh()
    bumpy.generate_copy_of_current_mesh()
    bumpy.get_hausdorff_distance(sampledmesh=0, targetmesh=1)
    steps = read_bytes(native.script_of(bumpy), "saved")
    calls = resolve(steps, "saved", (0,))
    assert len(calls) == 7
    assert calls[1].given["lambda_"] == 0.25
    assert calls[2].given["rotaxis"] == 3
    assert calls[6].given["targetmesh"] == 1


# --- what PyMeshLab makes of mismatches: why they are faults, or are not -----------------------


def natively(tmp_path, xml):
    """The set with the mesh that PyMeshLab's own reading of one step creates."""
    path = tmp_path / "native.mlx"
    path.write_text(f"<FilterScript>{xml}</FilterScript>")
    ms = pymeshlab.MeshSet()
    with native.muted():
        native._own.load_filter_script(ms, str(path))
    ms.apply_filter_script()
    return ms


@pytest.mark.parametrize(
    ("kind", "value", "size"),
    [
        ("RichFloat", "3", 3.0),
        ("RichDynamicFloat", "3", 3.0),
        ("RichAbsPerc", "3", 3.0),
        ("RichInt", "3", 0.0),
        ("RichBool", "true", 0.0),
        ("RichString", "3", 0.0),
    ],
)
def test_numbers_are_faults_where_pymeshlab_reads_zero(tmp_path, kind, value, size):
    cube = step("Box/Cube", param("size", kind, value=value, min=0, max=9))
    assert natively(tmp_path, cube).current_mesh().bounding_box().dim_x() == size
    assert bool(faults_of(steps_of(cube))) == (size == 0)


@pytest.mark.parametrize(
    ("kind", "faces"),
    [("RichInt", 80), ("RichMesh", 80), ("RichEnum", 80), ("RichFloat", 20)],
)
def test_whole_numbers_are_faults_where_pymeshlab_reads_zero(tmp_path, kind, faces):
    sphere = step("Sphere", param("subdiv", kind, value=1, enum_cardinality=2))
    assert natively(tmp_path, sphere).current_mesh().face_number() == faces
    assert bool(faults_of(steps_of(sphere))) == (faces == 20)
