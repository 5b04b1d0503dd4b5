"""The filter script of a set, with our steps among the native ones.

PyMeshLab records native steps itself, and its script can hold no others. Recorded here are our
steps, their places among the native ones, and the logical ids of layers that native steps were
called with, where our filters have shifted the ids (see `ids`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pymeshlab import MeshSet

from ..mlx.steps import Param, Percentage, ScriptError, Step
from ..temporary_files import temporary_folder
from . import catalogue, native
from .check import faults_of, is_todays, modernised, with_choices
from .filter import Filter
from .filter_info import keyword_of
from .filters import FILTERS

# Modules that read and write XML are imported where they are used: they take as long to import as
# the rest of this package, and many programs have no scripts.

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
    from ..mlx.read import read_bytes

    # These steps have run, so they are not checked.
    recorded = read_bytes(native.script_of(ms), _UNNAMED, strict=False)
    remaining = iter(recorded)
    entries = _in_step(_entries.get(ms) or [], len(recorded))
    return tuple(
        entry if isinstance(entry, Step) else _with_ids(next(remaining), entry) for entry in entries
    )


def save(ms: MeshSet, path: str) -> None:
    """Write the script of `ms` into a file.

    Raises
    ------
    OSError
        If the file can't be written.
    ScriptError
        If a step has a value that no script can hold.
    """
    from ..mlx.write import write

    write(path, steps_of(ms))


def put(ms: MeshSet, steps: Iterable[Step], source: str) -> None:
    """Make `steps`, which were read from `source`, the script of `ms`."""
    _sources.put(ms, source)
    native.clear_script(ms)
    _entries.put(ms, list(steps))


def source_of(ms: MeshSet) -> str:
    """The name of the script of `ms`: the file that it was loaded from, if it holds ours."""
    return _sources.get(ms)


def forget(ms: MeshSet) -> None:
    """Forget what was recorded: PyMeshLab's own script was cleared, or replaced."""
    if _sources.get(ms) != _UNNAMED:
        _sources.put(ms, _UNNAMED)
    if _entries.get(ms):
        _entries.put(ms, None)


def script_to_load(path: str) -> tuple[Step, ...] | None:
    """The steps of a file that needs this package; None for a script that PyMeshLab can load.

    This package is needed for scripts with our filters, for those that can be run but have old
    names, and for pipes, which can be read only once.

    Raises
    ------
    ScriptError
        If a file that names one of our filters can't be read, or a pipe can't.
    """
    from ..mlx.read import read

    is_pipe = _is_pipe(path)
    try:
        steps = read(path)
    except ScriptError:
        if is_pipe or _names_willmore_filter(path):
            raise
        return None
    found = (catalogue.find(step.filter) for step in steps)
    if is_pipe or any(known and known.is_willmore for known in found) or _has_old_names(steps):
        return modernised(steps)
    return None


def _is_pipe(path: str) -> bool:
    try:
        return Path(path).is_fifo()
    except (OSError, ValueError):
        return False


def _has_old_names(steps: tuple[Step, ...]) -> bool:
    """Whether steps can be run, but not by PyMeshLab, which knows only today's names."""
    return not all(map(is_todays, steps)) and not faults_of(steps)


def _names_willmore_filter(path: str) -> bool:
    try:
        data = Path(path).read_bytes().replace(b"\0", b"")
    except (OSError, ValueError):
        return False
    names = (name for filter_ in FILTERS for name in (filter_.name, filter_.meshlab_name))
    return any(re.search(rf"""name\s*=\s*["']{name}["']""".encode(), data) for name in names)


# --- noting ------------------------------------------------------------------------------------


def catch_up(ms: MeshSet) -> None:
    """Make room for the next step of ours after all native steps so far.

    Raises
    ------
    OSError
        If PyMeshLab can't write its script.
    """
    recorded = native.script_of(ms).count(b"<filter ")
    _entries.put(ms, _in_step(_entries.get(ms) or [], recorded))


def note_step(ms: MeshSet, filter_: Filter, values: dict[str, Any]) -> None:
    """Append a step of ours, which was run with these values."""
    _append(ms, _step(filter_, values))


def note_native_step(ms: MeshSet, ids: Ids) -> None:
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
    barred = filter_.barred(values)
    for parameter, info in zip(filter_.parameters, known.params, strict=True):
        if parameter.name in barred:
            continue
        details = (("description", parameter.label), ("tooltip", parameter.tooltip))
        value = values[parameter.name]
        params.append(Param(info.name, info.type, value, with_choices(info, details)))
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
        dropped = set(native_places[:-extra])
        return [entry for i, entry in enumerate(entries) if i not in dropped]
    unnoted: list[Ids | Step] = [NO_IDS] * extra
    has_steps = any(isinstance(entry, Step) for entry in entries)
    return [*entries, *unnoted] if has_steps else [*unnoted, *entries]


def _with_ids(step: Step, ids: Ids) -> Step:
    if not ids:
        return step
    params = (p._replace(value=ids.get(keyword_of(p.name), p.value)) for p in step.params)
    return step._replace(params=tuple(params))


# --- printing ----------------------------------------------------------------------------------

# A percentage of this range is printed as it is.
_PERCENT_RANGE = (("min", "0"), ("max", "100"))


def listing(steps: Iterable[Step]) -> str:
    """The text that PyMeshLab prints of a script, which it reads from a file for it."""
    from ..mlx.write import write

    with temporary_folder() as folder:
        path = folder / "script.mlx"
        write(path, map(_with_ranges, steps))
        return native.script_listing(path)


def _with_ranges(step: Step) -> Step:
    """The step with a range for each percentage, which PyMeshLab can't read without one."""
    return step._replace(
        params=tuple(
            p._replace(value=p.value.percent, details=_PERCENT_RANGE)
            if isinstance(p.value, Percentage)
            else p
            for p in step.params
        )
    )
