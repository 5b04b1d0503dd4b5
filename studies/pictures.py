"""Draws docs/part.png: the CAD part scrambled, after the paper's flips, and after "faithful".

Run by hand, from the top of the repository, with matplotlib installed:

    python -m studies.pictures docs/part.png
"""

import sys

from meshlab_willmore import optimize_flips
from meshlab_willmore.report.pictures import Shot, camera_from, comparison
from studies import originals
from studies.fidelity import fidelity

MODEL = "CAD part"
CAMERA = camera_from((0.5, -1.0, 0.9), (0.0, 0.0, 1.0))
PIXELS_PER_INCH = 80


def shots():
    """The part in three triangulations of the same vertices."""
    (start,) = originals.starts([MODEL])
    scrambled = originals.scrambled(start)
    yield shot("scrambled", start, scrambled)
    for preset in ("paper", "faithful"):
        result = optimize_flips(start.vertices, scrambled, preset=preset)
        yield shot(f'"{preset}"', start, result.faces)


def shot(name, start, faces):
    found = fidelity(start.vertices, faces, start.original)
    caption = f"{name}: normals {found.normal_error:.2f}° off, shape {found.mean_shape:.2f}"
    return Shot(caption, start.vertices, faces)


if __name__ == "__main__":
    comparison(CAMERA, *shots()).savefig(sys.argv[1], dpi=PIXELS_PER_INCH)
