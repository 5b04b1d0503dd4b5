"""What PyMeshLab itself can tell of a filter: keywords, kinds and choices of its parameters.

It takes a mesh to ask, and some filters crash where there is none: one is made here, and nobody
else sees it.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import pymeshlab
from pymeshlab import MeshSet

from . import native

# A value that no flag, number, enum or percentage takes.
_NO_VALUE = "no such value"
_UNSUPPORTED = "still_unsupported"
_MATRIX_SIZE = 16
_ENOUGH = 3
_ANOTHER_ID = 3
# PyMeshLab's exceptions have no common base.
_REFUSALS = (pymeshlab.PyMeshLabException, pymeshlab.InvalidEnumException, RuntimeError)


class ParamInfo(NamedTuple):
    """A parameter of a filter.

    Attributes
    ----------
    name, keyword : str
        The name in MeshLab, and PyMeshLab's keyword.
    type : str
        "RichBool", "RichFloat", ...
    choices : tuple of str
        The values of an enum.
    required : bool
        Whether the filter fails without it.
    guessed : bool
        Whether only PyMeshLab told of it: MeshLab's name for it is not known, its type a guess.
    """

    name: str
    keyword: str
    type: str
    choices: tuple[str, ...]
    required: bool
    guessed: bool = False


def params(name: str) -> tuple[ParamInfo, ...]:
    """The parameters of a native filter, as far as PyMeshLab tells; MeshLab's names it does not."""
    return tuple(_param(name, key, value) for key, value in _values(name).items())


def brought_up_to_date(name: str, recorded: tuple[ParamInfo, ...]) -> tuple[ParamInfo, ...]:
    """The parameters that a filter has now, of one that was recorded with another PyMeshLab."""
    values = _values(name)
    if not values:
        return recorded
    by_keyword = {param.keyword: param for param in recorded}
    return tuple(by_keyword.get(key) or _param(name, key, value) for key, value in values.items())


def partners(name: str, keywords: Iterable[str], count: int, current: int) -> dict[str, int]:
    """The places, in a set of `count` meshes, of those that a native filter takes by itself.

    Parameters
    ----------
    name : str
    keywords : iterable of str
        Its parameters that are meshes.
    count, current : int
        How many meshes there are, and the place of the current one, from 0.
    """
    # It is the current one, or one of the first two; so the third stands for all after it.
    place = min(current, _ENOUGH - 1)
    values = _defaults_among(name, min(count, _ENOUGH), place)
    found = {key: values[key] for key in keywords if key in values}
    return {key: current if value == place else value for key, value in found.items()}


@functools.cache
def _defaults_among(name: str, count: int, current: int) -> dict[str, Any]:
    ms = _triangles(count)
    native.make_current(ms, current)
    try:
        with native.muted():
            return native.defaults(ms, name)
    except _REFUSALS:
        return {}


def _values(name: str) -> dict[str, Any]:
    """The filter's defaults; empty if PyMeshLab can't tell them either."""
    try:
        with native.muted():
            return native.defaults(_asked(), name)
    except _REFUSALS:
        return {}


def _param(name: str, key: str, value: Any) -> ParamInfo:
    choices: tuple[str, ...] = ()
    kind = _kind(value)
    # Enums look like numbers, and percentages like floats; what they refuse gives them away.
    if kind == "RichInt" and _is_layer(name, key, value):
        kind = "RichMesh"
    elif kind == "RichInt":
        refusal = _refusal(name, **{key: _NO_VALUE})
        if isinstance(refusal, pymeshlab.InvalidEnumException):
            kind, choices = "RichEnum", _choices(str(refusal))
    elif kind == "RichFloat" and _refusal(name, **{key: value}):
        kind = "RichAbsPerc"
    return ParamInfo(key, key, kind, choices, required=False, guessed=True)


def _is_layer(name: str, key: str, value: Any) -> bool:
    """Whether a default is the id of the mesh, in two sets where that has different ids."""
    with native.muted():
        later = native.defaults(_asked_later(), name)
    return (value, later.get(key)) == tuple(native.ids(s)[0] for s in (_asked(), _asked_later()))


def _kind(value: Any) -> str:
    if isinstance(value, bool):
        return "RichBool"
    if isinstance(value, int):
        return "RichInt"
    if isinstance(value, float):
        return "RichFloat"
    if isinstance(value, pymeshlab.Color):
        return "RichColor"
    if isinstance(value, str):
        return "RichShotf" if value == _UNSUPPORTED else "RichString"
    return "RichMatrix44f" if np.size(value) == _MATRIX_SIZE else "RichPosition"


def _refusal(name: str, **given: Any) -> Exception | None:
    try:
        with native.muted():
            native.defaults(_asked(), name, **given)
    except _REFUSALS as error:
        return error
    return None


def _choices(refusal: str) -> tuple[str, ...]:
    """The choices out of "... Possible values are 'a'; 'b'; "."""
    listed = refusal.partition(" values are '")[2].rpartition("'; ")[0]
    return tuple(listed.split("'; '"))


@functools.cache
def _asked() -> MeshSet:
    return _triangles(1)


@functools.cache
def _asked_later() -> MeshSet:
    """The same as `_asked`, but the id of its mesh is another."""
    ms = _triangles(_ANOTHER_ID + 1)
    for mesh_id in range(_ANOTHER_ID):
        native.make_current(ms, mesh_id)
        native.apply(ms, "delete_current_mesh")
    return ms


def _triangles(count: int) -> MeshSet:
    """A set of triangles that have what some filters need to be asked."""
    ms = MeshSet()
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    values = {"v_scalar_array": np.arange(3.0), "f_scalar_array": np.arange(1.0)}
    for _ in range(count):
        native.add(ms, pymeshlab.Mesh(corners, np.array([[0, 1, 2]]), **values))
    return ms
