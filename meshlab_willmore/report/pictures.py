"""Pictures of a mesh before and after flips: wireframe and flat shading, seen by one camera.

Triangles are drawn from the back to the front by matplotlib, which needs no display, no graphics
driver and no system library. On facets as small and even as a scan's, this hides what is hidden,
and the lines of the wireframe are as fine as a print's.
"""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure

Vector = tuple[float, float, float]

# Of the size of the mesh, around it.
MARGIN = 0.02
# Lengths on the page, in inches.
PANEL_WIDTH = 5.0
CAPTION_HEIGHT = 0.4
GAP = 0.1
PIXELS_PER_INCH = 160
POINTS_PER_INCH = 72

# A low light from the left catches creases that run up and down; a weak one from the camera keeps
# the far side from going black.
KEY_LIGHT = np.array([-0.62, 0.44, 0.65])
KEY, FILL, AMBIENT = 0.62, 0.23, 0.15
CLAY = np.array([0.95, 0.90, 0.84])
# Neighbours are stroked in their own colour, or the paper would shine through the seam.
SEAM_WIDTH = 0.5

WIRE_FACE = "white"
WIRE_COLOUR = "0.1"
# Lines are as wide as this part of a typical triangle, within limits in points.
WIRE_SHARE = 0.06
THINNEST, WIDEST = 0.3, 1.2


# --- the camera -----------------------------------------------------------------------------------


class Window(NamedTuple):
    """What part of the picture plane is shown, in the mesh's units."""

    left: float
    right: float
    bottom: float
    top: float


class Camera(NamedTuple):
    """An orthographic camera.

    rotation (3, 3): its rows are the directions to the right, upwards, and towards the viewer.
    window: along the first two of these; None shows the whole mesh.
    """

    rotation: NDArray[np.float64]
    window: Window | None = None


def camera_from(direction: Vector, up: Vector, window: Window | None = None) -> Camera:
    """Point a camera from `direction` at the origin, with `up` upwards in the picture."""
    towards = np.array(direction) / np.linalg.norm(direction)
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return Camera(np.stack([right, np.cross(towards, right), towards]), window)


def window_of(vertices: NDArray[np.float64], camera: Camera) -> Window:
    """Return the camera's own window, or one that shows all vertices (n, 3) with a margin."""
    if camera.window is not None:
        return camera.window
    flat = vertices @ camera.rotation[:2].T
    low, high = flat.min(axis=0), flat.max(axis=0)
    margin = MARGIN * (high - low).max()
    (left, bottom), (right, top) = (low - margin).tolist(), (high + margin).tolist()
    return Window(left, right, bottom, top)


# --- the pictures ---------------------------------------------------------------------------------


class Shot(NamedTuple):
    """What one column of a comparison shows: vertices (n, 3), faces (m, 3)."""

    caption: str
    vertices: NDArray[np.float64]
    faces: NDArray[np.integer]


class Facets(NamedTuple):
    """Triangles (t, 3, 2) of the picture plane from the back to the front; their light (t,)."""

    corners: NDArray[np.float64]
    light: NDArray[np.float64]


def can_draw() -> bool:
    """Whether matplotlib is installed, which is optional."""
    return importlib.util.find_spec("matplotlib") is not None


def comparison(camera: Camera, *shots: Shot) -> Figure:
    """Draw triangulations of the same vertices side by side: wireframes above, shaded below.

    Returns
    -------
    matplotlib.figure.Figure
        With two axes for each shot, all of the same limits: the wireframe, then the shaded one.
        Ready for `savefig`.
    """
    from matplotlib.figure import Figure

    window = window_of(shots[0].vertices, camera)
    panel = PANEL_WIDTH, PANEL_WIDTH * (window.top - window.bottom) / (window.right - window.left)
    page = len(shots) * (panel[0] + GAP) - GAP, 2 * panel[1] + GAP + CAPTION_HEIGHT
    figure = Figure(figsize=page, dpi=PIXELS_PER_INCH)
    for column, shot in enumerate(shots):
        left = column * (panel[0] + GAP)
        facets = facets_seen(shot, camera, window)
        for drawn, bottom in ((_wireframe(facets, panel), panel[1] + GAP), (_shaded(facets), 0.0)):
            place = np.array([left, bottom, *panel]) / (*page, *page)
            axes = figure.add_axes(tuple(place.tolist()))
            axes.set(xlim=(window.left, window.right), ylim=(window.bottom, window.top))
            axes.set_axis_off()
            axes.add_collection(drawn)
        middle = (left + panel[0] / 2) / page[0], 1 - CAPTION_HEIGHT / 2 / page[1]
        figure.text(*middle, shot.caption, ha="center", va="center")
    return figure


def facets_seen(shot: Shot, camera: Camera, window: Window) -> Facets:
    """Select, sort and light the triangles that face the camera and touch the window."""
    corners = (shot.vertices @ camera.rotation.T)[shot.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    low, high = corners.min(axis=1), corners.max(axis=1)
    seen = (
        (normals[:, 2] > 0)
        & (high[:, 0] > window.left)
        & (low[:, 0] < window.right)
        & (high[:, 1] > window.bottom)
        & (low[:, 1] < window.top)
    )
    corners, normals = corners[seen], normals[seen]
    back_to_front = np.argsort(corners[:, :, 2].mean(axis=1), kind="stable")
    corners, normals = corners[back_to_front], normals[back_to_front]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    light = AMBIENT + FILL * normals[:, 2] + KEY * np.clip(normals @ KEY_LIGHT, 0, 1)
    return Facets(corners[:, :, :2], light)


def _wireframe(facets: Facets, panel: tuple[float, float]) -> PolyCollection:
    square_inches = panel[0] * panel[1] / max(len(facets.corners), 1)
    width = np.clip(WIRE_SHARE * np.sqrt(square_inches) * POINTS_PER_INCH, THINNEST, WIDEST)
    return _polygons(facets, facecolors=WIRE_FACE, edgecolors=WIRE_COLOUR, linewidths=width)


def _shaded(facets: Facets) -> PolyCollection:
    colours = np.clip(facets.light[:, None] * CLAY, 0, 1)
    return _polygons(facets, facecolors=colours, edgecolors=colours, linewidths=SEAM_WIDTH)


def _polygons(facets: Facets, **style: Any) -> PolyCollection:
    from matplotlib.collections import PolyCollection

    # Annotated as a sequence, but an array is drawn faster.
    corners: Any = facets.corners
    return PolyCollection(corners, **style)
