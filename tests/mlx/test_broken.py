"""Scripts that are not well-formed, or whose elements are wrong: each fault has its own message."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshlab_willmore.mlx.read import DEEPEST, read_bytes
from meshlab_willmore.mlx.steps import MOST_FAULTS, Fault, ScriptError
from meshlab_willmore.mlx.write import to_xml

from .scripts import cases, element, error_of, one_param, script

LAUGHS = b"".join(
    b'<!ENTITY l%d "%s">' % (i, b"&l%d;" % (i - 1) * 10 if i else b"ha") for i in range(10)
)
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


@cases((name, data, WELL_FORMED + text) for name, data, text in XML)
def test_xml_that_is_not_well_formed_is_one_fault(data, text):
    assert error_of(data) == f"s.mlx: {text}"


@cases(STRUCTURE)
def test_an_element_that_is_wrong_is_one_fault(data, text):
    assert error_of(data) == f"s.mlx: {text}"


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


def test_a_text_of_several_lines_is_one_fault():
    with pytest.raises(ScriptError) as caught:
        read_bytes(script("Invert\nFaces &amp;\nmore"), "s")
    assert caught.value.faults == (Fault("text 'Invert' in <FilterScript> (line 3) is never read"),)


def test_faults_before_broken_xml_are_reported_too():
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
def test_damage_anywhere_is_reported_or_harmless(data, piece):
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
