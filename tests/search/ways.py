"""What the tests of the searches share: meshes, rules, and all triangulations of a few points."""

import itertools

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.energy import willmore
from meshlab_willmore.energy.table import ENERGIES
from meshlab_willmore.mesh.build import build, faces_of
from meshlab_willmore.mesh.halfedge import NONE, flip, following
from meshlab_willmore.search.rules import Rules
from tests import meshes
from tests.connectivity import can_flip

GUARDED, FREE = guards.fold_limits(90.0), guards.fold_limits(180.0, 0.0)


def some_locked():
    vertices, faces = meshes.bumpy_sphere(40, 3, bump=0.6)
    mesh = build(vertices, faces)
    guards.lock_unselected(mesh, vertices[faces].mean(axis=1)[:, 0] > -0.3)
    return mesh


def shuffled(count, seed, bump=0.6):
    """A bumpy sphere after random flips: far from optimal, with 3-cycles that are no faces."""
    mesh = build(*meshes.bumpy_sphere(count, seed, bump))
    rng = np.random.default_rng(seed)
    for _ in range(4 * count):
        flip(mesh, rng.choice([h for h in range(len(mesh.origin)) if can_flip(mesh, h)]))
    mesh.corner[:] = np.arange(len(mesh.corner))
    return mesh


MESHES = {
    "closed": lambda: build(*meshes.bumpy_sphere(40, 1, bump=0.6)),
    "boundary": lambda: build(*meshes.patch(40, 1, height=0.6)),
    "flat boundary": lambda: build(*meshes.patch(30, height=0.0)),
    "cube": lambda: build(*meshes.cube(0.1)),
    "fin": lambda: build(*meshes.fin()[:2]),
    "locked": some_locked,
    "moebius band": lambda: build(*meshes.moebius_band()),
    "empty": lambda: build(np.zeros((0, 3)), np.zeros((0, 3), np.int32)),
    "two triangles": lambda: build(*meshes.two_triangles()),
}


each_energy_and_mesh = pytest.mark.parametrize(
    ("energy", "name"), list(itertools.product(ENERGIES, MESHES))
)


def rules_for(energy, fold=GUARDED):
    """The rules under which an energy is lowered; lengths are near 1 in these meshes."""
    row = ENERGIES[energy]
    return Rules(
        fold,
        not row.is_potential,
        is_potential=row.is_potential,
        is_wide=row.is_wide,
        is_narrow=row.is_narrow,
    )


def ends(mesh, h):
    return frozenset((int(mesh.origin[h]), int(mesh.origin[following(h)])))


def interrupted(kernel, number):
    """A kernel that is interrupted in its call of that number, and what its calls began with."""
    calls = []

    def interrupting(state, progress, *more):
        calls.append(progress)
        if len(calls) == number:
            raise KeyboardInterrupt
        return kernel(state, progress, *more)

    return interrupting, calls


def locked_edges(mesh):
    return {ends(mesh, h) for h in np.flatnonzero(mesh.locked)}


def assert_equal(one, other):
    """All arrays of two meshes, bit for bit."""
    for x, y in zip(one, other, strict=True):
        np.testing.assert_array_equal(x, y)


def scramble(mesh, seed, flips_per_edge=2):
    """Make random flips that connectivity and fold guard allow."""
    rng = np.random.default_rng(seed)
    left = round(flips_per_edge * len(mesh.origin) / 2)
    while left > 0:
        for h in rng.integers(0, len(mesh.origin), left):
            if can_flip(mesh, h) and not guards.folds(mesh, h, GUARDED):
                flip(mesh, h)
                left -= 1
    return mesh


def least_energy(vertices, faces):
    """The least Willmore energy of all triangulations that flips lead to, by trying them all."""
    seen, waiting = set(), [np.asarray(faces)]
    least = np.inf
    while waiting:
        mesh = build(vertices, waiting.pop())
        least = min(least, willmore.total(mesh))
        for h in np.flatnonzero(mesh.twin != NONE):
            if h < mesh.twin[h] and can_flip(mesh, h):
                flip(mesh, h)
                key = frozenset(map(_rolled, mesh.origin.reshape(-1, 3).tolist()))
                if key not in seen:
                    seen.add(key)
                    waiting.append(faces_of(mesh))
                for _ in range(3):
                    flip(mesh, h)
    return least, len(seen)


def _rolled(face):
    c = face.index(min(face))
    return tuple(face[c:] + face[:c])
