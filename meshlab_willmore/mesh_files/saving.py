"""Saving a mesh with its material and textures: output files are written atomically.

PyMeshLab writes into a hidden folder beside the target, and what it wrote is renamed in the end:
first the files beside the mesh, then the mesh.
"""

from __future__ import annotations

import filecmp
import os
import re
import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from ..files import folder_beside, refuse_special, replace
from ..messages import note, reason
from . import formats, single
from .losses import ply_header

if TYPE_CHECKING:
    import pymeshlab

# A writer that ran out of room leaves less than this.
_ROOM = 65536
# The parts of a mask with which textures are saved.
_TEXTURED = frozenset({"vt", "wt"})
_WEDGE_KEYWORD = formats.PARTS["wt"][0]
# Qt's quality of a PNG is how little it is compressed.
_FASTEST = 100
# PyMeshLab's keywords of custom attributes: v or f, s or p, then the name in small letters.
_ATTRIBUTE = re.compile(r"__ca_[vf][sp]__(.*)", re.DOTALL)


class SaveOptions(NamedTuple):
    """How a mesh is saved."""

    # As in `formats.PARTS`; empty for what PyMeshLab saves by default.
    parts: tuple[str, ...] = ()
    # As text, where the format has both; numbers of a PLY's vertices in single precision.
    is_text: bool = False
    is_single: bool = False
    # Overwrite existing files.
    force: bool = False
    # The folders of the inputs, from which unchanged textures are copied.
    origins: tuple[Path, ...] = ()
    # What this run has written, which no other output replaces; the new files are added.
    written: set[Path] | None = None
    # When a batch began that several processes work at. Newer files are its own: the mesh is of an
    # attempt that ended before it was reported, and other files may belong to other meshes.
    begun: float | None = None

    def is_own(self, file: Path) -> bool:
        """Whether a file that exists has been written by this batch."""
        return self.begun is not None and file.lstat().st_mtime >= self.begun


def save(ms: pymeshlab.MeshSet, path: Path, options: SaveOptions) -> list[Path]:
    """Save the current mesh of `ms`; returns the files that were written, the mesh first.

    Raises `OSError` in one line: the file, and what is wrong. Then existing files are unchanged.
    """
    ending = path.suffix.lstrip(".")
    if missing := formats.not_held(options.parts, ending):
        note(missing)
    if options.is_text and not formats.can_be_text(ending):
        note(f".{ending} files are binary in any case")
    if options.is_single and ending.lower() != "ply":
        note(f"only PLY files can be in single precision, no .{ending} files")
    with folder_beside(path) as folder:
        images = _textures(ms, path, options)
        draft = _deep_folder(folder, images) / path.name
        _write(ms, draft, path, options)
        if options.is_single and ending.lower() == "ply":
            _make_single(draft, path)
        for name, image in images.items():
            folders = (path.parent, *options.origins)
            write_texture(image, draft.parent / name, [place / name for place in folders])
        moves = _moves(folder, draft, path)
        for source, target in moves:
            _check_complete(source, target)
        _check_free(moves, path, options)
        for loss in formats.losses(ms, draft, ending.lower(), bool(options.parts)):
            note(f"{path}: {loss}")
        _rename_all(moves, is_shared=options.begun is not None)
    if options.written is not None:
        options.written.update(target.resolve() for _, target in moves)
    return [target for _, target in reversed(moves)]


def _write(ms: pymeshlab.MeshSet, draft: Path, path: Path, options: SaveOptions) -> None:
    """Write the current mesh at `draft`; errors name `path`."""
    from ..meshset import native

    ending = path.suffix.lstrip(".")
    is_text = options.is_text and formats.holds(ending, "binary")
    manner = {"binary": False} if is_text else {}
    if options.parts:
        _write_with(ms, draft, path, {**formats.keywords(options.parts, ending), **manner})
        return
    # PyMeshLab saves custom attributes only if each is named, and only as PLY.
    custom = [key for key in native.defaults(ms, "ply") if _ATTRIBUTE.fullmatch(key)]
    if custom and path.suffix.lower() != ".ply":
        note(f"{path.suffix} files hold no custom attributes")
        custom = []
    _write_with(ms, draft, path, {**dict.fromkeys(custom, True), **manner})
    if custom:
        names = {_simplified(found.name) for found in ply_header(draft)[0]}
        sound = [key for key in custom if _simplified(_ATTRIBUTE.sub(r"\1", key)) in names]
        if sound != custom:
            note("custom attributes with odd names are not saved")
            _write_with(ms, draft, path, {**dict.fromkeys(sound, True), **manner})


def _simplified(name: str) -> str:
    """The name without what PyMeshLab's keywords leave out or replace."""
    return re.sub(r"[\W_]", "", name.lower())


def _write_with(ms: pymeshlab.MeshSet, draft: Path, path: Path, flags: dict[str, bool]) -> None:
    from ..meshset import native

    native.forget_failures()
    why = ""
    try:
        with native.muted(), native.kept_working_folder():
            ms.save_current_mesh(str(draft.absolute()), save_textures=False, **flags)
    except native.ERRORS as error:
        why = reason(error)
    if not draft.is_file() or draft.stat().st_size == 0:
        why = why or f"PyMeshLab wrote no {path.suffix} file"
    else:
        _check_complete(draft, path)
    if why:
        raise OSError(f"cannot write {path}: {why}")


def _make_single(draft: Path, path: Path) -> None:
    try:
        single.to_single(draft)
    except OSError as error:
        raise OSError(f"cannot write {path}: {error.strerror}") from error


def _check_complete(source: Path, target: Path) -> None:
    """Raise if the disk is full: many of PyMeshLab's writers stop early without an error."""
    try:
        with source.open("ab") as file:
            size = file.tell()
            file.write(bytes(_ROOM))
            file.flush()
            os.fsync(file.fileno())
            file.truncate(size)
    except OSError as error:
        raise OSError(f"cannot write {target}: {error.strerror}") from error


def _moves(folder: Path, draft: Path, path: Path) -> list[tuple[Path, Path]]:
    """Each file that was written and its place; the mesh is last."""
    others = [p for p in sorted(folder.rglob("*")) if p.is_file() and p != draft]
    moves = [
        (source, Path(os.path.normpath(path.parent / os.path.relpath(source, draft.parent))))
        for source in others
    ]
    return [*moves, (draft, path)]


def _check_free(moves: list[tuple[Path, Path]], path: Path, options: SaveOptions) -> None:
    """Raise if a file would be replaced without `force`, or something that is no file."""
    for source, target in moves:
        refuse_special(target)
        if target != path and target.is_file() and filecmp.cmp(source, target, shallow=False):
            continue
        exists = os.path.lexists(target)
        is_of_batch = exists and options.is_own(target)
        is_replaced = is_of_batch and target in (path, path.with_name(f"{path.name}.mtl"))
        is_of_run = options.written is not None and target.resolve() in options.written
        if is_of_run or (is_of_batch and not is_replaced):
            raise OSError(
                f"cannot write {path}: {target} belongs to another output; use different folders"
            )
        if exists and not (is_replaced or options.force):
            raise FileExistsError(
                f"cannot write {path}: {target} already exists; use --force to overwrite"
            )


def _rename_all(moves: list[tuple[Path, Path]], is_shared: bool) -> None:
    """Rename all files to their places; after an error remove those that are new.

    Where other processes write into the same folders (`is_shared`), files beside the mesh replace
    none that has come since it was looked for.
    """
    from ..meshset import interrupts

    new: list[Path] = []
    with interrupts.deferred():
        try:
            for source, target in moves:
                target.parent.mkdir(parents=True, exist_ok=True)
                is_new = not os.path.lexists(target)
                if is_shared and is_new and (source, target) != moves[-1]:
                    is_new = _place_new(source, target)
                else:
                    replace(source, target)
                new += [target] if is_new else []
        except OSError as error:
            for file in new:
                file.unlink(missing_ok=True)
            raise OSError(f"cannot write {target}: {error.strerror}") from error


def _place_new(source: Path, target: Path) -> bool:
    """Give a file its name, unless another one with the same content got it; return which."""
    try:
        os.link(source, target)
    except FileExistsError as error:
        if filecmp.cmp(source, target, shallow=False):
            return False
        reason = "the file now belongs to another output; use different folders"
        raise OSError(error.errno, reason) from error
    except OSError:
        # A disk without hard links.
        replace(source, target)
    return True


# --- textures ----------------------------------------------------------------------------------


def _textures(
    ms: pymeshlab.MeshSet, path: Path, options: SaveOptions
) -> dict[str, pymeshlab.Image]:
    """The images, by name, that are saved beside the current mesh."""
    mesh = ms.current_mesh()
    is_mapped = mesh.has_wedge_tex_coord() or mesh.has_vertex_tex_coord()
    is_wanted = not options.parts or _TEXTURED & set(options.parts)
    # PyMeshLab would write the images for formats without coordinates too.
    if not (is_wanted and is_mapped and formats.holds(path.suffix.lstrip("."), _WEDGE_KEYWORD)):
        return {}
    # A texture that was not found has no size; an absolute name needs no copy.
    return {
        name: image
        for name, image in mesh.textures().items()
        if image.width() and not Path(name).is_absolute()
    }


def _deep_folder(folder: Path, names: Iterable[str]) -> Path:
    """A folder so deep that ``..`` in the name of a texture stays inside `folder`."""
    upwards = max((PurePosixPath(name).parts.count("..") for name in names), default=0)
    deep = folder.joinpath(*["mesh"] * upwards)
    deep.mkdir(parents=True, exist_ok=True)
    return deep


def write_texture(image: pymeshlab.Image, file: Path, originals: Iterable[Path]) -> None:
    """Write an image, or copy the first of the originals that has the same pixels.

    A JPEG that is written again would lose some of it, and PyMeshLab does not write every format
    that it reads. Raises `OSError` if neither is possible.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    drawn = _as_png(image, file)
    for original in originals:
        if original.is_file() and _has_pixels_of(original, drawn):
            shutil.copyfile(original, file)
            drawn.unlink()
            return
    if file.suffix.lower() == ".bmp":
        image.save(str(file))
        drawn.unlink()
    else:
        # PyMeshLab always writes PNG; readers look at the content, not at the name.
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


def _has_pixels_of(file: Path, drawn: Path) -> bool:
    """Whether a file holds the image of the PNG `drawn`; PyMeshLab gives no access to pixels."""
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
