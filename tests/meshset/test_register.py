"""The filters stand among the native ones in everything that PyMeshLab lists and prints."""

import contextlib
import inspect
import os
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


def test_print_filter_list(capfd):
    pymeshlab.print_filter_list()
    lines = capfd.readouterr().out.splitlines()
    assert lines[1:] == [f"\t{name}" for name in pymeshlab.filter_list()]


def test_print_filter_parameter_list_of_ours_reads_as_that_of_native_ones(capfd):
    pymeshlab.print_filter_parameter_list(FLIP)
    ours = capfd.readouterr().out.splitlines()
    pymeshlab.print_filter_parameter_list(NATIVE)
    native._flush_c_streams()
    theirs = capfd.readouterr().out.splitlines()
    start = f"{NATIVE} filter - list of parameter names:"
    theirs = theirs[theirs.index(start) :]
    assert ours[0] == theirs[0].replace(NATIVE, FLIP)
    assert "\tselection : bool = False" in ours
    assert "\tselection : bool = False" in theirs
    assert "\tenergy : str = 'virtual willmore'" in ours
    assert "\tfoldangle : float = 90" in ours


def test_print_filter_parameter_list_without_parameters(capfd):
    pymeshlab.print_filter_parameter_list("get_willmore_measures")
    assert capfd.readouterr().out.splitlines()[1] == "\tNone."


def test_print_filter_parameter_list_of_an_unknown_filter_fails_as_before():
    with pytest.raises(pymeshlab.PyMeshLabException):
        pymeshlab.print_filter_parameter_list("nope")


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


def test_verbose_output(capfd):
    ms = pymeshlab.MeshSet()
    ms.set_verbosity(True)
    ms.add_mesh(pymeshlab.Mesh(*meshes.bumpy_sphere(60)))
    capfd.readouterr()
    flips = ms.apply_filter(FLIP)["flips"]
    captured = capfd.readouterr()
    values = ms.filter_parameter_values(FLIP)
    head = f"\nApplying filter {FLIP} with the following parameters:\n{values}\n\n"
    assert captured.out.startswith(head)
    assert f"LOG: 2 {flips} Willmore edge flips performed" in captured.err


def test_parameter_verbosity_prints_parameters_only(bumpy, capfd):
    bumpy.set_parameter_verbosity(True)
    bumpy.apply_filter(FLIP)
    captured = capfd.readouterr()
    assert "Applying filter" in captured.out
    assert captured.err == ""


PRINTING = """
import pymeshlab, meshlab_willmore
ms = pymeshlab.MeshSet()
ms.create_cube()
print("-1-")
ms.print_filter_script()
print("-2-")
ms.get_willmore_measures()
ms.print_filter_script()
print("-3-")
pymeshlab.print_filter_parameter_list("create_cube")
print("-4-")
pymeshlab.print_filter_parameter_list("get_willmore_measures")
print("-5-")
ms.print_status()
print("-6-")
pymeshlab.search("willmore")
print("-7-")
ms.set_verbosity(True)
ms.create_cube(size=2.0)
print("-8-")
ms.get_willmore_measures()
print("-9-")
ms.save_current_mesh("cube.ply")
ms.load_new_mesh("cube.ply")
ms.set_verbosity(False)
print("-10-")
"""
NEXT = "(?s:.*?)"
IN_ORDER = NEXT.join(
    [
        "^-1-\nFilter Script Size : 1\n",
        "box_cube",
        "-2-\nFilter Script Size : 2\n",
        "box_cube",
        "willmore_measures",
        "-3-",
        "create_cube filter",
        "-4-\nget_willmore_measures filter",
        "-5-\nNumber meshes: 1",
        "-6-\n.*willmore",
        "-7-\n\nApplying filter create_cube with the following parameters:\n{'size': 2.0}\n",
        "-8-\n\nApplying filter get_willmore_measures with the following parameters:\n{}\n",
        "-9-\n\nSaving file .*cube.ply with the following parameters:\n{'binary': True}\n",
        "\nLoading file .*cube.ply with the following parameters:\n{}\n",
        "-10-\n$",
    ]
)


def buffered():
    return {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}


def in_a_pipe(args, folder):
    return subprocess.run(
        args, stdout=subprocess.PIPE, text=True, cwd=folder, env=buffered(), check=True
    ).stdout


def on_a_terminal(args, folder):
    ours, theirs = os.openpty()
    with subprocess.Popen(args, stdout=theirs, cwd=folder, env=buffered()) as process:
        os.close(theirs)
        text = b""
        # At its end a terminal is an error.
        with contextlib.suppress(OSError):
            while part := os.read(ours, 1 << 16):
                text += part
    os.close(ours)
    assert process.returncode == 0
    return text.decode().replace("\r\n", "\n")


@pytest.mark.parametrize("run", [in_a_pipe, on_a_terminal])
@pytest.mark.slow
def test_what_python_and_pymeshlab_print_comes_in_order(run, tmp_path):
    assert re.search(IN_ORDER, run([sys.executable, "-c", PRINTING], tmp_path))


@pytest.mark.parametrize("how", ["sys.stdout = None", "sys.stdout.close()"])
@pytest.mark.slow
def test_a_program_without_standard_output_can_print(how):
    code = f"""
import sys, pymeshlab, meshlab_willmore
{how}
ms = pymeshlab.MeshSet()
ms.create_cube()
ms.print_filter_script()
if sys.stdout is None:
    ms.set_verbosity(True)
    ms.get_willmore_measures()
"""
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


@pytest.mark.parametrize("filter_", FILTERS, ids=NAMES)
def test_docstrings_describe_every_parameter(filter_):
    method = getattr(pymeshlab.MeshSet, filter_.name)
    assert method.__name__ == filter_.name
    assert filter_.meshlab_name in method.__doc__
    for parameter in filter_.parameters:
        assert f"\n{parameter.name} : " in method.__doc__
        assert parameter.tooltip in method.__doc__
    for name, *_ in filter_.returns:
        assert f"``{name}``" in method.__doc__
    signature = inspect.signature(method)
    assert list(signature.parameters) == ["self", *(p.name for p in filter_.parameters)]


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
