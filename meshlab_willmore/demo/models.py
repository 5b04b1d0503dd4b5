"""The paper's first two models, a technical part, and the planar Delaunay triangulation.

Source: section 4 of "Mesh optimisation based on Willmore energy". All arrays are float64 vertices
(n, 3) and int32 faces (m, 3), counter-clockwise seen from outside.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pymeshlab
from numpy.typing import NDArray

MAJOR_RADIUS = 3.0
MINOR_RADIUS = 1.0


class Surface(NamedTuple):
    """A triangle mesh: vertices (n, 3) float64 and faces (m, 3) int32."""

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]


def surface_of(meshes: pymeshlab.MeshSet) -> Surface:
    """Copy vertices and faces of the current mesh, with its transformation applied."""
    mesh = meshes.current_mesh()
    return Surface(mesh.transformed_vertex_matrix(), mesh.face_matrix())


def set_of(surface: Surface, name: str = "") -> pymeshlab.MeshSet:
    """Return a set with one mesh."""
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(*surface), name)
    return meshes


def dented_cube(push: float = 0.05) -> Surface:
    """Return the unit cube with a vertex at each side's centre, pushed inside: model I.

    Each side (a, b, c, d) with centre m is cut along a diagonal, (a, b, c), (a, c, m), (c, d, m),
    (d, a, m), so the centre has valence 3: the tight triangulation of Figure 4, left.

    Parameters
    ----------
    push
        How far the centres lie inside, in edge lengths of the cube.
    """
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    middle = corners.mean(axis=0)
    sides = np.array(
        [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    )
    centres = corners[sides].mean(axis=1)
    inward = (middle - centres) / np.linalg.norm(middle - centres, axis=1, keepdims=True)
    a, b, c, d = sides.T
    m = len(corners) + np.arange(len(sides))
    faces = np.stack([(a, b, c), (a, c, m), (c, d, m), (d, a, m)]).transpose(2, 0, 1)
    return Surface(
        np.concatenate([corners, centres + push * inward]),
        faces.reshape(-1, 3).astype(np.int32),
    )


def sampled_torus(points: int = 2000, jitter: float = 0.3, stretch: float = 8.0) -> Surface:
    """Return points on a torus, triangulated in a stretched parameter domain: model II.

    Parameters
    ----------
    points
        About this many vertices, on a grid with three times as many round the ring as the tube.
    jitter
        How far a vertex may leave its grid place, in grid spacings.
    stretch
        The parameter round the ring is scaled by this before the points are triangulated.
    """
    rings = round(np.sqrt(3 * points))
    ring_points = points // rings
    grid = np.stack(np.divmod(np.arange(rings * ring_points), ring_points), axis=1)
    scatter = np.random.default_rng(0).uniform(-jitter, jitter, grid.shape)
    uv = ((grid + scatter) / (rings, ring_points)) % 1

    # The domain is periodic: triangulate nine copies, and keep the triangles that belong to one.
    copies = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)])
    tiled = (uv[None] + copies[:, None]).reshape(-1, 2)
    faces = planar_delaunay(tiled, stretch)
    centroid = tiled[faces].mean(axis=1)
    faces = faces[((centroid >= 0) & (centroid < 1)).all(axis=1)] % len(uv)

    u, v = 2 * np.pi * uv.T
    distance = MAJOR_RADIUS + MINOR_RADIUS * np.cos(v)
    vertices = np.stack([distance * np.cos(u), distance * np.sin(u), MINOR_RADIUS * np.sin(v)], 1)
    return Surface(vertices, faces)


def technical_part(edge_percent: float = 3.0) -> Surface:
    """Return a block minus a bore through it and a ball at one corner.

    Parameters
    ----------
    edge_percent
        Length of the edges, in percent of the diagonal.
    """
    ms = pymeshlab.MeshSet()
    ms.create_cube(size=2.0)
    ms.create_cone(r0=0.5, r1=0.5, h=4.0, subdiv=48)
    ms.generate_boolean_difference(first_mesh=0, second_mesh=1)
    ms.create_sphere(radius=0.7, subdiv=4)
    ball = surface_of(ms)
    ms.add_mesh(pymeshlab.Mesh(ball.vertices + 1.0, ball.faces))
    ms.generate_boolean_difference(first_mesh=2, second_mesh=4)
    ms.meshing_isotropic_explicit_remeshing(
        targetlen=pymeshlab.PercentageValue(edge_percent), featuredeg=30.0, iterations=10
    )
    return surface_of(ms)


def scrambled(surface: Surface, flips_per_edge: float = 0.3, seed: int = 0) -> Surface:
    """Return a closed mesh after random flips to edges that are bent by a right angle at most."""
    vertices, faces = surface.vertices, surface.faces.tolist()
    # The face on the left of each half-edge.
    face_at = {(f[c - 1], f[c]): n for n, f in enumerate(faces) for c in range(3)}
    rng = np.random.default_rng(seed)
    left = round(flips_per_edge * len(face_at) / 2)
    while left > 0:
        n, c = (int(rng.integers(count)) for count in (len(faces), 3))
        i, j, k = faces[n][c - 2], faces[n][c - 1], faces[n][c]
        m = face_at[j, i]
        l = next(v for v in faces[m] if v not in (i, j))
        new = [k, i, l], [l, j, k]
        if (k, l) in face_at or (l, k) in face_at or _angle_cosine(vertices, *new) < 0.0:
            continue
        del face_at[i, j], face_at[j, i]
        for number, face in zip((n, m), new, strict=True):
            faces[number] = face
            face_at.update({(face[x - 1], face[x]): number for x in range(3)})
        left -= 1
    return Surface(vertices, np.array(faces, np.int32))


def _angle_cosine(vertices: NDArray[np.float64], one: list[int], other: list[int]) -> float:
    """Return the cosine of the angle between the normals of two faces, up to a positive factor."""
    normals = [
        np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a]) for a, b, c in (one, other)
    ]
    return float(normals[0] @ normals[1])


def planar_delaunay(points: NDArray[np.float64], stretch: float = 1.0) -> NDArray[np.int32]:
    """Triangulate points in the plane by Delaunay's rule, with MeshLab's convex hull filter.

    The Delaunay triangles are the lower side of the convex hull of the points lifted onto the
    paraboloid z = x^2 + y^2.

    Parameters
    ----------
    points : (n, 2) float64
        Distinct points that are not all on one line.
    stretch
        The first coordinate is scaled by this before the points are triangulated.

    Returns
    -------
    (m, 3) int32
        Triangles, counter-clockwise.
    """
    flat = points * (stretch, 1.0)
    flat = flat - flat.mean(axis=0)
    flat /= np.abs(flat).max()
    lifted = np.column_stack([flat, (flat**2).sum(axis=1)])

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(lifted))
    meshes.generate_convex_hull()
    hull = meshes.current_mesh()
    faces = _rows_in(lifted, hull.vertex_matrix())[hull.face_matrix()]

    lower = signed_areas(flat, faces) < 0
    return np.ascontiguousarray(faces[lower][:, ::-1], dtype=np.int32)


def signed_areas(points: NDArray[np.float64], faces: NDArray[np.integer]) -> NDArray[np.float64]:
    """Return the area (m,) of triangles (m, 3) of points (n, 2), negative where clockwise."""
    a, b, c = points[faces].transpose(1, 0, 2)
    areas: NDArray[np.float64] = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    return areas / 2


def _rows_in(table: NDArray[np.float64], rows: NDArray[np.float64]) -> NDArray[np.intp]:
    """Find each of `rows` in `table`, whose rows they are bit for bit copies of."""
    _, label = np.unique(np.concatenate([table, rows]), axis=0, return_inverse=True)
    label = label.reshape(-1)
    index = np.empty(label.max() + 1, dtype=np.intp)
    index[label[: len(table)]] = np.arange(len(table))
    return index[label[len(table) :]]
