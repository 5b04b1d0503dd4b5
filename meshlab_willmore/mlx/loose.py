"""What MeshLab's parser reads though it is no XML, made into XML.

Attributes may stand without a blank between them, and one may be there twice. MeshLabXML, which
wrote many of the scripts about, did both. Other things MeshLab's parser refuses as ours does.
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
