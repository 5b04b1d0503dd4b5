"""`--set`: the step, the parameter and the value."""

import pytest

from meshlab_willmore.cli.settings import with_settings
from meshlab_willmore.messages import WrongUse
from meshlab_willmore.mlx.steps import Param, Percentage, Step

FLIP = "Willmore flipping optimization"
STEPS = (
    Step("Taubin Smooth", (Param("stepSmoothNum", "RichInt", 10, (("tooltip", "Times"),)),)),
    Step(FLIP),
    Step("Simplification: Clustering Decimation"),
    Step("meshing_edge_flip_by_willmore_optimization"),
    Step("No such filter"),
)


def changed(*written):
    return with_settings(STEPS, written)


@pytest.mark.parametrize(
    "written",
    [
        "1.stepSmoothNum=3",
        "1.stepsmoothnum=3",
        "Taubin Smooth.stepSmoothNum=3",
        "apply_coord_taubin_smoothing.stepsmoothnum=3",
        " 1 . stepSmoothNum = 3",
    ],
)
def test_setting_replaces_the_value_of_the_script(written):
    steps = changed(written)
    details = (("tooltip", "Times"),)
    assert steps[0] == Step("Taubin Smooth", (Param("stepSmoothNum", "RichInt", 3, details),))
    assert steps[1:] == STEPS[1:]


@pytest.mark.parametrize(
    ("written", "step", "param"),
    [
        ("1.lambda=0.25", 0, Param("lambda", "RichFloat", 0.25)),
        ("2.energy=willmore", 1, Param("energy", "RichEnum", 1)),
        ("2.energy=mean-curvature", 1, Param("energy", "RichEnum", 4)),
        ("2.energy=mean curvature", 1, Param("energy", "RichEnum", 4)),
        ("2.energy=1", 1, Param("energy", "RichEnum", 1)),
        ("2.monotone=false", 1, Param("monotone", "RichBool", False)),
        ("3.Threshold=2%", 2, Param("Threshold", "RichAbsPerc", Percentage(2.0))),
        ("3.threshold=0.5", 2, Param("Threshold", "RichAbsPerc", 0.5)),
    ],
)
def test_missing_parameter_is_added(written, step, param):
    assert changed(written)[step].params[-1] == param


def test_last_setting_wins():
    (param,) = changed("1.stepSmoothNum=3", "1.stepSmoothNum=4")[0].params
    assert param.value == 4


def test_unknown_filters_are_left_to_the_checker():
    assert changed("5.foo=1") == STEPS


@pytest.mark.parametrize(
    ("written", "text"),
    [
        ("stepSmoothNum=3", "it must be STEP.PARAM=VALUE"),
        ("1.stepSmoothNum", "it must be STEP.PARAM=VALUE"),
        (".x=1", "it must be STEP.PARAM=VALUE"),
        ("0.x=1", "the script has steps 1 to 5"),
        ("6.x=1", "the script has steps 1 to 5"),
        ("Depth Smooth.x=1", "the script has no Depth Smooth, only Taubin Smooth, "),
        (
            "meshing_edge_flip_by_willmore_optimization.maxflips=1",
            "is in the script 2 times; name the step by its number (2, 4)",
        ),
        ("1.stepSmothNum=1", "has no parameter 'stepSmothNum'; did you mean 'stepSmoothNum'?"),
        ("1.zzz=1", "apply_coord_taubin_smoothing has no parameter 'zzz', only lambda, mu, "),
        ("1.stepSmoothNum=many", "'many' is not a whole number"),
        ("2.energy=wilmore", "; the choices are virtual willmore, willmore"),
        ("2.monotone=perhaps", "--set 2.monotone=perhaps: 'perhaps' "),
    ],
)
def test_wrong_settings_are_named(written, text):
    with pytest.raises(WrongUse) as caught:
        changed(written)
    assert str(caught.value).startswith(f"--set {written}: ")
    assert text in str(caught.value)
    assert "\n" not in str(caught.value)


def test_old_names_of_parameters_can_be_set():
    old = Step("Transform: Rotate", (Param("ToAll", "RichBool", False),))
    today = Step("Transform: Rotate", (Param("allLayers", "RichBool", True),))
    for written in ("1.allLayers=true", "1.alllayers=true", "1.ToAll=true"):
        assert with_settings([old], [written]) == (today,)
    filling = Step("Vertex Color Filling", tuple(Param(c, "RichFloat", 9.0) for c in "rgb"))
    (step,) = with_settings([filling], ["1.color1=1 2 3"])
    assert step.params == (Param("color1", "RichColor", (1, 2, 3, 255)),)
