"""What `help` shows of a filter: signature and docstring, which fit 80 columns."""

from __future__ import annotations

import inspect

from ..messages import wrapped
from .filter import Filter
from .parameters import Parameter

# `help` of a class indents the docstrings of its methods by eight columns.
WIDTH = 72
# What `help` writes before a signature is longer for some filters; a line begins here.
_INDENT = "    "


class Signature(inspect.Signature):
    """A signature that is printed in several lines, as `help` itself does it since Python 3.13."""

    def __str__(self) -> str:
        """The parameters in lines that fit a docstring."""
        parts = [str(p) for p in self.parameters.values() if p.kind is p.KEYWORD_ONLY]
        if not parts:
            return super().__str__()
        # No line ends inside of a default.
        lines = wrapped(", ".join(part.replace(" ", "\0") for part in parts), WIDTH)
        body = "".join(f"\n{_INDENT}{line}" for line in lines).replace("\0", " ")
        first = "self, /, *," if "self" in self.parameters else "*,"
        return f"({first}{body})"


def signature(filter_: Filter) -> Signature:
    """The signature of a filter's method; None is a default that depends on the mesh."""
    parameters = [inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)]
    for p in filter_.parameters:
        default = None if callable(p.default) else p.default
        parameters.append(
            inspect.Parameter(p.name, inspect.Parameter.KEYWORD_ONLY, default=default)
        )
    return Signature(parameters)


def docstring(filter_: Filter) -> str:
    """The docstring of a filter's method, in numpydoc's form."""
    lines = [*wrapped(filter_.summary, WIDTH), "", f"MeshLab name: {filter_.meshlab_name!r}.", ""]
    lines += wrapped(filter_.info, WIDTH)
    if filter_.parameters:
        lines += ["", "Parameters", "----------"]
    for parameter in filter_.parameters:
        lines += [f"{parameter.name} : {_type(parameter)}"]
        lines += wrapped(parameter.tooltip, WIDTH, _INDENT)
    if filter_.returns:
        lines += ["", "Returns", "-------", "dict"]
    for name, kind, text in filter_.returns:
        lines += wrapped(f"``{name}`` ({kind}): {text}", WIDTH, _INDENT)
    return "\n".join(lines)


def _type(parameter: Parameter) -> str:
    default = "None" if callable(parameter.default) else parameter.shown_default()
    if parameter.choices:
        # The tooltip lists them; here they would make the line too long.
        return f"choice or index, default {default}"
    return f"{parameter.type_name()}, default {default}"
