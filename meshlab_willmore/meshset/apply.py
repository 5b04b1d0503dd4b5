"""Applying one of our filters, as PyMeshLab applies its own: same words, same errors."""

from __future__ import annotations

import sys
import threading
import traceback
from typing import Any

import pymeshlab
from pymeshlab import MeshSet

from . import native
from .filter import Filter
from .parameters import read_all

# PyMeshLab redirects the streams of the whole process: filters take turns.
_turn = threading.RLock()


def values_of(ms: MeshSet, filter_: Filter, given: dict[str, Any]) -> dict[str, Any]:
    """All parameter values of a call: the given ones, and the defaults for the current mesh.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If the set has no mesh, or a keyword or a value does not fit.
    """
    if ms.mesh_number() == 0:
        raise pymeshlab.PyMeshLabException(
            f"{filter_.name} requires at least one mesh loaded in the MeshSet."
        )
    return read_all(filter_.name, filter_.parameters, given, ms)


def apply(ms: MeshSet, filter_: Filter, values: dict[str, Any]) -> dict[str, Any]:
    """Run a filter with all its values, and return what it returns.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If the filter fails; its mesh is as it was.
    """
    with _turn:
        verbosity = native.verbosity(ms)
        if verbosity.all or verbosity.parameters:
            with native.in_order():
                print(f"\nApplying filter {filter_.name} with the following parameters:")
                print(f"{values}\n")
        try:
            returned, log = _run(ms, filter_, values)
        except Exception as error:
            # Whoever keeps the exception, as an interactive session does, would hold the mesh.
            traceback.clear_frames(error.__traceback__)
            raise pymeshlab.PyMeshLabException(
                f"Failed to apply filter: {filter_.name}\nDetails: {error}"
            ) from error
        if verbosity.all:
            with native.in_order():
                print(f"LOG: 2 {log}\nLOG: 2 {filter_.name} applied!    [ 100% ]", file=sys.stderr)
                print()
        return returned


def _run(ms: MeshSet, filter_: Filter, values: dict[str, Any]) -> tuple[dict[str, Any], str]:
    """Run the filter; on a terminal, say why the first time takes so long."""
    from ..mesh.compiling import announced

    silent = native.verbosity(ms).all is False
    with announced(f"what {filter_.meshlab_name!r} needs", silent=silent):
        return filter_.run(ms, values)
