"""The texture images of a mesh, written beside its file without loss."""

from __future__ import annotations

import filecmp
import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from . import formats

if TYPE_CHECKING:
    import pymeshlab

# Qt's quality of a PNG is how little it is compressed.
_FASTEST = 100

_MAPPING = "save_wedge_texcoord"


def of(ms: pymeshlab.MeshSet, ending: str) -> dict[str, pymeshlab.Image]:
    """The images, by name, that have to stand beside the current mesh's file."""
    mesh = ms.current_mesh()
    mapped = mesh.has_wedge_tex_coord() or mesh.has_vertex_tex_coord()
    # PyMeshLab would write the images for other formats all the same.
    if not mapped or not formats.holds(ending, _MAPPING):
        return {}
    # A texture that was not found has no size; an absolute name needs no copy.
    return {
        name: image
        for name, image in mesh.textures().items()
        if image.width() and not Path(name).is_absolute()
    }


def write(image: pymeshlab.Image, file: Path, originals: Iterable[Path]) -> None:
    """Write an image, or copy the first of the originals that shows just the same.

    A JPEG that is written again would lose some of it, and PyMeshLab does not write every format
    that it reads.

    Raises
    ------
    OSError
        If neither can be done.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    drawn = _as_png(image, file)
    for original in originals:
        if original.is_file() and _shows(original, drawn):
            shutil.copyfile(original, file)
            drawn.unlink()
            return
    if file.suffix.lower() == ".bmp":
        image.save(str(file))
        drawn.unlink()
    else:
        # Of the other formats PyMeshLab surely writes PNG; readers look at the content.
        image.save(str(drawn))
        drawn.replace(file)


def _as_png(image: pymeshlab.Image, beside: Path) -> Path:
    from ..meshset import native

    path = beside.with_name(beside.name + ".png")
    try:
        with native.muted():
            image.save(str(path), _FASTEST)
    except native.ERRORS as error:
        raise OSError(f"cannot write the texture {beside.name}; is the disk full?") from error
    return path


def _shows(file: Path, drawn: Path) -> bool:
    """Whether a file holds the image that `drawn` is a PNG of; PyMeshLab shows no pixels."""
    import numpy as np
    import pymeshlab

    from ..meshset import native

    unreadable: tuple[type[Exception], ...] = (*native.ERRORS, ValueError)
    ms = pymeshlab.MeshSet()
    native.add(ms, pymeshlab.Mesh(np.eye(3), [[0, 1, 2]], w_tex_coords_matrix=np.zeros((3, 2))))
    with tempfile.TemporaryDirectory(dir=drawn.parent) as folder:
        copy = Path(folder) / "copy.png"
        try:
            with native.muted():
                native.apply(ms, "set_texture_per_mesh", textname=str(file))
            (image,) = ms.current_mesh().textures().values()
            image.save(str(copy), _FASTEST)
        except unreadable:
            native.forget_failures()
            return False
        return filecmp.cmp(drawn, copy, shallow=False)
