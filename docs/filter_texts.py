"""The parameters and returns of our filters in Markdown, from the package's own texts."""

import re

from meshlab_willmore.meshset.filters import BY_NAME
from meshlab_willmore.options import MAXDEVIATION, OPTIONS, SELECTION


def described(name):
    """What a filter does, its parameters and what it returns, in Markdown."""
    found = BY_NAME[name]
    parts = [
        f"MeshLab name: **{found.meshlab_name}**.",
        as_code(found.summary),
        as_code(found.info),
    ]
    if found.parameters:
        parts.append("**Parameters**")
        for option in OPTIONS:
            default = f"default: {shown_default(option)}"
            parts.append(f"`{option.name}`, {default}\n: {as_code(option.help)}")
    if found.returns:
        parts.append("**Returns** a dict")
        parts += [f"`{key}`, {kind}\n: {as_code(text)}" for key, kind, text in found.returns]
    return "\n\n".join(parts)


def shown_default(option):
    """The default of an option, as a reader types it."""
    if option is SELECTION:
        return "on where faces are selected"
    if option is MAXDEVIATION:
        return "`100%`"
    if option.type in (int, float):
        return f"`{option.default:g}`"
    return f"`{option.default!r}`"


def as_code(text):
    """A help text with its quoted names as code."""
    return re.sub(r"'([a-z]+( [a-z]+)*)'", r"`'\1'`", text)
