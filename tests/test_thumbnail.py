"""Pictures of meshes, drawn with NumPy."""

import struct
import zlib

import numpy as np
import pytest

from meshlab_willmore import thumbnail
from meshlab_willmore.thumbnail import picture, view_of
from tests import meshes

FRONT = np.eye(3)
UNIT_SQUARE = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
HALVES = np.array([[0, 1, 2], [0, 2, 3]])


def pixels(png):
    """Grey and opacity (rows, columns, 2) of a file without filters."""
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    at, parts = 8, {}
    while at < len(png):
        (length,) = struct.unpack(">I", png[at : at + 4])
        name, data = png[at + 4 : at + 8], png[at + 8 : at + 8 + length]
        (check,) = struct.unpack(">I", png[at + 8 + length : at + 12 + length])
        assert check == zlib.crc32(name + data)
        parts[name] = data
        at += 12 + length
    width, height = struct.unpack(">II", parts[b"IHDR"][:8])
    rows = np.frombuffer(zlib.decompress(parts[b"IDAT"]), np.uint8).reshape(height, -1)
    assert not rows[:, 0].any()
    return rows[:, 1:].reshape(height, width, 2).astype(int)


def test_square_fills_the_picture_but_for_a_margin():
    opacity = pixels(picture(UNIT_SQUARE, HALVES, 100, 50, FRONT))[..., 1]
    assert (opacity[3:47, 28:72] == 255).all()
    assert not opacity[:, :26].any()
    assert not opacity[:, 74:].any()
    assert opacity.sum() / 255 == pytest.approx((0.92 * 50) ** 2, rel=0.03)


def test_nearest_face_is_seen_in_any_order_of_faces():
    near, far = UNIT_SQUARE + [0, 0, 1], UNIT_SQUARE @ np.diag([1, 1, 0])
    vertices = np.concatenate([far, near * [0.5, 0.5, 1]])
    # The near one is turned round, and so darker.
    faces = np.concatenate([HALVES, HALVES[:, ::-1] + 4])
    one = pixels(picture(vertices, faces, 60, 60, FRONT))
    other = pixels(picture(vertices, faces[::-1], 60, 60, FRONT))
    np.testing.assert_array_equal(one, other)
    assert one[30, 30, 0] < one[5, 5, 0]
    assert one[30, 30, 0] == one[20, 20, 0]


def test_pieces_make_the_same_picture(monkeypatch):
    vertices, faces = meshes.bumpy_sphere(300)
    whole = picture(vertices, faces, 80, 60)
    monkeypatch.setattr(thumbnail, "CHUNK", 100)
    assert picture(vertices, faces, 80, 60) == whole


def test_pixels_are_those_whose_centres_are_inside():
    vertices, faces = meshes.bumpy_sphere(60)
    flat = thumbnail._on_screen(thumbnail._in_unit_cube(vertices), faces, FRONT, 20, 15)
    owned = set()
    numbers, depths, owners = thumbnail._fragments(flat, 20, 15)
    for pixel, owner in zip(numbers.tolist(), owners.tolist(), strict=True):
        owned.add((pixel, owner))
    for f, (a, b, c) in enumerate(flat[:, :, :2]):
        for pixel in range(20 * 15):
            p = np.array([pixel % 20 + 0.5, pixel // 20 + 0.5])
            turns = [np.linalg.det([y - x, p - x]) for x, y in ((a, b), (b, c), (c, a))]
            is_inside = min(turns) > 1e-9 or max(turns) < -1e-9
            is_outside = min(turns) < -1e-9 < 1e-9 < max(turns)
            if is_inside or is_outside:
                assert ((pixel, f) in owned) == is_inside
    assert np.isfinite(depths).all()


def test_open_surface_is_seen_from_its_front_and_a_closed_one_obliquely():
    vertices, faces = meshes.patch(100)
    turn = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    for placed in (vertices, vertices @ turn):
        towards = view_of(placed, faces)[2]
        normals = np.cross(*np.diff(placed[faces], axis=1).transpose(1, 0, 2))
        assert towards @ normals.sum(axis=0) / np.linalg.norm(normals.sum(axis=0)) > 0.999
    view = view_of(*meshes.bumpy_sphere(100))
    np.testing.assert_allclose(view @ view.T, np.eye(3), atol=1e-12)
    assert (view[2] > 0.2).all()


@pytest.mark.parametrize("scale", [1e-300, 1e-160, 1e160, 1e300])
def test_scale_does_not_matter(scale):
    vertices, faces = meshes.bumpy_sphere(200)
    assert picture(vertices * scale, faces, 40, 30) == picture(vertices, faces, 40, 30)


@pytest.mark.parametrize(
    ("vertices", "faces"),
    [
        (np.empty((0, 3)), np.empty((0, 3), int)),
        (UNIT_SQUARE, np.empty((0, 3), int)),
        (np.ones((3, 3)), np.array([[0, 1, 2]])),
        (np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]), np.array([[0, 1, 2]])),
    ],
)
def test_nothing_to_see_is_an_empty_picture(vertices, faces):
    assert not pixels(picture(vertices, faces, 20, 10)).any()
