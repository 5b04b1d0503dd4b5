"""Scripts with something wrong in how they are written: each fault has its own words."""

import codecs
import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshlab_willmore.mlx.decode import LARGEST
from meshlab_willmore.mlx.read import DEEPEST, MOST_FAULTS, read, read_bytes
from meshlab_willmore.mlx.steps import Fault, ScriptError
from meshlab_willmore.mlx.write import to_xml

from .scripts import element, one_param, script

P = "step 1 (F), parameter 'p': "
LAUGHS = b"".join(
    b'<!ENTITY l%d "%s">' % (i, b"&l%d;" % (i - 1) * 10 if i else b"ha") for i in range(10)
)
FULL_MATRIX = {f"val{i}": "0" for i in range(16)}
WITHOUT_LAST = {f"val{i}": "0" for i in range(15)}

FILES = [
    ("empty", b"", "is empty"),
    ("blank", b" \r\n\t", "is empty"),
    ("too-large", b"<" * (LARGEST + 1), "is larger than 16 MiB: not a filter script"),
    ("a-ply", b"ply\nformat ascii 1.0\n", "is not XML: it begins with 'ply'"),
    ("utf-16-no-xml", "hi".encode("utf-16"), "is not XML: it begins with 'hi'"),
    ("binary", b"\x89PNG\r\n\x1a\n\0\0", "is binary data, not XML"),
    ("binary-later", b"<FilterScript>\0</FilterScript>", "is binary data, not XML"),
    (
        "latin-1-undeclared",
        '<FilterScript>\n<filter name="é"/></FilterScript>'.encode("latin-1"),
        "byte 0xe9 in line 2 is not UTF-8; "
        "save the script as UTF-8, or declare the encoding that it has",
    ),
    (
        "latin-1-after-utf-8-mark",
        codecs.BOM_UTF8 + b"<FilterScript>\xe9</FilterScript>",
        "byte 0xe9 in line 1 is not UTF-8; "
        "save the script as UTF-8, or declare the encoding that it has",
    ),
    (
        "utf-16-cut-in-a-character",
        "<FilterScript/>".encode("utf-16-le")[:-1].join([codecs.BOM_UTF16_LE, b""]),
        "byte 0x3e in line 1 is not UTF-16; "
        "save the script as UTF-8, or declare the encoding that it has",
    ),
    (
        "unknown-encoding",
        b'<?xml version="1.0" encoding="martian"?><FilterScript/>',
        "declares the encoding 'martian', which is not known here; save it as UTF-8",
    ),
    (
        "encoding-not-for-files",
        b"<?xml version='1.0' encoding='utf-7'?><FilterScript/>",
        "declares the encoding 'utf-7', which is not known here; save it as UTF-8",
    ),
    (
        "not-the-declared-encoding",
        b'<?xml version="1.0" encoding="UTF-16"?><FilterScript/>',
        "declares the encoding 'UTF-16', but isn't in it",
    ),
]

XML = [
    (
        "truncated-between-tags",
        b'<FilterScript>\n<filter name="a">',
        "it ends before </FilterScript> (line 2, column 18)",
    ),
    (
        "truncated-in-a-tag",
        b"<FilterScript>\n<filter nam",
        "it ends before </FilterScript> (line 2, column 1)",
    ),
    (
        "only-a-doctype",
        b"<!DOCTYPE FilterScript>",
        "it ends before </FilterScript> (line 1, column 24)",
    ),
    (
        "tags-cross",
        script('<filter name="a"></Filter>'),
        "mismatched tag (line 3, column 20)",
    ),
    ("unquoted", script("<filter name=a/>"), "a character has no place there (line 3, column 14)"),
    (
        "control",
        script('<filter name="\x01"/>'),
        "a character has no place there (line 3, column 15)",
    ),
    (
        "control-by-number",
        script('<filter name="&#1;"/>'),
        "reference to invalid character number (line 3, column 15)",
    ),
    (
        "ampersand",
        script('<filter name="a & b"/>'),
        "& in the attribute 'name' is written &amp; (line 3)",
    ),
    ("html-entity", script('<filter name="a&nbsp;b"/>'), "undefined entity (line 3, column 1)"),
    (
        "attribute-twice",
        script('<filter name="a" name="b"/>'),
        "duplicate attribute (line 3, column 18)",
    ),
    (
        "two-roots",
        b"<FilterScript/>\n<FilterScript/>",
        "junk after document element (line 2, column 1)",
    ),
    (
        "blank-line-first",
        b'\n<?xml version="1.0"?><FilterScript/>',
        "XML or text declaration not at start of entity (line 2, column 1)",
    ),
]

STRUCTURE = [
    ("root", b"<html/>", "is not a filter script: its root is <html>, not <FilterScript>"),
    (
        "root-case",
        b"<filterscript><bad/></filterscript>",
        "is not a filter script: its root is <filterscript>, not <FilterScript>",
    ),
    (
        "entity",
        b'<!DOCTYPE FilterScript [<!ENTITY a "b">]><FilterScript>&a;</FilterScript>',
        "declares the entity 'a'; a filter script has no entities",
    ),
    (
        "billion-laughs",
        b"<!DOCTYPE FilterScript [" + LAUGHS + b"]><FilterScript>&l9;</FilterScript>",
        "declares the entity 'l0'; a filter script has no entities",
    ),
    (
        "file-entity",
        b'<!DOCTYPE FilterScript [<!ENTITY f SYSTEM "file:///etc/passwd">]>'
        b"<FilterScript>&f;</FilterScript>",
        "declares the entity 'f'; a filter script has no entities",
    ),
    (
        "parameter-entity",
        b'<!DOCTYPE FilterScript [<!ENTITY % f SYSTEM "http://a.b/c"> %f;]><FilterScript/>',
        "declares the entity 'f'; a filter script has no entities",
    ),
    (
        "external-doctype",
        b'<!DOCTYPE FilterScript SYSTEM "http://a.b/c.dtd"><FilterScript/>',
        "refers to 'http://a.b/c.dtd'; a filter script needs no other file",
    ),
    (
        "attribute-default",
        b'<!DOCTYPE FilterScript [<!ATTLIST filter name CDATA "Invert">]>'
        b"<FilterScript><filter/></FilterScript>",
        "has declarations in its DOCTYPE; write just <!DOCTYPE FilterScript>",
    ),
    (
        "filter-case",
        script('<Filter name="a"/>'),
        "<Filter> has no place in <FilterScript> (line 3); did you mean <filter>?",
    ),
    (
        "unknown-in-root",
        script("<mesh><filter name='never read'/>nor this</mesh>"),
        "<mesh> has no place in <FilterScript> (line 3)",
    ),
    (
        "param-in-root",
        script(element(kind="RichInt", value="1")),
        "<Param> has no place in <FilterScript> (line 3); it belongs into <filter>",
    ),
    (
        "param-case",
        script('<filter name="F">\n<param name="p"/></filter>'),
        "step 1 (F): <param> has no place in <filter> (line 4); did you mean <Param>?",
    ),
    (
        "filter-in-filter",
        script('<filter name="F"><filter name="G"/></filter>'),
        "step 1 (F): <filter> has no place in <filter> (line 3); it belongs into <FilterScript>",
    ),
    (
        "old-param-in-filter",
        script('<filter name="F"><xmlparam name="p" value="1"/></filter>'),
        "step 1 (F): <xmlparam> has no place in <filter> (line 3); it belongs into <xmlfilter>",
    ),
    (
        "param-in-old-filter",
        script(f'<xmlfilter name="F">{element(kind="RichInt", value="1")}</xmlfilter>'),
        "step 1 (F): <Param> has no place in <xmlfilter> (line 3); it belongs into <filter>",
    ),
    (
        "element-in-param",
        script('<filter name="F"><Param name="p" type="RichInt" value="1"><b/></Param></filter>'),
        "step 1 (F): <b> has no place in <Param> (line 3)",
    ),
    (
        "namespace",
        script('<m:filter name="F"/>'),
        "<m:filter> has no place in <FilterScript> (line 3); did you mean <filter>?",
    ),
    ("text-in-root", script("\nInvert"), "text 'Invert' in <FilterScript> (line 4) is never read"),
    (
        "text-in-filter",
        script('<filter name="F">value="3"</filter>'),
        "step 1 (F): text 'value=\"3\"' in <filter> (line 3) is never read",
    ),
    (
        "text-in-param",
        script('<filter name="F"><Param name="p" type="RichInt" value="1">2</Param></filter>'),
        "step 1 (F): text '2' in <Param> (line 3) is never read",
    ),
    (
        "cdata",
        script("<![CDATA[<filter/>]]>"),
        "text '<filter/>' in <FilterScript> (line 3) is never read",
    ),
    ("filter-no-name", script("<filter/>"), "step 1: the filter (line 3) has no name"),
    ("filter-empty-name", script('<filter name=""/>'), "step 1: the filter (line 3) has no name"),
    (
        "filter-name-case",
        script('<filter Name="F"/>'),
        "step 1: the filter (line 3) has no name; is 'Name' meant for it?",
    ),
]

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
PIECES = [
    b"",
    b'"',
    b"<",
    b"/>",
    b"&",
    b"-->",
    b"<!--",
    b"]]>",
    b"\n",
    b' x="1"',
    b"Param",
    b"<a/>",
]
WELL_FORMED = "is not well-formed XML: "
CORPUS = [
    *FILES,
    *((name, data, WELL_FORMED + text) for name, data, text in XML),
    *STRUCTURE,
    *PARAMS,
]


@pytest.mark.parametrize(("data", "text"), [pytest.param(*case[1:], id=case[0]) for case in CORPUS])
def test_a_broken_script_is_named_with_its_only_fault(data, text):
    with pytest.raises(ScriptError) as caught:
        read_bytes(data, "s.mlx")
    assert str(caught.value) == f"s.mlx: {text}"
    assert caught.value.source == "s.mlx"


@pytest.mark.parametrize("data", [pytest.param(case[1], id=case[0]) for case in CORPUS])
def test_a_file_is_judged_as_its_content(tmp_path, data):
    path = tmp_path / "broken.mlx"
    path.write_bytes(data)
    with pytest.raises(ScriptError) as of_file:
        read(path)
    with pytest.raises(ScriptError) as of_data:
        read_bytes(data, str(path))
    assert of_file.value.faults == of_data.value.faults
    assert of_file.value.source == str(path)


def test_all_faults_come_at_once():
    body = (
        '<filter name="A"/>\n<Filter/>\n'
        f'<filter name="F">{element(kind="RichInt", value="x")}text<b/>\n'
        f"{element(kind='RichBool', value='x')}</filter>\n<filter/>"
    )
    with pytest.raises(ScriptError) as caught:
        read_bytes(script(body), "s")
    assert caught.value.faults == (
        Fault("<Filter> has no place in <FilterScript> (line 4); did you mean <filter>?"),
        Fault("value='x' is not a whole number", 2, "F", "p"),
        Fault("text 'text' in <filter> (line 5) is never read", 2, "F"),
        Fault("<b> has no place in <filter> (line 5)", 2, "F"),
        Fault("is given twice", 2, "F", "p"),
        Fault("value='x' is neither 'true' nor 'false'", 2, "F", "p"),
        Fault("the filter (line 7) has no name", 3),
    )


def test_all_that_is_wrong_with_a_value_is_told():
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


def test_a_text_of_several_lines_is_one_fault():
    with pytest.raises(ScriptError) as caught:
        read_bytes(script("Invert\nFaces &amp;\nmore"), "s")
    assert caught.value.faults == (Fault("text 'Invert' in <FilterScript> (line 3) is never read"),)


def test_faults_before_broken_xml_are_told_too():
    with pytest.raises(ScriptError) as caught:
        read_bytes(script('<filter/><filter name="a">'), "s")
    first, second = caught.value.faults
    assert first == Fault("the filter (line 3) has no name", 1)
    assert second.text.startswith(WELL_FORMED)


@pytest.mark.parametrize(
    "body", ["<a/>\n" * (MOST_FAULTS + 50), "<a/>\n" * MOST_FAULTS + "</b>"], ids=["more", "broken"]
)
def test_faults_beyond_counting_are_cut_short(body):
    with pytest.raises(ScriptError) as caught:
        read_bytes(script(body), "s")
    assert len(caught.value.faults) == MOST_FAULTS + 1
    assert caught.value.faults[-2].text == "<a> has no place in <FilterScript> (line 102)"
    assert caught.value.faults[-1].text == "has more than 100 faults; these are the first"


@pytest.mark.parametrize("depth", [DEEPEST - 1, DEEPEST, 1_000_000])
def test_depth_has_an_end(depth):
    data = b"<FilterScript>" + b"<a>" * depth + b"</a>" * depth + b"</FilterScript>"
    with pytest.raises(ScriptError) as caught:
        read_bytes(data, "s")
    deep = [fault.text for fault in caught.value.faults if "deep" in fault.text]
    assert deep == (["has elements more than 100 deep (line 1)"] if depth >= DEEPEST else [])


def test_long_and_broken_words_stay_on_one_short_line():
    word = "a\n" * 100_000
    body = f'<filter name="{word}"><Param name="{word}" type="{word}" value=""/></filter>'
    data = script(body.replace("\n", "&#10;"))
    with pytest.raises(ScriptError) as caught:
        read_bytes(data, "s")
    (line,) = str(caught.value).splitlines()
    assert len(line) < 600


@given(st.data(), st.binary(max_size=6) | st.sampled_from(PIECES))
def test_damage_anywhere_is_told_or_harmless(data, piece):
    whole = one_param(kind="RichEnum", value="1", enum_cardinality="2", tooltip="a &lt;b&gt;")
    start = data.draw(st.integers(0, len(whole)))
    end = data.draw(st.integers(start, min(start + 8, len(whole))))
    damaged = whole[:start] + piece + whole[end:]
    found = outcome(damaged)
    if isinstance(found, ScriptError):
        assert len(str(found).splitlines()) == len(found.faults) >= 1
    elif all(param.type for step in found for param in step.params):
        assert outcome(to_xml(found).encode()) == found
    else:
        with pytest.raises(ScriptError, match="has no type; look up the filter's own first"):
            to_xml(found)


def outcome(data):
    try:
        return read_bytes(data, "s")
    except ScriptError as error:
        return error


def test_a_missing_file_is_named(tmp_path):
    path = tmp_path / "none.mlx"
    with pytest.raises(ScriptError) as caught:
        read(path)
    assert str(caught.value) == f"{path}: there is no such file"


def test_a_folder_is_named(tmp_path):
    with pytest.raises(ScriptError) as caught:
        read(tmp_path)
    assert str(caught.value) == f"{tmp_path}: is a folder, not a filter script"


def test_a_file_that_may_not_be_read_is_named(tmp_path, monkeypatch):
    def refuse(*args, **kwargs):
        raise PermissionError(13, "Permission denied", str(tmp_path))

    # The tests may be run by somebody who is allowed everything.
    monkeypatch.setattr("builtins.open", refuse)
    with pytest.raises(ScriptError) as caught:
        read(tmp_path / "s.mlx")
    assert str(caught.value) == f"{tmp_path / 's.mlx'}: can't be read: Permission denied"


def test_a_name_that_no_file_can_have_is_named():
    with pytest.raises(ScriptError) as caught:
        read("a\0b.mlx")
    assert [fault.text for fault in caught.value.faults] == ["can't be read: embedded null byte"]


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="needs a file without an end")
def test_a_file_without_an_end_is_not_read_to_its_end():
    with pytest.raises(ScriptError) as caught:
        read("/dev/zero")
    assert [fault.text for fault in caught.value.faults] == [
        "is larger than 16 MiB: not a filter script"
    ]
