"""The filter script of a set, with our filters in their place among the native steps.

PyMeshLab records native steps itself, and its script can hold no other: they stay there, and what
is noted here is where our steps stand between them. Noted too is what PyMeshLab would write of a
native step in a way that does not come back: numbers (it writes six digits), text outside ASCII
(it writes in the encoding of the system), and ids of layers, which our filters shift (see
`numbering`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from pymeshlab import MeshSet

from ..mlx.read import read, read_bytes
from ..mlx.steps import Param, ScriptError, Step, Value
from . import catalogue, native, numbering
from .filters import FILTERS, Filter

Noted = dict[str, Value]

# What QString::number writes of a float.
_DIGITS_OF_MESHLAB = ".6g"


class _Native(NamedTuple):
    """The next step of PyMeshLab's own script, and exact values of it by keyword."""

    name: str
    exact: Noted


_UNNOTED = _Native("", {})

# By set: the whole script in order. A `Step` is ours, or was loaded with others of ours.
_entries: native.PerSet[tuple[_Native | Step, ...]] = native.PerSet(())


def holds_more(ms: MeshSet) -> bool:
    """Whether the script of `ms` has steps that PyMeshLab's own script does not hold."""
    return any(isinstance(entry, Step) for entry in _entries.get(ms))


def steps_of(ms: MeshSet) -> tuple[Step, ...]:
    """All steps of the script of `ms`."""
    recorded = read_bytes(native.script_of(ms), "filter script")
    waiting = iter(recorded)
    entries = _in_step(_entries.get(ms), len(recorded))
    return tuple(
        entry if isinstance(entry, Step) else _with_exact(next(waiting), entry) for entry in entries
    )


def put(ms: MeshSet, steps: Iterable[Step]) -> None:
    """Make `steps` the script of `ms`."""
    native.clear_script(ms)
    _entries.put(ms, tuple(steps))


def forget(ms: MeshSet) -> None:
    """Forget what was noted: PyMeshLab's own script was cleared, or filled by another."""
    if _entries.get(ms):
        _entries.put(ms, ())


def our_script(path: str) -> tuple[Step, ...] | None:
    """The steps of a file that holds one of our filters; None for what is PyMeshLab's to load.

    Raises
    ------
    ScriptError
        If the file names one of our filters, but can't be read.
    """
    try:
        steps = read(path)
    except ScriptError:
        if _names_ours(path):
            raise
        return None
    found = (catalogue.find(step.filter) for step in steps)
    return steps if any(known and known.ours for known in found) else None


def _names_ours(path: str) -> bool:
    try:
        data = Path(path).read_bytes().replace(b"\0", b"")
    except (OSError, ValueError):
        return False
    names = (name for filter_ in FILTERS for name in (filter_.name, filter_.meshlab_name))
    return any(name.encode() in data for name in names)


# --- noting ------------------------------------------------------------------------------------


def catch_up(ms: MeshSet) -> None:
    """Make the place after all native steps so far the one for the next step of ours.

    Raises
    ------
    OSError
        If PyMeshLab can't write its script.
    """
    recorded = native.script_of(ms).count(b"<filter ")
    _entries.put(ms, _in_step(_entries.get(ms), recorded))


def note_ours(ms: MeshSet, filter_: Filter, values: dict[str, Any]) -> None:
    """Append a step of ours, which was run with these values."""
    _entries.put(ms, (*_entries.get(ms), _step(filter_, values)))


def note_native(ms: MeshSet, name: str, exact: Noted) -> None:
    """Note the exact values of a native step that PyMeshLab has just recorded."""
    _entries.put(ms, (*_entries.get(ms), _Native(name, exact)))


def exact_values(ms: MeshSet, name: object, given: dict[str, Any]) -> Noted:
    """The values of a native call that its recorded step would not hold exactly, by keyword."""
    known = catalogue.find(name) if isinstance(name, str) else None
    readers = {p.keyword: _EXACT[p.type] for p in known.params if p.type in _EXACT} if known else {}
    if not known or not readers:
        return {}
    try:
        with native.muted():
            values = native.defaults(ms, known.name, **given)
    except Exception:
        # The call itself will say what is wrong with it.
        return {}
    return {key: read(ms, values[key]) for key, read in readers.items() if key in values}


def _shortest(number: float) -> float:
    """The float with the fewest digits that is the same number in single precision."""
    with np.errstate(over="ignore"):
        single = np.float32(number)
    return float(str(single)) if float(single) == number else float(number)


def _array(_: MeshSet, values: Any) -> Value:
    return tuple(_shortest(value) for value in np.ravel(values))


_EXACT: dict[str, Callable[[MeshSet, Any], Value]] = {
    "RichFloat": lambda _, value: _shortest(value),
    "RichDynamicFloat": lambda _, value: _shortest(value),
    "RichAbsPerc": lambda _, value: _shortest(value),
    "RichPosition": _array,
    "RichDirection": _array,
    "RichMatrix44f": _array,
    "RichString": lambda _, value: value,
    "RichOpenFile": lambda _, value: value,
    "RichSaveFile": lambda _, value: value,
    "RichMesh": numbering.logical_id,
}


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


def _in_step(entries: tuple[_Native | Step, ...], recorded: int) -> tuple[_Native | Step, ...]:
    """The entries with one for each native step that PyMeshLab recorded, noted or not.

    Steps from before this package was imported come first. Whoever kept PyMeshLab's functions from
    then can also have cleared the script: its last steps are what is left.
    """
    extra = recorded - sum(isinstance(entry, _Native) for entry in entries)
    if extra < 0:
        return tuple(_without_first(entries, -extra))
    unnoted = (_UNNOTED,) * extra
    has_ours = any(isinstance(entry, Step) for entry in entries)
    return (*entries, *unnoted) if has_ours else (*unnoted, *entries)


def _without_first(entries: tuple[_Native | Step, ...], surplus: int) -> Iterator[_Native | Step]:
    for entry in entries:
        if isinstance(entry, _Native) and surplus:
            surplus -= 1
        else:
            yield entry


def _with_exact(step: Step, noted: _Native) -> Step:
    known = catalogue.find(step.filter)
    if known is None or known.name != noted.name:
        return step
    params = []
    for param in step.params:
        exact = noted.exact.get(catalogue.keyword_of(param.name), param.value)
        params.append(param._replace(value=exact) if _same(param.value, exact) else param)
    return step._replace(params=tuple(params))


def _same(written: Value, exact: Value) -> bool:
    """Whether PyMeshLab could have written the one for the other."""
    if isinstance(written, str) or isinstance(exact, str):
        return isinstance(exact, str)
    if isinstance(written, int):
        return isinstance(exact, int)
    return _digits(written) == _digits(exact)


def _digits(value: Value) -> list[str]:
    return [format(number, _DIGITS_OF_MESHLAB) for number in np.ravel(np.array(value, dtype=float))]
