"""The catalogue says of every filter what PyMeshLab itself says, or does."""

import json
import os
import re
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pymeshlab
import pytest

from meshlab_willmore.meshset import catalogue, filter_info, native
from meshlab_willmore.meshset.catalogue import closest, everything, find
from meshlab_willmore.meshset.filters import BY_NAME, FILTERS
from meshlab_willmore.mlx import rich
from tests.meshset.conftest import FLIP, set_of

ENTRIES = json.loads(Path(catalogue.__file__).with_name("native_filters.json").read_text())
NATIVES = ENTRIES["filters"]
REMESH = "meshing_isotropic_explicit_remeshing"
REMESH_MESHLAB = "Remeshing: Isotropic Explicit Remeshing"

# As PyMeshLab's print_filter_parameter_list says them.
PYTHON_TYPES = {
    "RichBool": "bool",
    "RichInt": "int",
    "RichMesh": "int",
    "RichFloat": "float",
    "RichDynamicFloat": "float (bounded)",
    "RichAbsPerc": "PercentageValue",
    "RichEnum": "str",
    "RichString": "str",
    "RichOpenFile": "str",
    "RichSaveFile": "str",
    "RichPosition": "numpy.ndarray[numpy.float64[3]]",
    "RichDirection": "numpy.ndarray[numpy.float64[3]]",
    "RichMatrix44f": "numpy.ndarray[numpy.float64[4, 4]]",
    "RichColor": "Color",
    "RichShotf": "Shotf [still unsupported]",
}


@pytest.fixture(autouse=True)
def fresh():
    """What a test made the catalogue believe does not outlive it."""
    caches = (catalogue._read, catalogue._by_meshlab_name, filter_info._defaults)
    for cached in caches:
        cached.cache_clear()
    yield
    for cached in caches:
        cached.cache_clear()


@pytest.fixture
def without(monkeypatch):
    """Makes the catalogue forget what was recorded of some filters."""

    def forget(*names):
        entries = {name: entry for name, entry in NATIVES.items() if name not in names}
        monkeypatch.setattr(catalogue, "_recorded", lambda: entries)

    return forget


recorded_here = pytest.mark.skipif(
    catalogue.version() != ENTRIES["pymeshlab"], reason="another PyMeshLab than the recorded one"
)


# --- against PyMeshLab -------------------------------------------------------------------------


@recorded_here
def test_every_native_filter_is_recorded():
    assert sorted(NATIVES) == sorted(set(pymeshlab.filter_list()) - BY_NAME.keys())
    assert catalogue.missing() == ()


@recorded_here
def test_keywords_and_types_are_those_that_pymeshlab_prints(capfd):
    for known in everything():
        if not known.is_willmore:
            pymeshlab.print_filter_parameter_list(known.name)
    native._flush_c_streams()
    printed = {}
    for line in capfd.readouterr().out.splitlines():
        if heading := re.fullmatch(r"(\w+) filter - list of parameter names:", line):
            params = printed.setdefault(heading[1], [])
        elif param := re.match(r"\t(\w+) : (.+?) = ", line):
            params.append((param[1], param[2]))
    assert len(printed) == len(NATIVES)
    assert printed == {
        known.name: [(p.keyword, PYTHON_TYPES[p.type]) for p in known.params]
        for known in everything()
        if not known.is_willmore
    }


@recorded_here
def test_choices_are_those_that_pymeshlab_names():
    recorded = {known.name: [p.choices for p in known.params] for known in map(find, NATIVES)}
    found = {name: [p.choices for p in filter_info.params(name)] for name in NATIVES}
    assert found == recorded
    assert sum(len(choices) > 1 for params in found.values() for choices in params) > 50


@recorded_here
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs child processes")
@pytest.mark.parametrize("step", [21, pytest.param(7, marks=pytest.mark.nightly)])
@pytest.mark.slow
def test_all_names_are_known_and_a_sample_does_what_its_entry_says(step):
    sample = sorted(NATIVES)[::step]
    command = [sys.executable, "-m", "generate.native_filters", "--check", *sample]
    root = Path(__file__).parents[2]
    run = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
    assert run.stdout == f"{len(NATIVES)} checked\n"


@recorded_here
@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("get_hausdorff_distance", {"savesample": True}),
        ("generate_polyline_from_planar_section", {}),
        ("create_cube", {}),
    ],
)
def test_filters_that_make_layers(bumpy, name, given):
    bumpy.create_sphere()
    before = bumpy.mesh_number()
    bumpy.apply_filter(name, **given)
    assert bumpy.mesh_number() > before
    assert find(name).makes_layers


@recorded_here
@pytest.mark.parametrize(
    ("name", "keyword", "words"),
    [
        ("apply_coord_directional_preservation", "attr_name", 'attribute called ""'),
        ("load_active_raster_cameras", "importfile", "No file to open"),
        ("nxs_build", "output_file", "filename not valid"),
        ("nxs_compress", "output_file", "filename not valid"),
    ],
)
def test_filters_fail_without_what_is_required(bumpy, name, keyword, words):
    assert find(name).param(keyword).required
    with pytest.raises(pymeshlab.PyMeshLabException, match=words):
        bumpy.apply_filter(name)
    native.forget_failures()


def test_nothing_else_is_required():
    required = [known.name for known in everything() for p in known.params if p.required]
    assert sorted(required) == [
        "apply_coord_directional_preservation",
        "load_active_raster_cameras",
        *["nxs_build"] * 2,
        *["nxs_compress"] * 2,
    ]


def test_all_types_are_known_to_scripts():
    types = {p.type for known in everything() for p in known.params}
    assert types <= set(rich.TYPES)
    assert set(PYTHON_TYPES) - types == set()


# --- finding -----------------------------------------------------------------------------------


def test_every_filter_is_found_by_each_of_its_names():
    for known in everything():
        assert find(known.name) == find(known.meshlab_name) == known
        for param in known.params:
            assert known.param(param.name) == known.param(param.keyword) == param


def test_names_are_unique():
    names = [name for known in everything() for name in {known.name, known.meshlab_name}]
    assert len(names) == len(set(names))
    for known in everything():
        keywords = [p.keyword for p in known.params]
        assert len(keywords) == len(set(keywords))


def test_every_old_name_of_pymeshlab_is_found():
    keys = Path(pymeshlab.__file__).with_name("keys.txt").read_text().split()
    for old, today in zip(keys[::2], keys[1::2], strict=True):
        known = find(old)
        if today in NATIVES and old not in NATIVES:
            assert known.name == today
    assert find("hausdorff_distance").name == "get_hausdorff_distance"


@pytest.mark.parametrize(
    ("old", "today"),
    [
        ("Quadric Edge Collapse Decimation", "meshing_decimation_quadric_edge_collapse"),
        (
            "Quadric Edge Collapse Decimation (with texture)",
            "meshing_decimation_quadric_edge_collapse_with_texture",
        ),
        ("Re-Orient all faces coherentely", "meshing_re_orient_faces_coherently"),
        ("Remove Duplicated Vertex", "meshing_remove_duplicate_vertices"),
        (
            "Remove Isolated pieces (wrt Face Num)",
            "meshing_remove_connected_component_by_face_number",
        ),
        ("Remove Unreferenced Vertex", "meshing_remove_unreferenced_vertices"),
        ("Compute Geometric Measures", "get_geometric_measures"),
        ("Remove Duplicate Vertices", "meshing_remove_duplicate_vertices"),
        ("Alpha Wrap", "generate_alpha_wrap"),
    ],
)
def test_names_of_meshlab_are_found(old, today):
    assert find(old).name == today


def test_an_old_name_of_meshlab_is_found(monkeypatch):
    monkeypatch.setattr(catalogue, "_renamed", lambda: {"planar_flip_optimization": "create_cube"})
    assert find("Planar-Flip: Optimization").name == "create_cube"


@pytest.mark.parametrize(
    "name",
    [
        "remeshing: isotropic explicit remeshing",
        "Remeshing Isotropic Explicit Remeshing",
        "Meshing_Isotropic_Explicit_Remeshing",
        "willmore flipping optimization",
        "TargetLen",
        "",
        " ",
        "no such filter",
        "x" * 100_000,
    ],
)
def test_other_names_are_not_found(name):
    assert find(name) is None


@pytest.mark.parametrize(
    ("name", "nearest"),
    [
        ("remeshing: isotropic explicit remeshing", REMESH_MESHLAB),
        ("Remeshing Isotropic", REMESH_MESHLAB),
        ("meshing_isotropic_remeshing", REMESH),
        ("Taubin Smoth", "Taubin Smooth"),
        ("Willmore flip", "Willmore flipping optimization"),
        ("willmore_flip_optimization", "Willmore flipping optimization"),
        ("meshing_edge_flip_willmore", FLIP),
    ],
)
def test_closest_names(name, nearest):
    found = closest(name)
    assert found[0] == nearest
    assert len(found) <= 3
    # All are names of one kind.
    assert len({find(other).name == other for other in found}) == 1


@pytest.mark.parametrize("name", ["", "qqqqq", "x" * 100_000])
def test_nothing_is_close_to_nonsense(name):
    assert closest(name) == []


def test_ours_are_as_their_table_says():
    for filter_ in FILTERS:
        known = find(filter_.meshlab_name)
        assert known.name == filter_.name
        assert known.is_willmore
        assert known.summary == filter_.summary
        assert [p.keyword for p in known.params] == [p.name for p in filter_.parameters]
    types = {p.name: p.type for p in find(FLIP).params}
    assert types == {
        "preset": "RichEnum",
        "selection": "RichBool",
        "energy": "RichEnum",
        "search": "RichEnum",
        "depth": "RichInt",
        "breadth": "RichInt",
        "sweeps": "RichInt",
        "seed": "RichInt",
        "virtualpoint": "RichString",
        "monotone": "RichBool",
        "foldangle": "RichFloat",
        "minshape": "RichFloat",
        "maxdeviation": "RichAbsPerc",
        "checkintersections": "RichBool",
        "featuredeg": "RichFloat",
        "maxflips": "RichInt",
        "allowloss": "RichBool",
    }
    assert find(FLIP).param("energy").choices[:2] == ("virtual willmore", "willmore")
    assert find(FLIP).param("virtualpoint").choices == ()


def test_parameters_differ_in_case():
    known = find(REMESH)
    assert known.param("TargetLen") == known.param("targetlen")
    assert known.param("Targetlen") is None


def test_keywords_that_python_reserves():
    assert find("Taubin Smooth").param("lambda").keyword == "lambda_"


def test_everything_is_sorted_and_there():
    names = [known.name for known in everything()]
    assert names == sorted(pymeshlab.filter_list())
    assert all(known.available for known in everything())


# --- other versions, other plugins -------------------------------------------------------------


def test_a_filter_that_was_not_recorded_is_asked_from_pymeshlab(without):
    recorded = find(REMESH)
    without(REMESH)
    catalogue._read.cache_clear()
    known = find(REMESH)
    assert known.meshlab_name == ""
    assert known.available
    assert known.makes_layers
    assert known.needs_mesh
    assert [p.keyword for p in known.params] == [p.keyword for p in recorded.params]
    assert [p.type for p in known.params] == [p.type for p in recorded.params]
    # MeshLab's names are not known, so what computes to the keyword is let through.
    assert known.param("TargetLen").keyword == "targetlen"
    assert not find("no such filter")


def test_a_filter_that_was_not_recorded_is_found_by_what_its_name_computes_to(without):
    without("set_matrix")
    assert find("Set Matrix").name == "set_matrix"


def test_one_that_was_not_recorded_and_needs_no_mesh(without):
    without("create_cube")
    assert not find("create_cube").needs_mesh


@recorded_here
def test_types_that_are_guessed():
    """Every kind that PyMeshLab tells apart comes out right, on every filter."""
    alike = {"RichDynamicFloat": "RichFloat", "RichDirection": "RichPosition"}
    alike |= dict.fromkeys(("RichOpenFile", "RichSaveFile"), "RichString")
    wrong = {
        (name, own.name, own.type, guess.type)
        for name in NATIVES
        for own, guess in zip(find(name).params, filter_info.params(name), strict=True)
        if alike.get(own.type, own.type) != guess.type
    }
    # Their defaults are numbers, whatever the ids of the meshes.
    assert {(name, own) for name, own, *_ in wrong} == {
        ("compute_matrix_by_icp_between_meshes", "ReferenceMesh"),
        ("compute_matrix_by_icp_between_meshes", "SourceMesh"),
        ("compute_matrix_by_mesh_global_alignment", "BaseMesh"),
    }


def test_parameters_of_another_version_are_brought_up_to_date(monkeypatch):
    today = find(REMESH)
    entry = dict(NATIVES[REMESH])
    entry["params"] = [["Vanished", "RichBool"], *entry["params"][:-1]]
    monkeypatch.setattr(catalogue, "_recorded", lambda: {**NATIVES, REMESH: entry})
    monkeypatch.setattr(catalogue, "version", lambda: "2099.1")
    catalogue._read.cache_clear()
    known = find(REMESH_MESHLAB)
    assert known.params[:-1] == today.params[:-1]
    assert known.params[-1].keyword == today.params[-1].keyword
    assert known.params[-1].guessed
    assert known.param("Vanished") is None


def test_a_filter_whose_plugin_is_not_there(monkeypatch):
    there = set(NATIVES) - {REMESH}
    monkeypatch.setattr(catalogue, "_there", lambda: there)
    known = find(REMESH_MESHLAB)
    assert known.name == REMESH
    assert not known.available
    assert known.params
    assert [k.name for k in catalogue.missing()] == [REMESH]
    assert REMESH not in [k.name for k in everything()]


def test_an_unknown_version(monkeypatch):
    def unknown(_):
        raise metadata.PackageNotFoundError

    monkeypatch.setattr(metadata, "version", unknown)
    assert catalogue.version() == "latest"
    assert find("create_cube").summary.endswith("/en/latest/filter_list.html#create_cube")


# --- manners -----------------------------------------------------------------------------------


def test_asking_prints_nothing_and_touches_no_set(capfd, without):
    ms = set_of([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    before = native.script_of(ms)
    without(*NATIVES)
    capfd.readouterr()
    everything()
    closest("Taubin Smoth")
    native._flush_c_streams()
    assert capfd.readouterr() == ("", "")
    assert native.script_of(ms) == before
    assert ms.mesh_number() == 1


def test_what_a_plugin_prints_when_it_is_asked_is_not_seen(capfd, monkeypatch):
    quiet = native.defaults

    def noisy(*args, **given):
        os.write(1, b"noise")
        os.write(2, b"noise")
        return quiet(*args, **given)

    monkeypatch.setattr(native, "defaults", noisy)
    assert len(filter_info.params(REMESH)) == 12
    assert capfd.readouterr() == ("", "")


@pytest.mark.slow
def test_the_file_is_not_read_before_it_is_needed():
    code = (
        "import meshlab_willmore\n"
        "from meshlab_willmore.meshset import catalogue\n"
        "print(catalogue._file.cache_info().currsize, catalogue._renamed.cache_info().currsize)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["0", "0"]
