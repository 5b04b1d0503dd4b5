"""What is packed for the viewer, read again as it reads it."""

import base64
import zlib

import numpy as np
import pytest

from meshlab_willmore import optimize_flips
from meshlab_willmore.report.pack import STEPS, Shown, grid_of, packed
from tests import meshes


class Reader:
    """Reads the stream of bytes, in plain Python."""

    def __init__(self, text):
        self._data = zlib.decompress(base64.b64decode(text))
        self._at = 0

    def take(self, count):
        part = self._data[self._at : self._at + count]
        assert len(part) == count
        self._at += count
        return list(part)

    def numbers(self, count, planes):
        parts = [self.take(count) for _ in range(planes)]
        return [sum(part[i] << 8 * p for p, part in enumerate(parts)) for i in range(count)]

    def is_at_end(self):
        return self._at == len(self._data)


def read(head, text):
    """The meshes as (positions, energies, corners, dihedral levels, flips)."""
    reader, found = Reader(text), []
    for size in head["meshes"]:
        n, m = size["vertices"], size["faces"]
        old = found[-1] if found and head["isSame"] else None
        if old is None:
            steps = np.array(reader.numbers(3 * n, 2)).reshape(3, n).astype(np.uint16)
            positions = steps.cumsum(axis=1, dtype=np.uint16).astype(np.int16).T
            energy = reader.take(n)
            corners, seen = [], 0
            for code in reader.numbers(3 * m, 4):
                corners.append(seen - code)
                seen += code == 0
            dihedral = reader.take(3 * m)
        else:
            positions = old[0]
            energy = [(a + b) % 256 for a, b in zip(reader.take(n), old[1], strict=True)]
            steps = [-(s + 1) // 2 if s & 1 else s // 2 for s in reader.numbers(3 * m, 4)]
            corners = (np.array(steps) + old[2].ravel()).tolist()
            dihedral = [(a + b) % 256 for a, b in zip(reader.take(3 * m), old[3], strict=True)]
        found.append(
            (positions, energy, np.array(corners).reshape(-1, 3), dihedral, reader.take(m))
        )
    assert reader.is_at_end()
    return found


def shown(vertices, faces, seed=0):
    """A mesh with values that all differ."""
    rng = np.random.default_rng(seed)
    return Shown(
        np.asarray(vertices),
        np.asarray(faces, np.int32),
        10.0 ** rng.uniform(-6, 2, len(vertices)),
        rng.uniform(0, 180, (len(faces), 3)),
        rng.random((len(faces), 3)) < 0.5,
    )


def corner_set(positions, faces, *values):
    """The corners of faces with what is said of them, in an order that means nothing."""
    return {
        frozenset(
            (tuple(positions[v]), *(value[f][c] for value in values)) for c, v in enumerate(face)
        )
        for f, face in enumerate(faces.tolist())
    }


def expected(mesh, grid):
    places = np.rint(grid.on_grid(mesh.vertices) * STEPS).astype(int).tolist()
    levels = np.rint(mesh.dihedral / 180 * 255).astype(int).tolist()
    return corner_set(places, mesh.faces, levels, mesh.flipped.tolist())


@pytest.mark.parametrize("kind", ["flips", "other mesh", "points", "scattered"])
def test_viewer_gets_what_was_packed(kind):
    vertices, faces = meshes.bumpy_sphere(150)
    if kind == "flips":
        before = shown(vertices, faces)
        after = shown(vertices, optimize_flips(vertices, faces).faces, 1)
    elif kind == "other mesh":
        before, after = shown(*meshes.octahedron()), shown(vertices, faces, 1)
    elif kind == "points":
        before, after = shown(vertices, np.empty((0, 3))), shown(vertices, faces, 1)
    else:
        # Vertices and faces in no order, and vertices of no face.
        rng = np.random.default_rng(2)
        order = rng.permutation(2 * len(vertices))[: len(vertices)]
        spread = np.full((2 * len(vertices), 3), 100.0)
        spread[order] = vertices
        before = shown(spread, rng.permutation(order[faces]))
        after = before._replace(energy=before.energy[::-1])
    grid = grid_of(before, after)
    head, text = packed(before, after, grid)
    assert head["isSame"] == (kind in ("flips", "scattered"))
    for mesh, got in zip((before, after), read(head, text), strict=True):
        positions, _, corners, dihedral, flips = got
        sides = [[bool(bits >> c & 1) for c in range(3)] for bits in flips]
        rows = np.array(dihedral).reshape(-1, 3).tolist()
        assert corner_set(positions.tolist(), corners, rows, sides) == expected(mesh, grid)


def test_energies_are_on_a_logarithmic_scale():
    vertices, faces = meshes.octahedron()
    energy = np.array([0.0, 1e-5, 1e-4 * 1.0001, 10**-1.5, 10.0, 1e5])
    mesh = shown(vertices, faces)._replace(energy=energy)
    head, text = packed(mesh, mesh, grid_of(mesh))
    positions, levels, *_ = read(head, text)[0]
    place = {tuple(p): level for p, level in zip(positions.tolist(), levels, strict=True)}
    order = (vertices * STEPS).astype(int).tolist()
    assert [place[tuple(p)] for p in order] == [0, 0, 1, 128, 255, 255]
