"""Small shaded pictures of triangle meshes, as PNG files, with NumPy alone.

Triangles are cut into spans, one for each row of pixels, and spans into pixels; of each pixel the
nearest triangle is seen. Pictures are drawn larger and averaged, so edges are smooth. They hold
grey and opacity, and so look right on light and dark pages.
"""

from __future__ import annotations

import struct
import zlib
from base64 import b64encode
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Pixels of a picture are averages of squares with so many on each side.
OVERSAMPLING = 2
# Of the smaller side of the picture.
MARGIN = 0.04
# Pixels that are drawn at a time: memory is a matter of these, not of the mesh.
CHUNK = 2_000_000

# A key light from the upper left, and a weak one from the camera.
KEY_LIGHT = np.array([-0.48, 0.52, 0.71])
KEY, FILL, AMBIENT = 0.56, 0.26, 0.16
# Inside faces that are seen from behind are darker.
BEHIND = 0.6
# A surface whose normals have a mean longer than this is open, and is seen from its front.
OPEN = 0.25
# Towards the viewer of a closed one.
OBLIQUE = np.array([0.48, 0.36, 0.8])

_PNG = b"\x89PNG\r\n\x1a\n"
_GREY_WITH_ALPHA = 4


def view_of(vertices: Array, faces: NDArray[np.integer]) -> Array:
    """Return a rotation that shows much of a mesh: an open one from its front, others obliquely.

    Its rows are the directions to the right, upwards, and towards the viewer.
    """
    normals = _normals(_in_unit_cube(vertices)[faces])
    mean, size = normals.sum(axis=0), np.linalg.norm(normals, axis=1).sum()
    is_open = size > 0.0 and np.linalg.norm(mean) > OPEN * size
    towards = mean if is_open else OBLIQUE
    towards = towards / np.linalg.norm(towards)
    up = np.array([0.0, 1.0, 0.0]) if abs(towards[1]) < 0.9 else np.array([0.0, 0.0, -1.0])
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(towards, right), towards])


def picture(
    vertices: Array, faces: NDArray[np.integer], width: int, height: int, view: Array | None = None
) -> bytes:
    """Return a PNG file with a shaded picture of a mesh on a transparent ground.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int
    width, height : int
        In pixels.
    view : (3, 3) float64, optional
        As `view_of` returns it.
    """
    rows, columns = height * OVERSAMPLING, width * OVERSAMPLING
    light = np.zeros((rows, columns))
    seen = np.zeros((rows, columns))
    if len(faces):
        view = view_of(vertices, faces) if view is None else view
        vertices = _in_unit_cube(vertices)
        corners = _on_screen(vertices, faces, view, columns, rows)
        shades = _shades(_normals(vertices[faces]) @ view.T)
        nearest = np.full(rows * columns, -np.inf)
        for chunk in _chunks(corners):
            pixels, depths, owners = _fragments(corners[chunk], columns, rows)
            # Later ones overwrite earlier ones: the nearest comes last.
            order = np.argsort(depths, kind="stable")
            order = order[depths[order] > nearest[pixels[order]]]
            nearest[pixels[order]] = depths[order]
            light.ravel()[pixels[order]] = shades[chunk][owners[order]]
            seen.ravel()[pixels[order]] = 1.0
    opacity = _averaged(seen)
    with np.errstate(invalid="ignore"):
        grey = np.where(opacity > 0.0, _averaged(light) / opacity, 0.0)
    return _png(np.stack([grey, opacity], axis=-1))


def data_uri(png: bytes) -> str:
    """Return a PNG file as the address of a picture inside a page."""
    return "data:image/png;base64," + b64encode(png).decode("ascii")


def _in_unit_cube(vertices: Array) -> Array:
    """The vertices (n, 3), moved and scaled so that no product of coordinates is out of range."""
    if not len(vertices):
        return vertices
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    # Halves first: the difference of the largest numbers is infinite.
    half = (high / 2.0 - low / 2.0).max()
    return (vertices / 2.0 - (low / 4.0 + high / 4.0)) / half if half > 0.0 else vertices - low


def _normals(corners: Array) -> Array:
    """The normals (m, 3) of triangles (m, 3, 3), as long as twice their areas."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _shades(normals: Array) -> Array:
    """How light triangles with these normals (m, 3), as the viewer sees them, are: 0 to 1."""
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    unit = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0.0)
    is_behind = unit[:, 2] < 0.0
    unit[is_behind] *= -1.0
    light = AMBIENT + FILL * unit[:, 2] + KEY * np.clip(unit @ KEY_LIGHT, 0.0, 1.0)
    light[is_behind] *= BEHIND
    return np.clip(light, 0.0, 1.0)


def _on_screen(
    vertices: Array, faces: NDArray[np.integer], view: Array, columns: int, rows: int
) -> Array:
    """The corners (m, 3, 3): column and row in pixels, and depth, which grows to the viewer."""
    turned = vertices @ view.T
    is_used = np.zeros(len(vertices), np.bool_)
    is_used[faces] = True
    used = turned[is_used]
    low, high = used.min(axis=0), used.max(axis=0)
    room = (1.0 - 2.0 * MARGIN) * np.array([columns, rows])
    share = ((high - low)[:2] / room).max()
    scale = 1.0 / share if share > 0.0 else 1.0
    middle = (low + high) / 2.0
    flat = (turned - middle) * np.array([scale, -scale, scale])
    flat[:, :2] += np.array([columns, rows]) / 2.0
    return flat[faces]


def _chunks(corners: Array) -> Iterator[slice]:
    """Slices of triangles that cover about `CHUNK` pixels each."""
    heights = np.ptp(corners[:, :, 1], axis=1)
    covered = np.abs(_normals(corners)[:, 2]) / 2.0 + heights + 1.0
    chunk = np.cumsum(covered) // CHUNK
    ends = [*(np.flatnonzero(np.diff(chunk)) + 1).tolist(), len(corners)]
    for start, end in zip([0, *ends], ends, strict=False):
        yield slice(start, end)


def _fragments(
    corners: Array, columns: int, rows: int
) -> tuple[NDArray[np.intp], Array, NDArray[np.intp]]:
    """The pixels that triangles cover: their numbers, depths, and whose they are."""
    x, y = corners[:, :, 0], corners[:, :, 1]
    doubled = (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
    owners = np.flatnonzero(doubled != 0.0)
    # Centres of pixels are in the middle between whole numbers.
    first = np.clip(np.ceil(y.min(axis=1) - 0.5), 0, rows).astype(np.intp)
    last = np.clip(np.ceil(y.max(axis=1) - 0.5), 0, rows).astype(np.intp)
    owners, row = _expanded(owners, first[owners], last[owners])
    left, right = _spans(corners[owners], np.asarray(row + 0.5, np.float64))
    begin = np.clip(np.ceil(left - 0.5), 0, columns).astype(np.intp)
    end = np.clip(np.ceil(right - 0.5), 0, columns).astype(np.intp)
    places, column = _expanded(np.arange(len(owners)), begin, end)
    owners, row = owners[places], row[places]
    a, b, c = corners[owners].transpose(1, 2, 0)
    area = doubled[owners]
    px, py = column + 0.5, row + 0.5
    at_b = ((px - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (py - a[1])) / area
    at_c = ((b[0] - a[0]) * (py - a[1]) - (px - a[0]) * (b[1] - a[1])) / area
    return row * columns + column, a[2] + at_b * (b[2] - a[2]) + at_c * (c[2] - a[2]), owners


def _expanded(
    items: NDArray[np.intp], start: NDArray[np.intp], stop: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Each item as often as its range from `start` up to `stop` is long, and the numbers there."""
    counts = np.maximum(stop - start, 0)
    ends = counts.cumsum()
    numbers = np.arange(ends[-1] if len(ends) else 0) - np.repeat(ends - counts - start, counts)
    return np.repeat(items, counts), numbers


def _spans(corners: Array, y: Array) -> tuple[Array, Array]:
    """From where to where the lines at the heights `y` (s,) are inside of triangles (s, 3, 3)."""
    left, right = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    for c in range(3):
        (x0, y0), (x1, y1) = corners[:, c, :2].T, corners[:, c - 1, :2].T
        crosses = (np.minimum(y0, y1) <= y) & (y <= np.maximum(y0, y1)) & (y0 != y1)
        share = np.divide(y - y0, y1 - y0, out=np.zeros_like(y), where=crosses)
        x = x0 + share * (x1 - x0)
        left = np.where(crosses, np.minimum(left, x), left)
        right = np.where(crosses, np.maximum(right, x), right)
    # No side is crossed where rounding has put a height beside the triangle.
    return np.where(left <= right, left, 0.0), np.where(left <= right, right, 0.0)


def _averaged(image: Array) -> Array:
    rows, columns = (size // OVERSAMPLING for size in image.shape)
    return image.reshape(rows, OVERSAMPLING, columns, OVERSAMPLING).mean(axis=(1, 3))


def _png(image: Array) -> bytes:
    """A PNG file of grey and opacity (rows, columns, 2), both 0 to 1."""
    rows, columns = image.shape[:2]
    pixels = np.rint(image * 255.0).astype(np.uint8).reshape(rows, -1)
    # Each row begins with its filter: none.
    lines = np.concatenate([np.zeros((rows, 1), np.uint8), pixels], axis=1)
    head = struct.pack(">IIBBBBB", columns, rows, 8, _GREY_WITH_ALPHA, 0, 0, 0)
    parts = ((b"IHDR", head), (b"IDAT", zlib.compress(lines.tobytes(), 9)), (b"IEND", b""))
    return _PNG + b"".join(_chunk(name, data) for name, data in parts)


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
