"""PyMeshLab lists and prints the filters as it does native ones."""

import inspect
import os
import pydoc
import re
import subprocess
import sys

import pymeshlab
import pytest

import meshlab_willmore
from meshlab_willmore.meshset import native, register
from meshlab_willmore.meshset.filters import FILTERS
from tests import meshes
from tests.meshset.conftest import FLIP, set_of

NAMES = [f.name for f in FILTERS]
NATIVE = "meshing_edge_flip_by_planar_optimization"


def test_names_are_those_of_the_documentation():
    assert {f.name: f.meshlab_name for f in FILTERS} == {
        "meshing_edge_flip_by_willmore_optimization": "Willmore flipping optimization",
        "compute_scalar_by_willmore_energy_per_vertex": "Willmore energy per vertex",
        "get_willmore_measures": "Willmore measures",
    }


def test_filter_list_is_complete_and_sorted():
    names = pymeshlab.filter_list()
    assert names == sorted(names)
    assert set(NAMES) < set(names)
    assert NATIVE in names
    assert len(names) == len(set(names))


@pytest.mark.parametrize("words", ["willmore", "Willmore flip", "edge flipping"])
def test_search_finds_ours(capfd, words):
    pymeshlab.search(words)
    assert FLIP in capfd.readouterr().out


def test_search_still_finds_native_filters(capfd):
    pymeshlab.search("planar flipping")
    native._flush_c_streams()
    out = capfd.readouterr().out
    assert NATIVE in out
    assert FLIP not in out


def test_filter_parameter_values(bumpy):
    values = bumpy.filter_parameter_values(FLIP, energy="willmore", maxflips=3, virtualpoint=0.1)
    diagonal = bumpy.current_mesh().bounding_box().diagonal()
    assert values == {
        "preset": 0,
        "selection": False,
        "energy": 1,
        "search": 0,
        "depth": 5,
        "breadth": 3,
        "sweeps": 200,
        "seed": 0,
        "virtualpoint": "0.1",
        "monotone": True,
        "foldangle": 90.0,
        "minshape": 0.05,
        "maxdeviation": pytest.approx(diagonal),
        "checkintersections": False,
        "featuredeg": 180.0,
        "maxflips": 3,
        "allowloss": False,
    }
    bumpy.set_selection_all()
    assert bumpy.filter_parameter_values(FLIP)["selection"] is True
    assert bumpy.filter_parameter_values("get_willmore_measures") == {}
    assert "planartype" in bumpy.filter_parameter_values(NATIVE)
    assert "binary" in bumpy.filter_parameter_values("ply")


@pytest.mark.parametrize("name", NAMES)
def test_methods_and_apply_filter_do_the_same(name):
    by_name, by_method = set_of(*meshes.patch(60)), set_of(*meshes.patch(60))
    returned = by_name.apply_filter(name)
    also = getattr(by_method, name)()
    assert (also or {}).keys() == returned.keys()
    left, right = by_name.current_mesh(), by_method.current_mesh()
    assert (left.face_matrix() == right.face_matrix()).all()


def test_apply_filter_takes_its_name_as_a_keyword(bumpy):
    assert bumpy.apply_filter(filter_name=FLIP)["flips"] > 0
    assert bumpy.apply_filter(filter_name="get_geometric_measures")["surface_area"] > 0


def test_methods_take_no_positional_arguments_like_native_ones(bumpy):
    for name in (FLIP, NATIVE):
        with pytest.raises(TypeError, match="takes 1 positional argument but 2 were given"):
            getattr(bumpy, name)(True)
        with pytest.raises(TypeError):
            bumpy.apply_filter(name, True)


def test_unknown_filters_fail_as_before(bumpy):
    with pytest.raises(pymeshlab.PyMeshLabException, match="Filter does not exists"):
        bumpy.apply_filter("nope")
    with pytest.raises(TypeError):
        bumpy.apply_filter()
    with pytest.raises(pymeshlab.PyMeshLabException):
        bumpy.filter_parameter_values("nope")


def test_an_empty_set_is_refused_in_the_words_of_native_filters():
    for name in (FLIP, NATIVE):
        with pytest.raises(pymeshlab.PyMeshLabException) as caught:
            pymeshlab.MeshSet().apply_filter(name)
        text = f"{name} requires at least one mesh loaded in the MeshSet."
        assert str(caught.value) == text


@pytest.mark.parametrize("filter_", FILTERS, ids=NAMES)
def test_docstrings_describe_every_parameter(filter_):
    method = getattr(pymeshlab.MeshSet, filter_.name)
    assert method.__name__ == filter_.name
    assert filter_.meshlab_name in method.__doc__
    for parameter in filter_.parameters:
        assert f"\n{parameter.name} : " in method.__doc__
        assert parameter.tooltip in " ".join(method.__doc__.split())
        assert all(f"'{choice}':" in parameter.tooltip for choice in parameter.choices)
    for name, *_ in filter_.returns:
        assert f"``{name}``" in method.__doc__
    signature = inspect.signature(method)
    assert list(signature.parameters) == ["self", *(p.name for p in filter_.parameters)]


@pytest.mark.parametrize("filter_", FILTERS, ids=NAMES)
def test_help_fits_80_columns_and_shows_every_default(filter_):
    ms = pymeshlab.MeshSet()
    for owner in (pymeshlab.MeshSet, ms):
        # The first line and the end of the next one are Python's own.
        text = pydoc.render_doc(getattr(owner, filter_.name), renderer=pydoc.plaintext)
        lines = text.replace(" method of pymeshlab.pmeshlab.MeshSet instance", "").splitlines()[1:]
        assert max(map(len, lines)) <= 80
        for parameter in filter_.parameters:
            assert re.search(rf"\b{parameter.name}=.", text)
    text = pydoc.render_doc(pymeshlab.MeshSet, renderer=pydoc.plaintext)
    ours = text.partition(f" |  {filter_.name}(")[2].partition("\n |  \n |  ")[0]
    assert max(map(len, ours.splitlines())) <= 80


def test_none_is_the_default_where_that_depends_on_the_mesh(bumpy):
    bumpy.compute_selection_by_condition_per_face(condselect="fi < 20")
    given = bumpy.filter_parameter_values(FLIP, selection=None, maxdeviation=None, preset="shape")
    assert given == bumpy.filter_parameter_values(FLIP, preset="shape")
    assert given["selection"] is True
    with pytest.raises(pymeshlab.PyMeshLabException, match="foldangle"):
        bumpy.filter_parameter_values(FLIP, foldangle=None)


def test_native_methods_keep_their_docstrings():
    assert "filter" in pymeshlab.MeshSet.apply_filter.__doc__
    assert pymeshlab.MeshSet.apply_filter.__name__ == "apply_filter"
    assert pymeshlab.filter_list.__doc__


# --- the working folder ------------------------------------------------------------------------


def test_a_file_that_cannot_be_read_leaves_the_working_folder(tmp_path, monkeypatch, bumpy):
    (tmp_path / "scans").mkdir()
    monkeypatch.chdir(tmp_path)
    for suffix in ("ply", "obj", "off"):
        (tmp_path / "scans" / f"broken.{suffix}").write_text("no mesh")
        with pytest.raises(pymeshlab.PyMeshLabException):
            bumpy.load_new_mesh(f"scans/broken.{suffix}")
        assert os.getcwd() == str(tmp_path)
    bumpy.save_current_mesh("whole.ply")
    with pytest.raises(pymeshlab.PyMeshLabException):
        bumpy.load_project("scans/broken.ply")
    bumpy.load_new_mesh(file_name="whole.ply")
    assert bumpy.current_mesh().vertex_number() == 300


@pytest.mark.parametrize("has_flipped", [False, True])
def test_a_filter_that_fails_leaves_the_working_folder(tmp_path, monkeypatch, bumpy, has_flipped):
    monkeypatch.chdir(tmp_path)
    if has_flipped:
        bumpy.apply_filter(FLIP)
    bumpy.add_mesh(pymeshlab.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]]))
    with pytest.raises(pymeshlab.PyMeshLabException):
        bumpy.generate_surface_reconstruction_screened_poisson()
    assert os.getcwd() == str(tmp_path)


def test_flips_work_in_a_folder_that_is_gone(tmp_path, monkeypatch, bumpy):
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    here.rmdir()
    assert bumpy.apply_filter(FLIP)["flips"] > 0
    bumpy.compute_scalar_by_willmore_energy_per_vertex()
    with pytest.raises(FileNotFoundError):
        os.getcwd()
    os.chdir(tmp_path)


# --- registering -------------------------------------------------------------------------------


def snapshot():
    return {
        **{name: getattr(pymeshlab, name) for name in dir(pymeshlab)},
        **{f"MeshSet.{name}": value for name, value in vars(pymeshlab.MeshSet).items()},
    }


def test_unregister_leaves_pymeshlab_as_it_was_and_register_brings_all_back():
    meshlab_willmore.unregister()
    before = snapshot()
    assert not meshlab_willmore.is_registered()
    assert not set(NAMES) & set(pymeshlab.filter_list())
    assert not hasattr(pymeshlab.MeshSet, FLIP)
    meshlab_willmore.register()
    assert meshlab_willmore.is_registered()
    assert hasattr(pymeshlab.MeshSet, FLIP)
    meshlab_willmore.unregister()
    assert snapshot() == before


def test_registering_twice_does_nothing():
    before = snapshot()
    meshlab_willmore.register()
    assert snapshot() == before
    meshlab_willmore.unregister()
    meshlab_willmore.unregister()
    assert not hasattr(pymeshlab.MeshSet, FLIP)


def test_a_native_filter_is_never_shadowed(monkeypatch):
    meshlab_willmore.unregister()
    monkeypatch.setattr(pymeshlab.MeshSet, FLIP, lambda self: "native", raising=False)
    before = snapshot()
    with pytest.raises(RuntimeError, match=FLIP):
        meshlab_willmore.register()
    assert snapshot() == before
    monkeypatch.undo()


def test_subclasses_and_older_sets_have_the_filters():
    meshlab_willmore.unregister()
    older = set_of(*meshes.bumpy_sphere(60))
    meshlab_willmore.register()
    assert older.apply_filter(FLIP)["flips"] > 0

    class Chain(pymeshlab.MeshSet):
        pass

    chain = Chain()
    chain.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(60)))
    assert chain.meshing_edge_flip_by_willmore_optimization()["flips"] > 0


def test_a_failing_half_registration_is_impossible_to_see(monkeypatch):
    """The check comes before the first replacement."""
    meshlab_willmore.unregister()
    native = pymeshlab.filter_list
    monkeypatch.setattr(pymeshlab, "filter_list", lambda: [*native(), NAMES[-1]])
    with pytest.raises(RuntimeError, match=NAMES[-1]):
        register.register()
    assert not register.is_registered()
    assert not hasattr(pymeshlab.MeshSet, FLIP)


AGAIN = """
import sys
import pymeshlab, meshlab_willmore
for name in [name for name in sys.modules if name.startswith("meshlab_willmore")]:
    del sys.modules[name]
import meshlab_willmore
ms = pymeshlab.MeshSet()
ms.create_cube()
assert ms.meshing_edge_flip_by_willmore_optimization()["flips"] == 0
meshlab_willmore.unregister()
assert not hasattr(ms, "meshing_edge_flip_by_willmore_optimization")
"""


@pytest.mark.slow
def test_a_second_import_after_a_reload_takes_over():
    run = subprocess.run([sys.executable, "-c", AGAIN], capture_output=True, text=True)
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")


NO_LIBRARY = """
import importlib.abc, sys, warnings

class Missing(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "pymeshlab":
            raise ImportError(sys.argv[1])

sys.meta_path.insert(0, Missing())
warnings.simplefilter("always")
try:
    import meshlab_willmore
except ImportError as error:
    print("raised", error)
else:
    print(meshlab_willmore.measures([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).area)
    try:
        meshlab_willmore.register()
    except ImportError as error:
        print("refused", error)
"""


def import_without(text):
    return subprocess.run(
        [sys.executable, "-c", NO_LIBRARY, text], capture_output=True, text=True, check=True
    )


@pytest.mark.slow
def test_without_a_system_library_arrays_work_and_a_warning_brings_the_cure():
    text = "libGL.so.1: cannot open shared object file: No such file or directory"
    run = import_without(text)
    area, refusal = run.stdout.splitlines()
    assert float(area) == 0.5
    assert refusal.startswith(f"refused PyMeshLab could not be loaded: {text}")
    for message in (run.stderr, refusal):
        assert "apt-get install libgl1 libopengl0" in message
    assert run.stderr.count("UserWarning") == 1


def test_another_import_error_of_pymeshlab_stays_as_it_is():
    text = "cannot import name 'x' (/usr/lib/python3/dist-packages/x.py)"
    run = import_without(text)
    assert (run.stdout, run.stderr) == (f"raised {text}\n", "")


IMPORTED = """
import sys, warnings
warnings.simplefilter("error")
import meshlab_willmore
assert "numba" not in sys.modules, "it takes its time to load"
import pymeshlab
assert hasattr(pymeshlab.MeshSet, "meshing_edge_flip_by_willmore_optimization")
assert callable(meshlab_willmore.optimize_flips)
assert set(meshlab_willmore.__all__) <= set(dir(meshlab_willmore))
try:
    meshlab_willmore.nope
except AttributeError as error:
    assert "nope" in str(error)
"""


@pytest.mark.slow
def test_importing_registers_and_loads_no_kernels():
    run = subprocess.run([sys.executable, "-c", IMPORTED], capture_output=True, text=True)
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")


@pytest.mark.slow
def test_no_warning_of_numbas_threading_layers_reaches_the_user():
    code = (
        "import pymeshlab, meshlab_willmore\n"
        "ms = pymeshlab.MeshSet()\n"
        "ms.create_sphere(subdiv=3)\n"
        "ms.meshing_edge_flip_by_willmore_optimization()\n"
        "ms.get_willmore_measures()\n"
    )
    run = subprocess.run(
        [sys.executable, "-W", "default", "-c", code], capture_output=True, text=True
    )
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")
