"""Steps that choose and show layers, wherever scripts are checked and run."""

import pymeshlab
import pytest

from meshlab_willmore import script
from meshlab_willmore.meshset import document, native
from meshlab_willmore.meshset.catalogue import find
from meshlab_willmore.meshset.check import faults_of
from meshlab_willmore.mlx.steps import Param, Step
from tests import meshes
from tests.meshset.conftest import FLIP

CHOOSE = "Change the current layer"
SHOW = "Change Visibility of layer(s)"


def step(name, **params):
    return Step(name, tuple(Param(key, "", str(value)) for key, value in params.items()))


@pytest.fixture
def cubes():
    """Three cubes with sides of 1, 2 and 3; the last is current."""
    ms = pymeshlab.MeshSet()
    for size in (1, 2, 3):
        ms.create_cube(size=size)
    return ms


def visible(ms):
    return [mesh.is_visible() for mesh in ms]


@pytest.mark.parametrize("name", ["mesh", "layer"])
def test_the_chosen_layer_is_the_one_that_steps_change(cubes, name):
    played = script.run([step(CHOOSE, **{name: 1}), step("Delete Current Mesh")], cubes)
    assert [mesh.id() for mesh in cubes] == [0, 2]
    assert [p.name for p in played] == ["set_current_mesh", "delete_current_mesh"]
    assert played[0].returned == {}


def test_a_layer_that_was_flipped_is_chosen_by_its_id(cubes):
    cubes.add_mesh(pymeshlab.Mesh(*meshes.cube()), "flipped")
    assert getattr(cubes, FLIP)()["flips"] == 6
    assert native.current_id(cubes) != 3
    script.run([step(CHOOSE, mesh=0), step(CHOOSE, mesh=3)], cubes)
    assert cubes.current_mesh().label() == "flipped"


def test_without_a_layer_nothing_is_chosen(cubes):
    script.run([step(CHOOSE)], cubes)
    assert cubes.current_mesh_id() == 2


def test_layers_are_hidden_by_id_or_by_a_part_of_their_name(cubes):
    script.run([step(SHOW, layer=0, isMeshVisible="false")], cubes)
    assert visible(cubes) == [False, True, True]
    cubes.mesh(2).set_label("a part of it")
    script.run([step(SHOW, layer=0, lName="part", isMeshVisible="false")], cubes)
    assert visible(cubes) == [False, True, False]
    script.run([step("Change Visibility of a Mesh", mesh=2)], cubes)
    assert visible(cubes) == [False, True, True]


@pytest.mark.parametrize("name", ["Compact vertices", "Compact faces"])
def test_compacting_changes_nothing(cubes, name):
    script.run([Step(name)], cubes)
    assert cubes.current_mesh().vertex_number() == 8


def test_a_layer_that_is_not_there_is_a_fault():
    (fault,) = faults_of([step(CHOOSE, mesh=3)], (0, 1))
    assert fault.text == "there will be no mesh 3 (there are: 0, 1)"
    (fault,) = faults_of([step(CHOOSE, mesh=0)], ())
    assert fault.text.startswith("needs a mesh")


def test_a_layer_that_a_step_makes_can_be_chosen(cubes):
    script.run([step("Box/Cube"), step(CHOOSE, mesh=0), step(CHOOSE, mesh=3)], cubes)
    assert cubes.current_mesh_id() == 3


@pytest.mark.parametrize("chosen", [step(CHOOSE, mesh=7), step(SHOW, layer=7)])
def test_a_layer_that_no_step_has_made_is_named_and_no_other_taken(cubes, chosen):
    # A check can't know how many layers the first step makes.
    steps = [step("Box/Cube"), chosen, step("Laplacian Smooth")]
    with pytest.raises(pymeshlab.PyMeshLabException) as caught:
        script.run(steps, cubes)
    assert str(caught.value).endswith("there is no mesh 7 (there are: 0, 1, 2, 3)")
    assert cubes.current_mesh_id() == 3
    assert visible(cubes) == [True] * 4


def test_native_steps_do_not_crash_where_no_mesh_is_current(cubes):
    cubes.set_current_mesh(7)
    with pytest.raises(pymeshlab.PyMeshLabException, match="no current Mesh"):
        script.run([step("Laplacian Smooth")], cubes)
    script.run([step(CHOOSE, mesh=1), step("Laplacian Smooth")], cubes)
    assert cubes.current_mesh_id() == 1


def test_names_of_steps_are_no_names_of_filters():
    natives = set(pymeshlab.filter_list())
    for item in document.STEPS:
        assert item.name not in natives
        for name in (item.name, *item.meshlab_names):
            assert find(name).name == item.name


def test_a_sets_own_script_can_choose_layers(cubes, tmp_path):
    path = tmp_path / "s.mlx"
    script.write(path, [step(CHOOSE, mesh=0), step("Delete Current Mesh")])
    cubes.load_filter_script(str(path))
    cubes.apply_filter_script()
    assert [mesh.id() for mesh in cubes] == [1, 2]
    copy = tmp_path / "copy.mlx"
    cubes.save_filter_script(str(copy))
    assert copy.read_text() == path.read_text()
