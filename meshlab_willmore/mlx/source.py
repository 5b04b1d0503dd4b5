"""A script's file as text, whatever its encoding."""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from .steps import Fault, ScriptError
from .words import quoted

LARGEST = 16 * 2**20  # bytes; MeshLab's own scripts have a few kilobytes a step

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
_FAMILIES = re.compile(
    r"utf-8|ascii|iso8859-\d+|cp\d{3,4}|mac-\w+|koi8-[ru]|shift_jis(x0213|_2004)?|euc_\w+|gb\w+|big5"
)


def bytes_of(path: Path) -> bytes:
    """The content of a script's file.

    Raises
    ------
    ScriptError
        If there is no such file, it can't be read, or is too large for a script.
    """
    try:
        with open(path, "rb") as file:
            data = file.read(LARGEST + 1)
    except FileNotFoundError:
        raise ScriptError(str(path), [Fault("there is no such file")]) from None
    except IsADirectoryError:
        raise ScriptError(str(path), [Fault("is a folder, not a filter script")]) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        if path.is_dir():  # Windows calls it a lack of permission
            reason = "it is a folder"
        raise ScriptError(str(path), [Fault(f"can't be read: {reason}")]) from None
    return data


def text_of(data: bytes, source: str) -> str:
    """The text of a script, by its byte order mark, its XML declaration, or as UTF-8.

    Raises
    ------
    ScriptError
        If the data is too large, empty, no XML, or not in the encoding that it says.
    """
    if len(data) > LARGEST:
        raise _refusal(source, f"is larger than {LARGEST >> 20} MiB: not a filter script")
    if not data.strip():
        raise _refusal(source, "is empty")
    marked = next((encoding for mark, encoding in _BEGINNINGS if data.startswith(mark)), None)
    if marked is None:
        _check_looks(data, source)
    encoding = marked or _declared(data, source)
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        raise _refusal(source, _undecodable(error, encoding)) from None
    if not text.lstrip().startswith("<"):
        raise _refusal(source, f"is not XML: it begins with {_beginning(text)}")
    return text


def _refusal(source: str, text: str) -> ScriptError:
    return ScriptError(source, [Fault(text)])


def _check_looks(data: bytes, source: str) -> None:
    if b"\0" in data:
        raise _refusal(source, "is binary data, not XML")
    if not data.lstrip().startswith(b"<"):
        begin = _beginning(data[:200].decode("ascii", "backslashreplace"))
        raise _refusal(source, f"is not XML: it begins with {begin}")


def _beginning(text: str) -> str:
    return quoted(text.lstrip().partition("\n")[0])


def _declared(data: bytes, source: str) -> str:
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
        raise _refusal(source, f"declares the encoding {quoted(name)}, but isn't in it")
    if not _FAMILIES.fullmatch(encoding):
        raise _refusal(
            source,
            f"declares the encoding {quoted(name)}, which is not known here; save it as UTF-8",
        )
    return encoding


def _undecodable(error: UnicodeDecodeError, encoding: str) -> str:
    line = error.object.count(b"\n", 0, error.start) + 1
    name = encoding.upper().removesuffix("-SIG")
    what = f"byte 0x{error.object[error.start]:02x} in line {line} is not {name}"
    return f"{what}; save the script as UTF-8, or declare the encoding that it has"
