"""Quality measures of a mesh after the flips of a row."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pymeshlab
from numpy.typing import NDArray

from ..demo.models import surface_of
from ..measure import measures, triangle_shapes
from ..mesh.build import changed_edges
from .reference import Reference, deviation

WORST_SHARE = 0.01


class Quality(NamedTuple):
    """Quality measures of a mesh; lengths in units of the coordinates.

    Attributes
    ----------
    flips : int
        Edges that the initial mesh does not have.
    willmore_energy, area, absolute_gaussian_curvature, absolute_mean_curvature : float
        As `meshlab_willmore.measures` returns them.
    worst_shape, mean_shape : float
        4 sqrt(3) area / (sum of squared sides) of the triangles, 1 if equilateral: the 1 %
        quantile, and the mean.
    self_intersecting : int
        Faces that intersect another, as PyMeshLab counts them.
    normal_error, distance : float or None
        See `meshlab_willmore.compare.reference.Deviation`; None without a reference.
    """

    flips: int
    willmore_energy: float
    area: float
    absolute_gaussian_curvature: float
    absolute_mean_curvature: float
    worst_shape: float
    mean_shape: float
    self_intersecting: int
    normal_error: float | None
    distance: float | None


def quality_of(
    ms: pymeshlab.MeshSet, before: NDArray[np.int32], reference: Reference | None
) -> Quality:
    """Measure the current mesh of `ms`; its selection of faces is changed.

    Parameters
    ----------
    before : (m, 3) int32
        The faces of the initial mesh.
    """
    vertices, faces = surface_of(ms)
    totals = measures(vertices, faces)
    shapes = triangle_shapes(vertices, faces)
    ms.compute_selection_by_self_intersections_per_face()
    return Quality(
        changed_edges(before, faces),
        totals.willmore_energy,
        totals.area,
        totals.absolute_gaussian_curvature,
        totals.absolute_mean_curvature,
        float(np.quantile(shapes, WORST_SHARE)),
        float(shapes.mean()),
        ms.current_mesh().selected_face_number(),
        *((None, None) if reference is None else deviation(vertices, faces, reference)),
    )
