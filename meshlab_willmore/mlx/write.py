"""Write filter scripts as MeshLab does: steps to `.mlx`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from os import PathLike
from pathlib import Path

from .. import files
from . import rich
from .read import FILTER, PARAM, ROOT, read_bytes
from .steps import Fault, Param, ScriptError, Step, shortened

SOURCE = "the script to be written"
# Line breaks in an attribute would be read as spaces. The standard library's quoteattr does the
# same, but its import takes half as long as that of this whole package.
_ESCAPES = str.maketrans(
    {
        "&": "&amp;",
        "<": "&lt;",
        ">": "&gt;",
        '"': "&quot;",
        "\n": "&#10;",
        "\r": "&#13;",
        "\t": "&#9;",
    }
)
_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def to_xml(steps: Iterable[Step]) -> str:
    """The script in today's form; it reads back as the same steps.

    Parameters
    ----------
    steps : iterable of Step
        Attributes that MeshLab needs and the details lack are added: the number of choices, the
        range of an absolute or percentage value, ...

    Raises
    ------
    ScriptError
        With all faults, if a parameter has no type or a value of another type, a text holds a
        character that XML can't, or the script wouldn't be read back. (It is a `ValueError`.)
    """
    faults: list[Fault] = []
    lines = list(_lines(tuple(steps), faults))
    if faults:
        raise ScriptError(SOURCE, faults)
    text = "\n".join(lines) + "\n"
    read_bytes(text.encode(), SOURCE)
    return text


def write(path: str | PathLike[str], steps: Iterable[Step]) -> None:
    """Write a filter script atomically, or into a pipe or device; errors as in `to_xml`."""
    files.write(Path(path), to_xml(steps).encode())


def _lines(steps: tuple[Step, ...], faults: list[Fault]) -> Iterator[str]:
    yield f"<!DOCTYPE {ROOT}>"
    if not steps:
        yield f"<{ROOT}/>"
        return
    yield f"<{ROOT}>"
    for number, step in enumerate(steps, start=1):
        yield from _step(number, step, faults)
    yield f"</{ROOT}>"


def _step(number: int, step: Step, faults: list[Fault]) -> Iterator[str]:
    if problem := _unwritable({"name": step.filter}):
        faults.append(Fault(problem, number, shortened(step.filter)))
    params = [_param(param, number, step, faults) for param in step.params]
    yield f" <{FILTER} name={_quoted(step.filter)}{'' if params else '/'}>"
    if params:
        yield from params
        yield f" </{FILTER}>"


def _param(param: Param, number: int, step: Step, faults: list[Fault]) -> str:
    attributes: dict[str, str] = {}
    try:
        attributes = rich.attributes(param)
        problem = _unwritable(attributes)
    except ValueError as error:
        problem = str(error)
    if problem:
        faults.append(Fault(problem, number, shortened(step.filter), shortened(param.name)))
    shown = " ".join(f"{key}={_quoted(text)}" for key, text in attributes.items())
    return f"  <{PARAM} {shown}/>"


def _unwritable(attributes: dict[str, str]) -> str | None:
    for key, text in attributes.items():
        if found := _NOT_IN_XML.search(text):
            return f"the {key} holds U+{ord(found[0]):04X}, a character that XML can't hold"
    return None


def _quoted(text: str) -> str:
    # Double quotes always, as MeshLab.
    return f'"{escaped(text)}"'


def escaped(text: str) -> str:
    """The text as it is written inside of double quotes."""
    return text.translate(_ESCAPES)
