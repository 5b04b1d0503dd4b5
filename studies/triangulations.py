"""Triangulations of the paper's cube: those that keep its edges, and those that flips reach.

A side of the cube is a quad (a, b, c, d) with a point m inside. It can be triangulated in five
ways: a fan of four faces around m, or one corner is cut off by a diagonal and m, of valence 3, is
joined to the other three. Sides do not matter to each other, so there are 5^6 = 15,625 ways to
triangulate the cube without a flip of its edges; the 48 symmetries of the cube make classes of
them. Beyond these, a search goes from triangulation to triangulation by flips of any edge.
"""

import heapq
import itertools
from typing import NamedTuple

import numpy as np

from meshlab_willmore.energy import area, gaussian_curvature, mean_curvature, willmore
from meshlab_willmore.mesh.build import build
from meshlab_willmore.mesh.halfedge import flip, following, next_in_fan
from meshlab_willmore.mesh.jit import allocating_jit, jit
from meshlab_willmore.mesh.points import angle_between, cross, dot, norm, point, subtract
from tests.connectivity import can_flip
from tests.meshes import CUBE_QUADS, cube

SIDES = np.array(CUBE_QUADS)
CORNERS = 8
WAYS = 5
FAN = 4
FULL_TURN = 2.0 * np.pi
# Four of the corners and centres are in one plane up to this (all are within one unit).
FLAT = 1e-9


def faces_of_ways(ways):
    """The faces (24, 3) of the cube with the given way (0 .. 4) for each side.

    `FAN` is the fan, 0 to 3 the corner that is cut off.
    """
    faces = []
    for side, way in enumerate(ways):
        m = CORNERS + side
        if way == FAN:
            ring = SIDES[side]
        else:
            cut, *ring = np.roll(SIDES[side], -way)
            faces.append((ring[-1], cut, ring[0]))
        faces += [(a, b, m) for a, b in zip(ring, np.roll(ring, -1), strict=True)]
    return np.array(faces, np.int32)


def symmetries():
    """The 48 permutations (48, 14) of corners and centres that are symmetries of the cube."""
    vertices = cube(0.1)[0] - 0.5
    found = []
    for axes in itertools.permutations(range(3)):
        for signs in itertools.product((-1.0, 1.0), repeat=3):
            moved = vertices[:, axes] * signs
            distance = np.abs(moved[:, None] - vertices[None]).sum(axis=2)
            found.append(distance.argmin(axis=1))
    return np.array(found)


def classes():
    """One of each class of the 5^6 triangulations under the symmetries, and the class sizes.

    Returns
    -------
    ways : (c, 6) int
        As `faces_of_ways` takes them.
    sizes : (c,) int
        They sum to 5^6.
    """
    ways = np.array(list(itertools.product(range(WAYS), repeat=len(SIDES))))
    corner_of = np.column_stack([SIDES, np.full(len(SIDES), -1)])
    powers = WAYS ** np.arange(len(SIDES))
    least = np.full(len(ways), WAYS ** len(SIDES))
    for number in symmetries():
        code = np.zeros(len(ways), int)
        moves_to = np.append(number[:CORNERS], -1)
        for side in range(len(SIDES)):
            image = number[CORNERS + side] - CORNERS
            corners = moves_to[corner_of[side]]
            place = np.array([list(corner_of[image]).index(corner) for corner in corners])
            code += place[ways[:, side]] * powers[image]
        least = np.minimum(least, code)
    _, first, sizes = np.unique(least, return_index=True, return_counts=True)
    return ways[first], sizes


@jit
def _is_side_of_cone(a, b, directions):
    """Whether the cone of the directions has a face from a to b, all others to its left."""
    n = cross(a, b)
    if norm(n) <= FLAT:
        return False
    for row in range(len(directions)):
        c = point(directions, row)
        height = dot(n, c)
        if height < -FLAT:
            return False
        if height <= FLAT and (dot(cross(a, c), n) < -FLAT or dot(cross(c, b), n) < -FLAT):
            return False
    return True


@jit
def _cone_curvature(directions):
    """2 pi minus the angles of the convex cone of unit vectors; 0 if they span a half-space."""
    perimeter = 0.0
    for one in range(len(directions)):
        for other in range(len(directions)):
            a, b = point(directions, one), point(directions, other)
            if one != other and _is_side_of_cone(a, b, directions):
                perimeter += angle_between(a, b)
    return FULL_TURN - perimeter if perimeter > 0.0 else 0.0


@allocating_jit
def extrinsic_curvature(mesh):
    """The total absolute extrinsic curvature of a closed mesh: that of a tight triangulation.

    At each vertex the curvature K splits into the positive part, the curvature of the convex cone
    of the star (0 where the vertex is inside that cone), and a negative part, the rest: K = P - N.
    The sum is that of P + N, which is |K| only where one of them vanishes (L. Alboul and R. van
    Damme, "Polyhedral metrics in surface reconstruction", 1996).
    """
    defects = gaussian_curvature.angle_defects(mesh)
    total = 0.0
    seen = np.zeros(len(mesh.vertices), np.bool_)
    directions = np.empty((len(mesh.vertices), 3))
    for start in range(len(mesh.origin)):
        v = mesh.origin[start]
        if seen[v]:
            continue
        seen[v] = True
        count, h = 0, start
        while count == 0 or h != start:
            u = subtract(point(mesh.vertices, mesh.origin[following(h)]), point(mesh.vertices, v))
            length = norm(u)
            directions[count, 0] = u.x / length
            directions[count, 1] = u.y / length
            directions[count, 2] = u.z / length
            count += 1
            h = next_in_fan(mesh, h)
        total += 2.0 * _cone_curvature(directions[:count]) - defects[v]
    return total


@allocating_jit
def totals(mesh):
    """Area, absolute Gaussian and extrinsic curvature, M, and W (as the objective) of a mesh."""
    return (
        area.total(mesh),
        gaussian_curvature.total(mesh),
        extrinsic_curvature(mesh),
        mean_curvature.total(mesh),
        willmore.total(mesh),
    )


TOTALS = ["area", "abs K", "extrinsic", "M", "W"]


@jit
def _name(mesh, numbers, weights):
    """A number that is the same for all symmetric copies of a mesh, and for hardly any other.

    A triangulation of the sphere without double edges is known by its edges.
    """
    least = np.uint64(0xFFFFFFFFFFFFFFFF)
    for s in range(len(numbers)):
        code = np.uint64(0)
        for h in range(len(mesh.origin)):
            if h < mesh.twin[h]:
                a = numbers[s, mesh.origin[h]]
                b = numbers[s, mesh.origin[mesh.twin[h]]]
                code += weights[min(a, b), max(a, b)]
        least = min(least, code)
    return least


@allocating_jit
def _neighbours(mesh, measure, numbers, weights, values, names, faces):
    """Write down what each flip leads to; return the number of flips."""
    count = 0
    for h in range(len(mesh.origin)):
        if h < mesh.twin[h] and can_flip(mesh, h):
            flip(mesh, h)
            values[count] = totals(mesh)[measure]
            names[count] = _name(mesh, numbers, weights)
            faces[count] = mesh.origin
            count += 1
            flip(mesh, h)
            flip(mesh, h)
            flip(mesh, h)
    return count


class Found(NamedTuple):
    """The best triangulation of a search: what it measures, its faces, and how it was found."""

    value: float
    faces: np.ndarray
    expanded: int


def best_first(vertices, starts, measure, limit, is_allowed=None):
    """Search the triangulations for the least total, always from the best one not yet left.

    Parameters
    ----------
    vertices : (14, 3) float64
        Of the cube.
    starts : list of (24, 3) int32
    measure : str
        One of `TOTALS`.
    limit : int
        Number of triangulations from which all flips are tried.
    is_allowed : callable, optional
        Of the faces; others are not entered.

    Returns
    -------
    Found
    """
    which, numbers = TOTALS.index(measure), symmetries()
    count = len(vertices)
    weights = np.random.default_rng(0).integers(0, 2**64, (count, count), np.uint64)
    edges = 3 * (count - 2)
    values, names = np.empty(edges), np.empty(edges, np.uint64)
    around = np.empty((edges, 2 * edges), np.int32)
    seen, queue, best, expanded = set(), [], Found(np.inf, np.empty((0, 3)), 0), 0
    for faces in starts:
        mesh = build(vertices, faces)
        name = int(_name(mesh, numbers, weights))
        if name not in seen:
            seen.add(name)
            heapq.heappush(queue, (totals(mesh)[which], name, faces))
    while queue and expanded < limit:
        value, _, faces = heapq.heappop(queue)
        if is_allowed is not None and not is_allowed(faces):
            continue
        expanded += 1
        if value < best.value:
            best = Found(value, faces, expanded)
        mesh = build(vertices, faces)
        for n in range(_neighbours(mesh, which, numbers, weights, values, names, around)):
            name = int(names[n])
            if name not in seen:
                seen.add(name)
                heapq.heappush(queue, (values[n], name, around[n].reshape(-1, 3).copy()))
    return best._replace(expanded=expanded)
