"""Random small meshes, the odder the better: each function takes a random generator.

A mesh is vertices (n, 3) and faces (m, 3), as the tests' other meshes are.
"""

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from tests import meshes, reference

MOST_FACES = 40


# --- where a mesh comes from ---------------------------------------------------------------------


def hull(rng):
    """A closed mesh: the hull of points, each then moved along its radius."""
    points = rng.normal(size=(rng.integers(5, 22), 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    faces = meshes.outward(points, ConvexHull(points).simplices)
    return points * rng.uniform(1.0 - rng.choice([0.1, 0.5, 0.9]), 1.0, len(points))[:, None], faces


def patch(rng):
    """A mesh with a boundary."""
    return meshes.patch(int(rng.integers(4, 22)), int(rng.integers(2**31)), rng.choice([0, 0.3, 2]))


def grid(rng):
    """Squares with heights that are integers: full of ties."""
    vertices, faces = meshes.grid(*map(int, rng.integers(1, 5, 2)))
    vertices[:, 2] = rng.integers(0, rng.integers(1, 4), len(vertices))
    return vertices, faces


def crumpled(rng):
    return meshes.crumpled(int(rng.integers(2, 5)), int(rng.integers(2**31)), rng.uniform(0.2, 1.5))


def lattice(rng):
    """The hull of points with integer coordinates: many in one plane, or on one sphere."""
    points = np.unique(rng.integers(-2, 3, (30, 3)), axis=0).astype(float)
    points = points[rng.permutation(len(points))[: rng.integers(6, 20)]]
    try:
        simplices = ConvexHull(points).simplices
    except QhullError:
        return grid(rng)
    used, faces = np.unique(simplices, return_inverse=True)
    points = points[used] - points[used].mean(axis=0)
    return points, meshes.outward(points, faces.reshape(-1, 3))


def soup(rng):
    """Random faces on few vertices: hardly an edge with two faces."""
    count = int(rng.integers(4, 9))
    faces = [rng.permutation(count)[:3] for _ in range(rng.integers(1, 16))]
    return rng.normal(size=(count, 3)), np.array(faces, np.int32)


def ring(rng):
    """A bipyramid: each edge of its rim would become the same one."""
    vertices, faces = meshes.bipyramid(int(rng.integers(3, 12)))
    return vertices + rng.choice([0.0, 0.2]) * rng.normal(size=vertices.shape), faces


def torus(rng):
    """A torus of a few squares, on which edges are many for so few vertices."""
    a, b = map(int, rng.integers(3, 5, 2))
    faces = []
    for x in range(a):
        for y in range(b):
            p, q = x * b + y, (x + 1) % a * b + y
            r, s = (x + 1) % a * b + (y + 1) % b, x * b + (y + 1) % b
            faces += [(p, q, r), (p, r, s)]

    u, v = np.repeat(np.arange(a), b) * 2 * np.pi / a, np.tile(np.arange(b), a) * 2 * np.pi / b
    radius = 3.0 + np.cos(v)
    vertices = np.column_stack([radius * np.cos(u), radius * np.sin(u), np.sin(v)])
    return vertices + rng.choice([0.0, 0.3]) * rng.normal(size=vertices.shape), np.array(faces)


def known(rng):
    """One of the meshes of the other tests."""
    made = [
        meshes.tetrahedron,
        meshes.octahedron,
        meshes.two_triangles,
        lambda: meshes.cube(rng.choice([0.0, 0.05, 0.1])),
        lambda: meshes.moebius_band(int(rng.integers(5, 9))),
        lambda: (np.eye(3), np.array([(0, 1, 2)])),
        lambda: (np.eye(3), np.array([(0, 1, 2), (2, 1, 0)])),
    ]
    return made[rng.integers(len(made))]()


SOURCES = [
    hull,
    hull,
    hull,
    patch,
    patch,
    grid,
    crumpled,
    lattice,
    lattice,
    soup,
    ring,
    torus,
    known,
]


# --- what happens to it --------------------------------------------------------------------------


def scrambled(rng, vertices, faces):
    """The mesh after random flips of edges with one half-edge each way."""
    faces = list(map(tuple, faces.tolist()))
    for _ in range(int(rng.integers(1, 20))):
        rows = reference.diamonds(np.array(faces))
        if not len(rows):
            break
        i, j, k, l = rows[rng.integers(len(rows))].tolist()
        ends = np.array(faces).ravel()
        if k == l or (min(k, l), max(k, l)) in reference.edge_set(faces):
            continue
        if min(np.count_nonzero(ends == i), np.count_nonzero(ends == j)) > 3:
            faces = reference.flipped(faces, i, j)
    return vertices, np.array(faces, np.int32)


def doubled(rng, vertices, faces):
    """Some faces twice, some of these the other way round."""
    again = faces[rng.integers(0, len(faces), rng.integers(1, 4))]
    return vertices, np.vstack([faces, again if rng.random() < 0.5 else again[:, ::-1]])


def turned(rng, vertices, faces):
    """Some faces of opposite orientation."""
    some = rng.random(len(faces)) < rng.choice([0.1, 0.5])
    return vertices, np.where(some[:, None], faces[:, ::-1], faces)


def torn(rng, vertices, faces):
    """Without some faces."""
    return vertices, faces[rng.random(len(faces)) < 0.85]


def glued(rng, vertices, faces):
    """Two vertices become one: a vertex of two fans, or an edge of four faces."""
    a, b = rng.integers(0, len(vertices), 2)
    faces = np.where(faces == a, b, faces)
    fine = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return vertices, faces[fine]


def finned(rng, vertices, faces):
    """Another face at an edge."""
    face, tip = faces[rng.integers(len(faces))], len(vertices)
    far = vertices[face].mean(axis=0) + rng.normal(size=3)
    return np.vstack([vertices, far]), np.vstack([faces, [(face[0], face[1], tip)]])


def flattened(rng, vertices, faces):
    """Some vertices in one plane."""
    vertices = vertices.copy()
    some = rng.random(len(vertices)) < rng.choice([0.5, 1.0])
    vertices[some, rng.integers(3)] = 0.0
    return vertices, faces


def rounded(rng, vertices, faces):
    """Coordinates on a coarse grid: ties, coplanar and coincident points."""
    step = rng.choice([0.25, 0.5, 1.0])
    return np.round(vertices / step) * step, faces


def with_needles(rng, vertices, faces):
    """Some vertices next to others, or next to an edge."""
    vertices = vertices.copy()
    for _ in range(int(rng.integers(1, 4))):
        a, b, c = faces[rng.integers(len(faces))]
        part = rng.choice([0.0, 0.3, 0.5, 1.0])
        near = 10.0 ** rng.uniform(-16.0, -2.0) * rng.choice([0.0, 1.0])
        vertices[a] = vertices[b] + part * (vertices[c] - vertices[b]) + near * rng.normal(size=3)
    return vertices, faces


def squeezed(rng, vertices, faces):
    """Much thinner along an axis."""
    factors = np.ones(3)
    factors[rng.integers(3)] = 10.0 ** rng.uniform(-12.0, 0.0)
    return vertices * factors, faces


def uneven(rng, vertices, faces):
    """Parts of very different size in one mesh."""
    far = vertices * 10.0 ** rng.uniform(-200.0, 0.0) + rng.choice([0.0, 2.0])
    return np.vstack([vertices, far]), np.vstack([faces, faces + len(vertices)])


def moved(rng, vertices, faces):
    """Far from the origin, so that digits are lost."""
    return vertices + 10.0 ** rng.uniform(0.0, 12.0) * rng.normal(size=3), faces


def single(rng, vertices, faces):
    """As files in single precision hold it."""
    return vertices.astype(np.float32).astype(float), faces


def relabelled(rng, vertices, faces):
    """Vertices and faces in another order, with vertices of no face among them."""
    vertices = np.vstack([vertices, rng.normal(size=(rng.integers(0, 3), 3))])
    label = rng.permutation(len(vertices))
    other = np.empty_like(vertices)
    other[label] = vertices
    shifts = rng.integers(0, 3, len(faces))
    faces = [np.roll(face, shift) for face, shift in zip(label[faces], shifts, strict=True)]
    return other, np.array(faces)[rng.permutation(len(faces))]


def scaled(rng, vertices, faces):
    """As large or as small as floats allow."""
    exponent = rng.choice([rng.uniform(-150.0, 150.0), rng.uniform(-3.0, 3.0)])
    return vertices * 10.0**exponent, faces


# Each with how often it happens, in this order.
CHANGES = [
    (scrambled, 0.6),
    (torn, 0.1),
    (glued, 0.1),
    (finned, 0.1),
    (doubled, 0.1),
    (turned, 0.1),
    (flattened, 0.1),
    (rounded, 0.2),
    (squeezed, 0.1),
    (with_needles, 0.25),
    (uneven, 0.05),
    (moved, 0.05),
    (single, 0.1),
    (relabelled, 0.5),
    (scaled, 0.3),
]


def random_mesh(rng):
    """A random mesh, and the names of what it was made by."""
    source = SOURCES[rng.integers(len(SOURCES))]
    vertices, faces = source(rng)
    names = [source.__name__]
    for change, share in CHANGES:
        if rng.random() < share and len(faces):
            vertices, faces = change(rng, vertices, faces)
            names.append(change.__name__)
    return np.ascontiguousarray(vertices, float), np.asarray(faces, np.int32).reshape(-1, 3), names
