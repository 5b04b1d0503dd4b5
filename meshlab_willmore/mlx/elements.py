"""The elements of a script, taken in one after the other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NoReturn
from xml.sax.handler import ContentHandler, LexicalHandler
from xml.sax.xmlreader import AttributesImpl, Locator

from . import rich
from .kinds import PERCENTAGE
from .steps import Fault, Gap, Param, Reading, Step
from .words import closest, meant_for, missing, quoted, shortened

ROOT = "FilterScript"
FILTER = "filter"
PARAM = "Param"
OLD_FILTER = "xmlfilter"
OLD_PARAM = "xmlparam"
# Where each element belongs.
PARENTS = {FILTER: ROOT, OLD_FILTER: ROOT, PARAM: FILTER, OLD_PARAM: OLD_FILTER}
DEEPEST = 100
MOST_FAULTS = 100


class EnoughError(Exception):
    """There is no sense in reading on."""


class Reader(ContentHandler, LexicalHandler):
    """Builds steps and faults from the elements of a script, in their order."""

    def __init__(self) -> None:
        super().__init__()
        self.steps: list[Step] = []
        self.faults: list[Fault] = []
        self.gaps: dict[int, Gap] = {}
        self.has_comments = False
        self.declares = False
        self.is_script = False
        self._open: list[str] = []
        self._params: list[Param] = []
        self._seen: set[str] = set()
        self._unread = False  # whether something before the next step was not read
        self._skipped: int | None = None  # the depth of the element that is skipped
        self._text_told = False
        self._place = Locator()

    def setDocumentLocator(self, locator: Locator) -> None:  # noqa: N802
        """Remember whom to ask for the line."""
        self._place = locator

    def add(self, text: str, param: str = "", in_step: bool = False) -> None:
        """Add a fault of the script, of the step that is open, or of its parameter."""
        if len(self.faults) == MOST_FAULTS:
            self.faults.append(Fault(f"has more than {MOST_FAULTS} faults; these are the first"))
            raise EnoughError
        step = self.steps[-1].filter if in_step else ""
        number = len(self.steps) if in_step else 0
        self.faults.append(Fault(text, number, shortened(step), shortened(param)))

    def comment(self, content: str) -> None:
        """Note that there are comments."""
        self.has_comments = True

    def result(self) -> Reading:
        """What has been read so far; the last step may not have ended."""
        if len(self._open) > 1 and PARENTS.get(self._open[1]) == ROOT:
            self.steps[-1] = self.steps[-1]._replace(params=tuple(self._params))
            self._note(is_cut=True)
        return Reading(tuple(self.steps), tuple(self.faults), self.gaps, self.has_comments)

    def _note(self, **changes: Any) -> None:
        """Note what of the step that is open could not be read."""
        number = len(self.steps)
        self.gaps[number] = self.gaps.get(number, Gap())._replace(**changes)

    def _gap(self) -> Gap:
        return self.gaps.get(len(self.steps), Gap())

    def endDTD(self) -> None:  # noqa: N802
        """Refuse attribute defaults and the like; a plain document type is as it should be."""
        if self.declares:
            self._stop(f"has declarations in its DOCTYPE; write just <!DOCTYPE {ROOT}>")

    def startElement(self, name: str, attrs: AttributesImpl) -> None:  # noqa: N802
        """Take an element in, or tell that it has no place here."""
        if len(self._open) == DEEPEST:
            self._stop(f"has elements more than {DEEPEST} deep {self._line()}")
        parent = self._open[-1] if self._open else ""
        self._open.append(name)
        self._text_told = False
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
            self.steps[-1] = self.steps[-1]._replace(params=tuple(self._params))
        if self._skipped == len(self._open):
            self._skipped = None
        self._open.pop()
        self._text_told = False

    def characters(self, content: str) -> None:
        """Tell of text; a script says everything in attributes."""
        if self._skipped is None and not self._text_told and not content.isspace():
            self._text_told = True
            self.add(
                f"text {quoted(content)} in <{self._open[-1]}> {self._line()} is never read",
                in_step=len(self._open) > 1,
            )

    def _start_root(self, name: str) -> None:
        if name != ROOT:
            self._stop(f"is not a filter script: its root is <{shortened(name)}>, not <{ROOT}>")
        self.is_script = True

    def _start_step(self, attrs: dict[str, str]) -> None:
        self.steps.append(Step(attrs.get("name", "")))
        self._params = []
        self._seen = set()
        if self._unread:
            self._note(follows_unread=True)
            self._unread = False
        if not self.steps[-1].filter:
            self._note(is_nameless=True)
            self.add(
                f"the filter {self._line()} has no name{meant_for('name', attrs)}", in_step=True
            )

    def _add_param(self, tag: str, attrs: dict[str, str]) -> None:
        name = attrs.get("name", "")
        if not name:
            text = f"the parameter {self._line()} has no name{meant_for('name', attrs)}"
            self.add(text, in_step=True)
            self._note(is_cut=True)
        elif name in self._seen:
            self.add("is given twice", name, in_step=True)
        is_new = name not in self._seen
        self._seen.add(name)
        try:
            param = _old_param(attrs) if tag == OLD_PARAM else _param(attrs)
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
        cure = ""
        if name in PARENTS:
            cure = f"; it belongs into <{PARENTS[name]}>"
        elif meant := closest(name, [tag for tag in PARENTS if PARENTS[tag] == parent]):
            cure = f"; did you mean <{meant}>?"
        self.add(
            f"<{shortened(name)}> has no place in <{parent}> {self._line()}{cure}",
            in_step=len(self._open) > 2,
        )
        if len(self._open) > 2:
            self._note(is_cut=True)
        else:
            self._unread = True

    def _line(self) -> str:
        return f"(line {self._place.getLineNumber()})"

    def _stop(self, text: str) -> NoReturn:
        self.add(text)
        raise EnoughError


def _param(attrs: Mapping[str, str]) -> Param:
    if not attrs.get("type"):
        return _untyped_param(attrs)
    type = attrs["type"]
    value = rich.parse(type, attrs)
    # Only the text of a percentage differs between the two; today's form is that of MeshLab's type.
    type = "RichAbsPerc" if type == PERCENTAGE else type
    return Param(attrs.get("name", ""), type, value, _details(attrs, rich.fields(type)))


def _untyped_param(attrs: Mapping[str, str]) -> Param:
    """A parameter whose type only its filter can tell; its value is a text."""
    meant = meant_for("type", attrs)
    fields = rich.fields_in(attrs)
    if meant or not fields:
        raise ValueError(f"has no type{meant}")
    text = " ".join(attrs[field] for field in fields)
    return Param(attrs.get("name", ""), "", text, _details(attrs, fields))


def _old_param(attrs: Mapping[str, str]) -> Param:
    if problem := missing(["value"], attrs):
        raise ValueError(problem)
    return Param(attrs.get("name", ""), "", attrs["value"], _details(attrs, ("value",)))


def _details(attrs: Mapping[str, str], fields: tuple[str, ...]) -> tuple[tuple[str, str], ...]:
    known = {"name", "type", *fields}
    return tuple((key, text) for key, text in attrs.items() if key not in known)
