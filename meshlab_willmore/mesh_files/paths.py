"""The names of mesh files: inputs, patterns, and outputs with placeholders; each is checked."""

from __future__ import annotations

import difflib
import errno
import glob
import os
import re
import string
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from ..files import UnwritableError, is_stream, place_of, refuse_special, special, writable_folder
from ..messages import WrongUse
from . import formats

# The ending of projects.
PROJECT = ".mlp"
PLACEHOLDERS = {
    "name": "the input's name without its ending",
    "ext": "the input's ending",
    "dir": "the input's folder",
    "index": "1, 2, 3, ...",
}

# How many similar names of a folder an error lists, and how much of a long name it shows.
_SIMILAR = 3
_SHOWN = 40
# Up to two digits: a width, filled with blanks or zeros.
_WIDTH = re.compile(r"0?\d{0,2}d?")


# --- inputs ------------------------------------------------------------------------------------


class Input(NamedTuple):
    """A file, or a pattern that no file matches, and why it can't be a mesh."""

    path: Path
    problem: WrongUse | None


class NoMatchError(WrongUse):
    """A pattern that no file matches."""


def is_project(path: Path) -> bool:
    """Whether a file with this name is a project that can be read and written."""
    return path.suffix.lower() == PROJECT


def find_inputs(names: Iterable[str], takes_projects: bool = False) -> list[Input]:
    """The files for names and patterns, in their order, with what is wrong with each.

    A name that no file has is a pattern if it has wildcards, also where the shell does not expand
    them; ``**`` goes through folders.
    """
    return [found for name in names for found in _find_inputs(name, takes_projects)]


def _find_inputs(name: str, takes_projects: bool) -> list[Input]:
    try:
        return [Input(path, _problem(path, takes_projects)) for path in matches(name)]
    except NoMatchError as error:
        return [Input(Path(name), error)]


def _problem(path: Path, takes_projects: bool) -> WrongUse | None:
    try:
        check_input(path, takes_projects)
    except WrongUse as error:
        return error
    return None


def only_input(pattern: str, rule: str) -> Path:
    """The one mesh file for a name or pattern.

    Raises `WrongUse` if there is none, it can't be read, or there are several; then with `rule`,
    which says what the command takes.
    """
    inputs = find_inputs([pattern])
    for _, problem in inputs:
        if problem is not None:
            raise problem
    if len(inputs) > 1:
        raise WrongUse(f"{pattern} matches {len(inputs)} files; {rule}")
    return inputs[0].path


def matches(name: str) -> list[Path]:
    """The files for a name or pattern; a plain name is one file, whether it exists or not.

    Folders match only a pattern with the ending of a file. Raises `NoMatchError` if nothing does.
    """
    if os.path.lexists(name) or not glob.has_magic(name):
        return [Path(name)]
    # Hidden files, which glob leaves out, are temporary files of other programs or of this one.
    found = [Path(match) for match in sorted(glob.glob(name, recursive=True))]
    files = [path for path in found if Path(name).suffix or not path.is_dir()]
    if not files:
        raise NoMatchError(f"no file matches {name!r}")
    return files


def refuse_folder(path: Path, things: str, example: str) -> None:
    """Raise `WrongUse` for a folder where one of the files in it is needed."""
    if os.path.isdir(path):
        raise WrongUse(f"{path} is a folder; name the {things} in it, such as '{path / example}'")


def check_input(path: Path, takes_projects: bool = False) -> None:
    """Raise `WrongUse` unless this is a readable file that is not empty, and no wrong project."""
    refuse_folder(path, "meshes", "*.ply")
    try:
        os.stat(path)
    except PermissionError as error:
        raise WrongUse(f"{path} can't be read: permission denied") from error
    except OSError as error:
        raise WrongUse(f"there is no file {path}{_hint(path)}") from error
    kind = special(path)
    if kind:
        raise WrongUse(f"{path} is {kind}; meshes are read from files")
    if not os.access(path, os.R_OK):
        raise WrongUse(f"{path} can't be read: permission denied")
    if os.path.getsize(path) == 0:
        raise WrongUse(f"{path} is empty (0 bytes)")
    if path.suffix.lower() in formats.PROJECTS and not (takes_projects and is_project(path)):
        which = f"only {PROJECT} projects are read" if takes_projects else "it takes 'run' to read"
        raise WrongUse(f"{path} is a project; {which}")
    _check_encoding(path)


def _check_encoding(path: Path) -> None:
    """Raise `WrongUse` if PyMeshLab can't open a file of this name."""
    try:
        str(path.absolute()).encode()
    except UnicodeEncodeError as error:
        raise WrongUse(f"{path}: PyMeshLab takes names in UTF-8 only; rename it") from error


def _hint(path: Path) -> str:
    """Why a file is missing, or which names in its folder are similar."""
    if os.path.islink(path):
        return f": it is a link to {os.readlink(path)}"
    if not os.path.isdir(path.parent):
        return f": there is no folder {path.parent}"
    try:
        names = [entry.name for entry in os.scandir(path.parent) if entry.is_file()]
    except OSError:
        return ""
    similar = difflib.get_close_matches(path.name, names, n=_SIMILAR)
    return f"; there is {', '.join(similar)}" if similar else ""


# --- outputs -----------------------------------------------------------------------------------


class Output(NamedTuple):
    """An output of `run`: a file or a pattern, the parts of the mesh and the layer to save.

    No parts are those that PyMeshLab saves. A layer is an index, "c" or "x"; empty for none. Files
    can be texts, and those of PLY in single precision.
    """

    name: str
    parts: tuple[str, ...] = ()
    layer: str = ""
    is_text: bool = False
    is_single: bool = False

    @property
    def path(self) -> Path:
        """The file."""
        return Path(self.name)

    @property
    def is_project(self) -> bool:
        """Whether all layers are saved, with a project that names them."""
        return is_project(self.path)

    @property
    def has_placeholder(self) -> bool:
        """Whether the name depends on the input."""
        return any(field is not None for _, field, _, _ in _parsed(self.name))

    def of(self, source: Path, index: int) -> Output:
        """The output of one input, with its placeholders filled in."""
        return self._replace(name=_filled(self.name, source, index))


def _filled(pattern: str, source: Path, index: int) -> str:
    """The pattern with its placeholders replaced; raises `WrongUse` if one is wrong."""
    values: dict[str, Any] = {
        "name": source.stem,
        "ext": source.suffix.lstrip("."),
        "dir": str(source.parent),
        "index": index,
    }
    for _, field, width, conversion in _parsed(pattern):
        if field is None:
            continue
        if field not in values:
            known = ", ".join(f"{{{name}}}" for name in PLACEHOLDERS)
            raise WrongUse(
                f"{{{field}}} in {pattern!r} is no placeholder; there are {known}, and a brace "
                "itself is written twice"
            )
        if conversion or (width and not (field == "index" and _WIDTH.fullmatch(width))):
            raise WrongUse(
                f"the output name {pattern!r} can't be read: only {{index}} takes a width, such as "
                "{index:03}"
            )
    return pattern.format_map(values)


def _parsed(pattern: str) -> list[tuple[str, str | None, str | None, str | None]]:
    try:
        return list(string.Formatter().parse(pattern))
    except ValueError as error:
        raise WrongUse(
            f"the output name {pattern!r} can't be read: {error}; a brace itself is written twice"
        ) from error


def check_output(path: Path, force: bool) -> None:
    """Raise before anything is computed if a mesh, or a project, can't be saved at `path`.

    `WrongUse` if the name, its format or its folder is wrong, or the file exists and `force` is
    false; `OSError` if the folder can't be written into.
    """
    check_place(path, force)
    _check_encoding(path)
    check_format(path)
    writable_folder(path.parent)
    writable_folder(place_of(path).parent)


def check_format(path: Path) -> None:
    """Raise `WrongUse` if the ending is not that of a format that can be written."""
    ending = path.suffix.lstrip(".")
    if path.suffix.lower() in formats.PROJECTS and not is_project(path):
        raise WrongUse(f"{path} would be a project; only {PROJECT} projects are written")
    if not (is_project(path) or (ending and formats.is_written(ending))):
        why = f"PyMeshLab writes no {path.suffix} files" if ending else "it has no ending"
        raise WrongUse(
            f"the format of {path} is unknown: {why}; there are {', '.join(formats.COMMON)}"
        )


def check_place(
    path: Path, force: bool, example: str = "{name}.ply", takes_streams: bool = False
) -> None:
    """Raise `WrongUse` if no new file can have this name.

    The message for a folder has the `example` of a file in it. With `takes_streams` it may be a
    pipe or a device, of which nothing is replaced.
    """
    try:
        path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        pass
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            raise WrongUse(f"the output name {str(path)[:_SHOWN]}... is too long") from error
        raise UnwritableError(path, error.strerror) from error
    if path.is_dir():
        raise WrongUse(f"{path} is a folder; name a file in it, such as '{path / example}'")
    try:
        if takes_streams and is_stream(path):
            return
        refuse_special(path)
    except UnwritableError as error:
        raise WrongUse(str(error)) from error
    folder = place_of(path).parent
    if not folder.is_dir():
        what = "is a file, not a folder" if folder.exists() else "does not exist"
        raise WrongUse(f"cannot write {path}: the folder {folder} {what}")
    # A link that leads nowhere exists as well.
    if os.path.lexists(path) and not force:
        raise WrongUse(f"{path} already exists; use --force to overwrite")
