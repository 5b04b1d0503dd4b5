"""The models of the studies, and how their tables are printed."""

import pathlib

import numpy as np
import pymeshlab

from meshlab_willmore.demo.models import Surface
from meshlab_willmore.demo.scan import CLEANING, scan_file, stretched_triangulation
from tests import meshes

SAMPLES = pathlib.Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"
MAJOR_RADIUS = 3.0


def cleaned(path):
    """The vertices and faces of a file after the demo's cleaning."""
    loaded = pymeshlab.MeshSet()
    loaded.load_new_mesh(str(path))
    return _clean(loaded)


def face():
    """The paper's third model: points of the face scan, Delaunay in a stretched domain."""
    stretched = pymeshlab.MeshSet()
    scan = cleaned(scan_file())
    surface = stretched_triangulation(Surface(*scan))
    stretched.add_mesh(pymeshlab.Mesh(*surface))
    return _clean(stretched)


def bunny():
    return cleaned(SAMPLES / "bunny.obj")


def tori():
    """The paper's second model, on a jittered grid and at random."""
    yield "torus(2000, 0.3, 8)", *meshes.torus(2000, 0.3, 8)
    yield "torus(2000, None, 1)", *meshes.torus(2000, None, 1)


def all_models():
    """Name, vertices and faces of each, one at a time."""
    yield "cube", *meshes.cube(0.05)
    yield from tori()
    yield "face, stretched", *face()
    yield "bunny", *bunny()


def torus_normal_error(vertices, faces):
    """Mean angle in degrees between the faces' normals and those of the torus at their centres."""
    a, b, c = vertices[faces].transpose(1, 0, 2)
    found = np.cross(b - a, c - a)
    centre = (a + b + c) / 3.0
    flat = centre * (1.0, 1.0, 0.0)
    wanted = centre - MAJOR_RADIUS * flat / np.linalg.norm(flat, axis=1)[:, None]
    sine = np.linalg.norm(np.cross(found, wanted), axis=1)
    return float(np.degrees(np.arctan2(sine, (found * wanted).sum(axis=1))).mean())


def print_table(head, rows):
    """Print a table in Markdown."""
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |", flush=True)


def _clean(loaded):
    for name, options in CLEANING:
        loaded.apply_filter(name, **options)
    mesh = loaded.current_mesh()
    return mesh.vertex_matrix().copy(), mesh.face_matrix().astype(np.int32)
