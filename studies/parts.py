"""Surfaces made in code: parts with creases, and smooth ones. All are closed and finely meshed."""

import math

import numpy as np
import pymeshlab

# Of the edges of the parts, as a share of their diagonal in percent.
EDGE_PERCENT = 1.0
# Edges bent by more degrees than this are creases, and stay where they are.
CREASE = 20.0
ITERATIONS = 10
ROUND_SIDES = 96
BEND_RADIUS = 8.0


def bored_block():
    """A block minus a bore through it and a ball at one corner of its top."""
    block = prism([(0, 0), (4, 0), (4, 3), (0, 3)], 0, 2)
    bore = prism(circle((1.3, 1.5), 0.7), -1, 3)
    ball = placed(sphere(5), 1.1, (3.2, 1.6, 2.1))
    return evenly_meshed(difference(difference(block, bore), ball))


def filleted_block():
    """A block with two rounded edges and a bore across."""
    profile = [(0, 0), (4, 0), *arc((3.2, 1.2), 0.8, 0, 90), *arc((0.5, 1.5), 0.5, 90, 180)]
    block = prism(profile, 0, 3)
    bore = prism(circle((1.8, 0.9), 0.5), -1, 4)
    return evenly_meshed(difference(block, bore))


def thin_plate():
    """A plate with a hole, bent round a cylinder; its thickness is a fiftieth of its length."""
    plate = prism([(0, 0), (4, 0), (4, 2.4), (0, 2.4)], 0, 0.12)
    hole = prism(circle((2.6, 1.2), 0.5), -1, 1)
    vertices, faces = evenly_meshed(difference(plate, hole))
    angle, radius = vertices[:, 0] / BEND_RADIUS, BEND_RADIUS + vertices[:, 2]
    bent = np.column_stack([radius * np.sin(angle), vertices[:, 1], radius * np.cos(angle)])
    return bent, faces


def torus():
    """The torus with the radii 3 and 1."""
    return created("create_torus", hradius=3.0, vradius=1.0, hsubdiv=480, vsubdiv=160)


def ellipsoid():
    """The ellipsoid with the axes 4 : 1 : 0.5."""
    vertices, faces = sphere(6)
    return vertices * (4.0, 1.0, 0.5), faces


# --- what they are made of -----------------------------------------------------------------------


def created(name, **options):
    """The vertices (n, 3) and faces (m, 3) that a filter of PyMeshLab makes."""
    ms = pymeshlab.MeshSet()
    ms.apply_filter(name, **options)
    return arrays_of(ms)


def arrays_of(ms):
    """Copies of the vertices and faces of the current mesh."""
    mesh = ms.current_mesh()
    return mesh.vertex_matrix().copy(), mesh.face_matrix().astype(np.int32)


def sphere(subdivisions):
    return created("create_sphere", radius=1.0, subdiv=subdivisions)


def placed(surface, scale, offset):
    vertices, faces = surface
    return vertices * scale + offset, faces


def circle(middle, radius):
    return arc(middle, radius, 0, 360)[:-1]


def arc(middle, radius, start, stop):
    """Points on a circle from one angle to another, in degrees, both counted."""
    steps = round(ROUND_SIDES * (stop - start) / 360)
    angles = np.radians(np.linspace(start, stop, steps + 1))
    return [
        (middle[0] + radius * math.cos(angle), middle[1] + radius * math.sin(angle))
        for angle in angles
    ]


def prism(polygon, bottom, top):
    """The prism over a convex, counter-clockwise polygon in the plane of x and y."""
    flat = np.asarray(polygon, float)
    count = len(flat)
    here = np.arange(count)
    after = np.roll(here, -1)
    fan = np.column_stack([np.zeros(count - 2, int), here[1:-1], here[2:]])
    faces = [
        fan[:, ::-1],
        fan + count,
        np.column_stack([here, after, after + count]),
        np.column_stack([here, after + count, here + count]),
    ]
    rings = [np.column_stack([flat, np.full(count, height)]) for height in (bottom, top)]
    return np.vstack(rings).astype(float), np.vstack(faces).astype(np.int32)


def difference(first, second):
    """The first solid minus the second."""
    ms = pymeshlab.MeshSet()
    for surface in (first, second):
        ms.add_mesh(pymeshlab.Mesh(*surface))
    ms.generate_boolean_difference(first_mesh=0, second_mesh=1)
    return arrays_of(ms)


def evenly_meshed(surface):
    """A surface with triangles of one size, which keep its creases."""
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(*surface))
    ms.meshing_isotropic_explicit_remeshing(
        targetlen=pymeshlab.PercentageValue(EDGE_PERCENT),
        featuredeg=CREASE,
        iterations=ITERATIONS,
    )
    return arrays_of(ms)
