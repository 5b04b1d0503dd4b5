"""Files of scripts: those that can't be read as text, encodings, and text that is not quite XML."""

import codecs
import os

import pytest

from meshlab_willmore.meshset.check import examine
from meshlab_willmore.mlx.decode import LARGEST, as_xml
from meshlab_willmore.mlx.read import read, read_bytes, reading_of
from meshlab_willmore.mlx.steps import Param, ScriptError, Step

from .scripts import cases, error_of, script

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


# --- files ---------------------------------------------------------------------------------------


@cases(FILES)
def test_data_that_is_no_xml_is_one_fault(data, text):
    assert error_of(data) == f"s.mlx: {text}"


@cases([*FILES, ("xml", script("<filter/>"), "step 1: the filter (line 3) has no name")])
def test_a_file_is_judged_as_its_content(tmp_path, data, text):
    path = tmp_path / "broken.mlx"
    path.write_bytes(data)
    with pytest.raises(ScriptError) as caught:
        read(path)
    assert str(caught.value) == f"{path}: {text}"
    assert caught.value.source == str(path)


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


# --- encodings -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("encoding", "declared", "mark"),
    [
        ("utf-8", "", b""),
        ("utf-8", "UTF-8", b""),
        ("utf-8", "", codecs.BOM_UTF8),
        ("utf-8", "UTF-8", codecs.BOM_UTF8),
        ("utf-16", "", b""),
        ("utf-16", "UTF-16", b""),
        ("utf-16-be", "", codecs.BOM_UTF16_BE),
        ("utf-16-le", "", b""),
        ("utf-16-be", "UTF-16", b""),
        ("utf-32", "", b""),
        ("latin-1", "ISO-8859-1", b""),
        ("cp1252", "Windows-1252", b""),
        ("shift_jis", "Shift_JIS", b""),
        ("gb18030", "GB18030", b""),
    ],
)
def test_a_script_is_read_in_its_encoding(encoding, declared, mark):
    name = "日本" if encoding in ("shift_jis", "gb18030") else "Fläche é"
    start = f'<?xml version="1.0" encoding="{declared}"?>' if declared else ""
    text = f'{start}<FilterScript>\n<filter name="{name}"/></FilterScript>'
    assert read_bytes(mark + text.encode(encoding), "s") == (Step(name),)


# --- what is not quite XML -----------------------------------------------------------------------

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
def test_other_text_is_unchanged(text):
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


def test_an_attribute_without_its_end_is_no_text_with_signs():
    text = script('<filter name="a & b>\n<Param name="p" type="RichInt" value="1"/></filter>')
    assert error_of(text) == (
        "s.mlx: is not well-formed XML: a character has no place there (line 3, column 18)"
    )
