"""The passes of a run of flips, made of what the caller gives: a preset, a list, or options."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from . import options, presets

DEFAULT_PRESET = options.PRESET.default
# The energy to which `vertexnormals` adds something.
BENDS = "mean curvature"


class Pass(NamedTuple):
    """A pass: one search with its options, all checked.

    The fields are those of `meshlab_willmore.optimize_flips`, and:

    Attributes
    ----------
    counts_anew : bool
        Whether `maxdeviation` is counted from the beginning of this pass, and not from the input.
    """

    energy: str
    search: str
    depth: int
    breadth: int
    sweeps: int
    seed: int
    virtualpoint: str | float
    monotone: bool
    foldangle: float
    minshape: float
    maxdeviation: float | None
    checkintersections: bool
    maxflips: int | None
    atfolds: bool = False
    vertexnormals: bool = False
    mingain: float = 0.0
    counts_anew: bool = False


# What a pass may say for itself.
PASS_OPTIONS = tuple(name for name in Pass._fields if name != "counts_anew")


def check_combination(given: Mapping[str, Any]) -> None:
    """Raise `ValueError` if options that a preset or a list of passes decides are given beside it.

    Parameters
    ----------
    given : mapping
        The arguments that were given, by name; what has its default is left out.
    """
    preset = options.PRESET.checked(given.get("preset", DEFAULT_PRESET))
    has_passes = given.get("passes") is not None
    if has_passes and preset != DEFAULT_PRESET:
        raise ValueError(f"passes can't be given beside preset={preset!r}, which has its own")
    decided = presets.SEARCH_OPTIONS if has_passes else presets.decided_by(preset)
    wrong = [name for name in given if name in decided]
    if wrong and has_passes:
        raise ValueError(f"{wrong[0]} can't be given beside passes; give it in each of these")
    if wrong:
        raise ValueError(presets.conflict(wrong[0], preset))


def planned(
    preset: str,
    passes: Sequence[Mapping[str, Any]] | None,
    given: Mapping[str, Any],
    diagonal: float,
) -> tuple[Pass, ...]:
    """Return the passes of a run.

    Parameters
    ----------
    preset : str
    passes : sequence of mappings or None
        The options of each pass, in place of a preset.
    given : mapping
        A value for each of `PASS_OPTIONS` that the filter has too: for passes that do not say
        otherwise.
    diagonal : float
        Of the bounding box, in the unit of `maxdeviation`.

    Raises
    ------
    TypeError, ValueError
        If a value or a name is wrong.
    """
    if passes is not None:
        return _listed(passes, given)
    chosen = presets.PRESETS[preset]
    if not chosen.passes:
        return (_checked(given),)
    limit = given["maxdeviation"]
    if limit is None and chosen.maxdeviation < presets.FULL_DIAGONAL:
        limit = chosen.maxdeviation / presets.FULL_DIAGONAL * diagonal
    is_limited = any(one.stays_near for one in chosen.passes)
    plan = []
    for one in chosen.passes:
        gives_way = {
            name: value
            for name, value in one.defaults.items()
            if given[name] == options.BY_NAME[name].default
        }
        values = {**given, **gives_way, **one.options}
        if is_limited:
            values["maxdeviation"] = limit if one.stays_near else None
        plan.append(_checked(values)._replace(counts_anew=one.stays_near))
    return tuple(plan)


def _listed(passes: Sequence[Mapping[str, Any]], given: Mapping[str, Any]) -> tuple[Pass, ...]:
    if isinstance(passes, (str, Mapping)) or not isinstance(passes, Sequence):
        raise TypeError(f"passes must be a list of dicts, not {type(passes).__name__}")
    if not passes:
        raise ValueError("passes is empty; give at least one pass, such as dict(energy='willmore')")
    plan = []
    for number, one in enumerate(passes):
        where = f"passes[{number}]"
        if not isinstance(one, Mapping):
            raise TypeError(f"{where} must be a dict, not {type(one).__name__}")
        for name in one:
            if name not in PASS_OPTIONS:
                known = ", ".join(PASS_OPTIONS)
                raise ValueError(f"{where}: unknown option {name!r}; a pass can have {known}")
        try:
            checked = _checked({**given, **one})
        except (TypeError, ValueError) as error:
            raise type(error)(f"{where}: {error}") from None
        plan.append(checked._replace(counts_anew="maxdeviation" in one))
    return tuple(plan)


def _checked(values: Mapping[str, Any]) -> Pass:
    values = {**{option.name: option.default for option in options.OF_PASSES}, **values}
    found = Pass(**{name: options.BY_NAME[name].checked(values[name]) for name in PASS_OPTIONS})
    if found.vertexnormals and found.energy != BENDS:
        raise ValueError(f"vertexnormals needs the energy {BENDS!r}, not {found.energy!r}")
    if found.vertexnormals and found.atfolds:
        raise ValueError("vertexnormals can't be given beside atfolds: no fold has good normals")
    return found
