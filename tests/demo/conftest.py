"""The cleaned scan, which several tests need, and a build of PyMeshLab without it."""

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.demo import scan as scan_module
from meshlab_willmore.demo.models import surface_of
from meshlab_willmore.demo.scan import CLEANING, scan_file


@pytest.fixture(scope="session")
def cleaned():
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(scan_file()))
    for name, given in CLEANING:
        meshes.apply_filter(name, **given)
    return surface_of(meshes)


@pytest.fixture
def no_scan(monkeypatch, tmp_path):
    monkeypatch.setattr(scan_module, "SCAN_IN_WHEEL", tmp_path / "nowhere" / "face000.ply")


def canonical(faces):
    """Faces as sorted tuples, each turned so that its smallest index comes first."""
    faces = np.asarray(faces)
    turns = (faces.argmin(axis=1)[:, None] + np.arange(3)) % 3
    return sorted(map(tuple, np.take_along_axis(faces, turns, axis=1).tolist()))


def upright(surface):
    """Share of the edges that rise more than twice as far as they go across."""
    a, b = surface.vertices[surface.faces], surface.vertices[surface.faces[:, [1, 2, 0]]]
    across, along = np.abs(b - a)[:, :, 0], np.abs(b - a)[:, :, 1]
    return (along > 2 * across).mean()
