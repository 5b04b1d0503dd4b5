"""What MeshLab's parser reads though it is no XML, made into XML.

Attributes may stand without a blank between them, and one may be there twice. MeshLabXML, which
wrote many of the scripts about, did both. Other things MeshLab's parser refuses as ours does; where
they are plain mistakes, the rest can be read nevertheless, to find what else is wrong.
"""

from __future__ import annotations

import re

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
    return _TAG.sub(_mended, text)


def _mended(tag: re.Match[str]) -> str:
    if tag["attributes"] is None:
        return tag[0]
    seen: dict[str, str] = {}
    pieces = [tag["begin"]]
    for space, name, equals, value in _ATTRIBUTE.findall(tag["attributes"]):
        if seen.get(name) == value[1:-1]:
            pieces.append("\n" * (space + equals + value).count("\n"))
        else:
            seen[name] = value[1:-1]
            pieces.append((space or " ") + name + equals + value)
    return "".join(pieces)


def with_entities(text: str) -> tuple[str, list[str]]:
    """The text with ``&`` and ``<`` in attributes as XML wants them, and a fault for each.

    An attribute that goes on in another line is more likely one that lacks its end.
    """
    faults: list[str] = []

    def tag(found: re.Match[str]) -> str:
        if found["attributes"] is None:
            return found[0]

        def attribute(part: re.Match[str]) -> str:
            space, name, equals, value = part.groups()
            if "\n" in value:
                return part[0]
            line = text.count("\n", 0, found.start("attributes") + part.start(2)) + 1
            faults.extend(
                f"is not well-formed XML: {sign} in the attribute {name!r} is written "
                f"{_ENTITIES[sign]} (line {line})"
                for sign in dict.fromkeys(_STRAY.findall(value))
            )
            return space + name + equals + _STRAY.sub(lambda sign: _ENTITIES[sign[0]], value)

        return found["begin"] + _ATTRIBUTE.sub(attribute, found["attributes"])

    return _TAG.sub(tag, text), faults
