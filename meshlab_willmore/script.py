"""Filter scripts (`.mlx`): read, checked, run and written.

PyMeshLab skips what it does not understand in a script, and reports nothing. Here a script is
checked as a whole before its first step runs, and all faults are named::

    from meshlab_willmore import script

    for fault in script.check("clean.mlx"):
        print(fault)
    for step in script.run("clean.mlx", ms):
        print(step.number, step.name, step.seconds, step.returned)
"""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable
from pathlib import Path

import pymeshlab

from .meshset.check import Call, Findings, examine, modernised
from .meshset.play import Played, play
from .mlx.decode import bytes_of
from .mlx.read import read, reading_of
from .mlx.steps import Fault, Param, Percentage, Reading, ScriptError, ScriptWarning, Step
from .mlx.write import write as _write
from .progress import Listen

__all__ = [
    "Call",
    "Fault",
    "Param",
    "Percentage",
    "Played",
    "ScriptError",
    "ScriptWarning",
    "Step",
    "calls",
    "check",
    "examined",
    "read",
    "run",
    "warnings",
    "write",
]

Script = str | os.PathLike[str] | Iterable[Step]

_UNNAMED = "filter script"


def check(script: Script, mesh_ids: Collection[int] | None = None) -> list[Fault]:
    """Find all that is wrong with a script, without running it.

    Parameters
    ----------
    script : path or iterable of Step
        A file, or the steps themselves.
    mesh_ids : collection of int, optional
        Ids of the layers that are there when the script starts; not checked if they aren't known.

    Returns
    -------
    list of Fault
        Empty if the script can run.
    """
    source = _path_of(script)
    return [fault._replace(source=source) for fault in examined(script, mesh_ids).faults]


def warnings(script: Script) -> list[ScriptWarning]:
    """Find what has changed since a script was written, though it can run.

    Old names and what they are today, parameters that no longer exist or have no type, other
    defaults.

    Parameters
    ----------
    script : path or iterable of Step
        A file, or the steps themselves.

    Returns
    -------
    list of ScriptWarning
        In the order of the steps. Where `changes_result` is true, the step does something else than
        it did in the MeshLab that the script was written for.
    """
    source = _path_of(script)
    return [warning._replace(source=source) for warning in examined(script).warnings]


def calls(script: Script, mesh_ids: Collection[int] | None = None) -> tuple[Call, ...]:
    """The filter calls that a script makes, with filters and parameters looked up.

    Raises
    ------
    ScriptError
        With all faults of the script.
    """
    return _without_fault(examined(script, mesh_ids), script)


def run(
    script: Script,
    ms: pymeshlab.MeshSet | None = None,
    *,
    progress: Listen | None = None,
    before: Callable[[Call], None] | None = None,
    after: Callable[[Played], None] | None = None,
) -> list[Played]:
    """Check a script, then run it on a set of meshes.

    Parameters
    ----------
    script : path or iterable of Step
        A file, or the steps themselves.
    ms : pymeshlab.MeshSet, optional
        Changed in place; an empty one is made for a script that creates its own mesh. Its own
        filter script stays as it is.
    progress : callable, optional
        Called with the fraction that is done and a text that names the step: when a step begins,
        while one of this package's filters works, at most ten times a second, and last with exactly
        1. All steps count the same. If it returns False, or raises an exception, no further step
        runs, and a filter of this package leaves its mesh as it was; native filters can't be
        stopped.
    before, after : callable, optional
        Called before each step with its `Call`, and after it with what was `Played`.

    Returns
    -------
    list of Played
        For each step its number, name, parameters, time and what it returned.

    Raises
    ------
    ScriptError
        With all faults of the script; then no step has run.
    pymeshlab.PyMeshLabException
        If a step fails; its number and name are in the message. The steps before it stay done.
    Cancelled
        If `progress` returns False. The steps before stay done.
    """
    ms = pymeshlab.MeshSet() if ms is None else ms
    checked = _without_fault(examined(script, [mesh.id() for mesh in ms]), script)
    return play(ms, checked, _path_of(script) or _UNNAMED, before, after, progress)


def write(path: str | os.PathLike[str], steps: Iterable[Step]) -> None:
    """Write steps as a filter script, with MeshLab's names where they can be looked up.

    Parameters
    ----------
    path : str or path
        The file, which is written atomically. An existing file is replaced, also where a link
        leads to it. A pipe or device gets the text.
    steps : iterable of Step
        PyMeshLab's names, old names, and parameters without a type become what MeshLab writes
        today; a step with a fault is written as it is.

    Raises
    ------
    ScriptError
        If no script can hold what a step says.
    OSError
        In one line, if the file can't be written.
    """
    _write(path, modernised(steps))


def examined(script: Script, mesh_ids: Collection[int] | None = None) -> Findings:
    """All that a check finds in a script: calls, faults, warnings, and the steps themselves."""
    if not isinstance(script, (str, os.PathLike)):
        return examine(Reading(tuple(script)), mesh_ids)
    try:
        data = bytes_of(Path(script))
    except ScriptError as error:
        return _unreadable(error)
    return examined_bytes(data, str(script), mesh_ids)


def examined_bytes(data: bytes, source: str, mesh_ids: Collection[int] | None = None) -> Findings:
    """All that a check finds in the text of a script, which messages call `source`."""
    try:
        reading = reading_of(data, source)
    except ScriptError as error:
        return _unreadable(error)
    return examine(reading, mesh_ids)


def _unreadable(error: ScriptError) -> Findings:
    return Findings((), error.faults, (), Reading((), error.faults))


def _path_of(script: Script) -> str:
    """The path of a script; empty for steps that are in no file."""
    return str(script) if isinstance(script, (str, os.PathLike)) else ""


def _without_fault(found: Findings, script: Script) -> tuple[Call, ...]:
    if found.faults:
        raise ScriptError(_path_of(script) or _UNNAMED, found.faults)
    return found.calls
