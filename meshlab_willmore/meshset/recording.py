"""The filter script of a set, with our filters in their place among the native steps.

PyMeshLab records native steps itself, and its script can hold no other: they stay there, as it
writes them. What is noted here is the place of our steps between them, and the ids of layers that
native steps were called with, where our filters have shifted them (see `ids`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from pymeshlab import MeshSet

from ..mlx.read import read, read_bytes
from ..mlx.steps import Param, Percentage, ScriptError, Step
from . import catalogue, native
from .check import faults_of, is_todays, modernised
from .filter import Filter
from .filter_info import keyword_of
from .filters import FILTERS

# The logical ids of a native step, by the keyword of the parameter.
Ids = dict[str, int]

NO_IDS: Ids = {}
_UNNAMED = "filter script"

# By set: the whole script in order. A `Step` is ours, or was loaded with others of ours; `Ids`
# belong to the next step of PyMeshLab's own script.
_entries: native.PerSet[list[Ids | Step] | None] = native.PerSet(None)
# By set: the file that the script was loaded from, if that holds ours.
_sources: native.PerSet[str] = native.PerSet(_UNNAMED)


def holds_more(ms: MeshSet) -> bool:
    """Whether the script of `ms` holds what PyMeshLab's own does not: our steps, or moved ids."""
    return any(isinstance(entry, Step) or entry for entry in _entries.get(ms) or ())


def steps_of(ms: MeshSet) -> tuple[Step, ...]:
    """All steps of the script of `ms`."""
    # What stands there has run, whatever it looks like.
    recorded = read_bytes(native.script_of(ms), _UNNAMED, strict=False)
    remaining = iter(recorded)
    entries = _in_step(_entries.get(ms) or [], len(recorded))
    return tuple(
        entry if isinstance(entry, Step) else _with_ids(next(remaining), entry) for entry in entries
    )


def put(ms: MeshSet, steps: Iterable[Step], source: str) -> None:
    """Make `steps`, which were read from `source`, the script of `ms`."""
    _sources.put(ms, source)
    native.clear_script(ms)
    _entries.put(ms, list(steps))


def source_of(ms: MeshSet) -> str:
    """What to call the script of `ms`: the file that it was loaded from, if it holds ours."""
    return _sources.get(ms)


def forget(ms: MeshSet) -> None:
    """Forget what was noted: PyMeshLab's own script was cleared, or filled by another."""
    if _sources.get(ms) != _UNNAMED:
        _sources.put(ms, _UNNAMED)
    if _entries.get(ms):
        _entries.put(ms, None)


def our_script(path: str) -> tuple[Step, ...] | None:
    """The steps of a file that needs this package; None for what is PyMeshLab's to load.

    That is a script that holds one of our filters, or can be run but has old names. What comes out
    of a pipe PyMeshLab could not read once more.

    Raises
    ------
    ScriptError
        If the file names one of our filters, but can't be read, or what a pipe gives can't.
    """
    is_pipe = _is_pipe(path)
    try:
        steps = read(path)
    except ScriptError:
        if is_pipe or _names_ours(path):
            raise
        return None
    found = (catalogue.find(step.filter) for step in steps)
    if is_pipe or any(known and known.is_willmore for known in found) or _is_ours_to_run(steps):
        return modernised(steps)
    return None


def _is_pipe(path: str) -> bool:
    try:
        return Path(path).is_fifo()
    except (OSError, ValueError):
        return False


def _is_ours_to_run(steps: tuple[Step, ...]) -> bool:
    """Whether steps can be run, but not by PyMeshLab, which knows no names but today's."""
    return not all(map(is_todays, steps)) and not faults_of(steps)


def _names_ours(path: str) -> bool:
    try:
        data = Path(path).read_bytes().replace(b"\0", b"")
    except (OSError, ValueError):
        return False
    names = (name for filter_ in FILTERS for name in (filter_.name, filter_.meshlab_name))
    return any(re.search(rf"""name\s*=\s*["']{name}["']""".encode(), data) for name in names)


# --- noting ------------------------------------------------------------------------------------


def catch_up(ms: MeshSet) -> None:
    """Make the place after all native steps so far the one for the next step of ours.

    Raises
    ------
    OSError
        If PyMeshLab can't write its script.
    """
    recorded = native.script_of(ms).count(b"<filter ")
    _entries.put(ms, _in_step(_entries.get(ms) or [], recorded))


def note_ours(ms: MeshSet, filter_: Filter, values: dict[str, Any]) -> None:
    """Append a step of ours, which was run with these values."""
    _append(ms, _step(filter_, values))


def note_native(ms: MeshSet, ids: Ids) -> None:
    """Append a native step, with the logical ids that it was called with."""
    _append(ms, ids)


def _append(ms: MeshSet, entry: Ids | Step) -> None:
    entries = _entries.get(ms)
    if entries is None:
        _entries.put(ms, [entry])
    else:
        entries.append(entry)


def _step(filter_: Filter, values: dict[str, Any]) -> Step:
    known = catalogue.find(filter_.name)
    assert known is not None
    params = []
    for parameter in filter_.parameters:
        kind = next(p.type for p in known.params if p.keyword == parameter.name)
        details = [("description", parameter.label), ("tooltip", parameter.tooltip)]
        if parameter.choices:
            details.append(("enum_cardinality", str(len(parameter.choices))))
            details += [(f"enum_val{i}", name) for i, name in enumerate(parameter.choices)]
        params.append(Param(parameter.name, kind, values[parameter.name], tuple(details)))
    return Step(filter_.meshlab_name, tuple(params))


# --- reading back ------------------------------------------------------------------------------


def _in_step(entries: list[Ids | Step], recorded: int) -> list[Ids | Step]:
    """The entries with one for each native step that PyMeshLab recorded, noted or not.

    Steps from before this package was imported come first. A caller who kept PyMeshLab's functions
    from then can also have cleared the script: its last steps are what is left.
    """
    extra = recorded - sum(not isinstance(entry, Step) for entry in entries)
    if extra < 0:
        native_places = [i for i, entry in enumerate(entries) if not isinstance(entry, Step)]
        gone = set(native_places[:-extra])
        return [entry for i, entry in enumerate(entries) if i not in gone]
    unnoted: list[Ids | Step] = [NO_IDS] * extra
    has_ours = any(isinstance(entry, Step) for entry in entries)
    return [*entries, *unnoted] if has_ours else [*unnoted, *entries]


def _with_ids(step: Step, ids: Ids) -> Step:
    if not ids:
        return step
    params = (p._replace(value=ids.get(keyword_of(p.name), p.value)) for p in step.params)
    return step._replace(params=tuple(params))


# --- printing ----------------------------------------------------------------------------------

_ROW = 4
_POINT = "numpy.ndarray[numpy.float64[3]]"

# PyMeshLab's names for the types of parameters.
_TYPE_NAMES = {
    "RichBool": "bool",
    "RichInt": "int",
    "RichMesh": "int",
    "RichFloat": "float",
    "RichDynamicFloat": "float (bounded)",
    "RichAbsPerc": "PercentageValue",
    "RichColor": "Color",
    "RichPosition": _POINT,
    "RichDirection": _POINT,
    "RichPoint3f": _POINT,
    "RichMatrix44f": "numpy.ndarray[numpy.float64[4, 4]]",
    "RichShotf": "Shotf [still unsupported]",
}


def listing(steps: Sequence[Step]) -> str:
    """The text of a script as `MeshSet.print_filter_script` prints it."""
    lines = [f"Filter Script Size : {len(steps)}", ""]
    for index, step in enumerate(steps):
        lines.append(f"{index}: {keyword_of(step.filter)}")
        lines += [f"\t{_line(step, param)}" for param in step.params]
        lines.append("")
    return "\n".join(lines)


def _line(step: Step, param: Param) -> str:
    kind = param.type
    if not kind:
        known = catalogue.find(step.filter)
        own = known.param(param.name) if known else None
        kind = own.type if own else ""
    show = _SHOWN.get(kind, _text)
    return f"{keyword_of(param.name)} : {_TYPE_NAMES.get(kind, 'str')} = {show(param)}"


def _text(param: Param) -> str:
    return f"'{param.value}'"


def _number(param: Param) -> str:
    return f"{param.value:g}" if isinstance(param.value, float) else str(param.value)


def _enum(param: Param) -> str:
    return f"'{dict(param.details).get(f'enum_val{param.value}', param.value)}'"


def _share(param: Param) -> str:
    """PyMeshLab prints a percentage, of the range that the script gives."""
    if isinstance(param.value, Percentage):
        return f"{param.value.percent:g}%"
    details = dict(param.details)
    low, high = float(details.get("min", 0)), float(details.get("max", 0))
    if high == low or not isinstance(param.value, (int, float)):
        return str(param.value)
    # The range has six digits, so the last one of the quotient means nothing.
    return f"{(param.value - low) / (high - low) * 100:.5g}%"


def _bounded(param: Param) -> str:
    details = dict(param.details)
    return f"{_number(param)} [min: {details.get('min', '')}; max: {details.get('max', '')}]"


def _joined(separator: str, ends: str = "[]") -> Callable[[Any], str]:
    def join(numbers: Any) -> str:
        return ends[0] + separator.join(f"{number:g}" for number in numbers) + ends[1]

    return join


_comma, _semicolon = _joined(", "), _joined("; ")


def _matrix(param: Param) -> str:
    values = param.value if isinstance(param.value, tuple) else ()
    rows = [_comma(values[i : i + _ROW]) for i in range(0, len(values), _ROW)]
    return f"[{','.join(rows)}]"


_SHOWN: dict[str, Callable[[Param], str]] = {
    "RichBool": lambda param: str(param.value),
    "RichInt": _number,
    "RichMesh": _number,
    "RichFloat": _number,
    "RichEnum": _enum,
    "RichAbsPerc": _share,
    "RichDynamicFloat": _bounded,
    "RichColor": lambda param: _semicolon(param.value),
    "RichPosition": lambda param: _comma(param.value),
    "RichDirection": lambda param: _comma(param.value),
    "RichPoint3f": lambda param: _comma(param.value),
    "RichMatrix44f": _matrix,
    "RichShotf": lambda _: "None",
}
