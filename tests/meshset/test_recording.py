"""Our filters in the filter script of a set, and such scripts applied to another."""

import itertools
import subprocess
import sys

import numpy as np
import pymeshlab
import pytest

import meshlab_willmore
from meshlab_willmore.meshset import native
from meshlab_willmore.mlx.read import read
from meshlab_willmore.mlx.steps import Percentage, Step
from meshlab_willmore.mlx.write import to_xml
from tests import meshes
from tests.meshset.conftest import FLIP, SAMPLES, set_of
from tests.meshset.scripts import names, natively, printed, sphere, state

SCALAR = "compute_scalar_by_willmore_energy_per_vertex"
MEASURE = "get_willmore_measures"
REMESH = "Remeshing: Isotropic Explicit Remeshing"
SAMPLE_SCRIPT = SAMPLES / "sample_filter_script.mlx"

OURS = {
    "flip": (FLIP, {"foldangle": 80.123456789}),
    "energy": (SCALAR, {}),
    "measure": (MEASURE, {}),
}
# The six digits that PyMeshLab writes of a number are all of these.
LENGTH, SIZE = pymeshlab.PureValue(0.0625), pymeshlab.PureValue(0.1875)
NATIVE = {
    "smooth": ("apply_coord_taubin_smoothing", {"lambda_": 0.323056}),
    "remesh": ("meshing_isotropic_explicit_remeshing", {"iterations": 1, "targetlen": LENGTH}),
    "turn": ("compute_matrix_from_rotation", {"angle": 33.3}),
    "select": ("compute_selection_by_condition_per_face", {"condselect": "fi < 40 && 1 > 0"}),
    "offset": ("generate_resampled_uniform_mesh", {"cellsize": SIZE}),
}
CHAINS = [
    *itertools.product(OURS),
    *itertools.permutations(["flip", "smooth"]),
    *itertools.permutations(["flip", "remesh", "energy"]),
    *itertools.product(["flip", "turn"], repeat=3),
    ("select", "flip", "measure", "smooth"),
    ("offset", "flip", "remesh", "flip", "smooth"),
    ("smooth", "energy", "offset", "flip"),
]


def apply_chain(ms, chain):
    for key in chain:
        name, given = {**OURS, **NATIVE}[key]
        ms.apply_filter(name, **given)


# Recording


@pytest.mark.heavy
@pytest.mark.parametrize("chain", CHAINS, ids="-".join)
def test_a_saved_script_gives_the_same_meshes_to_the_last_bit(chain, tmp_path, capfd):
    called = sphere()
    apply_chain(called, chain)
    path = str(tmp_path / "chain.mlx")
    called.save_filter_script(path)

    loaded = sphere()
    loaded.load_filter_script(path)
    assert printed(loaded, capfd) == printed(called, capfd)
    again = str(tmp_path / "again.mlx")
    loaded.save_filter_script(again)
    assert read(again) == read(path)
    loaded.apply_filter_script()
    assert state(loaded) == state(called)
    loaded.save_filter_script(again)
    assert read(again) == read(path), "applying a script does not add to it"


def test_steps_are_recorded_in_their_order_with_all_parameters(bumpy, tmp_path):
    bumpy.apply_coord_taubin_smoothing()
    bumpy.meshing_edge_flip_by_willmore_optimization(
        energy="willmore", maxflips=7, virtualpoint=0.25
    )
    bumpy.get_geometric_measures()
    bumpy.get_willmore_measures()
    path = tmp_path / "script.mlx"
    bumpy.save_filter_script(str(path))
    smooth, flip, geometry, measure = read(path)
    assert (smooth.filter, geometry.filter) == ("Taubin Smooth", "Compute Geometric Measures")
    assert measure == Step("Willmore measures")
    assert flip.filter == "Willmore flipping optimization"
    assert {p.name: (p.type, p.value) for p in flip.params} == {
        "preset": ("RichEnum", 0),
        "selection": ("RichBool", False),
        "energy": ("RichEnum", 1),
        "search": ("RichEnum", 0),
        "depth": ("RichInt", 5),
        "breadth": ("RichInt", 3),
        "sweeps": ("RichInt", 200),
        "seed": ("RichInt", 0),
        "virtualpoint": ("RichString", "0.25"),
        "monotone": ("RichBool", True),
        "foldangle": ("RichFloat", 90.0),
        "minshape": ("RichFloat", 0.05),
        "maxdeviation": ("RichAbsPerc", Percentage(100.0)),
        "checkintersections": ("RichBool", False),
        "featuredeg": ("RichFloat", 180.0),
        "maxflips": ("RichInt", 7),
        "allowloss": ("RichBool", False),
    }


def test_the_listing_reads_as_pymeshlabs_own(bumpy, capfd):
    """PyMeshLab lists the native steps; ours, added afterwards, leave these lines alone."""
    bumpy.apply_coord_taubin_smoothing(lambda_=0.1234567)
    bumpy.compute_matrix_from_rotation(angle=33.3, customaxis=[0.1, 0.2, 0.3])
    bumpy.meshing_isotropic_explicit_remeshing(iterations=1)
    bumpy.set_matrix(transformmatrix=np.arange(16.0).reshape(4, 4) / 7, compose=True)
    bumpy.set_matrix_identity()
    bumpy.set_color_per_vertex(color1=pymeshlab.Color(10, 20, 30, 40))
    bumpy.compute_color_from_scalar_per_vertex()
    bumpy.compute_scalar_by_function_per_vertex(q="x + 1")
    bumpy.create_cube()
    bumpy.get_hausdorff_distance(sampledmesh=0, targetmesh=1, samplenum=3)
    own = printed(bumpy, capfd)
    bumpy.get_willmore_measures()
    head, *rest = own.split("\n")
    assert head == "Filter Script Size : 10"
    assert printed(bumpy, capfd).split("\n") == [
        "Filter Script Size : 11",
        *rest[:-1],
        "10: willmore_measures",
        "",
        "",
    ]


def test_a_percentage_is_listed_as_one(bumpy, tmp_path, capfd):
    path = tmp_path / "script.mlx"
    share = '<Param name="TargetLen" type="RichAbsPerc" value="2.5%"/>'
    path.write_text(
        to_xml([Step("Willmore measures")]).replace(
            "</FilterScript>",
            f'<filter name="{REMESH}">{share}</filter></FilterScript>',
        )
    )
    bumpy.load_filter_script(str(path))
    assert "\ttargetlen : PercentageValue = 2.5%\n" in printed(bumpy, capfd)


def test_a_step_that_fails_is_not_recorded(bumpy, tmp_path, capfd):
    bumpy.apply_coord_taubin_smoothing()
    with pytest.raises(pymeshlab.PyMeshLabException):
        bumpy.meshing_edge_flip_by_willmore_optimization(maxflips=-5)
    assert printed(bumpy, capfd).startswith("Filter Script Size : 1\n")


def test_clearing_forgets_ours_and_clearing_the_meshes_does_not(bumpy, capfd):
    bumpy.get_willmore_measures()
    bumpy.clear()
    assert printed(bumpy, capfd).startswith("Filter Script Size : 1\n")
    bumpy.clear_filter_script()
    assert printed(bumpy, capfd) == "Filter Script Size : 0\n\n"


def test_text_outside_ascii_and_quotes_come_back(bumpy, tmp_path):
    label = 'Müller\'s <mesh> "7" & 雪'
    bumpy.set_mesh_name(newname=label)
    bumpy.get_willmore_measures()
    path = tmp_path / "script.mlx"
    bumpy.save_filter_script(str(path))
    other = sphere()
    other.load_filter_script(str(path))
    other.apply_filter_script()
    assert other.current_mesh().label() == label


def test_numbers_that_are_none_do_not_stop_a_script(bumpy, tmp_path, capfd):
    """Scalars that are infinite give a filter an infinite default."""
    bumpy.compute_scalar_by_function_per_vertex(q="1 / 0")
    bumpy.compute_selection_by_scalar_per_vertex()
    bumpy.get_willmore_measures()
    path = str(tmp_path / "script.mlx")
    bumpy.save_filter_script(path)
    assert "2: willmore_measures" in printed(bumpy, capfd)
    loaded = sphere()
    loaded.load_filter_script(path)
    loaded.apply_filter_script()
    assert np.isinf(loaded.current_mesh().vertex_scalar_array()).all()
    assert len(names(path)) == 3


def test_an_old_form_can_be_saved_in_todays(bumpy, tmp_path):
    path = tmp_path / "script.mlx"
    path.write_text(
        '<FilterScript><filter name="Willmore measures"/><xmlfilter name="Taubin Smooth">'
        '<xmlparam name="lambda" value="0.3"/></xmlfilter></FilterScript>'
    )
    bumpy.load_filter_script(str(path))
    bumpy.save_filter_script(str(path))
    (param,) = read(path)[1].params
    assert (param.name, param.type, param.value) == ("lambda", "RichFloat", 0.3)


def test_names_of_files_may_be_bytes(bumpy, tmp_path):
    bumpy.get_willmore_measures()
    path = str(tmp_path / "script.mlx").encode()
    bumpy.save_filter_script(path)
    other = sphere()
    other.load_filter_script(path)
    other.save_filter_script(path)
    assert names(path.decode()) == ["Willmore measures"]


def test_a_folder_that_is_not_there_is_named(bumpy, tmp_path):
    bumpy.get_willmore_measures()
    with pytest.raises(pymeshlab.PyMeshLabException, match="nowhere"):
        bumpy.save_filter_script(str(tmp_path / "nowhere" / "script.mlx"))


SEEN_LATE = """
import pymeshlab, sys
ms = pymeshlab.MeshSet()
ms.create_sphere(subdiv=2)
kept = pymeshlab.MeshSet.apply_filter
import meshlab_willmore
ms.apply_coord_taubin_smoothing(lambda_=0.1234567)
ms.get_willmore_measures()
kept(ms, "set_selection_all")
ms.set_selection_none()
ms.save_filter_script(sys.argv[1])
"""


@pytest.mark.slow
def test_steps_from_before_the_import_come_first_and_unseen_ones_last(tmp_path):
    path = tmp_path / "script.mlx"
    subprocess.run([sys.executable, "-c", SEEN_LATE, str(path)], check=True)
    before, after = ["Sphere", "Taubin Smooth"], ["Select All", "Select None"]
    assert names(path) == [*before, "Willmore measures", *after]
    smooth = {p.name: p.value for p in read(path)[1].params}
    assert smooth["lambda"] == 0.123457


def test_a_loaded_script_takes_the_place_of_the_recorded_one(bumpy, tmp_path):
    bumpy.get_willmore_measures()
    path = str(tmp_path / "script.mlx")
    bumpy.save_filter_script(path)
    bumpy.set_selection_none()
    bumpy.load_filter_script(path)
    bumpy.save_filter_script(path)
    assert names(path) == ["Willmore measures"]
    bumpy.apply_filter(FLIP)
    bumpy.load_filter_script(str(SAMPLE_SCRIPT))
    bumpy.save_filter_script(path)
    assert names(path) == names(SAMPLE_SCRIPT)


# Ids of meshes


def two_meshes():
    ms = set_of(*meshes.bumpy_sphere(100))
    ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(120)), "other")
    return ms


@pytest.mark.parametrize("held", [False, True])
def test_mesh_ids_point_to_the_same_mesh_after_flips(held, tmp_path):
    called = two_meshes()
    keep = called.current_mesh() if held else None
    called.apply_filter(FLIP)
    called.create_cube()
    called.apply_filter(SCALAR)
    called.create_sphere(subdiv=1)
    last = called.current_mesh_id()
    flipped = next(mesh.id() for mesh in called if mesh.label() == "other")
    called.set_current_mesh(last)
    called.transfer_attributes_per_vertex(sourcemesh=flipped, targetmesh=last)
    path = str(tmp_path / "script.mlx")
    called.save_filter_script(path)
    transfer = {p.name: p.value for p in read(path)[-1].params}
    assert (transfer["SourceMesh"], transfer["TargetMesh"]) == (1, 3)
    del keep

    loaded = two_meshes()
    other = loaded.current_mesh() if not held else None
    loaded.load_filter_script(path)
    loaded.apply_filter_script()
    assert state(loaded) == state(called)
    del other


def test_a_script_of_meshlab_finds_the_flipped_mesh_by_its_id(tmp_path):
    path = tmp_path / "script.mlx"
    path.write_text(
        '<!DOCTYPE FilterScript><FilterScript><filter name="Willmore flipping optimization"/>'
        '<filter name="Hausdorff Distance">'
        '<Param type="RichMesh" name="SampledMesh" value="1"/>'
        '<Param type="RichMesh" name="TargetMesh" value="0"/>'
        "</filter></FilterScript>"
    )
    ms = two_meshes()
    (_, distance) = meshlab_willmore.script.run(path, ms)
    assert (distance.given["sampledmesh"], distance.given["targetmesh"]) == (1, 0)
    assert distance.returned["n_samples"] > 0


def test_a_mesh_that_a_step_deleted_is_an_error_and_no_crash(tmp_path):
    path = tmp_path / "script.mlx"
    path.write_text(
        '<FilterScript><filter name="Willmore measures"/><filter name="Delete Current Mesh"/>'
        '<filter name="Hausdorff Distance">'
        '<Param type="RichMesh" name="SampledMesh" value="1"/></filter></FilterScript>'
    )
    ms = two_meshes()
    ms.load_filter_script(str(path))
    with pytest.raises(
        pymeshlab.PyMeshLabException,
        match=r"step 3 \(get_hausdorff_distance\): parameter 'sampledmesh': there is no mesh 1 ",
    ):
        ms.apply_filter_script()


def test_a_native_script_knows_the_mesh_after_flips_made_before_it(tmp_path):
    ms = two_meshes()
    ms.apply_filter(FLIP)
    path = tmp_path / "script.mlx"
    path.write_text(
        '<FilterScript><filter name="Hausdorff Distance">'
        '<Param type="RichMesh" name="SampledMesh" value="1"/>'
        '<Param type="RichMesh" name="TargetMesh" value="0"/></filter></FilterScript>'
    )
    ms.load_filter_script(str(path))
    ms.apply_filter_script()
    assert ms.mesh_number() == 2


@pytest.mark.parametrize("kind", [int, np.int64, np.int32])
def test_native_filters_find_a_replaced_mesh_by_an_id_of_any_type(kind):
    ms = two_meshes()
    ms.apply_filter(FLIP)
    ms.set_current_mesh(0)
    distance = ms.get_hausdorff_distance(sampledmesh=kind(0), targetmesh=kind(1), samplenum=10)
    assert distance["n_samples"] > 0


def test_ids_in_a_script_without_our_steps_are_right_after_flips(tmp_path):
    """Flips before the script began have moved the ids that the set shows."""
    called = two_meshes()
    called.apply_filter(FLIP)
    called.apply_filter(SCALAR)
    called.clear_filter_script()
    called.create_cube()
    cube = called.current_mesh_id()
    flipped = next(mesh.id() for mesh in called if mesh.label() == "other")
    called.transfer_attributes_per_vertex(sourcemesh=flipped, targetmesh=cube)
    path = str(tmp_path / "script.mlx")
    called.save_filter_script(path)
    transfer = {p.name: p.value for p in read(path)[-1].params}
    assert (transfer["SourceMesh"], transfer["TargetMesh"]) == (1, 2)
    loaded = two_meshes()
    loaded.load_filter_script(path)
    loaded.apply_filter_script()
    assert state(loaded)[-1] == state(called)[-1]


WRITING_THREAD = """
import os, threading, pymeshlab, meshlab_willmore
lines, done = 0, threading.Event()
def write():
    global lines
    while not done.is_set():
        os.write(1, b"x\\n")
        lines += 1
thread = threading.Thread(target=write)
thread.start()
ms = pymeshlab.MeshSet()
ms.create_torus()
for _ in range(100):
    ms.compute_matrix_from_rotation(angle=1.0)
done.set()
thread.join()
os.write(2, str(lines).encode())
"""


def test_native_calls_do_not_take_the_output_of_other_threads():
    written, counted = natively(WRITING_THREAD)
    assert written.count("x") == int(counted)


@pytest.mark.parametrize("beside_ours", [False, True])
def test_native_steps_are_saved_as_pymeshlab_writes_them(beside_ours, tmp_path):
    """With six digits; ours keep all of theirs."""
    ms = sphere()
    ms.apply_coord_taubin_smoothing(lambda_=0.1234567)
    if beside_ours:
        ms.apply_filter(FLIP, foldangle=80.123456789)
    path = tmp_path / "script.mlx"
    ms.save_filter_script(str(path))
    smooth, *flips = read(path)
    assert {p.name: p.value for p in smooth.params}["lambda"] == 0.123457
    assert [p.value for s in flips for p in s.params if p.name == "foldangle"] == [
        80.123456789
    ] * beside_ours


def test_a_native_call_is_one_call_of_pymeshlab(bumpy, monkeypatch):
    """Recording asks for no defaults and saves no script: these take as long as small filters."""
    monkeypatch.setattr(native, "defaults", None)
    monkeypatch.setattr(native._own, "save_filter_script", None)
    bumpy.compute_matrix_from_rotation(angle=33.3)
