"""Sets of meshes for the tests of the filters."""

import tempfile
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

import meshlab_willmore
from meshlab_willmore.meshset import late
from tests import meshes

SAMPLES = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"
FLIP = "meshing_edge_flip_by_willmore_optimization"


@pytest.fixture(autouse=True)
def registered():
    """Each test starts and ends with the filters in place."""
    meshlab_willmore.register()
    yield
    meshlab_willmore.register()


@pytest.fixture(params=["early", "late"])
def saved(request, monkeypatch):
    """When a mesh that may be saved late is saved: before its flips by a copy, or after them."""
    least = {"early": 10**9, "late": 0}[request.param]
    monkeypatch.setattr(late, "LEAST_FACES", least)
    return request.param


def set_of(vertices, faces, **more):
    """A set with one mesh that nobody holds."""
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(vertices, faces, **more), "mesh")
    return ms


@pytest.fixture
def bumpy():
    """A set with a closed mesh that has much to flip."""
    return set_of(*meshes.bumpy_sphere(300))


def random_transform(seed=3):
    transform = np.eye(4)
    transform[:3] = np.random.default_rng(seed).normal(size=(3, 4))
    return transform


def script_of(ms):
    """The filter script of a set as text."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "script.mlx"
        ms.save_filter_script(str(path))
        return path.read_text()
