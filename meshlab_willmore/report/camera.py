"""Where a picture is taken from. Arrays only, so that it does not need the picture library."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

MARGIN = 0.02

Vector = tuple[float, float, float]


class Window(NamedTuple):
    """What part of the picture plane is shown, in the mesh's units."""

    left: float
    right: float
    bottom: float
    top: float


class View(NamedTuple):
    """An orthographic camera.

    rotation (3, 3): its rows are the directions to the right, upwards, and towards the viewer.
    window: along the first two of these; None shows the whole mesh.
    """

    rotation: NDArray[np.float64]
    window: Window | None = None


def view_from(direction: Vector, up: Vector, window: Window | None = None) -> View:
    """Point a camera from `direction` at the origin, with `up` upwards in the picture."""
    towards = np.array(direction) / np.linalg.norm(direction)
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return View(np.stack([right, np.cross(towards, right), towards]), window)


def window_of(vertices: NDArray[np.float64], view: View) -> Window:
    """Return the view's own window, or one that shows all vertices (n, 3) with a margin."""
    if view.window is not None:
        return view.window
    flat = vertices @ view.rotation[:2].T
    low, high = flat.min(axis=0), flat.max(axis=0)
    margin = MARGIN * (high - low).max()
    (left, bottom), (right, top) = (low - margin).tolist(), (high + margin).tolist()
    return Window(left, right, bottom, top)
