"""What is wrong with a script that reads well: each fault named, all at once, nothing run."""

import pytest

from meshlab_willmore.meshset import catalogue, native
from meshlab_willmore.meshset.check import examine, faults_of, resolve
from meshlab_willmore.mlx.read import reading_of
from meshlab_willmore.mlx.steps import Fault, Param, Percentage, Reading, ScriptError, Step
from tests.meshset.broken_scripts import CORPUS, ENERGIES, MISTYPED, NO_ENERGY
from tests.meshset.conftest import FLIP, set_of
from tests.meshset.scripts import (
    FLIP_NAME,
    HAUSDORFF,
    REMESH,
    TAUBIN,
    energy,
    old_step,
    param,
    percentage,
    step,
    steps_of,
)


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
