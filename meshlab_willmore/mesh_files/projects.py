"""MeshLab's projects (`.mlp`): all layers of a set, with their labels, places and visibility.

PyMeshLab reads them itself, once each mesh has been read as any other input is. It writes none of
the meshes, and names none that a project has not been read from: they are saved beside the project.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..files import atomic_write, writable_folder
from ..messages import WrongUse, note, reason
from . import loading
from .paths import check_input, is_project
from .saving import SaveOptions, save

if TYPE_CHECKING:
    import pymeshlab

_DOCTYPE = "MeshLabDocument"
_MESH, _MATRIX, _RASTER = "MLMesh", "MLMatrix44", "MLRaster"
_SIDE = 4
# Of an element that says nothing else.
_VISIBLE = "1"


class Layer(NamedTuple):
    """A layer of a project: the file of its mesh, and the matrix that places it."""

    file: Path
    matrix: np.ndarray


def layers_of(path: Path) -> list[Layer]:
    """The layers that a project names.

    Raises `OSError` in one line if it is none.
    """
    from defusedxml import ElementTree

    try:
        root = ElementTree.fromstring(path.read_bytes())
    except (ValueError, SyntaxError) as error:
        raise OSError(f"cannot read {path}: it is no project, {reason(error)}") from error
    return [_layer(path, element) for element in root.iter(_MESH)]


def _layer(path: Path, element: Any) -> Layer:
    name = element.get("filename", "")
    if not name:
        label = element.get("label", "")
        raise OSError(f"cannot read {path}: its layer {label!r} has no file")
    text = element.findtext(_MATRIX)
    matrix = np.eye(_SIDE)
    if text is not None:
        try:
            matrix = np.array(text.split(), dtype=np.float64).reshape(_SIDE, _SIDE)
        except ValueError:
            raise OSError(f"cannot read {path}: the matrix of {name} is not 16 numbers") from None
    return Layer(path.parent / name, matrix)


def files_of(path: Path) -> list[Path]:
    """A file, and the meshes that it names if it is a project which can be read."""
    try:
        return [path, *(layer.file for layer in layers_of(path))] if is_project(path) else [path]
    except OSError:
        return [path]


def load_project(ms: pymeshlab.MeshSet, path: Path, is_isolated: bool = False) -> None:
    """Load the layers of a project as new layers of `ms`, and print notes on what is not read.

    Raises `OSError` in one line: which file, and why it can't be read.
    """
    import pymeshlab

    from ..meshset import native

    layers = layers_of(path)
    if not layers:
        raise OSError(f"cannot read {path}: there is no mesh in it")
    for file in dict.fromkeys(layer.file for layer in layers):
        try:
            check_input(file)
        except WrongUse as error:
            raise OSError(f"cannot read {path}: {error}") from error
        # Each mesh is tried by itself, as PyMeshLab crashes on some.
        loading.load(pymeshlab.MeshSet(), file, is_isolated)
    before = ms.mesh_number()
    try:
        with native.muted():
            ms.load_project(str(path.absolute()))
    except native.ERRORS as error:
        raise OSError(f"cannot read {path}: {reason(error)}") from error
    new = [mesh.id() for mesh in ms][before:]
    if len(new) == len(layers):
        for mesh_id, layer in zip(new, layers, strict=True):
            ms.set_current_mesh(mesh_id)
            # PyMeshLab reads matrices in single precision.
            if not np.array_equal(ms.current_mesh().transform_matrix(), layer.matrix):
                native.apply(
                    ms,
                    "set_matrix",
                    transformmatrix=layer.matrix,
                    compose=False,
                    freeze=False,
                    alllayers=False,
                )


def save_project(
    ms: pymeshlab.MeshSet,
    path: Path,
    options: SaveOptions,
    saving: Callable[[Path], Any] = lambda path: nullcontext(),
) -> list[Path]:
    """Save all layers of `ms` beside a project, then the project; returns the files, it first.

    The mesh of layer i of ``out.mlp`` is ``out_i.ply``, in a folder ``out_i`` if one of its
    textures has the name of another layer's. `saving` gives a context for each file. Raises
    `OSError` in one line; then there is no new project.
    """
    from ..meshset import native

    if os.path.lexists(path) and not (options.force or options.is_own(path)):
        raise FileExistsError(f"cannot write {path}: it already exists; use --force to overwrite")
    ids = [mesh.id() for mesh in ms]
    names = _names(ms, path.stem)
    current = native.current_id(ms)
    files: list[Path] = []
    try:
        for mesh_id, name in zip(ids, names, strict=True):
            ms.set_current_mesh(mesh_id)
            file = path.parent / name
            with saving(file):
                if file.parent != path.parent:
                    writable_folder(file.parent)
                files += save(ms, file, options)
    finally:
        native.make_current(ms, current)
    if count := ms.raster_number():
        note(f"{path}: the project's images (rasters) are not written: {count}")
    with atomic_write(path) as draft:
        draft.write_text("\n".join(_lines(ms, names)) + "\n", encoding="utf-8")
    if options.written is not None:
        options.written.add(path.resolve())
    return [path, *files]


def _names(ms: pymeshlab.MeshSet, stem: str) -> list[str]:
    """The names of the meshes' files, as a project has them."""
    names: list[str] = []
    textures: set[str] = set()
    for place, mesh in enumerate(ms):
        name = f"{stem}_{place}"
        own = set(mesh.textures())
        names.append(f"{name}/{name}.ply" if own & textures else f"{name}.ply")
        textures |= own
    return names


def _lines(ms: pymeshlab.MeshSet, names: list[str]) -> Iterator[str]:
    from ..mlx.write import escaped

    yield f"<!DOCTYPE {_DOCTYPE}>"
    yield "<MeshLabProject>"
    yield " <MeshGroup>"
    for mesh, name in zip(ms, names, strict=True):
        label = escaped(mesh.label())
        visible = _VISIBLE if mesh.is_visible() else "0"
        yield f'  <{_MESH} label="{label}" filename="{escaped(name)}" visible="{visible}">'
        yield f"   <{_MATRIX}>"
        yield from (" ".join(map(repr, row)) for row in mesh.transform_matrix().tolist())
        yield f"   </{_MATRIX}>"
        yield f"  </{_MESH}>"
    yield " </MeshGroup>"
    yield " <RasterGroup/>"
    yield "</MeshLabProject>"
