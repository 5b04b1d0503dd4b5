"""Each wrong input gets an error that names the culprit; what is odd but right passes."""

import numpy as np
import pytest

from meshlab_willmore.mesh import validate
from tests import meshes

VERTICES, FACES = meshes.cube()


def with_vertex(v, value, dtype=float):
    vertices = VERTICES.astype(dtype)
    vertices[v, 1] = value
    return vertices


def with_face(f, face):
    faces = FACES.copy()
    faces[f] = face
    return faces


@pytest.mark.parametrize(
    ("vertices", "error", "message"),
    [
        (VERTICES[:, :2], ValueError, r"shape \(count, 3\), not \(14, 2\)"),
        (VERTICES.ravel(), ValueError, r"shape \(count, 3\), not \(42,\)"),
        (VERTICES.astype(complex), TypeError, "complex128"),
        (VERTICES.astype(object), TypeError, "object"),
        (VERTICES.astype(bool), TypeError, "bool"),
        (VERTICES.astype(str), TypeError, "<U"),
        (with_vertex(5, np.nan), ValueError, "vertex 5 .*nan"),
        (with_vertex(13, -np.inf, np.float32), ValueError, "vertex 13 .*-inf"),
        (with_vertex(2, np.longdouble("1e400"), np.longdouble), ValueError, "vertex 2 .*inf"),
    ],
)
def test_wrong_vertices(vertices, error, message):
    with pytest.raises(error, match=message):
        validate.check_mesh(vertices, FACES)


@pytest.mark.parametrize(
    ("faces", "error", "message"),
    [
        (FACES[:, :2], ValueError, r"shape \(count, 3\), not \(24, 2\)"),
        (FACES.ravel(), ValueError, r"not \(72,\)"),
        (FACES.astype(float), TypeError, "integers, not float64"),
        (FACES.astype(bool), TypeError, "integers, not bool"),
        (FACES.astype(object), TypeError, "integers, not object"),
        (FACES.astype(complex), TypeError, "integers, not complex128"),
        (with_face(7, (0, 1, 14)), ValueError, r"face 7 .*0 .. 13: \[0, 1, 14\]"),
        (with_face(9, (0, -1, 2)), ValueError, r"face 9 .*\[0, -1, 2\]"),
        (np.full((1, 3), 2**63, np.uint64), ValueError, "face 0 .*9223372036854775808"),
        (with_face(3, (4, 5, 4)), ValueError, "face 3 .*repeated"),
        (with_face(4, (4, 5, 5)), ValueError, "face 4 .*repeated"),
        (with_face(4, (4, 4, 5)), ValueError, "face 4 .*repeated"),
    ],
)
def test_wrong_faces(faces, error, message):
    with pytest.raises(error, match=message):
        validate.check_mesh(VERTICES, faces)


def test_too_many_faces_for_the_numbering_of_half_edges():
    many = np.broadcast_to(FACES[:1], (validate.MOST_FACES + 1, 3))
    with pytest.raises(ValueError, match=str(validate.MOST_FACES)):
        validate.check_mesh(VERTICES, many)


def test_too_many_vertices():
    many = np.broadcast_to(VERTICES[:1], (validate.MOST_VERTICES + 1, 3))
    with pytest.raises(ValueError, match=str(validate.MOST_VERTICES)):
        validate.check_mesh(many, FACES)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        (VERTICES.tolist(), FACES.tolist()),
        (VERTICES.astype(np.float32), FACES.astype(np.uint8)),
        (np.asfortranarray(VERTICES), np.asfortranarray(FACES.astype(np.int64))),
        (VERTICES[::-1], FACES[::2]),
        (VERTICES, []),
        (VERTICES, np.empty((0, 3), int)),
        (VERTICES, np.empty((0, 3))),
        (VERTICES, np.empty((0, 3), str)),
        ([], []),
    ],
)
def test_what_numpy_can_read_becomes_float64_and_int32(vertices, faces):
    checked, corners = validate.check_mesh(vertices, faces)
    assert checked.dtype == np.float64
    assert corners.dtype == np.int32
    assert checked.flags.c_contiguous
    assert corners.flags.c_contiguous
    np.testing.assert_array_equal(checked, np.asarray(vertices).reshape(-1, 3))
    np.testing.assert_array_equal(corners, np.asarray(faces).reshape(-1, 3))


def test_nothing_is_of_any_type():
    for empty in ([], np.zeros((0, 2)), np.zeros((0, 2), object), np.zeros((0, 2), np.int8)):
        edges = validate.check_edges(empty)
        assert (edges.shape, edges.dtype) == ((0, 2), np.int64)
    mask = validate.check_mask([], 0)
    assert (mask.shape, mask.dtype) == ((0,), np.bool_)
    with pytest.raises(ValueError, match=r"shape \(count, 2\), not \(0, 3\)"):
        validate.check_edges(np.zeros((0, 3)))
    with pytest.raises(ValueError, match=r"shape \(5,\), not \(0,\)"):
        validate.check_mask([], 5)


def test_faces_without_vertices():
    with pytest.raises(ValueError, match=r"face 0 .*there are no vertices"):
        validate.check_mesh(np.empty((0, 3)), FACES)


@pytest.mark.parametrize("scale", [1.0, 3e-7, 1e300, 1e-300, 5e-324, 1.7e308])
def test_unit_scale_is_a_power_of_two(scale):
    vertices = VERTICES * scale
    scaled, exponent = validate.to_unit_scale(vertices, FACES)
    assert 0.5 <= np.abs(scaled).max() < 1.0
    np.testing.assert_array_equal(np.ldexp(scaled, exponent), vertices)


def test_what_is_too_small_beside_the_largest_counts_as_zero():
    """Products of a few such lengths leave the range of floats, and angles would be of any size."""
    vertices = np.vstack([VERTICES, 1e-120 * VERTICES])
    faces = np.vstack([FACES, np.asarray(FACES) + len(VERTICES)])
    scaled, exponent = validate.to_unit_scale(vertices, faces)
    np.testing.assert_array_equal(np.ldexp(scaled[: len(VERTICES)], exponent), VERTICES)
    assert (scaled[len(VERTICES) :] == 0.0).all()
    alone, _ = validate.to_unit_scale(1e-120 * VERTICES, FACES)
    assert np.abs(alone).max() >= 0.5


def test_unit_scale_does_not_look_at_vertices_of_no_face():
    far = np.vstack([VERTICES, [[1e300, 0.0, 0.0]]])
    scaled, _ = validate.to_unit_scale(far, FACES)
    assert scaled.max() >= 0.5
    assert (scaled[-1] == 0.0).all()


def test_a_number_that_was_never_set_is_no_warning():
    """PyMeshLab leaves any bits in texture coordinates that were not given, also these."""
    signalling = np.full((1, 3, 2), np.uint32(0x7FA00000)).view(np.float32)
    assert np.isnan(validate.check_wedge_uv(signalling, 1)).all()
    vertices = np.array(VERTICES, np.float32)
    vertices[2] = signalling[0, 0, 0]
    with pytest.raises(ValueError, match="vertex 2 has a coordinate that is not finite"):
        validate.check_mesh(vertices, FACES)
