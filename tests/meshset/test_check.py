"""What is wrong with a script that reads well: each fault named, all at once, nothing run."""

from typing import NamedTuple

import pytest

from meshlab_willmore.meshset import catalogue, native
from meshlab_willmore.meshset.check import examine, faults_of, resolve
from meshlab_willmore.mlx.read import reading_of
from meshlab_willmore.mlx.steps import Fault, Param, Percentage, Reading, ScriptError, Step
from meshlab_willmore.options import ENERGY
from tests.meshset.conftest import FLIP, set_of
from tests.meshset.scripts import (
    FLIP_NAME,
    HAUSDORFF,
    MATRIX,
    REMESH,
    TAUBIN,
    energy,
    old_step,
    param,
    percentage,
    step,
    steps_of,
)

ENERGIES = ", ".join(f"{i} {name!r}" for i, name in enumerate(ENERGY.choices))
NO_ENERGY = len(ENERGY.choices)
REMESH_PARAMS = (
    "Iterations, Adaptive, SelectedOnly, TargetLen, FeatureDeg, CheckSurfDist, MaxSurfDist, "
    "SplitFlag, CollapseFlag, SwapFlag, SmoothFlag, ReprojectFlag"
)
MISTYPED = "is given as {}, but is a {}: PyMeshLab would read {}; write type='{}'"
NEEDS_MESH = "needs a mesh; give an input, or begin with a filter that creates one"


class Broken(NamedTuple):
    """A script with one fault, and all that is said of it."""

    said: str
    steps: tuple[str, ...]
    mesh_ids: tuple[int, ...] | None = None


def broken(said, *steps, ids=None):
    return Broken(said, steps, ids)


CORPUS = [
    # filters
    broken(
        "step 1 (Taubin Smoth): no such filter; did you mean 'Taubin Smooth' or "
        "'Laplacian Smooth' or 'Depth Smooth'?",
        step("Taubin Smoth"),
    ),
    broken(
        "step 2 (taubin smooth): no such filter; did you mean 'Taubin Smooth'? "
        "Upper and lower case differ",
        step(TAUBIN),
        step("taubin smooth"),
    ),
    broken(
        "step 1 (Willmore Flipping Optimization): no such filter; did you mean "
        "'Willmore flipping optimization'? Upper and lower case differ",
        step("Willmore Flipping Optimization"),
    ),
    broken(
        "step 1 (get_willmore_measure): no such filter; did you mean 'get_willmore_measures' or "
        "'get_geometric_measures' or 'get_topological_measures'?",
        step("get_willmore_measure"),
    ),
    broken(
        "step 1 (qqqqq): no such filter; pymeshlab.print_filter_list() lists them", step("qqqqq")
    ),
    # names of parameters
    broken(
        f"step 1 ({REMESH}), parameter 'Targetlen': no such parameter; did you mean 'TargetLen'? "
        "Upper and lower case differ",
        step(REMESH, percentage("Targetlen", 1)),
    ),
    broken(
        f"step 1 ({REMESH}), parameter 'TargetLength': no such parameter; did you mean "
        "'TargetLen'?",
        step(REMESH, percentage("TargetLength", 1)),
    ),
    broken(
        f"step 1 ({REMESH}), parameter 'zzz': no such parameter; it has {REMESH_PARAMS}",
        step(REMESH, percentage("zzz", 1)),
    ),
    broken(
        "step 1 (Planar flipping optimization), parameter 'qqq': no such parameter; it has "
        "selection, pthreshold, planartype, iterations",
        step("Planar flipping optimization", param("qqq", "RichInt", value=1)),
    ),
    broken(
        "step 1 (Re-Compute Face Normals), parameter 'selection': no such parameter; the filter "
        "has none",
        step("Re-Compute Face Normals", param("selection", "RichBool", value="true")),
    ),
    broken(
        f"step 1 ({REMESH}), parameter 'targetlen': is given twice, also as 'TargetLen'",
        step(REMESH, percentage("TargetLen", 1), percentage("targetlen", 1)),
    ),
    broken(
        f"step 1 ({REMESH}), parameter 'TargetLen': is given twice, also as 'targetlen'",
        step(REMESH, percentage("targetlen", 1), percentage("TargetLen", 1)),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'maxFlips': no such parameter; did you mean "
        "'maxflips'? Upper and lower case differ",
        step(FLIP_NAME, param("maxFlips", "RichInt", value=1)),
    ),
    # types
    *(
        broken(
            f"step 1 ({REMESH}), parameter '{name}': is given as {given}, but is a {own}: "
            f"PyMeshLab would read {read}; write type='{own}'",
            step(REMESH, param(name, given, value=value)),
        )
        for name, given, value, own, read in (
            ("FeatureDeg", "RichInt", 30, "RichFloat", "zero"),
            ("Iterations", "RichFloat", 3, "RichInt", "zero"),
            ("Adaptive", "RichInt", 1, "RichBool", "false"),
        )
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'foldangle': is given as RichString, but is a "
        "RichFloat: PyMeshLab would read zero; write type='RichFloat'",
        step(FLIP_NAME, param("foldangle", "RichString", value="90")),
    ),
    broken(
        "step 1 (Set Texture), parameter 'textName': is given as RichBool, but is a RichOpenFile: "
        "PyMeshLab would read ''; write type='RichOpenFile'",
        step("Set Texture", param("textName", "RichBool", value="true")),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'energy': is given as RichString, but is a RichEnum: "
        "PyMeshLab would read zero; write type='RichEnum'",
        step(FLIP_NAME, param("energy", "RichString", value="willmore")),
    ),
    # values
    broken(
        f"step 1 ({REMESH}), parameter 'FeatureDeg': can't be a percentage: a RichFloat has no "
        "range; give a number",
        step(REMESH, percentage("FeatureDeg", "5%")),
    ),
    broken(
        f"step 1 ({TAUBIN}), parameter 'lambda': 'half' is not a number",
        old_step(TAUBIN, **{"lambda": "half"}),
    ),
    broken(
        f"step 1 ({TAUBIN}), parameter 'stepSmoothNum': '2.5' is not a whole number",
        old_step(TAUBIN, stepSmoothNum="2.5"),
    ),
    broken(
        f"step 1 ({TAUBIN}), parameter 'Selected': 'yes' is neither 'true' nor 'false'",
        old_step(TAUBIN, Selected="yes"),
    ),
    broken(
        f"step 1 ({MATRIX}), parameter 'TransformMatrix': '1 0 0 1' is not 16 numbers",
        old_step(MATRIX, TransformMatrix="1 0 0 1"),
    ),
    broken(
        "step 1 (Set Mesh Camera), parameter 'Shot': a RichShotf can't be given as text",
        old_step("Set Mesh Camera", Shot="1 2 3"),
    ),
    # choices
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'energy': there is no choice {NO_ENERGY}; "
        f"the choices are {ENERGIES}",
        step(FLIP_NAME, energy(NO_ENERGY)),
    ),
    broken(
        "step 1 (Planar flipping optimization), parameter 'planartype': there is no choice 5; the "
        "choices are 0 'area/max side', 1 'inradius/circumradius', 2 'mean ratio', "
        "3 'delaunay', 4 'topology'",
        step(
            "Planar flipping optimization",
            param("planartype", "RichInt", value=5),
        ),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'energy': choice 0 is 'virtual willmore', but the "
        "script says 'willmore', which is 1",
        step(FLIP_NAME, energy(0, "willmore", "virtual willmore")),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'energy': there is no choice 'volume'; the choices are "
        f"{ENERGIES}",
        old_step(FLIP_NAME, energy="volume"),
    ),
    # ranges of ours
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'foldangle': foldangle must lie in 0 .. 180 degrees, "
        "not 181.0",
        step(FLIP_NAME, param("foldangle", "RichFloat", value=181)),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'featuredeg': featuredeg must lie in 0 .. 180 degrees, "
        "not -1.0",
        step(FLIP_NAME, param("featuredeg", "RichFloat", value=-1)),
    ),
    broken(
        f"step 1 ({FLIP_NAME}), parameter 'maxflips': maxflips must be -1 (no limit) or more, it "
        "is -2",
        step(FLIP_NAME, param("maxflips", "RichInt", value=-2)),
    ),
    # what is required
    broken(
        "step 1 (Import cameras for active rasters from file), parameter 'ImportFile': is "
        "missing; the filter can't do without it",
        step("Import cameras for active rasters from file"),
    ),
    broken(
        "step 1 (Import cameras for active rasters from file), parameter 'ImportFile': is "
        "empty; the filter can't do without it",
        old_step("Import cameras for active rasters from file", ImportFile=""),
    ),
    # meshes
    broken(
        f"step 1 ({HAUSDORFF}), parameter 'SampledMesh': there will be no mesh 2 (there are: 0, 1)",
        step(HAUSDORFF, param("SampledMesh", "RichMesh", value=2)),
        ids=(1, 0),
    ),
    broken(
        f"step 2 ({HAUSDORFF}), parameter 'TargetMesh': there will be no mesh 1 "
        "(there are: 0, 3; new ones get higher ids)",
        step("Box/Cube"),
        step(HAUSDORFF, param("TargetMesh", "RichMesh", value=1)),
        ids=(0, 3),
    ),
    broken(
        f"step 2 ({HAUSDORFF}), parameter 'TargetMesh': there will be no mesh 1 (there are: 0)",
        step(FLIP_NAME),
        step(HAUSDORFF, param("TargetMesh", "RichInt", value=1)),
        ids=(0,),
    ),
    # Later steps need one too: that is no news.
    broken(f"step 1 ({FLIP_NAME}): {NEEDS_MESH}", step(FLIP_NAME), step(TAUBIN), ids=()),
    broken(
        f"step 1 ({TAUBIN}): {NEEDS_MESH}",
        step(TAUBIN),
        step("Box/Cube"),
        step(HAUSDORFF, param("TargetMesh", "RichMesh", value=7)),
        ids=(),
    ),
]


@pytest.mark.parametrize("case", CORPUS, ids=lambda case: case.said[:60])
def test_each_fault_is_named(case):
    steps = steps_of(*case.steps)
    with pytest.raises(ScriptError) as caught:
        resolve(steps, "s.mlx", case.mesh_ids)
    assert str(caught.value) == f"s.mlx: {case.said}"
    assert [str(fault) for fault in faults_of(steps, case.mesh_ids)] == [case.said]


def test_the_corpus_is_one_of_different_faults():
    assert len({case.said for case in CORPUS}) == len(CORPUS) >= 25


def test_all_faults_are_listed_in_order():
    steps = steps_of(
        step("qqqqq", percentage("x", 1)),
        step(REMESH, percentage("zzz", 1), param("FeatureDeg", "RichInt", value=1)),
        step(TAUBIN),
        step(FLIP_NAME, energy(NO_ENERGY)),
        step("NXS Build"),
    )
    faults = faults_of(steps, ())
    assert [(f.step, f.param) for f in faults] == [
        (1, ""),
        (2, "zzz"),
        (2, "FeatureDeg"),
        (4, "energy"),
        (5, "input_file"),
        (5, "output_file"),
    ]


def said_of(*body, mesh_ids=None):
    """All faults of the steps of a script's text, of their form and of their names."""
    reading = reading_of(f"<FilterScript>{''.join(body)}</FilterScript>".encode(), "s.mlx")
    faults = examine(reading, mesh_ids).faults
    return [(fault.step, fault.param, fault.text) for fault in faults if fault.step]


def test_faults_of_the_form_hide_none_of_the_names_or_values():
    assert said_of(
        step(TAUBIN, param("lambd", "RichFloat", value="x"), param("mu", "RichInt", value="y")),
        step("Taubin Smoth"),
        step(REMESH, param("FeatureDeg", "RichFloat", value="x"), percentage("TargetLen", 0.5)),
        step(TAUBIN, param("Selected", "RichFloat", value=1)),
    ) == [
        (1, "lambd", "value='x' is not a number"),
        (1, "mu", "value='y' is not a whole number"),
        (1, "lambd", "no such parameter; did you mean 'lambda'?"),
        (1, "mu", MISTYPED.format("RichInt", "RichFloat", "zero", "RichFloat")),
        (
            2,
            "",
            "no such filter; did you mean 'Taubin Smooth' or 'Laplacian Smooth' or 'Depth Smooth'?",
        ),
        (3, "FeatureDeg", "value='x' is not a number"),
        (4, "Selected", MISTYPED.format("RichFloat", "RichBool", "false", "RichBool")),
    ]


def test_what_follows_from_a_fault_is_not_listed():
    """A parameter that can't be read is not missing, and what is not read may make a mesh."""
    cameras = "Import cameras for active rasters from file"
    assert said_of("<Filter name='Box/Cube'/>", step(TAUBIN), mesh_ids=()) == []
    assert said_of(step(cameras, param("ImportFile", "RichOpenFile", value="x"))) == [
        (1, "ImportFile", "attribute 'exts_cardinality' is missing")
    ]
    assert said_of(step(cameras, "<Param type='RichInt' value='1'/>")) == [
        (1, "", "the parameter (line 1) has no name")
    ]
    assert said_of("<filter/>", step(TAUBIN)) == [(1, "", "the filter (line 1) has no name")]
    assert said_of(f"<filter name='{cameras}'>") == []
    twice = param("mu", "RichFloat", value=1) * 2
    assert said_of(step(TAUBIN, twice)) == [(1, "mu", "is given twice")]


def test_faults_of_both_kinds_are_cut_short_together():
    body = [step(TAUBIN, param("mu", "RichFloat", value="x")), step("nonsense")] * 80
    faults = examine(
        reading_of(f"<FilterScript>{''.join(body)}</FilterScript>".encode(), "s")
    ).faults
    assert len(faults) == 101
    assert [fault.step for fault in faults[:4]] == [1, 2, 3, 4]
    assert faults[100] == Fault("has more than 100 faults; these are the first")


def test_faults_of_reading_alone_are_cut_short_too():
    body = step(TAUBIN) + "<a/>" * 150
    faults = examine(reading_of(f"<FilterScript>{body}</FilterScript>".encode(), "s")).faults
    assert len(faults) == 101
    assert faults[100] == Fault("has more than 100 faults; these are the first")


def test_a_parameter_without_a_type_takes_the_filters_own():
    body = (
        "<filter name='Transform: Rotate'><Param name='angle' value='90'/>"
        "<Param name='Freeze' value='True'/><Param name='rotAxis' value='Y axis'/>"
        "<Param name='customAxis' x='0' y='0' z='1'/></filter>"
        "<filter name='Vertex Color Filling'><Param name='color1' r='1' g='2' b='3' a='255'/>"
        "</filter>"
    )
    found = examine(reading_of(f"<FilterScript>{body}</FilterScript>".encode(), "s"))
    assert found.faults == ()
    assert [call.given for call in found.calls] == [
        {"angle": 90.0, "freeze": True, "rotaxis": 1, "customaxis": (0.0, 0.0, 1.0)},
        {"color1": (1, 2, 3, 255)},
    ]
    assert [(w.step, w.param) for w in found.warnings] == [
        (1, "angle"),
        (1, "Freeze"),
        (1, "rotAxis"),
        (1, "customAxis"),
        (2, "color1"),
    ]
    assert found.warnings[0].text == "has no type; it is read as RichDynamicFloat, the filter's own"
    assert not any(warning.changes_result for warning in found.warnings)


@pytest.mark.parametrize(("kind", "value"), [("", "0.5"), ("RichFloat", 0.5)])
def test_a_range_is_looked_at_too_where_the_type_is_another_or_none(kind, value):
    """Else nothing would be wrong with a script that no `convert` can write."""
    details = (("min", "0"), ("max", "x"))
    name = "NFRatio"
    (fault,) = faults_of([Step("Select Folded Faces", (Param(name, kind, value, details),))])
    assert (fault.param, fault.text) == (name, "max='x' is not a number")
    assert not faults_of([Step("Select Folded Faces", (Param(name, kind, value, details[:1]),))])


def test_the_old_form_without_types_needs_none():
    assert examine(Reading(steps_of(old_step(TAUBIN, mu="1")))).warnings == ()


def test_no_more_faults_than_anyone_reads():
    faults = faults_of([Step(f"nonsense {i}") for i in range(1000)])
    assert len(faults) == 101
    assert faults[99].step == 100
    assert faults[100] == Fault("has more than 100 faults; these are the first")


def test_a_filter_whose_plugin_is_not_loaded(monkeypatch):
    there = catalogue._there() - {"get_hausdorff_distance"}
    monkeypatch.setattr(catalogue, "_there", lambda: there)
    monkeypatch.setattr(catalogue, "recorded_version", lambda: "2099.1")
    monkeypatch.setattr(catalogue, "version", lambda: "2099.1")
    words = "is a filter of PyMeshLab 2099.1, but {}; "
    words += "pymeshlab.print_plugin_list() shows what is there"
    steps = [Step(HAUSDORFF)]
    assert [f.text for f in faults_of(steps)] == [words.format("its plugin is not loaded here")]
    monkeypatch.setattr(catalogue, "version", lambda: "2098.7")
    assert [f.text for f in faults_of(steps)] == [
        words.format("PyMeshLab 2098.7 does not have it, or has not loaded its plugin")
    ]


# --- steps that are made by hand ---------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (Param("maxflips", "RichInt", "x"), "'x' is not an int"),
        (Param("maxflips", "RichInt", True), "True is not an int"),
        (Param("maxflips", "", 2.5), "2.5 is not an int"),
        (
            Param("maxflips", "RichInt", 2**40),
            "value='1099511627776' is not between -2147483648 and 2147483647",
        ),
        (Param("maxflips", "RichNt", 1), "unknown type 'RichNt'; did you mean 'RichInt'?"),
        (Param("foldangle", "RichFloat", float("nan")), "value='nan' is not a finite number"),
        (Param("foldangle", "", None), "None is not a float"),
        (
            Param("foldangle", "", Percentage(5.0)),
            "can't be a percentage: a RichFloat has no range; give a number",
        ),
        (
            Param("energy", "RichEnum", "volume"),
            f"there is no choice 'volume'; the choices are {ENERGIES}",
        ),
    ],
)
def test_values_in_python_are_checked(given, said):
    assert faults_of([Step(FLIP, (given,))]) == [Fault(said, 1, FLIP, given.name)]


def test_the_same_parameter_twice():
    twice = (Param("maxflips", "RichInt", 1), Param("maxflips", "RichInt", 2))
    assert faults_of([Step(FLIP, twice)]) == [Fault("is given twice", 1, FLIP, "maxflips")]


def test_a_step_without_a_name():
    assert faults_of([Step("")]) == [Fault("has no name", 1)]


def test_long_names_are_cut():
    (fault,) = faults_of([Step("name " * 10_000)])
    assert len(str(fault)) < 200
    assert "\n" not in str(fault)


# --- manners -----------------------------------------------------------------------------------


def test_checking_runs_and_prints_nothing(capfd):
    ms = set_of([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    before = native.script_of(ms)
    capfd.readouterr()
    for case in CORPUS:
        faults_of(steps_of(*case.steps), (0,))
    native._flush_c_streams()
    assert capfd.readouterr() == ("", "")
    assert native.script_of(ms) == before
    assert ms.mesh_number() == 1
