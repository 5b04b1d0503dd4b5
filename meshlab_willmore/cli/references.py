"""`--reference`: the surface that a mesh stands for, as a file or in a word."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from . import inputs
from .errors import WrongUse, wrong_use

if TYPE_CHECKING:
    from ..compare.reference import Reference, Sphere, Torus

EXAMPLES = "sphere, sphere:2 or torus:3,1"


def check(text: str) -> None:
    """Raise `WrongUse` if it is neither a surface in a word nor a file that is there."""
    if _in_a_word(text) is None:
        _check_file(text)


def read(text: str) -> Reference:
    """The surface.

    Raises
    ------
    WrongUse
        As `check`.
    OSError
        If the file holds no mesh, or one without faces.
    """
    from ..compare.figures import arrays
    from ..compare.reference import Surface

    known = _in_a_word(text)
    if known is not None:
        return known
    _check_file(text)
    surface = Surface(*arrays(inputs.loaded(Path(text))))
    if len(surface.faces) == 0:
        raise OSError(f"{text} can't be the reference: it is a point cloud, without faces")
    return surface


def _check_file(text: str) -> None:
    try:
        inputs.check(Path(text))
    except WrongUse as error:
        raise wrong_use(f"--reference: {error} (nor is it a surface such as {EXAMPLES})") from error


def _in_a_word(text: str) -> Sphere | Torus | None:
    """The sphere or torus; nothing if it must be a file."""
    from ..compare.reference import Sphere, Torus

    name, colon, sizes = text.partition(":")
    if text != "sphere" and not (colon and name in ("sphere", "torus")):
        return None
    radii = [_radius(text, size) for size in sizes.split(",")] if colon else []
    if name == "sphere" and len(radii) <= 1:
        return Sphere(*radii)
    if name == "torus" and len(radii) == 2:
        return Torus(*radii)
    raise wrong_use(f"--reference {text}: it can be {EXAMPLES} (ring, tube), or a file")


def _radius(text: str, size: str) -> float:
    try:
        radius = float(size)
    except ValueError:
        radius = math.nan
    if not (np.isfinite(radius) and radius > 0.0):
        raise wrong_use(f"--reference {text}: {size!r} is no radius; it can be {EXAMPLES}")
    return radius
