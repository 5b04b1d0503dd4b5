"""Steps of older scripts that act on the set of meshes, MeshLab's "document", not on a mesh.

They were filters of MeshLab until 2021.07. PyMeshLab has methods of `MeshSet` instead, so these
steps are run here.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import pymeshlab
from pymeshlab import MeshSet

from . import ids, layers, native
from .filter_info import ParamInfo, keyword_of


class DocumentStep(NamedTuple):
    """A step: its names in PyMeshLab and MeshLab, and the parameters that it had."""

    name: str
    meshlab_names: tuple[str, ...]
    params: tuple[ParamInfo, ...]
    summary: str


def _param(name: str, type: str) -> ParamInfo:
    return ParamInfo(name, keyword_of(name), type, (), False)


_CURRENT = DocumentStep(
    "set_current_mesh",
    ("Change the current layer",),
    (_param("mesh", "RichMesh"),),
    "Makes another layer the current one.",
)
_VISIBILITY = DocumentStep(
    "set_mesh_visibility",
    ("Change Visibility of layer(s)", "Change Visibility of a Mesh"),
    (
        _param("layer", "RichMesh"),
        _param("lName", "RichString"),
        _param("isMeshVisible", "RichBool"),
    ),
    "Shows or hides a layer, or all whose names hold a text.",
)
# In MeshLab deleted vertices and faces could stay in memory; PyMeshLab shows none.
_COMPACT = tuple(
    DocumentStep(keyword_of(name), (name,), (), "Did nothing that could be seen.")
    for name in ("Compact vertices", "Compact faces")
)
STEPS = (_CURRENT, _VISIBILITY, *_COMPACT)
_BY_NAME = {name: step for step in STEPS for name in (step.name, *step.meshlab_names)}


def find(name: str) -> DocumentStep | None:
    """The step of that name in MeshLab or PyMeshLab."""
    return _BY_NAME.get(name)


def is_step(name: str) -> bool:
    """Whether a name, in PyMeshLab's form, is that of such a step."""
    return any(step.name == name for step in STEPS)


def play(ms: MeshSet, name: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """Run a step; ids in `given` are logical.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
        Changed in place.
    name : str
        The step's name in PyMeshLab.
    given : mapping
        Its parameters by keyword. MeshLab's defaults were the current layer, and "visible".

    Returns
    -------
    dict
        Empty, as of a filter that returns nothing.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If there is no layer of a given id; nothing is changed.
    """
    if name == _CURRENT.name and "mesh" in given:
        native.make_current(ms, _physical_id(ms, given["mesh"]))
    if name == _VISIBILITY.name:
        for mesh_id in _chosen(ms, given):
            native.show(ms, mesh_id, given.get("ismeshvisible", True))
    return {}


def _chosen(ms: MeshSet, given: Mapping[str, Any]) -> list[int]:
    """The physical ids of the layers that a step acts on."""
    part = given.get("lname", "")
    if part:
        return [native.id_of(mesh) for mesh in ms if part in mesh.label()]
    if "layer" in given:
        return [_physical_id(ms, given["layer"])]
    return [native.id_of(native.current_mesh(ms))]


def _physical_id(ms: MeshSet, mesh_id: int) -> int:
    """The physical id for a logical one; PyMeshLab would crash in the next filter without it."""
    physical = ids.physical_id(ms, mesh_id)
    if physical is None:
        raise pymeshlab.PyMeshLabException(layers.no_such_id(ms, mesh_id))
    return physical
