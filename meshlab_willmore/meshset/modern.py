"""Steps in today's form: MeshLab's names of filters and parameters, and their types."""

from __future__ import annotations

from collections.abc import Iterable

from ..mlx.steps import Param, ScriptError, Step
from .check import Call, resolve
from .parameter_info import ParamInfo

# Attributes of the time of meshlabserver, without a meaning today.
_OLD = frozenset({"isxmlparam"})


def modernised(steps: Iterable[Step]) -> tuple[Step, ...]:
    """The steps in today's form; a step with a fault stays as it is."""
    return tuple(map(_modernised, steps))


def _modernised(step: Step) -> Step:
    try:
        (call,) = resolve([step], "")
    except ScriptError:
        return step
    return in_todays_form(call, step)


def in_todays_form(call: Call, step: Step) -> Step:
    """The step that `call` was made of, in today's form; descriptions and ranges stay."""
    params = []
    for keyword, value in call.given.items():
        known = call.known.param(keyword)
        if known is not None:
            details = tuple(pair for pair in call.details[keyword] if pair[0] not in _OLD)
            params.append(Param(known.name, known.type, value, _with_choices(known, details)))
    # The MeshLab name of a plugin that the user brought is not known.
    return step._replace(filter=call.known.meshlab_name or step.filter, params=tuple(params))


def _with_choices(
    known: ParamInfo, details: tuple[tuple[str, str], ...]
) -> tuple[tuple[str, str], ...]:
    """The details, with the names of an enum's choices as they are today."""
    if not known.choices:
        return details
    names = [(f"enum_val{i}", choice) for i, choice in enumerate(known.choices)]
    choices = [("enum_cardinality", str(len(known.choices))), *names]
    kept = [pair for pair in details if not pair[0].startswith(("enum_val", "enum_card"))]
    is_there = len(details) == len(kept) + len(choices) and set(choices) <= set(details)
    return details if is_there else (*kept, *choices)
