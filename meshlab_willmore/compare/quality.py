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
    """Quality measures of a mesh; lengths in units of the coordinates."""

    # Edges that the initial mesh does not have.
    flips: int
    # As `meshlab_willmore.measures` returns them.
    willmore_energy: float
    area: float
    absolute_gaussian_curvature: float
    absolute_mean_curvature: float
    # As `meshlab_willmore.measure.triangle_shapes`: the 1 % quantile, and the mean.
    worst_shape: float
    mean_shape: float
    # Faces that intersect another, as PyMeshLab counts them.
    self_intersecting: int
    # See `meshlab_willmore.compare.reference.Deviation`; None without a reference.
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
