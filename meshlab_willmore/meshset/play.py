"""Running the checked steps of a filter script on a set of meshes.

Native steps are run by PyMeshLab's own filter functions, with the script's values. (PyMeshLab can
run a whole script, but does not report what a step returned or which one failed.)
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import pymeshlab
from pymeshlab import MeshSet

from ..markup import plain
from ..mlx.steps import Percentage
from ..progress import Listen, listening, stage, was_raised_by_listener
from . import document, layers, native, native_calls
from .check import Call
from .filter import apply, values_of
from .filters import BY_NAME

_log = logging.getLogger(__name__)

_MATRIX_SIDE = 4


class Played(NamedTuple):
    """A step that was run.

    Attributes
    ----------
    number : int
        Its place in the script, from 1.
    name : str
        The filter's name in PyMeshLab.
    given : dict
        The parameters that the script gives, by PyMeshLab's keyword, as they were passed.
    seconds : float
        How long it took.
    returned : dict
        What the filter returned.
    """

    number: int
    name: str
    given: dict[str, Any]
    seconds: float
    returned: dict[str, Any]


def play(
    ms: MeshSet,
    calls: Sequence[Call],
    source: str = "filter script",
    before: Callable[[Call], None] | None = None,
    after: Callable[[Played], None] | None = None,
    progress: Listen | None = None,
) -> list[Played]:
    """Run calls, one after the other; nothing is written into the set's own filter script.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
        Changed in place.
    calls : sequence of Call
        Checked steps. Mesh ids in them count as if our filters worked in place.
    source : str
        What error messages call the script.
    before, after : callable, optional
        Called around each step.
    progress : callable, optional
        As for `meshlab_willmore.script.run`.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If a step fails; the steps before it have had their effect.
    Cancelled
        If `progress` returns False.
    """
    done: list[Played] = []
    with listening(progress), native.unrecorded(ms):
        for call in calls:
            name = f"step {call.number} ({call.known.name})"
            with stage(1.0 / (len(calls) - len(done)), name):
                if before is not None:
                    before(call)
                with native.kept_working_folder():
                    played = _play_one(ms, call, source)
                _log.info("%s: %s of %s, %.3f s", source, name, len(calls), played.seconds)
                done.append(played)
                if after is not None:
                    after(played)
    return done


def _play_one(ms: MeshSet, call: Call, source: str) -> Played:
    name = call.known.name
    start = time.perf_counter()
    try:
        given = {key: _native_value(call, key, value) for key, value in call.given.items()}
        layers.sweep(ms)
        if document.is_step(name):
            returned = document.play(ms, name, given)
        elif call.known.is_willmore:
            returned = apply(ms, BY_NAME[name], values_of(ms, BY_NAME[name], given))
        else:
            if call.known.needs_mesh and native.ids(ms):
                # Without a current mesh this raises, and PyMeshLab's filters would crash.
                native.current_mesh(ms)
            with native_calls.prepared(ms, name, given) as completed:
                returned = native.apply(ms, name, **completed)
    except Exception as error:
        if was_raised_by_listener(error):
            raise
        if not call.known.is_willmore:
            native.forget_failures()
        raise pymeshlab.PyMeshLabException(
            f"{source}, step {call.number} ({name}): {_reason(error, call)}"
        ) from error
    return Played(call.number, name, given, time.perf_counter() - start, returned)


def _reason(error: Exception, call: Call) -> str:
    """The message without markup and without PyMeshLab's prefix, since the step is named."""
    name, given = call.known.name, call.given.values()
    text = str(error)
    for start in (f"Failed to apply filter: {name}", f"Failed to apply filter:  '{name}."):
        text = text.removeprefix(start)
    if not call.known.is_willmore:
        text = plain(text, *(value for value in given if isinstance(value, str)))
    return text.strip().removeprefix("Details: ") or type(error).__name__


def _native_value(call: Call, keyword: str, value: Any) -> Any:
    """The value as PyMeshLab's filter functions take it."""
    param = call.known.param(keyword)
    kind = param.type if param else ""
    if isinstance(value, Percentage):
        return pymeshlab.PercentageValue(value.percent)
    if kind == "RichAbsPerc":
        return pymeshlab.PureValue(value)
    if kind == "RichColor":
        return pymeshlab.Color(*value)
    if isinstance(value, tuple):
        array = np.array(value, dtype=float)
        is_matrix = len(array) == _MATRIX_SIDE * _MATRIX_SIDE
        return array.reshape(_MATRIX_SIDE, _MATRIX_SIDE) if is_matrix else array
    return value
