import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshlab_willmore.mlx import rich
from meshlab_willmore.mlx.steps import Param, Percentage

from . import scripts


def exactly(text):
    return f"^{re.escape(text)}$"


CARDINALITY = {"enum_cardinality": "3"}
RANGE = {"min": "0", "max": "1"}
MATRIX = {f"val{i}": str(i) for i in range(16)}


@pytest.mark.parametrize(
    ("type", "attributes", "value"),
    [
        ("RichBool", {"value": "true"}, True),
        ("RichBool", {"value": "TRUE"}, True),
        ("RichBool", {"value": "false"}, False),
        ("RichInt", {"value": " -007 "}, -7),
        ("RichInt", {"value": "-2147483648"}, -(2**31)),
        ("RichInt", {"value": "0" * 50 + "1"}, 1),
        ("RichFloat", {"value": "+.5E1"}, 5.0),
        ("RichFloat", {"value": "5."}, 5.0),
        ("RichFloat", {"value": "0e-999"}, 0.0),
        ("RichFloat", {"value": "1e-45"}, 1e-45),
        ("RichFloat", {"value": "3.4028234663852886e38"}, rich.LARGEST_FLOAT),
        ("RichString", {"value": " a "}, " a "),
        ("RichString", {"value": ""}, ""),
        ("RichEnum", {"value": "2"} | CARDINALITY, 2),
        ("RichAbsPerc", {"value": "7"} | RANGE, 7.0),
        ("RichAbsPerc", {"value": "5%"}, Percentage(5.0)),
        ("RichAbsPerc", {"value": "+0.5 % "} | RANGE, Percentage(0.5)),
        ("PercentageValue", {"value": "5"}, Percentage(5.0)),
        ("PercentageValue", {"value": "5%"}, Percentage(5.0)),
        # Beyond its own range: MeshLab takes it as it is.
        ("RichDynamicFloat", {"value": "7"} | RANGE, 7.0),
        ("RichColor", {"r": "255", "g": "0", "b": "1", "a": "2"}, (255, 0, 1, 2)),
        ("RichPosition", {"x": "1", "y": "2.5", "z": "-3"}, (1.0, 2.5, -3.0)),
        ("RichDirection", {"z": "1", "y": "2", "x": "3"}, (3.0, 2.0, 1.0)),
        ("RichPoint3f", {"x": "1", "y": "2", "z": "3"}, (1.0, 2.0, 3.0)),
        ("RichMatrix44f", MATRIX, tuple(map(float, range(16)))),
        ("RichMesh", {"value": "3"}, 3),
        ("RichOpenFile", {"value": "a.png", "exts_cardinality": "0"}, "a.png"),
        ("RichSaveFile", {"value": "a.png"}, "a.png"),
        ("RichShotf", {}, None),
    ],
)
def test_a_value_is_read_in_its_type(type, attributes, value):
    read = rich.parse(type, attributes)
    assert read == value
    if not isinstance(value, tuple):
        assert read.__class__ is value.__class__


@pytest.mark.parametrize(
    ("type", "text", "value"),
    [
        ("RichBool", "False", False),
        ("RichBool", " TRUE", True),
        ("RichInt", "3", 3),
        ("RichFloat", "1e-3", 0.001),
        ("RichString", " as it is ", " as it is "),
        ("RichEnum", "7", 7),
        ("RichAbsPerc", "5%", Percentage(5.0)),
        ("RichAbsPerc", "5", 5.0),
        ("RichDynamicFloat", "5", 5.0),
        ("RichMesh", "0", 0),
        ("RichOpenFile", "a b.png", "a b.png"),
        ("RichPosition", "1 2 3", (1.0, 2.0, 3.0)),
        ("RichDirection", "[1, 2 ,3]", (1.0, 2.0, 3.0)),
        ("RichPoint3f", "(1,2,3)", (1.0, 2.0, 3.0)),
        ("RichColor", "255, 0, 0", (255, 0, 0, 255)),
        ("RichColor", "255 0 0 7", (255, 0, 0, 7)),
        ("RichMatrix44f", "[[0,1,2,3],[4,5,6,7],[8,9,10,11],[12,13,14,15]]", tuple(range(16))),
    ],
)
def test_a_text_is_read_in_its_type(type, text, value):
    read = rich.parse_text(type, text)
    assert read == value
    assert read.__class__ is value.__class__


@pytest.mark.parametrize(
    ("type", "text", "problem"),
    [
        ("RichBool", "yes", "'yes' is neither 'true' nor 'false'"),
        ("RichInt", "1.0", "'1.0' is not a whole number"),
        ("RichFloat", "5%", "'5%' is not a number"),
        # Half of the least single above zero, which rounds to zero.
        (
            "RichFloat",
            repr(2.0**-150),
            f"'{2.0**-150!r}' is too close to zero for MeshLab to read; write 0",
        ),
        ("RichAbsPerc", "%", "'%' is not a number"),
        ("RichMesh", "-1", "'-1' is not between 0 and 2147483647"),
        ("RichPosition", "1 2", "'1 2' is not 3 numbers"),
        ("RichPosition", "", "'' is not 3 numbers"),
        ("RichPosition", "1,,3", "'' is not a number"),
        ("RichColor", "1 2", "'1 2' is not 4 numbers"),
        ("RichColor", "1 2 256", "'256' is not between 0 and 255"),
        ("RichShotf", "1", "a RichShotf can't be given as text"),
        ("Richint", "1", "unknown type 'Richint'; did you mean 'RichInt'?"),
        ("RichInt", "9" * 5000, f"'{'9' * 57}...' is not a whole number"),
    ],
)
def test_a_text_that_is_no_value_is_refused(type, text, problem):
    with pytest.raises(ValueError, match=exactly(problem)):
        rich.parse_text(type, text)


@pytest.mark.parametrize(
    ("type", "value", "problem"),
    [
        ("RichBool", 1, "1 is not a bool"),
        ("RichBool", "true", "'true' is not a bool"),
        ("RichInt", True, "True is not an int"),
        ("RichInt", 1.0, "1.0 is not an int"),
        ("RichFloat", "1", "'1' is not a float"),
        ("RichFloat", True, "True is not a float"),
        ("RichFloat", Percentage(5.0), "Percentage(percent=5.0) is not a float"),
        ("RichFloat", 10**400, f"1{'0' * 56}... is not a float"),
        ("RichString", 1, "1 is not a str"),
        ("RichAbsPerc", "5%", "'5%' is not a float or a Percentage"),
        ("RichMesh", None, "None is not a mesh id"),
        ("RichPosition", (1, 2), "(1, 2) is not 3 numbers"),
        ("RichPosition", (1, 2, 3, 4), "(1, 2, 3, 4) is not 3 numbers"),
        ("RichPosition", 1, "1 is not 3 numbers"),
        ("RichColor", "abcd", "'abcd' is not 4 ints from 0 to 255"),
        ("RichShotf", 1, "1 is not None"),
        ("PercentageValue", 5.0, "5.0 is not a Percentage"),
        ("", "1", "has no type; look up the filter's own first"),
        ("Rich", 1, "unknown type 'Rich'; did you mean 'RichInt'?"),
    ],
)
def test_a_value_of_another_type_is_not_written(type, value, problem):
    with pytest.raises(ValueError, match=exactly(problem)):
        rich.attributes(Param("p", type, value))


@pytest.mark.parametrize(
    ("param", "added"),
    [
        (Param("p", "RichEnum", 2), {"enum_cardinality": "3"}),
        (
            Param("p", "RichEnum", 0, (("enum_val0", "a"), ("enum_val1", "b"))),
            {"enum_cardinality": "2"},
        ),
        (Param("p", "RichEnum", 0, (("enum_cardinality", "7"),)), {}),
        (Param("p", "RichAbsPerc", 0.5), {"min": "0", "max": "100"}),
        (Param("p", "RichAbsPerc", -3.0, (("max", "9"),)), {"min": "-3"}),
        (Param("p", "RichAbsPerc", Percentage(5.0)), {}),
        (Param("p", "RichDynamicFloat", 250.5), {"min": "0", "max": "250.5"}),
        (Param("p", "RichOpenFile", "a"), {"exts_cardinality": "0"}),
        (Param("p", "RichOpenFile", "a", (("ext_val0", "*.png"),)), {"exts_cardinality": "1"}),
        (Param("p", "RichSaveFile", "a"), {}),
        (Param("p", "RichInt", 1, (("tooltip", "t"),)), {}),
    ],
)
def test_what_meshlab_needs_is_added(param, added):
    written = rich.attributes(param)
    details = dict(param.details)
    assert {
        k: v for k, v in written.items() if k not in {"name", "type", "value", *details}
    } == added
    assert rich.parse(param.type, written) == param.value


@pytest.mark.parametrize(
    ("key", "problem"),
    [
        ("value", "the attribute 'value' is given twice"),
        ("name", "the attribute 'name' is given twice"),
        ("tip", "the attribute 'tip' is given twice"),
        ("a b", "'a b' can't be an attribute's name"),
        ("1a", "'1a' can't be an attribute's name"),
        ("", "'' can't be an attribute's name"),
        ('x="1" y', "'x=\"1\" y' can't be an attribute's name"),
    ],
)
def test_details_can_not_break_the_element(key, problem):
    param = Param("p", "RichInt", 1, (("tip", "a"), (key, "b")))
    with pytest.raises(ValueError, match=exactly(problem)):
        rich.attributes(param)


def test_there_are_values_of_every_type():
    assert set(rich.TYPES) == set(scripts.VALUES)


@given(scripts.params())
@pytest.mark.slow
def test_the_attributes_have_one_order_and_read_back(param):
    written = rich.attributes(param)
    known = ["name", "type", *rich.rich_type(param.type).fields, *dict(param.details)]
    assert list(written) == known
    assert rich.parse(param.type, written) == param.value


@given(scripts.floats)
def test_a_float_is_written_exactly_and_short(value):
    text = rich.show_float(value)
    assert rich.parse_float(text).hex() == float(value).hex()
    assert len(text) <= len(repr(value))
    assert not text.endswith(".0")


@given(st.text(max_size=8) | st.from_regex(r"[-+0-9.eE_ ]{0,12}", fullmatch=True))
def test_a_text_is_a_number_that_fits_or_refused(text):
    plain = re.fullmatch(r"[-+0-9.eE]+", text.strip()) is not None
    try:
        value = rich.parse_float(text)
    except ValueError:
        assert not plain or not acceptable(text)
    else:
        assert plain
        # Python's float takes fewer characters for blanks.
        assert value == float(text.strip())


def acceptable(text):
    try:
        value = float(text)
    except ValueError:
        return False
    with_digits = any(digit in text.lower().partition("e")[0] for digit in "123456789")
    return rich.SMALLEST_FLOAT < abs(value) <= rich.LARGEST_FLOAT or not with_digits
