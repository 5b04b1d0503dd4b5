"""Read filter scripts: `.mlx` to steps, strictly.

MeshLab and PyMeshLab skip what they don't understand without a word. Here it is a fault, and all
faults of a script come at once.
"""

from __future__ import annotations

from contextlib import suppress
from os import PathLike
from pathlib import Path
from xml.parsers.expat import errors
from xml.sax import SAXParseException
from xml.sax.handler import property_lexical_handler

from defusedxml import EntitiesForbidden, ExternalReferenceForbidden
from defusedxml.expatreader import DefusedExpatParser

from .elements import ROOT, EnoughError, Reader
from .loose import as_xml, with_entities
from .source import bytes_of, text_of
from .steps import Reading, ScriptError, Step
from .words import quoted


def read(path: str | PathLike[str]) -> tuple[Step, ...]:
    """Read a filter script from a file.

    Parameters
    ----------
    path : str or path
        An `.mlx` file.

    Returns
    -------
    tuple of Step

    Raises
    ------
    ScriptError
        With all faults, if the file can't be read, or MeshLab would skip or misread a part of it.
    """
    return read_bytes(bytes_of(Path(path)), str(path))


def read_bytes(data: bytes, source: str, strict: bool = True) -> tuple[Step, ...]:
    """Read a filter script that is in memory; errors call it `source`.

    Parameters
    ----------
    strict : bool
        False: what MeshLab would skip or misread is left out, without an error.

    Raises
    ------
    ScriptError
        As `read`; where `strict` is false, only if it is no script at all.
    """
    reading = reading_of(data, source)
    if strict and reading.faults:
        raise ScriptError(source, reading.faults)
    return reading.steps


def reading_of(data: bytes, source: str) -> Reading:
    """All that can be read of a filter script, and what is wrong with the rest.

    Raises
    ------
    ScriptError
        If it is no script at all.
    """
    text = text_of(data, source)
    reader = Reader()
    may_be_loose = _parse(text, reader)
    xml = as_xml(text) if may_be_loose else text
    if is_loose := xml != text:
        reader = Reader()
        may_be_loose = _parse(xml, reader)
    if may_be_loose and (mended := with_entities(xml))[1]:
        xml, faults = mended
        reader = Reader()
        with suppress(EnoughError):
            for fault in faults:
                reader.add(fault)
        _parse(xml, reader)
    if not reader.is_script:
        raise ScriptError(source, reader.faults)
    return reader.result()._replace(is_loose=is_loose)


def _parse(text: str, reader: Reader) -> bool:
    """Let a reader go through a text; whether MeshLab may read it though it is no XML."""
    parser = _Parser(reader)
    may_be_loose = False
    with suppress(EnoughError):
        try:
            parser.feed(text)
            parser.close()
        except EntitiesForbidden as error:
            reader.add(f"declares the entity {quoted(error.name)}; a filter script has no entities")
        except ExternalReferenceForbidden as error:
            reader.add(f"refers to {quoted(str(error.sysid))}; a filter script stands by itself")
        except SAXParseException as error:
            may_be_loose = error.getMessage() in _LOOSE
            reader.add(_not_well_formed(error))
    return may_be_loose


_LOOSE = {errors.XML_ERROR_INVALID_TOKEN, errors.XML_ERROR_DUPLICATE_ATTRIBUTE}
_TRUNCATED = {errors.XML_ERROR_NO_ELEMENTS, errors.XML_ERROR_UNCLOSED_TOKEN}


def _not_well_formed(error: SAXParseException) -> str:
    problem = error.getMessage()
    if problem in _TRUNCATED:
        problem = f"it ends before </{ROOT}>"
    if problem == errors.XML_ERROR_INVALID_TOKEN:
        problem = "a character has no place there"
    where = f"line {error.getLineNumber()}, column {(error.getColumnNumber() or 0) + 1}"
    return f"is not well-formed XML: {problem} ({where})"


class _Parser(DefusedExpatParser):
    """Tells a `Reader` what an XML text holds."""

    def __init__(self, reader: Reader) -> None:
        super().__init__()
        self._reader = reader
        self.setContentHandler(reader)
        self.setProperty(property_lexical_handler, reader)
        # Only a parser that opens its file itself does this.
        reader.setDocumentLocator(self)

    def start_doctype_decl(
        self, name: str, sysid: str | None, pubid: str | None, subset: int
    ) -> None:
        """Note whether the document type declares anything, which may change what elements say."""
        self._reader.declares = bool(subset)
