"""MeshLab's projects (`.mlp`): all layers of a set, with their labels, places and visibility.

PyMeshLab reads a project itself, after each of its meshes has been read as any other input is. Its
own function for writing one saves no mesh. So here all meshes are saved, beside a project that
names them.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
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
_MESH, _MATRIX = "MLMesh", "MLMatrix44"
_SIDE = 4
# The name of a layer's mesh: that of its project, and the number of the layer.
_OWN_NAME = re.compile(r"(.+)_(?:0|[1-9]\d*)", re.DOTALL)
_ENDING = ".ply"
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


def project_of(file: Path) -> Path | None:
    """The project that would save a layer as this file, without its ending; None without one."""
    found = _OWN_NAME.fullmatch(file.stem)
    if found is None or file.suffix != _ENDING:
        return None
    # A layer may have a folder of its own.
    folder = file.parent.parent if file.parent.name == file.stem else file.parent
    return folder / found[1]


def check_layers(path: Path, is_own: Callable[[Path], bool] = lambda file: False) -> None:
    """Raise `WrongUse` if a file exists that has the name of a layer of the project `path`.

    How many layers there will be is not known before the script has run. Files that are the
    batch's own (`is_own`) may be replaced.
    """
    for name in sorted(os.listdir(path.parent)):
        if not name.startswith(f"{path.stem}_"):
            continue
        file = path.parent / name
        if file.is_dir():
            file /= f"{name}{_ENDING}"
        if project_of(file) == path.with_suffix("") and os.path.lexists(file) and not is_own(file):
            raise WrongUse(
                f"{file} already exists; use --force to overwrite, as a layer of {path} may get "
                "this name"
            )


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


def save_project(ms: pymeshlab.MeshSet, path: Path, options: SaveOptions) -> list[Path]:
    """Save all layers of `ms` beside a project, then the project; returns the files, it first.

    The mesh of layer i of ``out.mlp`` is ``out_i.ply``, in a folder ``out_i`` if one of its
    textures has the name of another layer's. Raises `OSError` in one line; then there is no new
    project, and no new mesh of a layer.
    """
    from ..meshset import native

    if os.path.lexists(path) and not (options.force or options.is_own(path)):
        raise FileExistsError(f"cannot write {path}: it already exists; use --force to overwrite")
    ids = [mesh.id() for mesh in ms]
    names = _names(ms, path.stem)
    current = native.current_id(ms)
    files: list[Path] = []
    new: list[Path] = []
    try:
        for mesh_id, name in zip(ids, names, strict=True):
            ms.set_current_mesh(mesh_id)
            file = path.parent / name
            new += [] if os.path.lexists(file) else [file]
            if file.parent != path.parent:
                writable_folder(file.parent)
            files += save(ms, file, options)
    except OSError:
        for file in new:
            file.unlink(missing_ok=True)
        raise
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
