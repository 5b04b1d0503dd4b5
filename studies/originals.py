"""What the study of faithful flips starts from: surfaces, and coarse triangulations of them."""

from typing import NamedTuple

import numpy as np
import pymeshlab

from meshlab_willmore.demo.scan import scan_file
from meshlab_willmore.mesh.build import build, faces_of
from studies import models, parts
from tests.search.ways import scramble

VERTICES = 3000
# Random flips for each edge.
SCRAMBLE = 0.3
# Of the mean edge, in each coordinate.
NOISE = 0.05


class Start(NamedTuple):
    """A mesh to be flipped: its vertices, its faces, and the surface that it approximates."""

    name: str
    vertices: np.ndarray
    faces: np.ndarray
    original: tuple[np.ndarray, np.ndarray]


MADE = {
    "CAD part": parts.bored_block,
    "CAD part, even": parts.bored_block,
    "filleted block": parts.filleted_block,
    "thin plate": parts.thin_plate,
    "torus": parts.torus,
    "ellipsoid": parts.ellipsoid,
}
SAMPLES = {
    "bunny": models.SAMPLES / "bunny.obj",
    "cow": models.SAMPLES / "cow.obj",
    "airplane": models.SAMPLES / "airplane.obj",
    "bone": models.SAMPLES / "bone.ply",
    "face scan": scan_file(),
}
# Coarser than the others, as their originals are.
FEWER = {"cow": 1500, "airplane": 2500, "bone": 900}
# Where planes keep vertices too.
EVEN = ("CAD part, even",)
NOISY = ("CAD part", "torus", "bunny")


def starts(names=(), vertices=None, seed=0):
    """The triangulations before they are scrambled; all, or those of the names.

    Parameters
    ----------
    vertices : int, optional
        About so many each; by default `VERTICES`, or `FEWER`.
    seed : int
        Of the noise.
    """
    for name in (*MADE, *SAMPLES):
        wanted = {name, f"{name}, noisy"} if name in NOISY else {name}
        wanted &= set(names) or wanted
        if not wanted:
            continue
        original = MADE[name]() if name in MADE else models.cleaned(SAMPLES[name])
        start = coarse(name, original, vertices or FEWER.get(name, VERTICES))
        if name in wanted:
            yield start
        if f"{name}, noisy" in wanted:
            yield noisy(start, seed)


def coarse(name, original, vertices):
    """Some of the vertices of a surface, none of them moved, by quadric decimation."""
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(*original))
    share = vertices / len(original[0])
    ms.meshing_decimation_quadric_edge_collapse(
        targetfacenum=round(share * len(original[1])),
        optimalplacement=False,
        preservenormal=True,
        planarquadric=name in EVEN,
    )
    ms.meshing_remove_unreferenced_vertices()
    return Start(name, *parts.arrays_of(ms), original)


def noisy(start, seed):
    """The same triangulation with noise on the vertices."""
    a, b, c = start.vertices[start.faces].transpose(1, 0, 2)
    edge = np.linalg.norm(np.concatenate([b - a, c - b, a - c]), axis=1).mean()
    noise = np.random.default_rng(seed).normal(0.0, NOISE * edge, start.vertices.shape)
    return start._replace(name=f"{start.name}, noisy", vertices=start.vertices + noise)


def scrambled(start, seed=0, flips_per_edge=SCRAMBLE):
    """The faces after random legal flips, under the fold guard."""
    return faces_of(scramble(build(start.vertices, start.faces), seed, flips_per_edge))
