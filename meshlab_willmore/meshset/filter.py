"""A filter of this package: what it is called, what it takes and does, and applying it."""

from __future__ import annotations

import logging
import math
import sys
import threading
import traceback
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from typing import Any, NamedTuple

import pymeshlab
from pymeshlab import MeshSet

from ..mlx.steps import Percentage
from ..progress import listening, was_raised_by_listener
from . import native
from .parameters import Parameter, read_all

_log = logging.getLogger(__name__)

# PyMeshLab redirects the streams of the whole process, so only one filter runs at a time.
_lock = threading.RLock()


class Filter(NamedTuple):
    """A filter of this package.

    Attributes
    ----------
    name, meshlab_name : str
        The name in PyMeshLab, and the one in MeshLab and its scripts.
    summary : str
        One sentence.
    info : str
        The rest of the help text.
    parameters : tuple of Parameter
        In the order of the dialog.
    returns : tuple of (str, str, str)
        Name, type and meaning of each entry of the returned dict.
    run : callable
        Gets the set and all parameter values; returns the dict and a line for the log.
    barred : callable
        Gets parameter values; returns the names of the parameters that can't be given beside these,
        each with the reason.
    """

    name: str
    meshlab_name: str
    summary: str
    info: str
    parameters: tuple[Parameter, ...]
    returns: tuple[tuple[str, str, str], ...]
    run: Callable[[MeshSet, dict[str, Any]], tuple[dict[str, Any], str]]
    barred: Callable[[Mapping[str, Any]], Mapping[str, str]] = lambda values: {}


def current_surface(ms: MeshSet) -> pymeshlab.Mesh:
    """The current mesh, if it has faces."""
    mesh = ms.current_mesh()
    if mesh.vertex_number() == 0:
        raise pymeshlab.PyMeshLabException("The current mesh is empty: it has no vertices.")
    if mesh.face_number() == 0:
        raise pymeshlab.PyMeshLabException(
            "The current mesh has no faces, it is a point cloud. A surface can be made of it "
            "by generate_surface_reconstruction_ball_pivoting, say."
        )
    return mesh


def values_of(ms: MeshSet, filter_: Filter, given: dict[str, Any]) -> dict[str, Any]:
    """All parameter values of a call: the given ones, and the defaults for the current mesh.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If the set has no mesh, a keyword or a value does not fit, or two contradict each other.
    """
    if ms.mesh_number() == 0:
        raise pymeshlab.PyMeshLabException(
            f"{filter_.name} requires at least one mesh loaded in the MeshSet."
        )
    values = read_all(filter_.name, filter_.parameters, given, ms)
    barred = filter_.barred(values)
    for name in given:
        if name in barred:
            raise pymeshlab.PyMeshLabException(f"Parameter {barred[name]}.")
    return values


def shown_values(ms: MeshSet, values: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a call as PyMeshLab shows them: percentages as lengths."""
    return {name: length_of(ms, value) for name, value in values.items()}


def length_of(ms: MeshSet, value: Any) -> Any:
    """A percentage of the current mesh's diagonal as a length; any other value as it is."""
    if not isinstance(value, Percentage):
        return value
    return value.percent / 100.0 * ms.current_mesh().bounding_box().diagonal()


def _by_name(filter_: Filter, values: dict[str, Any]) -> dict[str, Any]:
    """The values with the names of choices in place of their indices."""
    choices = {p.name: p.choices for p in filter_.parameters if p.choices}
    return {n: choices[n][value] if n in choices else value for n, value in values.items()}


def apply(ms: MeshSet, filter_: Filter, values: dict[str, Any]) -> dict[str, Any]:
    """Run a filter with all its values, and return what it returns.

    It prints what PyMeshLab prints of a native filter, and fails with the same words.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If the filter fails; its mesh is as it was.
    Cancelled
        If what listens to its progress (see `meshlab_willmore.progress`) has stopped it.
    """
    with _lock:
        verbosity = native.verbosity(ms)
        if verbosity.all or verbosity.parameters:
            with native.in_order():
                print(f"\nApplying filter {filter_.name} with the following parameters:")
                print(f"{shown_values(ms, values)}\n")
        _log.debug("%s with %s", filter_.name, _by_name(filter_, values))
        try:
            with listening(_print) if verbosity.all else nullcontext():
                returned, log = _run(ms, filter_, values)
        except Exception as error:
            if was_raised_by_listener(error):
                raise
            # A caller who keeps the exception, as an interactive session does, would hold the mesh.
            traceback.clear_frames(error.__traceback__)
            raise pymeshlab.PyMeshLabException(
                f"Failed to apply filter: {filter_.name}\nDetails: {error}{_cure(error)}"
            ) from error
        _log.info("%s: %s", filter_.name, log)
        if verbosity.all:
            with native.in_order():
                print(f"LOG: 2 {log}\nLOG: 2 {filter_.name} applied!    [ 100% ]", file=sys.stderr)
                print()
        return returned


def _print(fraction: float, text: str) -> None:
    """Print the progress as native filters do; what is printed of the end is not said here."""
    if fraction < 1.0:
        with native.in_order():
            print(f"LOG: 2 {text}    [ {math.floor(100 * fraction)}% ]", file=sys.stderr)


def _cure(error: Exception) -> str:
    """What removes from a mesh what the functions on arrays refuse; empty for other errors."""
    if not isinstance(error, ValueError):
        return ""
    from ..mesh.validate import NotFiniteError, RepeatedVertexError

    if isinstance(error, NotFiniteError):
        return (
            "; the PyMeshLab filters compute_selection_by_condition_per_vertex"
            "(condselect='x-x!=0 || y-y!=0 || z-z!=0') and meshing_remove_selected_vertices() "
            "remove such vertices"
        )
    if isinstance(error, RepeatedVertexError):
        return "; the PyMeshLab filter meshing_remove_null_faces removes such faces"
    return ""


def _run(ms: MeshSet, filter_: Filter, values: dict[str, Any]) -> tuple[dict[str, Any], str]:
    """Run the filter; on a terminal, say why the first time takes so long."""
    from ..mesh.compiling import announced

    silent = native.verbosity(ms).all is False
    with announced(f"what {filter_.meshlab_name!r} needs", silent=silent):
        return filter_.run(ms, values)
