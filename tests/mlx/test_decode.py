"""What MeshLab reads though it is no XML."""

import pytest

from meshlab_willmore.meshset.check import examine
from meshlab_willmore.mlx.decode import as_xml
from meshlab_willmore.mlx.read import read_bytes, reading_of
from meshlab_willmore.mlx.steps import Param, ScriptError, Step
from tests.mlx.scripts import script

LOOSE = script(
    '<filter name="Taubin Smooth"><Param name="mu"value="-0.2"type="RichFloat"/>\n'
    "<Param name='lambda' value='0.5'\nvalue='0.5' type='RichFloat'/></filter><Nothing/>"
)


def test_attributes_need_no_blank_between_them_and_may_be_repeated():
    reading = reading_of(LOOSE, "s")
    values = (Param("mu", "RichFloat", -0.2), Param("lambda", "RichFloat", 0.5))
    assert reading.steps == (Step("Taubin Smooth", values),)
    # Lines are those of the script.
    assert [fault.text for fault in reading.faults] == [
        "<Nothing> has no place in <FilterScript> (line 5)"
    ]
    assert reading.is_loose
    (warning,) = examine(reading).warnings
    assert "MeshLab still reads it" in warning.text


def test_repeated_attributes_that_differ_are_a_fault():
    with pytest.raises(ScriptError) as caught:
        read_bytes(script('<filter name="a"name="b"/>'), "s")
    (fault,) = caught.value.faults
    assert fault.text.startswith("is not well-formed XML: duplicate attribute (line 3")


@pytest.mark.parametrize(
    "text",
    [
        '<a b="1" c="2"/>',
        "<!-- <a b='1'c='2'> -->",
        "<![CDATA[<a b='1'c='2'>]]>",
        '<!DOCTYPE a SYSTEM "b""c">',
        "<a b=\"c='1'd='2'\"/>",
        "a='1'b='2'",
    ],
)
def test_what_is_no_such_element_stays(text):
    assert as_xml(text) == text


def test_proper_xml_is_read_as_it_is():
    assert not reading_of(script('<filter name="a"/>'), "s").is_loose


def test_signs_in_attributes_hide_no_other_fault():
    text = script(
        '<filter name="R&D"/>\n<Nothing/>\n<filter name="Conditional Vertex Selection">\n'
        ' <Param name="condSelect" type="RichString"\n  value="(q < 1) && (x &lt; 2)"/>\n'
        ' <Param name="other" type="RichInt" value="x"/></filter>'
    )
    with pytest.raises(ScriptError) as caught:
        read_bytes(text, "s")
    assert [str(fault) for fault in caught.value.faults] == [
        "is not well-formed XML: & in the attribute 'name' is written &amp; (line 3)",
        "is not well-formed XML: < in the attribute 'value' is written &lt; (line 7)",
        "is not well-formed XML: & in the attribute 'value' is written &amp; (line 7)",
        "<Nothing> has no place in <FilterScript> (line 4)",
        "step 2 (Conditional Vertex Selection), parameter 'other': value='x' is not a whole number",
    ]
