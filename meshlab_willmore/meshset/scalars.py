"""Writing an array into the vertex scalar of a mesh inside a set.

PyMeshLab has no function for it, so a native filter transfers the values from a helper layer, which
uses up an id of the set. A custom attribute would be quicker, but can't be removed again.
"""

from __future__ import annotations

import numpy as np
import pymeshlab
from pymeshlab import MeshSet

from . import ids, interrupts, native

# muParser, which evaluates MeshLab's functions, takes 20000 characters; a value with its test
# and brackets takes at most 40.
_VALUES_PER_FUNCTION = 400

# PyMeshLab's grid for the nearest point crashes where squares of coordinates overflow.
_LARGEST_COORDINATE = 1e150


def write_vertex_scalar(ms: MeshSet, scalar: np.ndarray) -> None:
    """Write `scalar`, (n,) float64, into the vertex scalar of the current mesh.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If coordinates are too large for PyMeshLab's filters.
    """
    _check_size(ms.current_mesh().vertex_matrix())
    with interrupts.deferred(), native.without_trace(ms):
        _transfer(ms, scalar)
        _correct(ms, scalar)


def _check_size(vertices: np.ndarray) -> None:
    too_large = (np.abs(vertices) > _LARGEST_COORDINATE).any(axis=1)
    if too_large.any():
        vertex = int(np.argmax(too_large))
        raise pymeshlab.PyMeshLabException(
            f"vertex {vertex} has a coordinate above {_LARGEST_COORDINATE:g}; "
            "compute_matrix_from_scaling_or_normalization makes the mesh smaller"
        )


def _transfer(ms: MeshSet, scalar: np.ndarray) -> None:
    """Give each vertex the value of the nearest vertex of a helper layer, which is its copy.

    The transfer would apply both transforms and undo them, with rounding: it runs without them.
    """
    target = native.id_of(native.current_mesh(ms))
    transform = ms.current_mesh().transform_matrix()
    vertices = ms.current_mesh().vertex_matrix()
    helper = pymeshlab.Mesh(vertices, v_scalar_array=scalar)
    native.add(ms, helper, "Willmore energy")
    source = native.id_of(native.current_mesh(ms))
    ids.note_used(ms, source)
    native.make_current(ms, target)
    try:
        native.apply(ms, "set_matrix_identity")
        native.apply(
            ms,
            "transfer_attributes_per_vertex",
            sourcemesh=source,
            targetmesh=target,
            vertexsampling=True,
            colortransfer=False,
            qualitytransfer=True,
            upperbound=pymeshlab.PercentageValue(1),
            onselected=False,
        )
    finally:
        native.apply(ms, "set_matrix", transformmatrix=transform, compose=False, freeze=False)
        native.make_current(ms, source)
        native.apply(ms, "delete_current_mesh")
        native.make_current(ms, target)


def _correct(ms: MeshSet, scalar: np.ndarray) -> None:
    """Set the values that the transfer mixed up: of vertices at the same position."""
    wrong = np.flatnonzero(ms.current_mesh().vertex_scalar_array() != scalar)
    for start in range(0, len(wrong), _VALUES_PER_FUNCTION):
        part = wrong[start : start + _VALUES_PER_FUNCTION]
        function = _function_of_index(part, scalar[part])
        native.apply(ms, "compute_scalar_by_function_per_vertex", q=function)


def _function_of_index(indices: np.ndarray, values: np.ndarray) -> str:
    """A MeshLab function with values[p] at vertex indices[p], and the scalar elsewhere."""
    if len(indices) == 1:
        return f"(vi=={indices[0]}?{float(values[0])!r}:q)"
    middle = len(indices) // 2
    lower = _function_of_index(indices[:middle], values[:middle])
    upper = _function_of_index(indices[middle:], values[middle:])
    return f"(vi<{indices[middle]}?{lower}:{upper})"
