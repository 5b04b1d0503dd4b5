"""A mesh with other faces into its set, with nothing lost on the way.

The mesh travels as PyMeshLab's own PLY (see `ply`), in a folder that is gone at the end:
``pymeshlab.Mesh(...)`` takes no selection, faux edges, texture images or radii. Custom attributes
go by the `Mesh` methods after that, because PyMeshLab 2025.7 crashes on attributes of a mesh that
`add_mesh` copied. What PyMeshLab might still drop is found by comparing a trial copy before the
set is touched.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

import numpy as np
import pymeshlab

from . import layers, native, ply
from .sides import carry_side_bits
from .snapshot import (
    ATTRIBUTE_METHODS,
    MESH_FILE,
    Snapshot,
    is_set_by_filter,
    plain_name,
    selected,
)

_PLACEHOLDER = "texture.png"

# Qt's quality of a PNG is how little it is compressed.
_FASTEST = 100


def give(ms: pymeshlab.MeshSet, snapshot: Snapshot, records: ply.PlyMesh) -> None:
    """Put the mesh of `snapshot`, with other records, in the place of the current mesh of `ms`.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
        Its current mesh is the one that `snapshot` was taken from. Changed in place, or not at
        all if an error is raised.
    records : PlyMesh
        ``snapshot.ply`` after changes, see `with_faces`.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If PyMeshLab would drop something that `snapshot.unsupported` does not name.
    """
    with tempfile.TemporaryDirectory(prefix="meshlab_willmore_") as name:
        path = _mesh_path(Path(name), snapshot.ply.textures)
        _write_files(path, snapshot, records)
        with _before_the_users_files(path.parent, snapshot.ply.textures):
            trial = pymeshlab.MeshSet()
            _load(trial, path, snapshot)
            _verify(trial.current_mesh(), snapshot, records)
            layers.replace_current(
                ms,
                lambda target: _load(target, path, snapshot),
                lambda target: _reload(target, path, snapshot),
                snapshot.identity,
            )


def with_faces(old: ply.PlyMesh, faces: np.ndarray, corners: np.ndarray) -> ply.PlyMesh:
    """The mesh with other faces.

    Parameters
    ----------
    faces : (m, 3) int32 ndarray
        The new faces, slot by slot.
    corners : (m, 3) int32 ndarray
        For each new corner the old corner (3 * face + place) whose wedge data it takes.
    """
    records = old.faces.copy()
    records["vertex_indices"] = faces
    records["flags"] = carry_side_bits(old, faces)
    if "texcoord" in (records.dtype.names or ()):
        wedges = old.faces["texcoord"].reshape(-1, 2)
        records["texcoord"] = wedges[corners.ravel()].reshape(-1, 6)
    return old._replace(faces=records)


def _write_files(path: Path, snapshot: Snapshot, records: ply.PlyMesh) -> None:
    """The PLY and the images that it names."""
    names = _file_names(records.textures)
    path.parent.mkdir(parents=True, exist_ok=True)
    ply.write(path, records._replace(textures=tuple(names.values())))
    for name, file_name in names.items():
        if name in snapshot.images:
            _save_image(snapshot.images[name], path.parent / file_name)


def _file_names(textures: tuple[str, ...]) -> dict[str, str]:
    """The name under which the PLY mentions each texture."""
    if is_set_by_filter(textures):
        return {textures[0]: _PLACEHOLDER}
    return {name: plain_name(name) for name in textures}


def _mesh_path(folder: Path, textures: tuple[str, ...]) -> Path:
    """Where the mesh stands: so deep in `folder` that ``..`` in a name stays inside."""
    upwards = max((PurePosixPath(name).parts.count("..") for name in textures), default=0)
    return folder.joinpath(*["mesh"] * upwards, MESH_FILE)


@contextmanager
def _before_the_users_files(folder: Path, textures: tuple[str, ...]) -> Iterator[None]:
    """Work in `folder` if the user's working directory has files of the textures' names.

    PyMeshLab looks for textures there first.
    """
    if not any(Path(name).exists() for name in _file_names(textures).values()):
        yield
        return
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def _save_image(image: pymeshlab.Image, path: Path) -> None:
    """Save without loss; Qt tells an image's format from its content, not from its name."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lossless = path.with_name(path.name + ".png")
    image.save(str(lossless), _FASTEST)
    lossless.replace(path)


def _load(ms: pymeshlab.MeshSet, path: Path, snapshot: Snapshot) -> None:
    """Load the mesh of `_write_files` as a new current mesh, as a native filter leaves one."""
    native.load(ms, path)
    textures = snapshot.ply.textures
    if is_set_by_filter(textures) and textures[0] in snapshot.images:
        image = path.with_name(textures[0])
        _save_image(snapshot.images[textures[0]], image)
        native.apply(ms, "set_texture_per_mesh", textname=str(image))
    native.apply(ms, "apply_normal_normalization_per_vertex")
    mesh = ms.current_mesh()
    for attribute in snapshot.attributes:
        _, adder = ATTRIBUTE_METHODS[attribute.kind]
        getattr(mesh, adder)(attribute.values, attribute.name)


def _reload(ms: pymeshlab.MeshSet, path: Path, snapshot: Snapshot) -> None:
    """Load the mesh as it was."""
    path.unlink()
    _write_files(path, snapshot, snapshot.ply)
    _load(ms, path, snapshot)


def _verify(mesh: pymeshlab.Mesh, snapshot: Snapshot, records: ply.PlyMesh) -> None:
    """Raise if `mesh`, as PyMeshLab read it, differs from what was to be carried."""
    names = records.vertices.dtype.names or ()
    face_names = records.faces.dtype.names or ()
    checks = {
        "vertex positions": lambda: _same(mesh.vertex_matrix(), snapshot.vertices),
        "faces": lambda: _same(mesh.face_matrix(), records.faces["vertex_indices"]),
        "edges": lambda: _same(mesh.edge_matrix(), records.edges),
        "vertex selection": lambda: _same(
            mesh.vertex_selection_array(), selected(records.vertices)
        ),
        "face selection": lambda: _same(mesh.face_selection_array(), selected(records.faces)),
        "vertex colours": lambda: mesh.has_vertex_color() == ("red" in names),
        "vertex scalars": lambda: mesh.has_vertex_scalar() == ("quality" in names),
        "face colours": lambda: mesh.has_face_color() == ("red" in face_names),
        "face scalars": lambda: mesh.has_face_scalar() == ("quality" in face_names),
        "wedge texture coordinates": lambda: (
            "texcoord" not in face_names
            or _same(mesh.wedge_tex_coord_matrix(), records.faces["texcoord"].reshape(-1, 2))
        ),
        "textures": lambda: _sizes(mesh.textures()) >= _sizes(_images_to_be(snapshot)),
    }
    lost = [what for what, holds in checks.items() if not holds()]
    if lost:
        raise pymeshlab.PyMeshLabException(
            f"PyMeshLab does not carry all of this mesh: {', '.join(lost)} would change. "
            "The mesh is left as it was."
        )


def _same(left: np.ndarray, right: np.ndarray) -> bool:
    equal_nan = np.issubdtype(right.dtype, np.floating)
    return left.shape == right.shape and np.array_equal(left, right, equal_nan=equal_nan)


def _images_to_be(snapshot: Snapshot) -> dict[str, pymeshlab.Image]:
    """The images under the names that the new mesh gives them."""
    names = snapshot.ply.textures
    given = {name: name for name in names} if is_set_by_filter(names) else _file_names(names)
    return {given[name]: image for name, image in snapshot.images.items()}


def _sizes(images: dict[str, pymeshlab.Image]) -> set[tuple[str, int, int]]:
    return {(name, image.width(), image.height()) for name, image in images.items()}
