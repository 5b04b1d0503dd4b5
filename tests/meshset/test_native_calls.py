"""A set whose meshes were flipped is used like one in which nothing was."""

import enum
import random
import re
import tempfile
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from tests import meshes
from tests.meshset.conftest import FLIP, set_of

SCALAR = "compute_scalar_by_willmore_energy_per_vertex"
IN_PLACE = "meshing_remove_unreferenced_vertices"


class Both:
    """A set with our filters, and one with a native filter in their place."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.flipped, self.plain = pymeshlab.MeshSet(), pymeshlab.MeshSet()
        self.held = []
        self.made = 0
        for _ in range(self.random.randint(1, 4)):
            self.add(True)

    def call(self, action):
        for ms in (self.flipped, self.plain):
            action(ms)

    def add(self, as_current=None):
        """A mesh that is known by its label and its number of vertices."""
        vertices, faces = meshes.bumpy_sphere(40 + self.made)
        mesh, label = pymeshlab.Mesh(vertices, faces), f"mesh {self.made}"
        self.made += 1
        current = self.random.random() < 0.5 if as_current is None else as_current
        self.call(lambda ms: ms.add_mesh(mesh, label, set_as_current=current))

    def flip(self):
        returned = self.flipped.apply_filter(FLIP, maxflips=1)
        assert returned["mesh_id"] == self.plain.current_mesh_id()
        self.plain.apply_filter(IN_PLACE)

    def write_scalar(self):
        self.flipped.apply_filter(SCALAR)
        self.plain.apply_filter(IN_PLACE)

    def hold(self):
        self.held.append(self.flipped.current_mesh())

    def let_go(self):
        if self.held:
            self.held.pop(self.random.randrange(len(self.held)))

    def copy(self):
        self.call(lambda ms: ms.generate_copy_of_current_mesh())

    def delete(self):
        # Whoever holds a mesh that a native filter deletes holds freed memory.
        self.let_all_go()
        self.call(lambda ms: ms.delete_current_mesh())

    def delete_hidden(self):
        self.let_all_go()
        self.call(lambda ms: ms.delete_non_visible_meshes())

    def let_all_go(self):
        self.held.clear()

    def make_current(self):
        mesh_id = self.random.choice([mesh.id() for mesh in self.plain])
        self.call(lambda ms: ms.set_current_mesh(mesh_id))

    def show(self):
        mesh_id = self.random.choice([mesh.id() for mesh in self.plain])
        visible = self.random.random() < 0.6
        self.call(lambda ms: ms.set_mesh_visibility(mesh_id, visible))

    def measure(self):
        """A filter of two meshes that chooses both itself, one, or none."""
        ids = [mesh.id() for mesh in self.plain]
        given = {}
        for keyword in ("sampledmesh", "targetmesh"):
            if self.random.random() < 0.5:
                given[keyword] = np.int64(self.random.choice(ids))
        left, right = (asked_and_measured(ms, given) for ms in (self.flipped, self.plain))
        assert left == right

    def merge(self):
        self.let_all_go()
        self.call(lambda ms: ms.generate_by_merging_visible_meshes())

    def split(self):
        self.let_all_go()
        given = {"delete_source_mesh": self.random.random() < 0.5}
        self.call(lambda ms: ms.generate_splitting_by_connected_components(**given))

    def flip_all_in_a_loop(self):
        for mesh in self.flipped:
            self.flipped.set_current_mesh(mesh.id())
            self.flipped.apply_filter(FLIP, maxflips=1)
        for mesh in self.plain:
            self.plain.set_current_mesh(mesh.id())

    def run_script(self):
        """Steps that copy the current mesh, use two by their numbers, and delete the copy."""
        self.let_all_go()
        ids = [mesh.id() for mesh in self.plain]
        pair = self.random.sample(ids, 2) if len(ids) > 1 else ()
        steps = [("Duplicate Current layer", {}), ("Delete Current Mesh", {})]
        if pair:
            keys = dict(zip(("SourceMesh", "TargetMesh"), pair, strict=True))
            steps.insert(1, ("Vertex Attribute Transfer", keys))
        script = "".join(
            f'<filter name="{name}">'
            + "".join(f'<Param type="RichMesh" name="{k}" value="{i}"/>' for k, i in keys.items())
            + "</filter>"
            for name, keys in steps
        )
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "script.mlx"
            path.write_text(f"<FilterScript>{script}</FilterScript>")
            self.call(lambda ms: ms.load_filter_script(str(path)))
        self.call(lambda ms: ms.apply_filter_script())
        self.call(lambda ms: ms.clear_filter_script())

    def clear(self):
        self.let_all_go()
        self.call(lambda ms: ms.clear())

    def assert_same(self):
        left, right = view(self.flipped), view(self.plain)
        assert left == right
        for ms in (self.flipped, self.plain):
            assert [ms[mesh.id()].label() for mesh in ms] == [mesh.label() for mesh in ms]
            assert [mesh.id() for mesh in ms] == [ms.mesh(mesh.id()).id() for mesh in ms]


def asked_and_measured(ms, given):
    values = ms.filter_parameter_values("get_hausdorff_distance", **given)
    chosen = values["sampledmesh"], values["targetmesh"]
    # From a mesh to itself it fails, and PyMeshLab prints nothing more in this process.
    measured = chosen[0] != chosen[1] and ms.get_hausdorff_distance(samplenum=9, **given)
    return chosen, measured and measured["n_samples"]


def view(ms):
    """All that can be reached in a set by ids, and what is current."""
    ids = [i for i in range(40) if ms.mesh_id_exists(i)]
    try:
        current = ms.current_mesh_id(), ms.current_mesh().id(), ms.current_mesh().label()
    except pymeshlab.PyMeshLabException as error:
        current = str(error)
    by_id = [
        (i, ms.mesh(i).label(), ms.mesh(i).vertex_number(), ms.is_mesh_visible(i)) for i in ids
    ]
    return current, len(ms), ms.mesh_number(), ids, [mesh.id() for mesh in ms], by_id


ANYTIME = {"add": 2, "let_go": 1, "clear": 0.3}
WITH_A_MESH = {
    "flip": 8,
    "write_scalar": 1,
    "hold": 3,
    "copy": 2,
    "delete": 2,
    "delete_hidden": 1,
    "make_current": 4,
    "show": 2,
    "measure": 2,
    "merge": 0.5,
    "split": 1,
    "flip_all_in_a_loop": 1,
    "run_script": 1,
}


def step(both):
    """One random action; its name."""
    weights = dict(ANYTIME)
    try:
        both.plain.current_mesh()
        weights.update(WITH_A_MESH)
    except pymeshlab.PyMeshLabException:
        if both.plain.mesh_number():
            weights["make_current"] = 4
    (name,) = both.random.choices(list(weights), list(weights.values()))
    if name == "merge" and not any(mesh.is_visible() for mesh in both.plain):
        name = "show"
    getattr(both, name)()
    return name


@pytest.mark.parametrize(
    "seed",
    [*range(6), *(pytest.param(seed, marks=pytest.mark.nightly) for seed in range(6, 25))],
)
@pytest.mark.slow
def test_ids_lead_to_the_same_meshes_as_in_a_set_without_flips(seed):
    both = Both(seed)
    done = []
    for _ in range(25):
        done.append(step(both))
        try:
            both.assert_same()
        except AssertionError as error:
            raise AssertionError(f"after {done}") from error


# Parameters that are meshes, and others


def holding_the_first_of_two():
    """A set with two meshes, the first of which was flipped while it was held, and its `Mesh`."""
    ms = set_of(*meshes.bumpy_sphere(60))
    held = ms.current_mesh()
    ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(80)), "other", set_as_current=False)
    ms.apply_filter(FLIP)
    return ms, held


SPLIT = "generate_splitting_by_connected_components"
NOT_MESHES = [
    (SPLIT, "delete_source_mesh"),
    ("compute_color_transfer_mesh_to_face", "allvisiblemesh"),
    ("apply_coord_point_cloud_movement_over_mesh", "colorize_mesh"),
]


@pytest.mark.parametrize(("name", "keyword"), NOT_MESHES)
def test_a_flag_is_no_mesh_whatever_its_name_ends_in(name, keyword):
    ms, held = holding_the_first_of_two()
    for value in (False, True):
        assert ms.filter_parameter_values(name, **{keyword: value})[keyword] is value
    assert ms.filter_parameter_values(name)[keyword] is False
    assert held.id() == 0


@pytest.mark.parametrize("given", [{}, {"delete_source_mesh": False}])
def test_the_flipped_mesh_stays_when_it_is_split(given):
    ms, held = holding_the_first_of_two()
    ms.apply_filter(SPLIT, **given)
    assert [(m.id(), m.vertex_number()) for m in ms] == [(0, 60), (1, 80), (2, 60)]
    assert (ms.mesh(0).face_matrix() != held.face_matrix()).any()


class Part(enum.IntEnum):
    BODY = 0


@pytest.mark.parametrize("kind", [int, np.int64, np.uint8, lambda _: Part.BODY])
def test_ids_of_all_types_lead_to_the_flipped_mesh(kind):
    ms, held = holding_the_first_of_two()
    name = "apply_coord_point_cloud_movement_over_mesh"
    flipped, there = kind(0), [mesh.id() for mesh in ms]
    # A mesh by its type, though not by its name.
    for keyword in ("point_cloud", "target_mesh"):
        assert ms.filter_parameter_values(name, **{keyword: flipped})[keyword] == 0
    ms.transfer_attributes_per_vertex(sourcemesh=1, targetmesh=flipped, geomtransfer=True)
    assert (there, ms.mesh_id_exists(flipped)) == ([0, 1], True)
    assert (ms.mesh(flipped).vertex_matrix() != held.vertex_matrix()).any()


def test_an_id_that_does_not_exist_is_an_error_in_a_flipped_set():
    ms, _ = holding_the_first_of_two()
    for mesh_id in (2, 3, -1, 2**40):
        with pytest.raises(pymeshlab.PyMeshLabException, match=rf"no mesh {mesh_id} .*: 0, 1\)"):
            ms.get_hausdorff_distance(targetmesh=mesh_id)
        for ask in (ms.mesh, ms.is_mesh_visible, ms.__getitem__):
            with pytest.raises(pymeshlab.PyMeshLabException, match=f"Mesh ID {mesh_id} not found"):
                ask(mesh_id)
        assert not ms.mesh_id_exists(mesh_id)
    for ask in (ms.mesh, ms.set_current_mesh, ms.mesh_id_exists, ms.is_mesh_visible):
        for value in ("0", 0.0, None):
            with pytest.raises(TypeError):
                ask(value)
    assert ms.current_mesh_id() == 0


def test_a_loop_by_number_works_twice():
    ms = pymeshlab.MeshSet()
    for n in range(3):
        ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(50 + n)))
    for energy in ("willmore", "area"):
        for i in range(ms.mesh_number()):
            ms.set_current_mesh(i)
            assert ms.apply_filter(FLIP, energy=energy)["flips"] > 0
            assert ms.current_mesh().vertex_number() == 50 + i
    assert [(m.id(), m.vertex_number()) for m in ms] == [(0, 50), (1, 51), (2, 52)]


def test_an_iterator_comes_to_meshes_that_were_flipped_after_it_began():
    ms = set_of(*meshes.bumpy_sphere(50))
    ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(60)))
    iterator = iter(ms)
    assert next(iterator).id() == 0
    ms.apply_filter(FLIP)
    assert [mesh.id() for mesh in iterator] == [1]


# What PyMeshLab prints and saves of the layers


def three():
    ms = pymeshlab.MeshSet()
    for n in range(3):
        ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(40 + n)), f"mesh\n\n{n}")
    ms.set_current_mesh(0)
    return ms


def test_the_status_prints_ids_that_lead_to_the_meshes(capfd):
    ms = three()
    held = ms.current_mesh()
    ms.apply_filter(FLIP)
    capfd.readouterr()
    ms.print_status()
    printed = capfd.readouterr().out
    assert printed.startswith("Number meshes: 3\n\tMesh id: 0\n")
    assert re.findall(r"Mesh id: (\d)\n\tMesh label: mesh\n\n(\d)\n", printed) == [
        ("0", "0"),
        ("1", "1"),
        ("2", "2"),
    ]
    assert held.id() == 0


def test_a_project_has_the_meshes_in_their_order(tmp_path):
    ms = three()
    ms.apply_filter(FLIP)
    for n in range(3):
        ms.set_current_mesh(n)
        ms.save_current_mesh(str(tmp_path / f"{n}.ply"))
    ms.set_mesh_visibility(1, False)
    project = str(tmp_path / "all.mlp")
    ms.save_project(project)
    loaded = pymeshlab.MeshSet()
    loaded.load_project(project)
    # PyMeshLab leaves hidden meshes out.
    assert [(mesh.id(), mesh.vertex_number()) for mesh in loaded] == [(0, 40), (1, 42)]
