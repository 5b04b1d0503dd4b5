"""`--set STEP.PARAM=VALUE`: values in place of a script's own."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ..messages import WrongUse
from .arguments import hyphened

if TYPE_CHECKING:
    from ..meshset.catalogue import FilterInfo, ParamInfo
    from ..mlx.steps import Param, Step, Value


class Setting(NamedTuple):
    """One ``STEP.PARAM=VALUE`` as it was written, in its parts."""

    written: str
    step: str
    param: str
    value: str


def with_settings(steps: Sequence[Step], written: Iterable[str]) -> tuple[Step, ...]:
    """The steps with the values of settings; raises `WrongUse` for one that does not fit.

    STEP is a number from 1, or a filter's name in MeshLab or PyMeshLab if the script has it once;
    PARAM is MeshLab's name or PyMeshLab's keyword.
    """
    changed = list(steps)
    for text in written:
        setting = _parsed(text)
        place = _place(changed, setting)
        changed[place] = _changed(changed[place], setting)
    return tuple(changed)


def _parsed(text: str) -> Setting:
    target, equals, value = text.partition("=")
    step, dot, param = target.rpartition(".")
    if not (equals and dot and step.strip() and param.strip()):
        raise WrongUse(f"--set {text}: it must be STEP.PARAM=VALUE, such as 2.TargetPerc=0.5")
    return Setting(text, step.strip(), param.strip(), value)


def _place(steps: Sequence[Step], setting: Setting) -> int:
    """The index of the step that is meant."""
    from ..meshset.catalogue import find

    if setting.step.isascii() and setting.step.isdigit():
        number = int(setting.step)
        if not 1 <= number <= len(steps):
            raise WrongUse(f"--set {setting.written}: the script has steps 1 to {len(steps)}")
        return number - 1
    wanted = find(setting.step)
    found = ((i, find(step.filter)) for i, step in enumerate(steps))
    places = [i for i, known in found if wanted and known and known.name == wanted.name]
    if len(places) == 1:
        return places[0]
    if places:
        numbers = ", ".join(str(i + 1) for i in places)
        raise WrongUse(
            f"--set {setting.written}: {setting.step} is in the script {len(places)} times; "
            f"name the step by its number ({numbers})"
        )
    there = ", ".join(dict.fromkeys(step.filter for step in steps))
    raise WrongUse(f"--set {setting.written}: the script has no {setting.step}, only {there}")


def _changed(step: Step, setting: Setting) -> Step:
    from ..meshset.catalogue import find
    from ..mlx.steps import Param

    known = find(step.filter)
    if known is None:
        # The check of the script names it and the closest ones.
        return step
    param = known.param(setting.param) or _renamed(known, setting.param)
    if param is None:
        raise WrongUse(f"--set {setting.written}: {_no_such_parameter(known, setting.param)}")
    new = Param(param.name, param.type, _value(param, setting))
    kept: list[Param] = []
    replaced = False
    for old in step.params:
        if param not in _meant(known, old.name):
            kept.append(old)
        elif not replaced:
            is_renamed = known.param(old.name) is None
            kept.append(new if is_renamed else new._replace(details=old.details))
            replaced = True
    return step._replace(params=(*kept,) if replaced else (*kept, new))


def _meant(known: FilterInfo, name: str) -> list[ParamInfo | None]:
    """The parameters that have, or had in older versions, this name."""
    from ..meshset.old_names import params_of

    own = known.param(name)
    return [own] if own else [known.param(old.param or "") for old in params_of(known.name, name)]


def _renamed(known: FilterInfo, name: str) -> ParamInfo | None:
    """The parameter that had this name before, with the same values."""
    from ..meshset.old_names import params_of

    olds = params_of(known.name, name)
    is_plain = len(olds) == 1 and not olds[0].change
    return known.param(olds[0].param or "") if is_plain else None


def _no_such_parameter(known: FilterInfo, name: str) -> str:
    names = [n for p in known.params for n in (p.name, p.keyword)]
    if not names:
        return f"{known.name} has no parameters"
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    if close:
        return f"{known.name} has no parameter {name!r}; did you mean {close[0]!r}?"
    return f"{known.name} has no parameter {name!r}, only {', '.join(p.name for p in known.params)}"


def _value(param: ParamInfo, setting: Setting) -> Value:
    from ..mlx import rich

    typed = [hyphened(choice) for choice in param.choices]
    if hyphened(setting.value) in typed:
        return typed.index(hyphened(setting.value))
    try:
        value = rich.parse_text(param.type, setting.value)
    except ValueError as error:
        choices = f"; the choices are {', '.join(param.choices)}" if param.choices else ""
        raise WrongUse(f"--set {setting.written}: {error}{choices}") from error
    return value
