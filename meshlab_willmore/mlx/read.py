"""Read filter scripts: `.mlx` to steps, strictly.

MeshLab and PyMeshLab skip what they don't understand without a word. Here it is a fault, and all
faults of a script come at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from os import PathLike
from pathlib import Path
from typing import Any, NoReturn
from xml.parsers.expat import errors
from xml.sax import SAXParseException
from xml.sax.handler import ContentHandler, LexicalHandler, property_lexical_handler
from xml.sax.xmlreader import AttributesImpl

from defusedxml import EntitiesForbidden, ExternalReferenceForbidden
from defusedxml.expatreader import DefusedExpatParser

from . import rich
from .decode import as_xml, bytes_of, text_of, with_entities
from .steps import (
    Fault,
    Gap,
    Param,
    Reading,
    ScriptError,
    Step,
    Value,
    add_fault,
    quoted,
    shortened,
)

ROOT = "FilterScript"
FILTER = "filter"
PARAM = "Param"
OLD_FILTER = "xmlfilter"
OLD_PARAM = "xmlparam"
# Where each element belongs.
PARENTS = {FILTER: ROOT, OLD_FILTER: ROOT, PARAM: FILTER, OLD_PARAM: OLD_FILTER}
DEEPEST = 100


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
    try:
        text = text_of(data)
    except ValueError as error:
        raise ScriptError(source, [Fault(str(error))]) from None
    reader = _parsed(text)
    xml = as_xml(text) if reader.may_be_loose else text
    if is_loose := xml != text:
        reader = _parsed(xml)
    if reader.may_be_loose and (fixed := with_entities(xml))[1]:
        reader = _parsed(*fixed)
    if not reader.is_script:
        raise ScriptError(source, reader.faults)
    return reader.result()._replace(is_loose=is_loose)


# --- XML -----------------------------------------------------------------------------------------

_LOOSE = {errors.XML_ERROR_INVALID_TOKEN, errors.XML_ERROR_DUPLICATE_ATTRIBUTE}
_TRUNCATED = {errors.XML_ERROR_NO_ELEMENTS, errors.XML_ERROR_UNCLOSED_TOKEN}


class _EnoughError(Exception):
    """There is no sense in reading on."""


def _parsed(text: str, faults: list[str] | None = None) -> _Reader:
    """A reader that went through a text; faults that are known already come first."""
    reader = _Reader()
    with suppress(_EnoughError):
        for fault in faults or []:
            reader.add(fault)
        try:
            reader.parser.feed(text)
            reader.parser.close()
        except EntitiesForbidden as error:
            reader.add(f"declares the entity {quoted(error.name)}; a filter script has no entities")
        except ExternalReferenceForbidden as error:
            reader.add(f"refers to {quoted(str(error.sysid))}; a filter script needs no other file")
        except SAXParseException as error:
            reader.may_be_loose = error.getMessage() in _LOOSE
            reader.add(_not_well_formed(error))
    return reader


def _not_well_formed(error: SAXParseException) -> str:
    problem = error.getMessage()
    if problem in _TRUNCATED:
        problem = f"it ends before </{ROOT}>"
    if problem == errors.XML_ERROR_INVALID_TOKEN:
        problem = "a character has no place there"
    where = f"line {error.getLineNumber()}, column {(error.getColumnNumber() or 0) + 1}"
    return f"is not well-formed XML: {problem} ({where})"


class _Parser(DefusedExpatParser):
    """Notes whether the document type declares anything, which may change what elements say."""

    declares = False

    def start_doctype_decl(
        self, name: str, sysid: str | None, pubid: str | None, subset: int
    ) -> None:
        self.declares = bool(subset)


# --- elements ------------------------------------------------------------------------------------


class _Reader(ContentHandler, LexicalHandler):
    """Builds steps and faults from the elements of a script, in their order."""

    def __init__(self) -> None:
        super().__init__()
        self.parser = _Parser()
        self.parser.setContentHandler(self)
        self.parser.setProperty(property_lexical_handler, self)
        self.faults: list[Fault] = []
        self.is_script = False
        self.may_be_loose = False  # whether MeshLab may read it though it is no XML
        self._steps: list[Step] = []
        self._params: list[Param] = []
        self._names: set[str] = set()  # of the parameters of the step that is open
        self._gaps: dict[int, Gap] = {}
        self._has_comments = False
        self._open: list[str] = []
        self._skipped: int | None = None  # the depth of the element that is skipped
        self._has_unread = False  # whether something before the next step was not read
        self._has_text = False  # whether a fault names the text that goes on

    def add(self, text: str, param: str = "", in_step: bool = False) -> None:
        """Add a fault of the script, of the step that is open, or of its parameter."""
        step = self._steps[-1].filter if in_step else ""
        number = len(self._steps) if in_step else 0
        if not add_fault(self.faults, Fault(text, number, shortened(step), shortened(param))):
            raise _EnoughError

    def result(self) -> Reading:
        """What has been read so far; the last step may not have ended."""
        if len(self._open) > 1 and PARENTS.get(self._open[1]) == ROOT:
            self._end_step()
            self._note(is_cut=True)
        return Reading(tuple(self._steps), tuple(self.faults), self._gaps, self._has_comments)

    def comment(self, content: str) -> None:
        """Note that there are comments."""
        self._has_comments = True

    def endDTD(self) -> None:  # noqa: N802
        """Refuse attribute defaults and the like; a plain document type is as it should be."""
        if self.parser.declares:
            self._stop(f"has declarations in its DOCTYPE; write just <!DOCTYPE {ROOT}>")

    def startElement(self, name: str, attrs: AttributesImpl) -> None:  # noqa: N802
        """Read an element, or name what has no place here."""
        if len(self._open) == DEEPEST:
            self._stop(f"has elements more than {DEEPEST} deep {self._line()}")
        parent = self._open[-1] if self._open else ""
        self._open.append(name)
        self._has_text = False
        if self._skipped is not None:
            return
        if not parent:
            self._start_root(name)
        elif PARENTS.get(name) != parent:
            self._skipped = len(self._open)
            self._misplaced(name, parent)
        elif parent == ROOT:
            self._start_step(dict(attrs.items()))
        else:
            self._add_param(name, dict(attrs.items()))

    def endElement(self, name: str) -> None:  # noqa: N802
        """Finish a step with its parameters, or the skipping of an element."""
        if self._skipped is None and PARENTS.get(name) == ROOT:
            self._end_step()
        if self._skipped == len(self._open):
            self._skipped = None
        self._open.pop()
        self._has_text = False

    def characters(self, content: str) -> None:
        """Name text; a script says everything in attributes."""
        if self._skipped is None and not self._has_text and not content.isspace():
            self._has_text = True
            where = f"in <{self._open[-1]}> {self._line()}"
            self.add(f"text {quoted(content)} {where} is never read", in_step=len(self._open) > 1)

    def _start_root(self, name: str) -> None:
        if name != ROOT:
            self._stop(f"is not a filter script: its root is <{shortened(name)}>, not <{ROOT}>")
        self.is_script = True

    def _start_step(self, attrs: dict[str, str]) -> None:
        self._steps.append(Step(attrs.get("name", "")))
        self._params = []
        self._names = set()
        if self._has_unread:
            self._note(follows_unread=True)
            self._has_unread = False
        if not self._steps[-1].filter:
            self._note(is_nameless=True)
            meant = rich.meant_for("name", attrs)
            self.add(f"the filter {self._line()} has no name{meant}", in_step=True)

    def _end_step(self) -> None:
        self._steps[-1] = self._steps[-1]._replace(params=tuple(self._params))

    def _add_param(self, tag: str, attrs: dict[str, str]) -> None:
        name = attrs.get("name", "")
        is_new = name not in self._names
        if not name:
            meant = rich.meant_for("name", attrs)
            self.add(f"the parameter {self._line()} has no name{meant}", in_step=True)
            self._note(is_cut=True)
        elif not is_new:
            self.add("is given twice", name, in_step=True)
        self._names.add(name)
        try:
            param = _param(tag, attrs)
        except ValueError as error:
            self.add(str(error), name, in_step=True)
            if name and is_new:
                broken = Param(name, attrs.get("type", ""), None)
                self._note(broken=(*self._gap().broken, broken))
            return
        if not param.type and tag == PARAM and name:
            self._note(untyped=self._gap().untyped | {name})
        if name and is_new:
            self._params.append(param)

    def _misplaced(self, name: str, parent: str) -> None:
        is_in_step = len(self._open) > 2
        cure = ""
        if name in PARENTS:
            cure = f"; it belongs into <{PARENTS[name]}>"
        elif meant := rich.closest(name, [tag for tag in PARENTS if PARENTS[tag] == parent]):
            cure = f"; did you mean <{meant}>?"
        where = f"in <{parent}> {self._line()}"
        self.add(f"<{shortened(name)}> has no place {where}{cure}", in_step=is_in_step)
        if is_in_step:
            self._note(is_cut=True)
        else:
            self._has_unread = True

    def _gap(self) -> Gap:
        return self._gaps.get(len(self._steps), Gap())

    def _note(self, **changes: Any) -> None:
        """Note what of the step that is open could not be read."""
        self._gaps[len(self._steps)] = self._gap()._replace(**changes)

    def _line(self) -> str:
        return f"(line {self.parser.getLineNumber()})"

    def _stop(self, text: str) -> NoReturn:
        self.add(text)
        raise _EnoughError


def _param(tag: str, attrs: Mapping[str, str]) -> Param:
    """The parameter of an element; without a type, its value is a text for the filter to read."""
    type = "" if tag == OLD_PARAM else attrs.get("type", "")
    value: Value
    if type:
        value = rich.parse(type, attrs)
        # Only the text of a percentage differs between the two; MeshLab has this type alone.
        type = "RichAbsPerc" if type == rich.PERCENTAGE else type
        fields = rich.rich_type(type).fields
    else:
        fields = _untyped_fields(tag, attrs)
        value = " ".join(attrs[field] for field in fields)
    used = {"name", "type", *fields}
    details = tuple((key, text) for key, text in attrs.items() if key not in used)
    return Param(attrs.get("name", ""), type, value, details)


def _untyped_fields(tag: str, attrs: Mapping[str, str]) -> tuple[str, ...]:
    if tag == OLD_PARAM:
        if problem := rich.missing(rich.VALUE, attrs):
            raise ValueError(problem)
        return rich.VALUE
    fields, meant = rich.fields_in(attrs), rich.meant_for("type", attrs)
    if meant or not fields:
        raise ValueError(f"has no type{meant}")
    return fields
