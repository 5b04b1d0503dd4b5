"""Draws the pictures in docs/pictures, with their captions as the text "Description" of each.

Run from the top of the repository, with matplotlib installed:

    python -m studies.pictures
"""

import io
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from PIL import Image, PngImagePlugin

from meshlab_willmore import optimize_flips
from meshlab_willmore.demo.experiments import CLOSEUP_CAMERA
from meshlab_willmore.report.pictures import Camera, Shot, camera_from, comparison
from meshlab_willmore.report.stages import significant
from studies import models, originals
from studies.fidelity import fidelity

FOLDER = Path(__file__).parents[1] / "docs" / "pictures"
PART = "CAD part"
# Enough for grey and clay, at a third of the size.
COLOURS = 256
CAPTIONS = "Description"


def face_shots():
    """The demo's face, before the flips and after."""
    vertices, faces = models.face()
    result = optimize_flips(vertices, faces)
    before, after = significant(result.willmore_before), significant(result.willmore_after)
    yield Shot(f"before: W = {before}", vertices, faces)
    yield Shot(f"after {result.flips} flips: W = {after}", vertices, result.faces)


def part_shots():
    """The CAD part in three triangulations of the same vertices."""
    (start,) = originals.starts([PART])
    scrambled = originals.scrambled(start)
    yield _part_shot("scrambled", start, scrambled)
    for preset in ("paper", "faithful"):
        result = optimize_flips(start.vertices, scrambled, preset=preset)
        yield _part_shot(f'"{preset}"', start, result.faces)


def _part_shot(name, start, faces):
    found = fidelity(start.vertices, faces, start.original)
    caption = f"{name}: normals {found.normal_error:.2f}° off, shape {found.mean_shape:.2f}"
    return Shot(caption, start.vertices, faces)


class Picture(NamedTuple):
    """A picture of several triangulations side by side."""

    shots: Callable
    camera: Camera
    pixels_per_inch: int


PICTURES = {
    "face.png": Picture(face_shots, CLOSEUP_CAMERA, 107),
    "part.png": Picture(part_shots, camera_from((0.5, -1.0, 0.9), (0.0, 0.0, 1.0)), 80),
}


def draw(name, folder):
    """Draw one of the pictures into a folder."""
    picture = PICTURES[name]
    shots = list(picture.shots())
    drawn = io.BytesIO()
    comparison(picture.camera, *shots).savefig(drawn, dpi=picture.pixels_per_inch)
    texts = PngImagePlugin.PngInfo()
    texts.add_itxt(CAPTIONS, "\n".join(shot.caption for shot in shots))
    image = Image.open(drawn).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    image.save(folder / name, optimize=True, pnginfo=texts)


if __name__ == "__main__":
    for name in PICTURES:
        print(name, file=sys.stderr)
        draw(name, FOLDER)
