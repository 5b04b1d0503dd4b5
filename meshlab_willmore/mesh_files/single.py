"""Single precision in PLY files: PyMeshLab itself writes nothing but doubles."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

_END = b"end_header\n"
_ASCII = b"format ascii"
_FLOAT, _DOUBLE = "float", "double"


class _Property(NamedTuple):
    """A property of an element; without a type of its count it is one number, else a list."""

    type: str
    of_count: str = ""


class _Element(NamedTuple):
    name: str
    size: int
    properties: list[_Property]


def to_single(file: Path) -> None:
    """Rewrite a PLY file of MeshLab's in place, with the doubles of its vertices as floats.

    Parameters
    ----------
    file : path
        Binary in little-endian order, or a text. Lists of a vertex have the same length in all.
    """
    draft = file.with_name(f"{file.name}.single")
    with file.open("rb") as source, draft.open("wb") as target:
        header = [*iter(source.readline, _END)]
        elements = _elements(header)
        target.writelines([*_renamed(header), _END])
        convert = _text if any(line.startswith(_ASCII) for line in header) else _binary
        for element in elements:
            convert(element, source, target)
            if element.name == "vertex":
                break
        shutil.copyfileobj(source, target)
    os.replace(draft, file)


def _elements(header: Sequence[bytes]) -> list[_Element]:
    elements: list[_Element] = []
    for line in header:
        words = line.decode("utf-8", "surrogateescape").split()
        if words[:1] == ["element"]:
            elements.append(_Element(words[1], int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            elements[-1].properties.append(_Property(words[3], words[2]))
        elif words[:1] == ["property"]:
            elements[-1].properties.append(_Property(words[1]))
    return elements


def _renamed(header: Sequence[bytes]) -> list[bytes]:
    """The header with floats in place of the doubles of vertices."""
    lines, element = [], b""
    for line in header:
        words = line.split(b" ")
        if words[0] == b"element":
            element = words[1]
        if words[0] == b"property" and element == b"vertex":
            # The last word is a name.
            words[1:-1] = [b"float" if word == b"double" else word for word in words[1:-1]]
        lines.append(b" ".join(words))
    return lines


def _binary(element: _Element, source: BinaryIO, target: BinaryIO) -> None:
    """Copy the records of an element; those of vertices in single precision."""
    import numpy as np

    old: list[tuple[str, str, tuple[int, ...]]] = []
    new: list[tuple[str, str, tuple[int, ...]]] = []
    start = source.tell()
    for number, (kind, count) in enumerate(element.properties):
        shape: tuple[int, ...] = ()
        if count:
            # The first record tells how long the list is.
            source.seek(start + np.dtype(old).itemsize)
            length = np.fromfile(source, _code(count), 1)
            shape = (int(length[0]) if len(length) else 0,)
            old.append((f"{number}n", _code(count), ()))
            new.append((f"{number}n", _code(count), ()))
        old.append((f"{number}", _code(kind), shape))
        is_kept = kind != _DOUBLE or element.name != "vertex"
        new.append((f"{number}", _code(kind if is_kept else _FLOAT), shape))
    source.seek(start)
    records = np.fromfile(source, np.dtype(old), element.size)
    with np.errstate(over="ignore"):
        records.astype(np.dtype(new)).tofile(target)


def _code(kind: str) -> str:
    from ..meshset.ply import SCALARS

    return SCALARS[kind]


def _text(element: _Element, source: BinaryIO, target: BinaryIO) -> None:
    """Copy the lines of an element; those of vertices with as few digits as floats need."""
    import numpy as np

    for _ in range(element.size):
        line = source.readline()
        if element.name == "vertex":
            words = iter(line.split())
            shown: list[bytes] = []
            for kind, count in element.properties:
                length = 1
                if count:
                    shown.append(next(words))
                    length = int(shown[-1])
                for _ in range(length):
                    word = next(words)
                    shown.append(str(np.float32(word)).encode() if kind == _DOUBLE else word)
            line = b" ".join(shown) + b"\n"
        target.write(line)
