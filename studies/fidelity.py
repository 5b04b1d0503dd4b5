"""How faithful a mesh is to the surface that it approximates, and how good its triangles are."""

from typing import NamedTuple

import numpy as np
import pymeshlab

from meshlab_willmore.compare.reference import ReferenceMesh
from meshlab_willmore.measure import triangle_shapes

SAMPLES = 20_000
WORST = 0.01


class Fidelity(NamedTuple):
    """What is measured of a mesh.

    Attributes
    ----------
    normal_error : float
        Mean angle in degrees between the normal of the mesh and that of the original where it is
        nearest, over samples of the mesh's surface.
    distance : float
        Mean distance of the samples from the original, in 1e-5 of its diagonal.
    mean_shape, worst_shape : float
        Of the triangles: 1 if equilateral; mean, and 1 % quantile.
    cut_faces : int
        Faces that intersect others, as MeshLab counts them.
    """

    normal_error: float
    distance: float
    mean_shape: float
    worst_shape: float
    cut_faces: int


def fidelity(vertices, faces, original):
    """Compare a mesh with its original, vertices and faces."""
    points, normals = surface_samples(vertices, faces)
    distances, wanted = ReferenceMesh(*original).nearest(points)
    sines = np.linalg.norm(np.cross(normals, wanted), axis=1)
    angles = np.arctan2(sines, np.einsum("nd,nd->n", normals, wanted))
    shapes = triangle_shapes(vertices, faces)
    return Fidelity(
        float(np.degrees(angles[sines + np.abs(angles) >= 0.0].mean())),
        1e5 * float(distances.mean()) / diagonal(original[0]),
        float(shapes.mean()),
        float(np.quantile(shapes, WORST)),
        cut_faces(vertices, faces),
    )


def surface_samples(vertices, faces, count=SAMPLES):
    """Points (count, 3) spread evenly over a mesh, the same in each run, and the normals there."""
    rng = np.random.default_rng(0)
    a, b, c = vertices[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    face = rng.choice(len(faces), count, p=areas / areas.sum())
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1.0, (1.0 - u, 1.0 - v), (u, v))
    points = a[face] + u * (b - a)[face] + v * (c - a)[face]
    return points, normals[face]


def diagonal(vertices):
    """The length of the diagonal of the box around the vertices."""
    return float(np.linalg.norm(np.ptp(vertices, axis=0)))


def cut_faces(vertices, faces):
    """How many faces MeshLab says cut another one."""
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(vertices, faces))
    ms.compute_selection_by_self_intersections_per_face()
    return ms.current_mesh().selected_face_number()
