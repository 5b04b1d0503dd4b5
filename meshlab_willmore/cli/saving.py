"""Saving a mesh so that it appears whole, with its material and textures, or not at all.

PyMeshLab writes into a hidden folder beside the target, and what it wrote is renamed in the end:
first the files beside the mesh, then the mesh.
"""

from __future__ import annotations

import filecmp
import os
from collections.abc import Iterable
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from ..files import folder_beside, put, refuse_special
from . import attributes, notes, textures, unheld
from .errors import reason
from .masks import TEXTURED, keywords, not_held

if TYPE_CHECKING:
    import pymeshlab

# Where a writer had to stop, not even so much more goes into its file.
_ROOM = 65536


class Wish(NamedTuple):
    """How a mesh is to be saved.

    Attributes
    ----------
    parts : tuple of str
        The short names of `masks`; empty for what PyMeshLab saves of itself.
    force : bool
        Replace files that are there.
    origin : Path or None
        The folder of the input: textures that are still as they were there are copied.
    placed : set of Path or None
        What was written before in this run, and is not replaced by something else; what is
        written is added.
    """

    parts: tuple[str, ...] = ()
    force: bool = False
    origin: Path | None = None
    placed: set[Path] | None = None


def save(ms: pymeshlab.MeshSet, path: Path, wish: Wish) -> list[Path]:
    """Save the current mesh of `ms`; returns the files that were written, the mesh first.

    Raises
    ------
    OSError
        In one line: the file, and what is wrong. What was there before is as it was.
    """
    ending = path.suffix.lstrip(".")
    if note := not_held(wish.parts, ending):
        notes.tell(note)
    with folder_beside(path) as folder:
        images = _textures(ms, path, wish)
        draft = _inside(folder, images) / path.name
        _write(ms, draft, path, wish)
        for name, image in images.items():
            folders = (path.parent, wish.origin) if wish.origin else (path.parent,)
            textures.write(image, draft.parent / name, [place / name for place in folders])
        moves = _moves(folder, draft, path)
        for source, target in moves:
            _check_whole(source, target)
        _check_free(moves, path, wish)
        for loss in unheld.losses(ms, draft, ending.lower(), bool(wish.parts)):
            notes.tell(f"{path}: {loss}")
        _place(moves)
    if wish.placed is not None:
        wish.placed.update(target.resolve() for _, target in moves)
    return [target for _, target in reversed(moves)]


def _textures(ms: pymeshlab.MeshSet, path: Path, wish: Wish) -> dict[str, pymeshlab.Image]:
    wanted = not wish.parts or TEXTURED & set(wish.parts)
    return textures.of(ms, path.suffix.lstrip(".")) if wanted else {}


def _inside(folder: Path, names: Iterable[str]) -> Path:
    """A folder so deep that ``..`` in the name of a texture stays inside `folder`."""
    upwards = max((PurePosixPath(name).parts.count("..") for name in names), default=0)
    deep = folder.joinpath(*["mesh"] * upwards)
    deep.mkdir(parents=True, exist_ok=True)
    return deep


def _write(ms: pymeshlab.MeshSet, draft: Path, path: Path, wish: Wish) -> None:
    """Write the current mesh at `draft`; errors call it `path`."""
    if wish.parts:
        _write_with(ms, draft, path, keywords(wish.parts, path.suffix.lstrip(".")))
        return
    custom = attributes.of(ms)
    if custom and path.suffix.lower() != ".ply":
        notes.tell(f"{path.suffix} files hold no custom attributes")
        custom = ()
    _write_with(ms, draft, path, dict.fromkeys(custom, True))
    odd = attributes.odd(draft, custom) if custom else ()
    if odd:
        notes.tell("custom attributes with odd names are not saved")
        _write_with(ms, draft, path, {key: True for key in custom if key not in odd})


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
        _check_whole(draft, path)
    if why:
        raise OSError(f"cannot write {path}: {why}")


def _moves(folder: Path, draft: Path, path: Path) -> list[tuple[Path, Path]]:
    """Each file that was written and its place; the mesh is last."""
    others = [p for p in sorted(folder.rglob("*")) if p.is_file() and p != draft]
    moves = [
        (source, Path(os.path.normpath(path.parent / os.path.relpath(source, draft.parent))))
        for source in others
    ]
    return [*moves, (draft, path)]


def _check_whole(source: Path, target: Path) -> None:
    """Raise if the writer may have run out of room: many of PyMeshLab's don't tell.

    One that stopped early left no room behind what it wrote.
    """
    try:
        with source.open("ab") as file:
            size = file.tell()
            file.write(bytes(_ROOM))
            file.flush()
            os.fsync(file.fileno())
            file.truncate(size)
    except OSError as error:
        raise OSError(f"cannot write {target}: {error.strerror}") from error


def _check_free(moves: list[tuple[Path, Path]], path: Path, wish: Wish) -> None:
    """Raise if a file of somebody else would be replaced without `force`, or what is no file."""
    for source, target in moves:
        refuse_special(target)
        if target.is_file() and filecmp.cmp(source, target, shallow=False) and target != path:
            continue
        if wish.placed and target.resolve() in wish.placed:
            raise OSError(
                f"cannot write {path}: {target} is that of another output; give each a folder"
            )
        if os.path.lexists(target) and not wish.force:
            raise FileExistsError(f"cannot write {path}: {target} is there; --force replaces it")


def _place(moves: list[tuple[Path, Path]]) -> None:
    """Rename all, or take back what is new."""
    from ..meshset import interrupts

    placed: list[Path] = []
    with interrupts.deferred():
        try:
            for source, target in moves:
                target.parent.mkdir(parents=True, exist_ok=True)
                is_new = not os.path.lexists(target)
                put(source, target)
                placed += [target] if is_new else []
        except OSError as error:
            for new in placed:
                new.unlink(missing_ok=True)
            raise OSError(f"cannot write {target}: {error.strerror}") from error
