"""The filter script of a set, with our filters in their place among the native steps.

PyMeshLab records native steps itself, and its script can hold no other: they stay there, and what
is noted here is where our steps stand between them. Noted too is what PyMeshLab would write of a
native step in a way that does not come back: numbers (it writes six digits), text outside ASCII
(it writes in the encoding of the system), and ids of layers, which our filters shift (see
`numbering`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import nullcontext
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from pymeshlab import MeshSet

from ..mlx.read import read, read_bytes
from ..mlx.steps import Param, ScriptError, Step, Value
from . import catalogue, native, numbering
from .check import faults_of, is_todays
from .filter import Filter
from .filters import FILTERS
from .modern import modernised

Noted = dict[str, Value]

# Filters whose defaults can't be asked for without PyMeshLab printing something.
_TALKING = frozenset(
    {
        "compute_color_from_scalar_per_face",
        "compute_selection_by_scalar_per_face",
        "get_scalar_histogram_per_face",
    }
)

# What QString::number writes of a float.
_DIGITS_OF_MESHLAB = ".6g"


class _Native(NamedTuple):
    """The next step of PyMeshLab's own script, and exact values of it by keyword."""

    name: str
    exact: Noted


_UNNOTED = _Native("", {})

_UNNAMED = "filter script"

# By set: the whole script in order. A `Step` is ours, or was loaded with others of ours.
_entries: native.PerSet[tuple[_Native | Step, ...]] = native.PerSet(())
# By set: the file that the script was loaded from, if that holds ours.
_sources: native.PerSet[str] = native.PerSet(_UNNAMED)


def holds_more(ms: MeshSet) -> bool:
    """Whether the script of `ms` holds what PyMeshLab's own script does not.

    That is steps of ours, digits that it has lost, and ids of layers that have moved.
    """
    if native.is_rounded(ms) or any(isinstance(entry, Step) for entry in _entries.get(ms)):
        return True
    return numbering.has_moved(ms) and b'type="RichMesh"' in native.script_of(ms)


def steps_of(ms: MeshSet) -> tuple[Step, ...]:
    """All steps of the script of `ms`."""
    # What stands there has run, whatever it looks like.
    recorded = read_bytes(native.script_of(ms), _UNNAMED, strict=False)
    waiting = iter(recorded)
    entries = _in_step(_entries.get(ms), len(recorded))
    return tuple(
        entry if isinstance(entry, Step) else _with_exact(next(waiting), entry) for entry in entries
    )


def put(ms: MeshSet, steps: Iterable[Step], source: str) -> None:
    """Make `steps`, which were read from `source`, the script of `ms`."""
    _sources.put(ms, source)
    native.clear_script(ms)
    native.forget_rounding(ms)
    _entries.put(ms, tuple(steps))


def source_of(ms: MeshSet) -> str:
    """What to call the script of `ms`: the file that it was loaded from, if it holds ours."""
    return _sources.get(ms)


def forget(ms: MeshSet) -> None:
    """Forget what was noted: PyMeshLab's own script was cleared, or filled by another."""
    native.forget_rounding(ms)
    if _sources.get(ms) != _UNNAMED:
        _sources.put(ms, _UNNAMED)
    if _entries.get(ms):
        _entries.put(ms, ())


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
    if is_pipe or any(known and known.ours for known in found) or _is_ours_to_run(steps):
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
        with native.muted() if known.name in _TALKING else nullcontext():
            values = native.defaults(ms, known.name, **given)
    except native.ERRORS:
        # The call itself will say what is wrong with it.
        return {}
    return {key: read(ms, values[key]) for key, read in readers.items() if key in values}


def _array(_: MeshSet, values: Any) -> Value:
    return tuple(np.ravel(values).tolist())


_EXACT: dict[str, Callable[[MeshSet, Any], Value]] = {
    "RichFloat": lambda _, value: float(value),
    "RichDynamicFloat": lambda _, value: float(value),
    "RichAbsPerc": lambda _, value: float(value),
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
        same = _same(param.value, exact)
        params.append(param._replace(value=_shortest(exact)) if same else param)
    return step._replace(params=tuple(params))


def _same(written: Value, exact: Value) -> bool:
    """Whether PyMeshLab could have written the one for the other."""
    if isinstance(written, str) or isinstance(exact, str):
        return isinstance(exact, str)
    if isinstance(written, int):
        return isinstance(exact, int)
    return _digits(written) == _digits(exact)


def _shortest(value: Value) -> Value:
    """Numbers of single precision with the fewest digits that say them."""
    if isinstance(value, tuple):
        return tuple(_fewest_digits(number) for number in value)
    return _fewest_digits(value) if isinstance(value, float) else value


def _fewest_digits(number: float) -> float:
    with np.errstate(over="ignore"):
        single = np.float32(number)
    return float(str(single)) if float(single) == number else number


def _digits(value: Value) -> list[str]:
    return [format(number, _DIGITS_OF_MESHLAB) for number in np.ravel(np.array(value, dtype=float))]
