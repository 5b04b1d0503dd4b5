"""The parameters of a step brought to the names and values of today's filter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ..mlx.steps import Param, Step, Value, quoted
from . import old_names
from .catalogue import FilterInfo
from .old_names import OldParam
from .parameter_info import ParamInfo

_OPAQUE = 255
# What MeshLab's old filter for one colour had for a part that is not given.
_FULL = 255
# Attributes that say the same of a parameter whatever becomes of its value.
_DESCRIBING = frozenset({"description", "tooltip"})


class Given(NamedTuple):
    """A parameter under today's name, and the name that the script shows."""

    shown: str
    param: Param


class Remark(NamedTuple):
    """What one should know of a parameter."""

    shown: str
    text: str
    changes_result: bool = False


class Migration:
    """The parameters of one step, as today's filter has them.

    Attributes
    ----------
    given : list of Given
        Under the names of today's filter; those that it never had are left as they are.
    remarks : list of Remark
        What is not called or meant as it was.
    problems : list of Remark
        Values that can't be taken over.
    age : int, optional
        At most how new the script is (see `old_names.age`), by what its parameters show.
    """

    def __init__(self, step: Step, known: FilterInfo, given: Mapping[str, Value], by: str) -> None:
        self.given: list[Given] = []
        self.remarks: list[Remark] = []
        self.problems: list[Remark] = []
        self.age: int | None = None
        self._known = known
        self._parts: dict[str, list[tuple[str, OldParam, Value]]] = {}
        for param in step.params:
            if not by or param.name.strip() != by:
                self._take(param)
        self.given += self._colours()
        there = {known.param(item.param.name) for item in self.given}
        for name, value in given.items():
            if known.param(name) not in there:
                self.given.append(Given(name, Param(name, "", value)))

    def _take(self, param: Param) -> None:
        self._make_older(old_names.age_of_attributes(param))
        own = self._known.param(old_names.plain(param.name))
        olds = () if own else old_names.params_of(self._known.name, param.name)
        if own:
            as_today = self._in_todays_symbols(own, self._in_todays_choices(own, param))
            self.given.append(Given(param.name, as_today._replace(name=own.name)))
        elif not olds:
            self.given.append(Given(param.name, param))
        for old in olds:
            self._make_older(old_names.age(old.until))
            try:
                self.given += self._converted(param, old)
            except ValueError as error:
                self.problems.append(Remark(param.name, str(error)))

    def _converted(self, param: Param, old: OldParam) -> Iterator[Given]:
        value = old_names.value_then(param, old)
        more = f": {old.note}" if old.note else ""
        if old.param is None:
            is_idle = old.idle in ("any", value)
            text = f"is ignored: the filter has had none such since MeshLab {old.until}{more}"
            self.remarks.append(Remark(param.name, text, changes_result=not is_idle))
            return
        text = f"is {old.param!r} today{more}"
        self.remarks.append(Remark(param.name, text, changes_result=bool(more)))
        new = old_names.convert(value, old)
        if "part" in old.change:
            self._parts.setdefault(old.param, []).append((param.name, old, new))
        elif old.change:
            kept = tuple(pair for pair in param.details if pair[0] in _DESCRIBING)
            yield Given(param.name, Param(old.param, "", new, kept))
        else:
            yield Given(param.name, param._replace(name=old.param))

    def _colours(self) -> Iterator[Given]:
        """Colours whose parts were parameters of their own."""
        for name, parts in self._parts.items():
            colour = [_FULL, _FULL, _FULL, _OPAQUE]
            for shown, old, value in parts:
                if not isinstance(value, (int, float)) or not 0 <= value <= _FULL:
                    self.problems.append(Remark(shown, f"is not between 0 and {_FULL}"))
                else:
                    colour[old.change["part"]] = int(value)
            yield Given(parts[0][0], Param(name, "", tuple(colour)))

    def _in_todays_choices(self, own: ParamInfo, param: Param) -> Param:
        """The parameter; an enum whose choices stood in another order gets today's index."""
        if not param.type and isinstance(param.value, str) and param.value not in own.choices:
            return self._by_old_choice(own, param)
        if param.type != "RichEnum" or not isinstance(param.value, int):
            return param
        details = dict(param.details)
        names = {key: name for key, name in details.items() if key.startswith("enum_val")}
        for old in old_names.choices_of(self._known.name, own.name):
            then = {f"enum_val{i}": name for i, name in enumerate(old.old)}
            fits = details.get("enum_cardinality", "").strip() == str(len(then))
            # Without names, only another number of choices tells.
            tells = bool(names) or len(then) != len(own.choices)
            if fits and tells and names.items() <= then.items() and param.value < len(then):
                self._make_older(old_names.age(old.until))
                return self._renumbered(own, param, old.old[param.value], old)
        return param

    def _by_old_choice(self, own: ParamInfo, param: Param) -> Param:
        """The parameter; a choice that is given by the name that it had gets today's index."""
        for old in old_names.choices_of(self._known.name, own.name):
            if param.value in old.old:
                self._make_older(old_names.age(old.until))
                return param._replace(value=old.now[old.old.index(str(param.value))])
        return param

    def _renumbered(
        self, own: ParamInfo, param: Param, name: str, old: old_names.OldChoices
    ) -> Param:
        assert isinstance(param.value, int)
        index = old.now[param.value]
        today = own.choices[index]
        if name != today and name in own.choices:
            more = f"; {old.note}" if old.note else ""
            text = f"choice {param.value}, {quoted(name)}, is {index}, {today!r}, today{more}"
            self.remarks.append(Remark(param.name, text))
        elif index != param.value:
            text = f"choice {param.value}, {quoted(name)}, is {index} today"
            self.remarks.append(Remark(param.name, text))
        kept = tuple(pair for pair in param.details if not pair[0].startswith("enum_"))
        return Param(param.name, "", index, kept)

    def _in_todays_symbols(self, own: ParamInfo, param: Param) -> Param:
        value, age = old_names.in_todays_symbols(self._known.name, own.name, param.value)
        if age is None:
            return param
        self._make_older(age)
        self.remarks.append(Remark(param.name, "formulas have '&&' for 'and', '||' for 'or' today"))
        return param._replace(value=value)

    def _make_older(self, age: int | None) -> None:
        if age is not None:
            self.age = age if self.age is None else min(self.age, age)
