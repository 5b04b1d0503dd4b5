"""Messages of MeshLab as plain text: some are written for a window that shows rich text.

A parser of HTML would also take a user's text for a tag, such as ``x <y`` in a condition. So only
complete tags of Qt's rich text are removed, and only where the user's text does not have them.
"""

from __future__ import annotations

import html
import re
from html.entities import html5

_BLOCKS = "br p div hr ul ol li dl dt dd table tr td th h1 h2 h3 h4 h5 h6 center pre blockquote"
_INLINE = (
    "a b i u s em strong tt code kbd samp var cite dfn big small sub sup font span nobr img "
    "html head body qt"
)
_ATTRIBUTE = r"""\s+[\w-]+\s*=\s*(?:"[^"]*"|'[^']*'|[^\s"'<>]+)"""
_MARKUP = re.compile(
    rf"<(?P<end>/?)(?P<tag>{'|'.join((_BLOCKS + ' ' + _INLINE).split())})(?:{_ATTRIBUTE})*\s*/?>"
    r"|&(?:#\d+|#x[\da-f]+|[a-z][a-z\d]*);",
    re.IGNORECASE,
)

# Marks the place of a tag inside a line; between words it becomes a blank.
_SEAM = "\0"
_BETWEEN_WORDS = re.compile(r"(?<=[\w.,;:!?)])\0+(?=[\w(])")

# Sentences between which MeshLab's sources lack the blank.
_RUN_TOGETHER = (
    ("filterIf you", "filter. If you"),
    ("filterwith function", "filter with function"),
)


def plain(text: str, *verbatim: str) -> str:
    """Return a native message without tags and entities, in one line if it had any.

    Parameters
    ----------
    text : str
        The message.
    *verbatim : str
        Texts of the user that the message may repeat (values of parameters, names of files): a tag
        or an entity in one of these is kept.
    """

    def replaced(match: re.Match[str]) -> str:
        if any(match[0] in own for own in verbatim):
            return match[0]
        if match["tag"] is None:
            # `html.unescape` alone takes the beginning of an unknown name for a known one.
            known = match[0][1] == "#" or match[0][1:] in html5
            return html.unescape(match[0]) if known else match[0]
        if match["tag"].lower() in _BLOCKS.split():
            return " "
        return _SEAM

    changed = _MARKUP.sub(replaced, text)
    if changed == text:
        return text
    changed = _BETWEEN_WORDS.sub(" ", changed).replace(_SEAM, "")
    for wrong, right in _RUN_TOGETHER:
        changed = changed.replace(wrong, right)
    return " ".join(changed.split())
