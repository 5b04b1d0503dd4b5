import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.energy.table import ENERGIES
from meshlab_willmore.meshset.parameters import Parameter, ParameterTypeError, read_all
from tests.meshset.conftest import FLIP

NATIVE = "meshing_edge_flip_by_planar_optimization"

FLAG = Parameter("flag", bool, False, "", "")
COUNT = Parameter("count", int, 3, "", "")
ANGLE = Parameter("angle", float, 90.0, "", "")
KIND = Parameter("kind", str, "b", "", "", ("a", "b"))
ALL = (FLAG, COUNT, ANGLE, KIND)


@pytest.mark.parametrize("value", [True, 1, np.True_, np.bool_(1), 2])
def test_bool_takes_what_native_filters_take(value):
    assert FLAG.read(value) is True


@pytest.mark.parametrize("value", [None, 0, np.False_])
def test_bool_false(value):
    assert FLAG.read(value) is False


@pytest.mark.parametrize(("value", "kind"), [(5, int), (np.int8(5), int), (True, int)])
def test_int(value, kind):
    assert type(COUNT.read(value)) is kind or value is True
    assert COUNT.read(value) == int(value)


@pytest.mark.parametrize("value", [5, 5.0, np.float32(5), True])
def test_float(value):
    assert ANGLE.read(value) == float(value)


@pytest.mark.parametrize(
    ("parameter", "value"),
    [
        (FLAG, "yes"),
        (FLAG, [1]),
        (COUNT, 2.5),
        (COUNT, "2"),
        (COUNT, None),
        (ANGLE, "x"),
        (COUNT, 2**31),
    ]
    + [(ANGLE, None), (ANGLE, 10**400), (KIND, 0.5), (KIND, None), (KIND, b"a")],
)
def test_wrong_types_are_named(parameter, value):
    with pytest.raises(ParameterTypeError, match=f"Parameter {parameter.name}"):
        parameter.read(value)
    # Native filters raise RuntimeError here: code that catches it catches this too.
    with pytest.raises(RuntimeError):
        parameter.read(value)


def test_enum_by_name_and_by_index():
    assert KIND.read("a") == KIND.read(0) == KIND.read(np.int64(0)) == 0


def _error_of(call):
    with pytest.raises(Exception) as caught:  # noqa: PT011 - the type is what is compared
        call()
    return caught.value


@pytest.mark.parametrize("value", [2, 9, -1, 2**70])
def test_enum_index_errors_name_the_parameter_and_its_choices(bumpy, value):
    ours = _error_of(lambda: KIND.read(value))
    assert str(ours) == (
        f"Parameter kind: Enum {value} not valid. Must be a value between 0 and 1: 0 'a', 1 'b'"
    )
    native = _error_of(lambda: bumpy.filter_parameter_values(NATIVE, planartype=9))
    assert type(ours) is type(native)
    assert str(native) == "Enum 9 not valid. Must be a value between 0 and 5"


def test_enum_name_errors_name_the_parameter_in_the_words_of_native_filters(bumpy):
    native = _error_of(lambda: bumpy.filter_parameter_values(NATIVE, planartype="nope"))
    ours = _error_of(lambda: bumpy.apply_filter(FLIP, energy="nope"))
    assert type(ours) is type(native) is pymeshlab.InvalidEnumException
    head, tail = str(native).split("values are")[0], "".join(f"'{name}'; " for name in ENERGIES)
    assert str(ours) == f"Parameter energy: {head}values are {tail}"


@pytest.mark.parametrize("value", [0.5, None, b"a", ["a"]])
def test_a_value_of_a_wrong_type_for_an_enum_names_the_choices(value):
    with pytest.raises(ParameterTypeError, match="kind: .*, one of 0 'a', 1 'b' is expected"):
        KIND.read(value)


def test_unknown_keyword_errors_are_those_of_native_filters(bumpy):
    native = _error_of(lambda: bumpy.apply_filter(NATIVE, nope=1))
    ours = _error_of(lambda: bumpy.apply_filter(FLIP, nope=1))
    assert type(ours) is type(native) is pymeshlab.PyMeshLabException
    assert str(ours) == str(native).replace(NATIVE, FLIP)


def test_defaults_and_given_values_together():
    values = read_all("f", ALL, {"kind": "a", "count": 7}, None)
    assert values == {"flag": False, "count": 7, "angle": 90.0, "kind": 0}


@pytest.mark.parametrize(
    ("value", "text"),
    [("midpoint", "midpoint"), (0.1, "0.1"), (np.float32(0.5), "0.5"), (1, "1.0"), ("", "")],
)
def test_a_number_may_be_given_as_text(value, text):
    parameter = Parameter("place", str, "midpoint", "Place", "Where.")
    assert parameter.read(value) == text
    assert parameter.default_for(None, {}) == "midpoint"


@pytest.mark.parametrize("value", [True, None, [0.5], b"midpoint", 1j])
def test_what_no_text_is(value):
    parameter = Parameter("place", str, "midpoint", "Place", "Where.")
    with pytest.raises(ParameterTypeError, match="place.*a text or a number is expected"):
        parameter.read(value)
