"""Options: checked values, and the same names, defaults and help texts wherever they are shown."""

import inspect
import re
from typing import get_args, get_type_hints

import numpy as np
import pytest

from meshlab_willmore import optimize_flips
from meshlab_willmore.options import (
    ALLOWLOSS,
    BY_NAME,
    ENERGY,
    FOLDANGLE,
    MAXDEVIATION,
    MAXFLIPS,
    MINSHAPE,
    MONOTONE,
    OF_PASSES,
    OPTIONS,
    PRESET,
    SEARCH,
    SEARCHES,
    SELECTION,
    VIRTUALPOINT,
    EnergyName,
    FlipOptions,
    PassOptions,
    PresetName,
    SearchName,
    VirtualPoint,
)
from meshlab_willmore.passes import PASS_OPTIONS
from meshlab_willmore.search.stencil import RING

OF_FILTER = {SELECTION.name, ALLOWLOSS.name}
CORE = {option.name: option for option in OPTIONS if option.name not in OF_FILTER}


# --- checks --------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [-1, 180.5, np.nan, np.inf])
def test_degrees_out_of_range(value):
    with pytest.raises(ValueError, match=r"foldangle must lie in 0 .. 180"):
        FOLDANGLE.checked(value)


@pytest.mark.parametrize("value", ["90", None, True, [90]])
def test_degrees_of_a_wrong_type(value):
    with pytest.raises(TypeError, match="foldangle must be a number"):
        FOLDANGLE.checked(value)


def test_limits_and_flags():
    assert MAXFLIPS.checked(None) is None
    assert [MAXFLIPS.checked(value) for value in (0, np.int32(3))] == [0, 3]
    assert MONOTONE.checked(np.bool_(True)) is True
    assert FOLDANGLE.checked(np.float32(90)) == 90.0
    with pytest.raises(ValueError, match="maxflips must not be negative, not -1"):
        MAXFLIPS.checked(-1)
    for wrong in (1.0, True, "1"):
        with pytest.raises(TypeError, match="maxflips must be an integer or None"):
            MAXFLIPS.checked(wrong)
    for wrong in (1, "yes", None):
        with pytest.raises(TypeError, match="monotone must be True or False"):
            MONOTONE.checked(wrong)


def test_a_shape_is_a_share():
    assert MINSHAPE.checked(np.float32(0.5)) == 0.5
    for wrong in (-0.1, 1.1, np.nan):
        with pytest.raises(ValueError, match=r"minshape must lie in 0 .. 1, not"):
            MINSHAPE.checked(wrong)
    with pytest.raises(TypeError, match="minshape must be a number, not str"):
        MINSHAPE.checked("0.5")


def test_a_deviation_is_a_length():
    assert [MAXDEVIATION.checked(value) for value in (None, 0, np.inf)] == [None, 0.0, np.inf]
    for wrong in (-1e-9, np.nan):
        with pytest.raises(ValueError, match="maxdeviation must be a length of 0 or more, not"):
            MAXDEVIATION.checked(wrong)
    with pytest.raises(TypeError, match="maxdeviation must be a length or None, not str"):
        MAXDEVIATION.checked("3%")


def test_virtual_points_are_at_a_name_or_inside_the_edge():
    assert [VIRTUALPOINT.checked(value) for value in ("closest", 0.25)] == ["closest", 0.25]
    for wrong in (0.0, 1.0, np.nan, "0.5"):
        with pytest.raises(ValueError, match="'midpoint', 'closest' or a number between 0 and 1"):
            VIRTUALPOINT.checked(wrong)
    with pytest.raises(TypeError, match="or a number between 0 and 1, not NoneType"):
        VIRTUALPOINT.checked(None)


def test_only_energy_and_search_are_nothing_but_a_choice():
    assert [option.name for option in OPTIONS if option.is_choice] == [
        "preset",
        "energy",
        "search",
    ]
    with pytest.raises(ValueError, match="unknown search 'quick'; choose one of 'parallel greedy'"):
        SEARCH.checked("quick")


def test_an_integer_lies_within_its_limits():
    limits = {option.name: option.most for option in OPTIONS if option.most is not None}
    assert limits == {"depth": 100, "breadth": 12, "sweeps": 10**9}
    for option in OPTIONS:
        if option.most is None:
            continue
        assert option.checked(np.int64(option.least)) == option.least
        for value in (option.least - 1, option.most + 1):
            message = f"{option.name} must lie in {option.least} .. {option.most}, not {value}"
            with pytest.raises(ValueError, match=re.escape(message)):
                option.checked(value)


def test_each_default_passes_its_own_check():
    for option in OPTIONS:
        if option not in (SELECTION, MAXFLIPS):
            assert option.checked(option.default) == option.default


def test_type_checkers_know_all_names():
    names = {ENERGY: EnergyName, PRESET: PresetName, SEARCH: SearchName}
    for option, literal in names.items():
        assert get_args(literal) == option.choices
    literal, number = get_args(VirtualPoint)
    assert (get_args(literal), number) == (VIRTUALPOINT.choices, float)


def test_type_checkers_know_the_options_of_a_pass_and_of_the_function():
    of_pass, of_function = get_type_hints(PassOptions), get_type_hints(optimize_flips)
    arrays = {"vertices", "faces", "return"}
    assert get_type_hints(FlipOptions) == {
        name: kind for name, kind in of_function.items() if name not in arrays
    }
    assert sorted(of_pass) == sorted(PASS_OPTIONS)
    own = {option.name for option in OF_PASSES}
    assert {name: of_function[name] for name in of_pass if name not in own} == {
        name: kind for name, kind in of_pass.items() if name not in own
    }
    for name, kind in of_pass.items():
        assert kind is BY_NAME[name].type or kind not in (bool, int), name


def test_a_chain_has_room_for_the_greatest_breadth():
    (breadth,) = (option for option in OPTIONS if option.name == "breadth")
    assert breadth.most == RING


# --- where they are shown ------------------------------------------------------------------------


def test_the_function_has_the_same_names_and_defaults():
    found = inspect.signature(optimize_flips).parameters
    arrays = {"vertices", "faces", "selected_faces", "locked_edges", "wedge_uv", "passes"}
    assert set(found) - arrays - {"progress"} == set(CORE)
    for name, option in CORE.items():
        is_limit = option in (MAXFLIPS, MAXDEVIATION)
        assert found[name].default == (None if is_limit else option.default)


def test_the_docstring_of_the_function_names_options_and_choices_that_there_are():
    text = inspect.getdoc(optimize_flips)
    parameters = text.partition("Parameters\n")[2].partition("\nReturns\n")[0]
    assert set(CORE) < set(re.findall(r"^(\w+) : ", parameters, re.MULTILINE))
    assert f"search : {{{', '.join(map('{!r}'.format, SEARCHES))}}}".replace("'", '"') in parameters
    named = set(re.findall(r'"([a-z ]+)"', parameters))
    choices = {choice for option in OPTIONS for choice in option.choices}
    assert named <= choices
