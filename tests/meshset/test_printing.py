"""What is printed of filters reads as that of native ones, and comes in order."""

import contextlib
import os
import re
import subprocess
import sys

import pymeshlab
import pytest

from meshlab_willmore.meshset import native
from tests import meshes
from tests.meshset.conftest import FLIP

NATIVE = "meshing_edge_flip_by_planar_optimization"


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
