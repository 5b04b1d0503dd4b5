"""The file of a script as XML text: its encoding, and what MeshLab reads though it is not XML.

MeshLab needs no blank between attributes, and takes the same attribute twice. MeshLabXML, which
wrote many of the existing scripts, did both.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Callable
from pathlib import Path

from .steps import Fault, ScriptError, quoted

LARGEST = 16 * 2**20  # bytes; MeshLab's own scripts have a few kilobytes a step


def bytes_of(path: Path) -> bytes:
    """The content of a script's file.

    Raises
    ------
    ScriptError
        If there is no such file, or it can't be read.
    """
    try:
        with open(path, "rb") as file:
            return file.read(LARGEST + 1)
    except FileNotFoundError:
        problem = "there is no such file"
    except (OSError, ValueError) as error:
        problem = f"can't be read: {getattr(error, 'strerror', None) or error}"
        # Windows calls it a lack of permission.
        if isinstance(error, OSError) and path.is_dir():
            problem = "is a folder, not a filter script"
    raise ScriptError(str(path), [Fault(problem)])


# --- encodings -----------------------------------------------------------------------------------

# Longest first: the mark of UTF-32 begins like that of UTF-16.
_BEGINNINGS = (
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
    (codecs.BOM_UTF8, "utf-8-sig"),
    (b"<\0", "utf-16-le"),
    (b"\0<", "utf-16-be"),
)
_DECLARATION = re.compile(rb"<\?xml\s[^>]{0,200}?\bencoding\s*=\s*[\"']([^\"'>]{1,100})[\"']")
# Python has other codecs, which are not for files.
_FOR_FILES = re.compile(
    r"utf-8|ascii|iso8859-\d+|cp\d{3,4}|mac-\w+|koi8-[ru]|shift_jis(x0213|_2004)?|euc_\w+|gb\w+|big5"
)


def text_of(data: bytes) -> str:
    """The text of a script, by its byte order mark, its XML declaration, or as UTF-8.

    Raises
    ------
    ValueError
        If the data is too large, empty, no XML, or not in the encoding that it says.
    """
    if len(data) > LARGEST:
        raise ValueError(f"is larger than {LARGEST >> 20} MiB: not a filter script")
    if not data.strip():
        raise ValueError("is empty")
    marked = next((encoding for mark, encoding in _BEGINNINGS if data.startswith(mark)), None)
    encoding = marked or _declared(data)
    beginning = data.decode(encoding, "backslashreplace").lstrip()
    if "\0" in beginning:
        raise ValueError("is binary data, not XML")
    if not beginning.startswith("<"):
        raise ValueError(f"is not XML: it begins with {quoted(beginning.partition(chr(10))[0])}")
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        name = encoding.upper().removesuffix("-SIG")
        raise ValueError(
            f"byte 0x{error.object[error.start]:02x} in line {line} is not {name}; "
            "save the script as UTF-8, or declare the encoding that it has"
        ) from None


def _declared(data: bytes) -> str:
    """The encoding that an XML declaration names, or else UTF-8."""
    found = _DECLARATION.match(data)
    if not found:
        return "utf-8"
    name = found[1].decode("ascii", "backslashreplace")
    try:
        encoding = codecs.lookup(name).name
    except (LookupError, ValueError):
        encoding = ""
    if encoding.startswith(("utf-16", "utf-32")):
        raise ValueError(f"declares the encoding {quoted(name)}, but isn't in it")
    if not _FOR_FILES.fullmatch(encoding):
        known = "which is not known here; save it as UTF-8"
        raise ValueError(f"declares the encoding {quoted(name)}, {known}")
    return encoding


# --- what is no XML ------------------------------------------------------------------------------

_NAME = r"""[^\s"'=<>/]+"""
_ATTRIBUTE = re.compile(rf"""(\s*)({_NAME})(\s*=\s*)("[^"]*"|'[^']*')""")
_TAG = re.compile(
    rf"""
    <!--.*?--> | <!\[CDATA\[.*?\]\]> | <[?!][^>]*>        # these stay as they are
    | (?P<begin> <{_NAME} ) (?P<attributes> (?: \s* {_NAME} \s*=\s* (?:"[^"]*"|'[^']*') )+ )
    """,
    re.VERBOSE | re.DOTALL,
)
_STRAY = re.compile(r"&(?!#?\w+;)|<")
_ENTITIES = {"&": "&amp;", "<": "&lt;"}


def as_xml(text: str) -> str:
    """The text with blanks between attributes, and without attributes that only repeat others.

    Lines stay where they are.
    """

    def attributes(tag: re.Match[str]) -> str:
        seen: dict[str, str] = {}
        pieces = []
        for space, name, equals, value in _ATTRIBUTE.findall(tag["attributes"]):
            if seen.get(name) == value[1:-1]:
                pieces.append("\n" * (space + equals + value).count("\n"))
            else:
                seen[name] = value[1:-1]
                pieces.append((space or " ") + name + equals + value)
        return "".join(pieces)

    return _with_attributes(text, attributes)


def with_entities(text: str) -> tuple[str, list[str]]:
    """The text with ``&`` and ``<`` in attributes as XML wants them, and a fault for each.

    MeshLab's parser refuses them, as ours does; but the rest can be read, to find what else is
    wrong. An attribute that goes on in another line is more likely one that lacks its end.
    """
    faults: list[str] = []

    def attributes(tag: re.Match[str]) -> str:
        def attribute(found: re.Match[str]) -> str:
            space, name, equals, value = found.groups()
            if "\n" in value:
                return found[0]
            line = text.count("\n", 0, tag.start("attributes") + found.start(2)) + 1
            faults.extend(
                f"is not well-formed XML: {sign} in the attribute {name!r} is written "
                f"{_ENTITIES[sign]} (line {line})"
                for sign in dict.fromkeys(_STRAY.findall(value))
            )
            return space + name + equals + _STRAY.sub(lambda sign: _ENTITIES[sign[0]], value)

        return _ATTRIBUTE.sub(attribute, tag["attributes"])

    return _with_attributes(text, attributes), faults


def _with_attributes(text: str, attributes: Callable[[re.Match[str]], str]) -> str:
    """The text with other attributes in its tags."""

    def tag(found: re.Match[str]) -> str:
        return found[0] if found["begin"] is None else found["begin"] + attributes(found)

    return _TAG.sub(tag, text)
