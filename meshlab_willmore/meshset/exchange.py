"""Puts a mesh with other faces into its set, without loss of other data.

The mesh is loaded from PyMeshLab's own PLY (see `ply`) in a temporary folder:
``pymeshlab.Mesh(...)`` takes no selection, faux edges, texture images or radii, and with `add_mesh`
it takes three times as long, because both compute normals, which the file holds. Custom attributes
are added by the `Mesh` methods afterwards, because PyMeshLab 2025.7 crashes on attributes of a mesh
that `add_mesh` copied. A comparison finds what PyMeshLab might drop: with the whole mesh, and
before the user's set is changed with a small part in a set of its own, where no mesh of the same
kind has come through before.
"""

from __future__ import annotations

import os
from contextlib import nullcontext
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
import pymeshlab

from ..temporary_files import temporary_folder
from . import ids, layers, native, ply
from .edge_flags import carry_side_bits
from .snapshot import (
    ATTRIBUTE_METHODS,
    MESH_FILE,
    MeshSnapshot,
    has_pixels,
    is_set_by_filter,
    plain_name,
    selected,
)

_PLACEHOLDER = "texture.png"
_PART_FILE = "part.ply"
_PART_SIZE = 100
NORMAL = ("nx", "ny", "nz")
# A column that MeshLab reads as opaque grey, in a range of 1; here all vertices are white.
GREY = "intensity"
WHITE = 0xFFFFFFFF

# MeshLab writes radii as double, but reads them into the place of a float.
_READABLE = {"radius": np.dtype("<f4")}

# Quality in Qt; for PNG it means least compression.
_FASTEST = 100
_BYTES_OF_PIXEL = 3
_SAVED_IMAGE = "meshlab_willmore.png"
_ONE_PIXEL = b"P1 1 1 0\n"


# What a mesh of numbers has: columns of vertices and faces, and whether it has edges.
_Kind = tuple[tuple, tuple, bool]

# Of these kinds a part came through.
_came_through: set[_Kind] = set()


def give(
    ms: pymeshlab.MeshSet, old: MeshSnapshot, new: MeshSnapshot, folder: Path | None = None
) -> None:
    """Replace the current mesh of `ms` by the mesh `new`.

    Parameters
    ----------
    ms : pymeshlab.MeshSet
        Its current mesh is the one that `old` was taken from. Changed in place, or not at all if
        an error is raised.
    old, new : MeshSnapshot
        The mesh before and after changes, see `with_faces`.
    folder : Path, optional
        Where `MESH_FILE` holds `new` already; without it, the mesh is written.

    Raises
    ------
    pymeshlab.PyMeshLabException
        If PyMeshLab would drop something that `new.unsupported` does not name.
    RoomError
        If the folder for temporary files has no room for the mesh and its textures.
    """
    with temporary_folder(_size(new)) if folder is None else nullcontext(folder) as place:
        path = _mesh_path(place, new.ply.textures)
        _write_images(path.parent, new)
        written = _write(path, new) if folder is None else new.ply
        with native.kept_working_folder():
            _leave_the_users_files(path.parent, new.ply.textures)
            _try_a_part(path.with_name(_PART_FILE), new, written)
            layers.replace_current(
                ms,
                lambda target: _load_whole(target, path, new, has_flags=_has_flags(written)),
                lambda target: _reload(target, path, old),
                old.identity,
                by_copies=new.is_without_pixels,
                by_filters=_needs_filters(new),
            )


def _size(snapshot: MeshSnapshot) -> int:
    """Size of the files in bytes, about; images are hardly compressed."""
    mesh = snapshot.ply
    records = mesh.vertices.nbytes + snapshot.normals.nbytes + mesh.faces.nbytes + mesh.edges.nbytes
    images = snapshot.images.values()
    return records + sum(_BYTES_OF_PIXEL * i.width() * i.height() for i in images)


def with_faces(old: MeshSnapshot, faces: np.ndarray, corners: np.ndarray) -> MeshSnapshot:
    """The mesh with other faces.

    Parameters
    ----------
    old : MeshSnapshot
    faces : (m, 3) int32 ndarray
        The new faces, slot by slot.
    corners : (m, 3) int32 ndarray
        For each new corner the old corner (3 * face + place) whose wedge data it gets.
    """
    # Numba takes too long to import for programs that don't flip.
    from ..mesh.normals import vertex_normals

    changed = {"vertex_indices": faces, "flags": carry_side_bits(old.ply, faces)}
    if "texcoord" in (old.ply.faces.dtype.names or ()):
        wedges = old.ply.faces["texcoord"].reshape(-1, 2)
        changed["texcoord"] = wedges[corners.ravel()].reshape(-1, 6)
    records = _with_columns(old.ply.faces, changed)
    normals = vertex_normals(old.vertices, faces, old.normals)
    return old._replace(faces=faces, ply=old.ply._replace(faces=records), normals=normals)


def _try_a_part(path: Path, whole: MeshSnapshot, written: ply.PlyMesh) -> None:
    """Load a small part in a set of its own, and raise if something of it was lost.

    Of meshes that differ in numbers only, the first one of a process is tried.
    """
    has_names = whole.ply.textures or whole.images or whole.attributes
    kind = None if has_names else _kind(written)
    if kind in _came_through:
        return
    part = _part(whole)
    _write(path, part)
    _load_whole(pymeshlab.MeshSet(), path, part)
    if kind is not None:
        _came_through.add(kind)


def _kind(mesh: ply.PlyMesh) -> _Kind:
    vertices, faces = (tuple(records.dtype.descr) for records in (mesh.vertices, mesh.faces))
    return vertices, faces, len(mesh.edges) > 0


def _part(whole: MeshSnapshot) -> MeshSnapshot:
    """A mesh of a few of the faces and edges, with every kind of data of the whole mesh."""
    kept = _first_and_flagged(whole.ply.faces)
    faces = whole.ply.faces[kept]
    edges = whole.ply.edges[:_PART_SIZE]
    corners = np.concatenate((faces["vertex_indices"].ravel(), edges.ravel()))
    used = np.union1d(corners, _first_and_flagged(whole.ply.vertices))
    renumbered = np.searchsorted(used, corners).astype(np.int32)
    faces["vertex_indices"] = renumbered[: 3 * len(faces)].reshape(-1, 3)
    edges = renumbered[3 * len(faces) :].reshape(-1, 2)
    indices = {"v": used, "f": kept}
    return whole._replace(
        vertices=whole.vertices[used],
        faces=faces["vertex_indices"],
        ply=whole.ply._replace(vertices=whole.ply.vertices[used], faces=faces, edges=edges),
        normals=whole.normals[used],
        attributes=[a._replace(values=a.values[indices[a.kind[0]]]) for a in whole.attributes],
    )


def _first_and_flagged(records: np.ndarray) -> np.ndarray:
    """Indices, ascending, of the first few records and of the first few with flags."""
    first = np.arange(min(len(records), _PART_SIZE))
    if "flags" not in (records.dtype.names or ()):
        return first
    return np.union1d(first, np.flatnonzero(records["flags"])[:_PART_SIZE])


def _write(path: Path, snapshot: MeshSnapshot) -> ply.PlyMesh:
    """Write the PLY. It names the images; flags are left out if none is set.

    Returns
    -------
    ply.PlyMesh
        What was written.
    """
    mesh = snapshot.ply
    normals = dict(zip(NORMAL, snapshot.normals.T, strict=True))
    carried = mesh._replace(
        vertices=_with_columns(mesh.vertices, normals),
        faces=_with_columns(mesh.faces, {}),
        textures=tuple(map(_file_names(mesh.textures).__getitem__, mesh.textures)),
    )
    ply.write(path, carried)
    return carried


def _with_columns(records: np.ndarray, columns: dict[str, np.ndarray]) -> np.ndarray:
    """Records with some fields changed or added, and without flags if none is set.

    The same records if nothing changes.
    """
    sources = {name: records[name] for name in records.dtype.names or ()} | columns
    if "flags" in sources and not sources["flags"].any():
        del sources["flags"]
    known: Any = records.dtype.fields
    fields = []
    for name, values in sources.items():
        kind = known[name][0] if name in known else values.dtype
        fields.append((name, _READABLE.get(name, kind)))
    if not columns and np.dtype(fields) == records.dtype:
        return records
    return ply.records(sources, fields)


def _write_images(folder: Path, snapshot: MeshSnapshot) -> None:
    """The images that the PLY names."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, file_name in _file_names(snapshot.ply.textures).items():
        _write_image(folder / file_name, name, snapshot)


def _file_names(textures: tuple[str, ...]) -> dict[str, str]:
    """The name under which the PLY mentions each texture."""
    if is_set_by_filter(textures):
        return {textures[0]: _PLACEHOLDER}
    return {name: plain_name(name) for name in textures}


def _mesh_path(folder: Path, textures: tuple[str, ...]) -> Path:
    """Where the PLY is: so deep in `folder` that ``..`` in a texture's name stays inside."""
    upwards = max((PurePosixPath(name).parts.count("..") for name in textures), default=0)
    return folder.joinpath(*["mesh"] * upwards, MESH_FILE)


def _leave_the_users_files(folder: Path, textures: tuple[str, ...]) -> None:
    """Go to `folder` if the user's working folder has files of the textures' names.

    PyMeshLab looks for textures there first.
    """
    if any(os.path.exists(name) for name in _file_names(textures).values()):
        os.chdir(folder)


def _write_image(path: Path, name: str, snapshot: MeshSnapshot) -> None:
    """Write the image of a texture; one pixel if no texture has any, so that its name is kept."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if snapshot.is_without_pixels:
        path.write_bytes(_ONE_PIXEL)
    elif name in snapshot.images and has_pixels(snapshot.images[name]):
        _save_image(snapshot.images[name], path)


def _save_image(image: pymeshlab.Image, path: Path) -> None:
    """Save without loss as PNG; Qt detects the format by the content, not by the name."""
    lossless = path.with_name(_SAVED_IMAGE)
    image.save(str(lossless), _FASTEST)
    lossless.replace(path)


def _load_whole(
    ms: pymeshlab.MeshSet, path: Path, snapshot: MeshSnapshot, has_flags: bool = True
) -> None:
    """Load a mesh as `_load` does, and raise if something of it was lost.

    A file without flags brings no selection, as a part of the first mesh of its kind has shown.
    """
    _load(ms, path, snapshot)
    lost = _lost(ms, snapshot, has_flags)
    if lost:
        raise pymeshlab.PyMeshLabException(
            f"PyMeshLab does not carry all of this mesh: {', '.join(lost)} would change. "
            "The mesh is left as it was."
        )


def _load(ms: pymeshlab.MeshSet, path: Path, snapshot: MeshSnapshot) -> None:
    """Load the mesh that `_write` wrote as a new current mesh, as a native filter leaves one."""
    if snapshot.is_without_pixels:
        _load_without_pixels(ms, path, snapshot)
    else:
        _load_with_images(ms, path, snapshot)
    if _has_selection(snapshot):
        # MeshLab counts what is selected after filters only; defaults of others depend on it.
        native.apply(ms, "apply_normal_normalization_per_vertex")
    mesh = ms.current_mesh()
    for attribute in snapshot.attributes:
        _, adder = ATTRIBUTE_METHODS[attribute.kind]
        getattr(mesh, adder)(attribute.values, attribute.name)


def _needs_filters(snapshot: MeshSnapshot) -> bool:
    return bool(snapshot.ply.textures) or _has_selection(snapshot)


def _has_selection(snapshot: MeshSnapshot) -> bool:
    return bool(selected(snapshot.ply.vertices).any() or selected(snapshot.ply.faces).any())


def _load_with_images(ms: pymeshlab.MeshSet, path: Path, snapshot: MeshSnapshot) -> None:
    native.load(ms, path)
    textures = snapshot.ply.textures
    if is_set_by_filter(textures):
        image = path.with_name(textures[0])
        _write_image(image, textures[0], snapshot)
        native.apply(ms, "set_texture_per_mesh", textname=str(image))


def _load_without_pixels(ms: pymeshlab.MeshSet, path: Path, snapshot: MeshSnapshot) -> None:
    """Load the mesh with names of textures, but no images.

    PyMeshLab loads no such mesh. But a copy from another set has no images, and a copy of the copy
    has empty ones, as after a native filter.
    """
    carrier = pymeshlab.MeshSet()
    _load_with_images(carrier, path, snapshot)
    native.add(ms, native.current_mesh(carrier))
    if not snapshot.images:
        return
    first = native.id_of(native.current_mesh(ms))
    native.apply(ms, "generate_copy_of_current_mesh")
    layers.delete(ms, first)
    ids.note_used(ms, first)


def _reload(ms: pymeshlab.MeshSet, path: Path, snapshot: MeshSnapshot) -> None:
    """Load the mesh as it was."""
    _write(path, snapshot)
    _load(ms, path, snapshot)


def _has_flags(mesh: ply.PlyMesh) -> bool:
    return any("flags" in (of.dtype.names or ()) for of in (mesh.vertices, mesh.faces))


def _lost(ms: pymeshlab.MeshSet, snapshot: MeshSnapshot, has_flags: bool) -> list[str]:
    """In what the current mesh, as PyMeshLab read it, differs from the snapshot."""
    mesh, vertices, faces = ms.current_mesh(), snapshot.ply.vertices, snapshot.ply.faces
    names, face_names = vertices.dtype.names or (), faces.dtype.names or ()
    copied = snapshot.is_without_pixels
    checks = {
        "vertex positions": lambda: _same(mesh.vertex_matrix(), snapshot.vertices),
        "faces": lambda: _same(mesh.face_matrix(), snapshot.faces),
        "edges": lambda: _same(mesh.edge_matrix(), snapshot.ply.edges),
        "vertex selection": lambda: (
            not has_flags or np.array_equal(mesh.vertex_selection_array(), selected(vertices))
        ),
        "face selection": lambda: (
            not has_flags or np.array_equal(mesh.face_selection_array(), selected(faces))
        ),
        # A copy from another set has them in any case.
        "vertex colours": lambda: (
            (mesh.vertex_color_array() == WHITE).all()
            if GREY in names
            else copied or mesh.has_vertex_color() == ("red" in names)
        ),
        "vertex scalars": lambda: copied or mesh.has_vertex_scalar() == ("quality" in names),
        "face colours": lambda: mesh.has_face_color() == ("red" in face_names),
        "face scalars": lambda: mesh.has_face_scalar() == ("quality" in face_names),
        "wedge texture coordinates": lambda: (
            "texcoord" not in face_names
            or _same(mesh.wedge_tex_coord_matrix(), faces["texcoord"].reshape(-1, 2))
        ),
        "textures": lambda: (
            mesh.texture_number() == len(snapshot.ply.textures)
            and _sizes(mesh.textures()) >= _sizes(_images_to_be(snapshot))
        ),
    }
    return [what for what, holds in checks.items() if not holds()]


def _same(left: np.ndarray, right: np.ndarray) -> bool:
    """Whether two matrices are equal; not-a-numbers are."""
    # PyMeshLab's matrices are stored by columns.
    return left.shape == right.shape and all(map(_same_column, left.T, right.T))


def _same_column(left: np.ndarray, right: np.ndarray) -> bool:
    # Only texture coordinates can be NaN, and a search for NaN takes longer than the comparison.
    is_float = right.dtype.kind == "f"
    return np.array_equal(left, right) or (is_float and np.array_equal(left, right, equal_nan=True))


def _images_to_be(snapshot: MeshSnapshot) -> dict[str, pymeshlab.Image]:
    """The images under the names that the new mesh gives them."""
    names = snapshot.ply.textures
    given = {name: name for name in names} if is_set_by_filter(names) else _file_names(names)
    kept = snapshot.is_without_pixels
    return {given[n]: image for n, image in snapshot.images.items() if kept or has_pixels(image)}


def _sizes(images: dict[str, pymeshlab.Image]) -> set[tuple[str, int, int]]:
    return {(name, image.width(), image.height()) for name, image in images.items()}
