"""Parameters whose type or value is wrong: each fault has its own message."""

import pytest

from meshlab_willmore.mlx.read import read_bytes
from meshlab_willmore.mlx.steps import ScriptError

from .scripts import cases, element, error_of, one_param, script

P = "step 1 (F), parameter 'p': "
FULL_MATRIX = {f"val{i}": "0" for i in range(16)}
WITHOUT_LAST = {f"val{i}": "0" for i in range(15)}

PARAMS = [
    (
        "param-no-name",
        script('<filter name="F"><Param type="RichInt" value="1"/></filter>'),
        "step 1 (F): the parameter (line 3) has no name",
    ),
    ("no-type", one_param(tooltip="1"), P + "has no type"),
    (
        "type-misspelt",
        one_param(typ="RichInt", value="1"),
        P + "has no type; is 'typ' meant for it?",
    ),
    (
        "type-unknown",
        one_param(kind="RichFlaot", value="1"),
        P + "unknown type 'RichFlaot'; did you mean 'RichFloat'?",
    ),
    (
        "type-case",
        one_param(kind="richbool", value="true"),
        P + "unknown type 'richbool'; did you mean 'RichBool'?",
    ),
    (
        "type-far-off",
        one_param(kind="xyz", value="1"),
        P + "unknown type 'xyz'; known are RichBool, RichInt, RichFloat, RichString, RichEnum, "
        "RichAbsPerc, RichDynamicFloat, RichColor, RichPosition, RichDirection, RichPoint3f, "
        "RichMatrix44f, RichMesh, RichOpenFile, RichSaveFile, RichShotf",
    ),
    ("no-value", one_param(kind="RichInt"), P + "attribute 'value' is missing"),
    (
        "value-misspelt",
        one_param(kind="RichString", vale="fi &gt; 1"),
        P + "attribute 'value' is missing; is 'vale' meant for it?",
    ),
    (
        "old-no-value",
        script('<xmlfilter name="F"><xmlparam name="p"/></xmlfilter>'),
        P + "attribute 'value' is missing",
    ),
    (
        "param-twice",
        script(f'<filter name="F">{element(kind="RichInt", value="1") * 2}</filter>'),
        P + "is given twice",
    ),
    (
        "bool-false-case",
        one_param(kind="RichBool", value="False"),
        P + "value='False' counts as true in MeshLab; write 'false' in lower case",
    ),
    (
        "bool-number",
        one_param(kind="RichBool", value="1"),
        P + "value='1' is neither 'true' nor 'false'",
    ),
    (
        "int-fraction",
        one_param(kind="RichInt", value="1.5"),
        P + "value='1.5' is not a whole number",
    ),
    ("int-empty", one_param(kind="RichInt", value=""), P + "value='' is not a whole number"),
    ("int-python", one_param(kind="RichInt", value="1_0"), P + "value='1_0' is not a whole number"),
    (
        "int-other-digits",
        one_param(kind="RichInt", value="٣"),
        P + "value='٣' is not a whole number",
    ),
    (
        "int-beyond",
        one_param(kind="RichInt", value="2147483648"),
        P + "value='2147483648' is not between -2147483648 and 2147483647",
    ),
    ("float-comma", one_param(kind="RichFloat", value="1,5"), P + "value='1,5' is not a number"),
    (
        "float-nan",
        one_param(kind="RichFloat", value="nan"),
        P + "value='nan' is not a finite number",
    ),
    (
        "float-inf",
        one_param(kind="RichFloat", value="-inf"),
        P + "value='-inf' is not a finite number",
    ),
    (
        "float-beyond",
        one_param(kind="RichFloat", value="3.4028235e38"),
        P + "value='3.4028235e38' is beyond 3.4028235e+38, the largest that MeshLab reads",
    ),
    (
        "float-beyond-double",
        one_param(kind="RichFloat", value="-1e999"),
        P + "value='-1e999' is beyond 3.4028235e+38, the largest that MeshLab reads",
    ),
    (
        "float-below",
        one_param(kind="RichFloat", value="-0.01e-46"),
        P + "value='-0.01e-46' is too close to zero for MeshLab to read; write 0",
    ),
    (
        "float-below-double",
        one_param(kind="RichFloat", value="1e-999"),
        P + "value='1e-999' is too close to zero for MeshLab to read; write 0",
    ),
    (
        "enum-no-cardinality",
        one_param(kind="RichEnum", value="1"),
        P + "attribute 'enum_cardinality' is missing",
    ),
    (
        "enum-cardinality-misspelt",
        one_param(kind="RichEnum", value="1", enum_cardinalty="2"),
        P + "attribute 'enum_cardinality' is missing; is 'enum_cardinalty' meant for it?",
    ),
    (
        "enum-cardinality-huge",
        one_param(kind="RichEnum", value="1", enum_cardinality="2000000000"),
        P + "enum_cardinality='2000000000' is not between 0 and 10000",
    ),
    (
        "enum-index-beyond",
        one_param(kind="RichEnum", value="2", enum_cardinality="2"),
        P + "index 2 is not below enum_cardinality='2'; the first choice is 0",
    ),
    (
        "enum-index-negative",
        one_param(kind="RichEnum", value="-1", enum_cardinality="2"),
        P + "value='-1' is not between 0 and 2147483647",
    ),
    (
        "enum-name",
        one_param(kind="RichEnum", value="a", enum_cardinality="1", enum_val0="a"),
        P + "value='a' is not a whole number",
    ),
    (
        "share-no-range",
        one_param(kind="RichAbsPerc", value="1"),
        P + "attributes 'min', 'max' are missing",
    ),
    (
        "share-broken-range",
        one_param(kind="RichAbsPerc", value="1", min="0", max=""),
        P + "max='' is not a number",
    ),
    (
        "share-two-signs",
        one_param(kind="RichAbsPerc", value="5%%"),
        P + "value='5%%' is not a number",
    ),
    ("percentage", one_param(kind="PercentageValue", value="x"), P + "value='x' is not a number"),
    (
        "percentage of more than all",
        one_param(kind="RichAbsPerc", value="150%"),
        P + "value='150%' is not between 0 and 100 percent",
    ),
    (
        "negative percentage",
        one_param(kind="RichAbsPerc", value="-5%"),
        P + "value='-5%' is not between 0 and 100 percent",
    ),
    (
        "dynamic-no-max",
        one_param(kind="RichDynamicFloat", value="1", min="0"),
        P + "attribute 'max' is missing",
    ),
    (
        "color-beyond",
        one_param(kind="RichColor", r="1", g="2", b="256", a="4"),
        P + "b='256' is not between 0 and 255",
    ),
    (
        "color-no-alpha",
        one_param(kind="RichColor", r="1", g="2", b="3"),
        P + "attribute 'a' is missing",
    ),
    (
        "point-as-value",
        one_param(kind="RichPosition", value="1 2 3"),
        P + "attributes 'x', 'y', 'z' are missing",
    ),
    (
        "point-case",
        one_param(kind="RichPoint3f", X="1", y="2", z="3"),
        P + "attribute 'x' is missing; is 'X' meant for it?",
    ),
    (
        "matrix-15",
        one_param(kind="RichMatrix44f", **WITHOUT_LAST),
        P + "attribute 'val15' is missing",
    ),
    (
        "matrix-text",
        one_param(kind="RichMatrix44f", **FULL_MATRIX | {"val7": "O"}),
        P + "val7='O' is not a number",
    ),
    (
        "mesh-negative",
        one_param(kind="RichMesh", value="-1"),
        P + "value='-1' is not between 0 and 2147483647",
    ),
    (
        "file-no-endings",
        one_param(kind="RichOpenFile", value="a.png"),
        P + "attribute 'exts_cardinality' is missing",
    ),
]


@cases(PARAMS)
def test_a_wrong_parameter_is_one_fault(data, text):
    assert error_of(data) == f"s.mlx: {text}"


def test_all_that_is_wrong_with_a_value_is_named():
    body = (
        f'<filter name="F">{element(name="c", kind="RichColor", r="x", g="300", a="0")}'
        f"{element(name='s', kind='RichAbsPerc', value='y', min='z')}</filter>"
    )
    with pytest.raises(ScriptError) as caught:
        read_bytes(script(body), "s")
    assert [fault.text for fault in caught.value.faults] == [
        "attribute 'b' is missing; r='x' is not a whole number; g='300' is not between 0 and 255",
        "value='y' is not a number; attribute 'max' is missing; min='z' is not a number",
    ]
