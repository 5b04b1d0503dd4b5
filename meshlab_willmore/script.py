"""Filter scripts (`.mlx`): read, checked, run and written.

PyMeshLab runs scripts loosely: it skips what it does not understand, without a word. Here a script
is checked as a whole before its first step runs, and everything that is wrong with it is named::

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

from .meshset.check import Call, Findings, examine
from .meshset.modern import modernised
from .meshset.play import Played, play
from .mlx import write as _writing
from .mlx.decode import bytes_of
from .mlx.read import read, reading_of
from .mlx.steps import Fault, Param, Percentage, Reading, ScriptError, ScriptWarning, Step

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
    source = str(script) if isinstance(script, (str, os.PathLike)) else ""
    return [fault._replace(source=source) for fault in examined(script, mesh_ids).faults]


def warnings(script: Script) -> list[ScriptWarning]:
    """Find what one should know of a script that can run.

    Old names and what they are today, parameters that have gone or have no type, defaults that
    have changed since the script was written.

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
    source = str(script) if isinstance(script, (str, os.PathLike)) else ""
    return [warning._replace(source=source) for warning in examined(script).warnings]


def calls(script: Script, mesh_ids: Collection[int] | None = None) -> tuple[Call, ...]:
    """The filter calls that a script stands for, with filters and parameters looked up.

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
    before, after : callable, optional
        Called around each step, with the `Call` and with what was `Played`.

    Returns
    -------
    list of Played
        For each step its number, name, parameters, time and what it returned.

    Raises
    ------
    ScriptError
        With all faults of the script; then no step has run.
    pymeshlab.PyMeshLabException
        If a step fails; it is named, and the steps before it have had their effect.
    """
    ms = pymeshlab.MeshSet() if ms is None else ms
    checked = _without_fault(examined(script, [mesh.id() for mesh in ms]), script)
    return play(ms, checked, _name_of(script), before, after)


def write(path: str | os.PathLike[str], steps: Iterable[Step]) -> None:
    """Write steps as a filter script, in the words of MeshLab where they can be looked up.

    Parameters
    ----------
    path : str or path
        The file, which is replaced if it is there, as is one that a link leads to; it appears when
        it is whole. A pipe or device gets what is written.
    steps : iterable of Step
        PyMeshLab's names, old names, and parameters without a type become what MeshLab writes
        today; a step with a fault is written as it is.

    Raises
    ------
    ScriptError
        If a step says what no script can hold.
    OSError
        In one line, if the file can't be written.
    """
    _writing.write(path, modernised(steps))


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


def _name_of(script: Script) -> str:
    """What errors call a script."""
    return str(script) if isinstance(script, (str, os.PathLike)) else _UNNAMED


def _without_fault(found: Findings, script: Script) -> tuple[Call, ...]:
    if found.faults:
        raise ScriptError(_name_of(script), found.faults)
    return found.calls
