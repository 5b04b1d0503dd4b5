"""A slow second implementation, in plain NumPy and dictionaries, independent of the kernels.

Angles come from an inversion in one end of the edge, which makes lines of both circumcircles; they
are computed in long double. Meshes are lists of faces, flips and virtual vertices make new lists.
"""

import numpy as np


def intersection_angle(a, b, p, q):
    """Angle between the circles (a, b, p) and (b, a, q); points (..., 3)."""
    a, b, p, q = (np.asarray(x, np.longdouble) for x in (a, b, p, q))

    def invert(x):
        return (x - a) / np.sum((x - a) ** 2, axis=-1, keepdims=True)

    first, second = invert(b) - invert(p), invert(q) - invert(b)
    sine = np.sqrt(np.sum(np.cross(first, second) ** 2, axis=-1))
    return np.arctan2(sine, np.sum(first * second, axis=-1))


def diamonds(faces):
    """Rows (i, j, k, l) of the edges with exactly one half-edge each way, i < j."""
    apexes = {}
    for i, j, k in np.asarray(faces).tolist():
        for a, b, c in ((i, j, k), (j, k, i), (k, i, j)):
            apexes.setdefault((a, b), []).append(c)
    rows = [
        (a, b, apexes[a, b][0], apexes[b, a][0])
        for a, b in apexes
        if a < b and len(apexes[a, b]) == len(apexes.get((b, a), ())) == 1
    ]
    return np.array(rows, int).reshape(-1, 4)


def edge_angles(vertices, faces):
    """The diamonds and the angle at each."""
    rows = diamonds(faces)
    return rows, intersection_angle(*vertices[rows].transpose(1, 0, 2))


def objective(vertices, faces):
    """Twice the sum of the angles over the interior edges."""
    return float(2 * edge_angles(vertices, faces)[1].sum())


def flipped(faces, i, j):
    """The faces after the flip of i-j, which must have one half-edge each way."""
    (k,) = _apexes(faces, i, j)
    (l,) = _apexes(faces, j, i)
    kept = [face for face in map(tuple, faces) if not {i, j} <= set(face)]
    return [*kept, (k, i, l), (l, j, k)]


def with_virtual_vertex(vertices, faces, i, j, t=0.5):
    """The mesh with a vertex at the part t of i-j, joined to the four corners of the diamond."""
    (k,) = _apexes(faces, i, j)
    (l,) = _apexes(faces, j, i)
    v = len(vertices)
    kept = [face for face in map(tuple, faces) if not {i, j} <= set(face)]
    added = np.vstack([vertices, vertices[i] + t * (vertices[j] - vertices[i])])
    return added, [*kept, (v, i, l), (v, l, j), (v, j, k), (v, k, i)]


def willmore_reduction(vertices, faces, i, j):
    """Objective before minus after the flip of i-j."""
    return objective(vertices, faces) - objective(vertices, flipped(faces, i, j))


def virtual_reduction(vertices, faces, i, j, a=0.5, b=0.5):
    """The paper's cost reduction of the edge i-j, by brute-force subdivision.

    The virtual vertices are at the part a of the way from i to j, and b of that from k to l.
    """
    (k,) = _apexes(faces, i, j)
    (l,) = _apexes(faces, j, i)
    before = objective(*with_virtual_vertex(vertices, faces, i, j, a))
    after = objective(*with_virtual_vertex(vertices, flipped(faces, i, j), k, l, b))
    return before - after


def virtual_reduction_at(vertices, faces, i, j, t):
    """The mean over the four ways to count t from an end of each diagonal."""
    places = [(a, b) for a in (t, 1 - t) for b in (t, 1 - t)]
    return sum(virtual_reduction(vertices, faces, i, j, a, b) for a, b in places) / 4


def virtual_reduction_closest(vertices, faces, i, j, margin):
    """The cost reduction with the virtual vertices at the closest points of the diagonals."""
    (k,) = _apexes(faces, i, j)
    (l,) = _apexes(faces, j, i)
    places = closest_places(*np.asarray(vertices, np.longdouble)[[i, j, k, l]], margin)
    return virtual_reduction(vertices, faces, i, j, *places)


def closest_places(i, j, k, l, margin):
    """The parts of i-j and k-l where these are closest, from margin to 1 - margin.

    If not inside both, one is at an end, and the other as near as it gets: the best of all these.
    """
    u, w, r = j - i, l - k, k - i
    uu, uw, ww, ru, rw = u @ u, u @ w, w @ w, r @ u, r @ w
    ends = margin, 1 - margin
    tried = [(a, np.clip((a * uw - rw) / ww, *ends)) for a in ends]
    tried += [(np.clip((b * uw + ru) / uu, *ends), b) for b in ends]
    crossing = uu * ww - uw * uw
    if crossing != 0:
        inside = (ru * ww - rw * uw) / crossing, (ru * uw - rw * uu) / crossing
        tried += [inside] if margin <= min(inside) and max(inside) <= 1 - margin else []
    return min(tried, key=lambda places: np.sum((r + places[1] * w - places[0] * u) ** 2))


def edge_set(faces):
    """All vertex pairs that some face joins."""
    faces = np.asarray(faces)
    ends = np.sort(np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return set(map(tuple, ends.tolist()))


def interior_vertices(faces, count):
    """Mask of the vertices whose faces form one closed fan, by walking round each."""
    interior = np.zeros(count, bool)
    rolled = [np.roll(face, -c).tolist() for face in np.asarray(faces) for c in range(3)]
    for v in range(count):
        around = [(b, c) for a, b, c in rolled if a == v]
        ahead = dict(around)
        if not around or len(ahead) < len(around) or set(ahead) != set(ahead.values()):
            continue
        start = here = around[0][0]
        steps = 0
        while steps == 0 or here != start:
            here = ahead[here]
            steps += 1
        interior[v] = steps == len(around)
    return interior


def vertex_energy(vertices, faces):
    """W(v) at the interior vertices, 0 elsewhere."""
    rows, beta = edge_angles(vertices, faces)
    energy = np.zeros(len(vertices), np.longdouble)
    np.add.at(energy, rows[:, 0], beta)
    np.add.at(energy, rows[:, 1], beta)
    return np.where(interior_vertices(faces, len(vertices)), energy - 2 * np.pi, 0).astype(float)


def corner_angles(vertices, faces):
    """The angles (m, 3) of the faces, from the sum and the difference of the unit side vectors."""
    corners = np.asarray(vertices, np.longdouble)[np.asarray(faces)]
    angles = np.empty(corners.shape[:2], np.longdouble)
    for c in range(3):
        left, right = (corners[:, (c + side) % 3] - corners[:, c] for side in (1, 2))
        angles[:, c] = _angle_between(left, right)
    return angles


def angle_defects(vertices, faces):
    """2 pi minus the angles of the faces at the interior vertices."""
    # 2 pi in long double, which np.pi is not.
    defects = np.full(len(vertices), 2 * np.arctan2(np.longdouble(0), np.longdouble(-1)))
    np.subtract.at(defects, np.asarray(faces), corner_angles(vertices, faces))
    return defects[interior_vertices(faces, len(vertices))].astype(float)


def absolute_gaussian_curvature(vertices, faces):
    """Sum of the absolute angle defects of the interior vertices."""
    return float(np.abs(angle_defects(vertices, faces)).sum())


def mean_curvature(vertices, faces):
    """Sum over the interior edges of the length times the angle that the faces are bent by.

    The angle is that between the heights of k and l over the edge, taken across it.
    """
    i, j, k, l = np.asarray(vertices, np.longdouble)[diamonds(faces)].transpose(1, 0, 2)
    along = j - i
    squared = np.sum(along**2, axis=1, keepdims=True)

    def height(apex):
        offset = apex - i
        return offset - along * np.sum(offset * along, axis=1, keepdims=True) / squared

    return float(np.sum(_angle_between(height(k), -height(l)) * np.sqrt(squared[:, 0])))


def area(vertices, faces):
    """Sum of the areas of the faces, by Heron's formula as W. Kahan arranges it."""
    a, b, c = np.sort(_side_lengths(vertices, faces), axis=1)[:, ::-1].T
    product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))
    return float(np.sum(np.sqrt(product)) / 4)


def vertex_normals(vertices, faces):
    """Unit sums of the normals of the faces at each vertex, weighted with the areas."""
    sums = np.zeros_like(vertices)
    for i, j, k in faces:
        sums[[i, j, k]] += np.cross(vertices[j] - vertices[i], vertices[k] - vertices[i])
    return sums / np.linalg.norm(sums, axis=1)[:, None]


def cotangents(vertices, faces):
    """Sum of the cotangents of all angles of all faces."""
    return float(np.sum(1 / np.tan(corner_angles(vertices, faces))))


def with_all_middles(vertices, faces):
    """The mesh with a vertex in the middle of every edge, and each face split into four."""
    middles, points, finer = {}, list(np.asarray(vertices, np.longdouble)), []

    def middle(a, b):
        key = frozenset((a, b))
        if key not in middles:
            middles[key] = len(points)
            points.append((points[a] + points[b]) / 2)
        return middles[key]

    for a, b, c in map(tuple, np.asarray(faces).tolist()):
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.array(points), finer


def uniform_objective(vertices, faces):
    """The objective of the mesh with a virtual vertex on every edge, by brute-force subdivision."""
    return objective(*with_all_middles(vertices, faces))


def reduction(objective, vertices, faces, i, j):
    """What a function of vertices and faces loses by the flip of i-j."""
    return objective(vertices, faces) - objective(vertices, flipped(faces, i, j))


def _angle_between(u, v):
    """Angles between the vectors of two arrays (n, 3), as good near 0 and pi as elsewhere."""
    u, v = (x / np.sqrt(np.sum(x**2, axis=1, keepdims=True)) for x in (u, v))
    half = np.arctan2(*(np.sqrt(np.sum(x**2, axis=1)) for x in (u - v, u + v)))
    return 2 * half


def _side_lengths(vertices, faces):
    corners = np.asarray(vertices, np.longdouble)[np.asarray(faces)]
    return np.sqrt(np.sum((corners - np.roll(corners, 1, axis=1)) ** 2, axis=2))


def _apexes(faces, a, b):
    return [
        face[(c + 2) % 3]
        for face in map(tuple, faces)
        for c in range(3)
        if face[c] == a and face[(c + 1) % 3] == b
    ]
