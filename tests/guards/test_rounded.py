"""What MeshLab says of two faces is never missed, and mostly met."""

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.guards import faces
from meshlab_willmore.mesh.validate import to_unit_scale
from tests.guards.test_triangles import FAMILIES, PATTERNS

PAIRS = 150
SCALES = [1.0, 1000.0, 0.01]
OFFSETS = [0.0, 10.0]


def counted(vertices, corners):
    """The number of faces that MeshLab counts."""
    ms = pymeshlab.MeshSet(verbose=False)
    ms.add_mesh(pymeshlab.Mesh(vertices, corners))
    ms.compute_selection_by_self_intersections_per_face()
    return ms.current_mesh().selected_face_number()


@pytest.mark.parametrize("sharing", PATTERNS)
@pytest.mark.parametrize("family", FAMILIES)
def test_what_meshlab_counts_is_counted(family, sharing):
    rng = np.random.default_rng(1)
    corners = np.array(PATTERNS[sharing], np.int32)
    agreed = 0
    for _ in range(PAIRS):
        vertices = np.asarray(FAMILIES[family](rng), float)
        vertices = vertices * rng.choice(SCALES) + rng.choice(OFFSETS)
        scaled, exponent = to_unit_scale(vertices, corners)
        one, other = (faces.face_of(scaled, *face) for face in corners)
        said = faces.count_as_cut(one, other, faces.match(one, other), 4.0**exponent)
        # MeshLab looks at a pair in the order of its faces, or in both.
        wanted = counted(vertices, corners) > 0 or counted(vertices, corners[::-1]) > 0
        assert said == faces.count_as_cut(other, one, faces.match(other, one), 4.0**exponent)
        assert said or not wanted, vertices.tolist()
        agreed += said == wanted
    assert agreed >= 0.95 * PAIRS
