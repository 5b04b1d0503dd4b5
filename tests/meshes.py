"""Meshes for the tests, built in code: each function returns vertices (n, 3) and faces (m, 3)."""

import numpy as np
from scipy.spatial import ConvexHull, Delaunay

CUBE_QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def cube(push=0.05):
    """The paper's first model: the unit cube with a point pushed inside at each face centre."""
    corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    centres, faces = [], []
    for a, b, c, d in CUBE_QUADS:
        m = len(corners) + len(centres)
        centre = corners[[a, b, c, d]].mean(axis=0)
        centres.append(centre + 2.0 * push * (0.5 - centre))
        faces += [(a, b, c), (a, c, m), (c, d, m), (d, a, m)]
    return np.vstack([corners, centres]), np.array(faces, np.int32)


def torus(count, jitter, stretch):
    """The paper's second model, R = 3 and r = 1: Delaunay in a stretched parameter domain."""
    rng = np.random.default_rng(0)
    if jitter is None:
        uv = rng.random((count, 2))
    else:
        a = round(np.sqrt(3 * count))
        b = count // a
        uv = np.stack(np.meshgrid(np.arange(a) / a, np.arange(b) / b, indexing="ij"), -1)
        uv = uv.reshape(-1, 2)
        uv = (uv + rng.uniform(-jitter, jitter, uv.shape) / (a, b)) % 1.0
    tiles = np.array([(du, dv) for du in (-1, 0, 1) for dv in (-1, 0, 1)])
    tiled = (uv + tiles[:, None]).reshape(-1, 2)
    triangles = Delaunay(tiled * (stretch, 1.0)).simplices
    centroids = tiled[triangles].mean(axis=1)
    triangles = triangles[((centroids >= 0.0) & (centroids < 1.0)).all(axis=1)]
    (ax, ay), (bx, by), (cx, cy) = tiled[triangles].transpose(1, 2, 0)
    clockwise = (bx - ax) * (cy - ay) < (by - ay) * (cx - ax)
    triangles[clockwise] = triangles[clockwise][:, ::-1]
    u, v = 2.0 * np.pi * uv.T
    ring = 3.0 + np.cos(v)
    vertices = np.column_stack([ring * np.cos(u), ring * np.sin(u), np.sin(v)])
    return vertices, (triangles % len(uv)).astype(np.int32)


def sphere_hull(count, seed=0):
    """The convex hull of random points on the unit sphere, outward normals."""
    vertices = np.random.default_rng(seed).normal(size=(count, 3))
    vertices /= np.linalg.norm(vertices, axis=1)[:, None]
    return vertices, outward(vertices, ConvexHull(vertices).simplices)


def bumpy_sphere(count, seed=0, bump=0.3):
    """A closed mesh with no symmetry: the hull above with each point moved along its radius."""
    vertices, faces = sphere_hull(count, seed)
    radius = np.random.default_rng(seed + 1).uniform(1.0 - bump, 1.0 + bump, count)
    return vertices * radius[:, None], faces


def patch(count, seed=0, height=0.3):
    """A mesh with a boundary: random points of a square, Delaunay, at random heights."""
    rng = np.random.default_rng(seed)
    flat = rng.random((count, 2))
    triangles = Delaunay(flat).simplices
    (ax, ay), (bx, by), (cx, cy) = flat[triangles].transpose(1, 2, 0)
    clockwise = (bx - ax) * (cy - ay) < (by - ay) * (cx - ax)
    triangles[clockwise] = triangles[clockwise][:, ::-1]
    return np.column_stack([flat, height * rng.random(count)]), triangles.astype(np.int32)


def grid(rows, columns):
    """A flat square grid, each square cut along the same diagonal."""
    vertices = np.array([(x, y, 0.0) for y in range(rows + 1) for x in range(columns + 1)], float)
    faces = []
    for y in range(rows):
        for x in range(columns):
            a = y * (columns + 1) + x
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            faces += [(a, b, c), (a, c, d)]
    return vertices, np.array(faces, np.int32)


def two_sheets(count, seed=0, gap=0.02):
    """Two rough patches, one a little above the other: they hardly miss each other."""
    vertices, faces = patch(count, seed)
    other = vertices + (0.0, 0.0, gap)
    return np.vstack([vertices, other]), np.vstack([faces, faces + len(vertices)])


def crumpled(rows, seed=0, noise=0.45):
    """A square sheet whose points are all moved about by nearly half the side of a square."""
    vertices, faces = grid(rows, rows)
    return vertices + noise * np.random.default_rng(seed).uniform(-1, 1, vertices.shape), faces


def with_giant_face(vertices, faces, corners):
    """The same mesh with one more face, of its own three corners."""
    count = len(vertices)
    giant = np.array([(count, count + 1, count + 2)], np.int32)
    return np.vstack([vertices, corners]), np.vstack([faces, giant])


def tetrahedron():
    vertices = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], float)
    return vertices, np.array([(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)], np.int32)


def octahedron():
    vertices = np.array(
        [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], float
    )
    return vertices, outward(vertices, ConvexHull(vertices).simplices)


def two_triangles():
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0.5, 1, 0.2), (0.4, -1, 0.3)], float)
    return vertices, np.array([(0, 1, 2), (1, 0, 3)], np.int32)


def bipyramid(count):
    """A ring of `count` points and two poles: each edge of the ring would become pole to pole."""
    turns = 2 * np.pi * np.arange(count) / count
    ring = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(count)])
    after = (np.arange(count) + 1) % count
    top = np.column_stack([np.arange(count), after, np.full(count, count)])
    bottom = np.column_stack([after, np.arange(count), np.full(count, count + 1)])
    vertices = np.vstack([ring, [(0, 0, 0.1), (0, 0, -0.1)]])
    return vertices, np.vstack([top, bottom]).astype(np.int32)


def hubs(count=80):
    """A bipyramid with the poles first, and its faces in no order."""
    vertices, faces = bipyramid(count)
    faces = np.random.default_rng(0).permutation((faces + 2) % len(vertices))
    return np.roll(vertices, 2, axis=0), faces.astype(np.int32)


def moebius_band(count=12):
    """A band of `count` squares with half a twist: it has no consistent orientation."""
    angle = 2.0 * np.pi * np.arange(count) / count
    offset = 0.3 * np.column_stack(
        [np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)]
    )
    middle = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(count)])
    faces = []
    for a in range(count):
        b, c, d = a + 1, a + count + 1, a + count
        if a == count - 1:
            b, c = count, 0
        faces += [(a, b, c), (a, c, d)]
    return np.vstack([middle + offset, middle - offset]), np.array(faces, np.int32)


def fin():
    """A bumpy sphere with a third face at its edge 0-x: a non-manifold edge. Returns also x."""
    vertices, faces = bumpy_sphere(40)
    other = int(faces[(faces == 0).any(axis=1)][0].max())
    vertices = np.vstack([vertices, [3.0, 3.0, 3.0]])
    return vertices, np.vstack([faces, [(0, other, len(vertices) - 1)]]).astype(np.int32), other


def bow_tie():
    """Two bumpy spheres that share vertex 0: a non-manifold vertex with two closed fans."""
    vertices, faces = bumpy_sphere(30)
    others = 2.0 * vertices[0] - vertices[1:]
    second = np.where(faces == 0, 0, faces + len(vertices) - 1)[:, ::-1]
    return np.vstack([vertices, others]), np.vstack([faces, second]).astype(np.int32)


def near_and_far(vertices):
    """The vertices in steps of 2^-20, and all moved by 2^24: their differences are the same."""
    near = np.round(2.0**20 * vertices) / 2.0**20
    return near, near + 2.0**24


def with_coincident_ends():
    """A bumpy sphere in which two neighbours coincide. Returns also these two."""
    vertices, faces = bumpy_sphere(24)
    i, j = faces[0, :2].tolist()
    vertices[j] = vertices[i]
    return vertices, faces, {i, j}


def outward(vertices, simplices):
    a, b, c = vertices[simplices].transpose(1, 0, 2)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) < 0.0
    faces = simplices.copy()
    faces[inward] = faces[inward][:, ::-1]
    return faces.astype(np.int32)


# One of each kind that an energy meets.
SMALL = {
    "closed": bumpy_sphere(24),
    "boundary": patch(20),
    "flat boundary": patch(20, height=0.0),
    "cube": cube(),
    "moebius band": moebius_band(),
    "fin": fin()[:2],
    "bow tie": bow_tie(),
}
