"""What holds for every result of `optimize_flips`."""

import numpy as np

from meshlab_willmore.mesh.build import build
from meshlab_willmore.results import FlipResult
from tests import reference
from tests.connectivity import validate_connectivity


def check(vertices, faces, result):
    assert isinstance(result, FlipResult)
    assert result.faces.dtype == np.int32
    assert result.faces.shape == np.shape(faces)
    assert result.corners.dtype == np.int32
    assert result.corners.shape == np.shape(faces)
    numbers = result.gain, result.willmore_before, result.willmore_after
    assert np.isfinite(numbers).all()
    # Chains ranked by the virtual energy are judged by another one.
    assert result.gain >= 0.0 or "chain" in result.reason
    assert [type(x) for x in result[1:7]] == [int, float, float, float, bool, str]
    faces = np.asarray(faces, np.int32).reshape(-1, 3)
    np.testing.assert_array_equal(result.faces.ravel(), faces.ravel()[result.corners.ravel()])
    validate_connectivity(build(np.asarray(vertices, float).reshape(-1, 3), result.faces))
    assert len(reference.edge_set(result.faces)) == len(reference.edge_set(faces))
    changed = (result.faces != faces).any(axis=1).sum()
    assert changed <= 2 * result.flips
