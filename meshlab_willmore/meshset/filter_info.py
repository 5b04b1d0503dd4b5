"""Information on a filter and its parameters, and asking PyMeshLab for it.

PyMeshLab gives keywords and defaults; types and choices follow from the values that it refuses. It
needs a mesh to answer, and some filters crash without one, so a set with a triangle is used.
"""

from __future__ import annotations

import functools
import keyword
import re
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
# By themselves filters take the current mesh or one of the first two.
_MOST_MESHES = 3
_LATER_ID = 3
# PyMeshLab's exceptions have no common base.
_REFUSALS = (pymeshlab.PyMeshLabException, pymeshlab.InvalidEnumException, RuntimeError)


def python_name(name: str) -> str:
    """The Python name that PyMeshLab makes of a name of MeshLab's."""
    return re.sub(r"[().,'\":+]", "", re.sub(r"[ /-]", "_", name.lower()))


def keyword_of(name: str) -> str:
    """The keyword that PyMeshLab makes of a name of MeshLab's."""
    made = python_name(name)
    return made + "_" if keyword.iskeyword(made) else made


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
        Whether it is known from PyMeshLab only: MeshLab's name is unknown, the type a guess.
    """

    name: str
    keyword: str
    type: str
    choices: tuple[str, ...]
    required: bool
    guessed: bool = False


class FilterInfo(NamedTuple):
    """A filter.

    Attributes
    ----------
    name, meshlab_name : str
        The name in PyMeshLab, and the one in MeshLab and its scripts (empty if it is unknown).
    params : tuple of ParamInfo
        In MeshLab's order.
    is_willmore : bool
        Whether it is a filter of this package.
    makes_layers : bool
        Whether it can add meshes to a set.
    summary : str
        What it does; for MeshLab's own, a link to the manual.
    needs_mesh : bool
        Whether it fails on an empty set.
    available : bool
        Whether the installed PyMeshLab has it.
    """

    name: str
    meshlab_name: str
    params: tuple[ParamInfo, ...]
    is_willmore: bool
    makes_layers: bool
    summary: str
    needs_mesh: bool = True
    available: bool = True

    def param(self, name: str) -> ParamInfo | None:
        """The parameter of that name in MeshLab or PyMeshLab."""
        for param in self.params:
            if name in (param.name, param.keyword):
                return param
            if param.guessed and keyword_of(name) == param.keyword:
                return param
        return None


# --- asking PyMeshLab -----------------------------------------------------------------------------


def params(name: str) -> tuple[ParamInfo, ...]:
    """The parameters of a native filter as PyMeshLab has them, without MeshLab's names."""
    return tuple(_param(name, key, value) for key, value in _defaults(name, 1, 0).items())


def updated(name: str, recorded: tuple[ParamInfo, ...]) -> tuple[ParamInfo, ...]:
    """The parameters that a filter has now, if it was recorded with another PyMeshLab."""
    values = _defaults(name, 1, 0)
    if not values:
        return recorded
    by_keyword = {param.keyword: param for param in recorded}
    return tuple(by_keyword.get(key) or _param(name, key, value) for key, value in values.items())


def default_places(name: str, keywords: Iterable[str], count: int, current: int) -> dict[str, int]:
    """The places of the meshes that a native filter takes by default, by keyword.

    Parameters
    ----------
    name : str
    keywords : iterable of str
        Its parameters that are meshes.
    count, current : int
        How many meshes there are, and the place of the current one, from 0.
    """
    place = min(current, _MOST_MESHES - 1)
    values = _defaults(name, min(count, _MOST_MESHES), place)
    found = {key: values[key] for key in keywords if key in values}
    return {key: current if value == place else value for key, value in found.items()}


@functools.cache
def _defaults(name: str, count: int, current: int) -> dict[str, Any]:
    """The filter's defaults in a set of `count` meshes; empty if PyMeshLab gives none."""
    ms = _triangles(count)
    native.make_current(ms, current)
    try:
        return _ask(ms, name)
    except _REFUSALS:
        return {}


def _ask(ms: MeshSet, name: str, **given: Any) -> dict[str, Any]:
    with native.muted():
        return native.defaults(ms, name, **given)


def _param(name: str, key: str, value: Any) -> ParamInfo:
    choices: tuple[str, ...] = ()
    kind = _type(value)
    # Enums and ids of meshes look like numbers, and percentages like floats.
    if kind == "RichInt" and _is_mesh_id(name, key, value):
        kind = "RichMesh"
    elif kind == "RichInt":
        refusal = _refusal(name, **{key: _NO_VALUE})
        if isinstance(refusal, pymeshlab.InvalidEnumException):
            kind, choices = "RichEnum", _choices(str(refusal))
    elif kind == "RichFloat" and _refusal(name, **{key: value}):
        kind = "RichAbsPerc"
    return ParamInfo(key, key, kind, choices, required=False, guessed=True)


def _is_mesh_id(name: str, key: str, value: Any) -> bool:
    """Whether a default is the id of the only mesh, in two sets where that has different ids."""
    return (value, _ask(_triangle_with_later_id(), name).get(key)) == (0, _LATER_ID)


def _type(value: Any) -> str:
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
        _ask(_triangles(1), name, **given)
    except _REFUSALS as error:
        return error
    return None


def _choices(refusal: str) -> tuple[str, ...]:
    """The choices out of "... Possible values are 'a'; 'b'; "."""
    listed = refusal.partition(" values are '")[2].rpartition("'; ")[0]
    return tuple(listed.split("'; '"))


@functools.cache
def _triangle_with_later_id() -> MeshSet:
    ms = _new_triangles(_LATER_ID + 1)
    for mesh_id in range(_LATER_ID):
        native.make_current(ms, mesh_id)
        native.apply(ms, "delete_current_mesh")
    return ms


@functools.cache
def _triangles(count: int) -> MeshSet:
    return _new_triangles(count)


def _new_triangles(count: int) -> MeshSet:
    """A set of triangles with scalars, on which the defaults of some filters depend."""
    ms = MeshSet()
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    values = {"v_scalar_array": np.arange(3.0), "f_scalar_array": np.arange(1.0)}
    for _ in range(count):
        native.add(ms, pymeshlab.Mesh(corners, np.array([[0, 1, 2]]), **values))
    return ms
