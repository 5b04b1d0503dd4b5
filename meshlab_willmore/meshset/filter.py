"""What a filter is, and the mesh that it works on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import pymeshlab

from .parameters import Parameter


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
    """

    name: str
    meshlab_name: str
    summary: str
    info: str
    parameters: tuple[Parameter, ...]
    returns: tuple[tuple[str, str, str], ...]
    run: Callable[[pymeshlab.MeshSet, dict[str, Any]], tuple[dict[str, Any], str]]


def current_surface(ms: pymeshlab.MeshSet) -> pymeshlab.Mesh:
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
