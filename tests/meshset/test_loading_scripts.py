"""Loading filter scripts into a set: native, broken and old ones, and those from pipes."""

import os

import pymeshlab
import pytest

from meshlab_willmore.mlx.read import read
from meshlab_willmore.mlx.steps import Step
from meshlab_willmore.mlx.write import to_xml
from tests.meshset.conftest import SAMPLES
from tests.meshset.scripts import names, natively, printed, sphere, state

SAMPLE_SCRIPT = SAMPLES / "sample_filter_script.mlx"


# Scripts without our filters


# Python prints to the other stream: with PyMeshLab alone, the order in one depends on buffers.
NATIVE_SCRIPT = """
import functools, hashlib, sys
print = functools.partial(print, file=sys.stderr)
if sys.argv[2] == "with":
    import meshlab_willmore
import pymeshlab
ms = pymeshlab.MeshSet()
ms.load_filter_script(sys.argv[1])
ms.print_filter_script()
try:
    ms.apply_filter_script()
except pymeshlab.PyMeshLabException as error:
    print(error)
for mesh in ms:
    print(hashlib.sha1(mesh.vertex_matrix().tobytes() + mesh.face_matrix().tobytes()).hexdigest())
ms.save_filter_script(sys.argv[3])
print(ms.mesh_number())
"""


@pytest.mark.parametrize(
    "text",
    [
        SAMPLE_SCRIPT.read_text(),
        '<FilterScript><filter name="Torus"/><filter name="Taubin Smooth">'
        '<Param type="RichFloat" name="lambda" value="nonsense"/>'
        '<Param type="RichFloat" name="mu" value="-0.2"/></filter></FilterScript>',
        '<FilterScript><filter name="Torus"/><filter name="Unheard of"/></FilterScript>',
        "<FilterScript><filter",
        "",
    ],
    ids=["sample", "malformed parameter", "unknown filter", "truncated", "empty"],
)
@pytest.mark.slow
def test_scripts_without_our_filters_behave_as_before(text, tmp_path):
    script, saved = tmp_path / "script.mlx", tmp_path / "saved.mlx"
    script.write_text(text)
    printed, results = [], []
    for mode in ("without", "with"):
        printed.append(natively(NATIVE_SCRIPT, script, mode, saved))
        # Qt writes attributes in an order that changes from run to run.
        results.append(read(saved) if "<filter" in saved.read_text() else saved.read_text())
    assert printed[0] == printed[1]
    assert [sorted_params(result) for result in results[:1]] == [sorted_params(results[1])]


def sorted_params(steps):
    if isinstance(steps, str):
        return steps
    return [
        (s.filter, [p._replace(details=tuple(sorted(p.details))) for p in s.params]) for s in steps
    ]


# Broken scripts with our filters


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('<FilterScript><filter name="Willmore measures">', "script.mlx: "),
        ('<Script><filter name="Willmore measures"/></Script>', "script.mlx: "),
    ],
)
def test_a_script_of_ours_that_cannot_be_read_is_an_error_and_the_old_one_stays(
    text, message, bumpy, tmp_path, capfd
):
    bumpy.get_willmore_measures()
    path = tmp_path / "script.mlx"
    path.write_text(text)
    with pytest.raises(pymeshlab.PyMeshLabException, match=message):
        bumpy.load_filter_script(str(path))
    assert "0: willmore_measures" in printed(bumpy, capfd)


@pytest.mark.skipif(not os.path.isdir("/dev/fd"), reason="pipes with a name")
@pytest.mark.parametrize("name", ["Laplacian Smooth", "Willmore flipping optimization"])
def test_a_script_can_come_out_of_a_pipe(bumpy, name):
    """It is read once: PyMeshLab would find nothing more in it."""
    end, start = os.pipe()
    os.write(start, to_xml([Step(name)]).encode())
    os.close(start)
    bumpy.load_filter_script(f"/dev/fd/{end}")
    os.close(end)
    before = state(bumpy)
    bumpy.apply_filter_script()
    assert state(bumpy) != before


@pytest.mark.skipif(not os.path.isdir("/dev/fd"), reason="pipes with a name")
def test_what_is_no_script_in_a_pipe_is_an_error(bumpy):
    end, start = os.pipe()
    os.write(start, b"<FilterScript>")
    os.close(start)
    with pytest.raises(pymeshlab.PyMeshLabException, match="is not well-formed"):
        bumpy.load_filter_script(f"/dev/fd/{end}")
    os.close(end)


def test_nothing_runs_of_a_script_with_a_fault(bumpy, tmp_path):
    before = state(bumpy)
    path = tmp_path / "script.mlx"
    path.write_text(
        '<FilterScript><filter name="Willmore flipping optimization"/>'
        '<filter name="Taubin smooth"/></FilterScript>'
    )
    bumpy.load_filter_script(str(path))
    with pytest.raises(pymeshlab.PyMeshLabException, match="Taubin Smooth") as caught:
        bumpy.apply_filter_script()
    assert str(caught.value).startswith(f"{path}: step 2 (Taubin smooth): ")
    assert state(bumpy) == before


def test_a_percentage_is_one_of_the_mesh_at_hand_when_the_step_runs(tmp_path):
    path = tmp_path / "script.mlx"
    path.write_text(
        to_xml([Step("Willmore measures")]).replace(
            "</FilterScript>",
            '<filter name="Transform: Scale, Normalize">'
            '<Param name="axisX" type="RichFloat" value="3"/></filter>'
            '<filter name="Remeshing: Isotropic Explicit Remeshing">'
            '<Param name="Iterations" type="RichInt" value="2"/>'
            '<Param name="TargetLen" type="RichAbsPerc" value="5%"/></filter></FilterScript>',
        )
    )
    ms = sphere()
    ms.load_filter_script(str(path))
    ms.apply_filter_script()
    called = sphere()
    called.compute_matrix_from_scaling_or_normalization(axisx=3)
    called.meshing_isotropic_explicit_remeshing(
        iterations=2, targetlen=pymeshlab.PercentageValue(5)
    )
    assert state(ms) == state(called)


@pytest.mark.parametrize(
    ("name", "param"),
    [
        ("Transform: Scale", '<Param name="axisX" type="RichFloat" value="2"/>'),
        ("Transform: Scale, Normalize", '<Param name="axisX" value="2"/>'),
        (" Transform: Scale, Normalize ", '<Param name="axisX" type="RichFloat" value="2"/>'),
        ("compute_matrix_from_scaling_or_normalization", '<Param name="axisx" value="2"/>'),
    ],
    ids=["old name", "no type", "blanks", "names of PyMeshLab"],
)
def test_a_script_whose_names_only_we_know_is_loaded_and_applied(name, param, tmp_path):
    ms = pymeshlab.MeshSet()
    ms.create_cube()
    path = tmp_path / "s.mlx"
    path.write_text(f'<FilterScript><filter name="{name}">{param}</filter></FilterScript>')
    ms.load_filter_script(str(path))
    ms.apply_filter_script()
    assert ms.current_mesh().bounding_box().dim_x() == pytest.approx(2)
    ms.save_filter_script(str(path))
    assert names(path) == ["Transform: Scale, Normalize"]
