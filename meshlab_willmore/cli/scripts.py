"""The filter scripts named on a command line: files, pipes, and those of this package."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ..mesh_files.formats import COMMON
from ..mesh_files.paths import refuse_folder
from ..messages import WrongUse, note

if TYPE_CHECKING:
    from ..meshset.check import Findings

STANDARD_STREAM = "-"
ENDING = ".mlx"
_FOLDER = "filter_scripts"

# Names with the ending of a script, the standard input, and what a shell puts for ``<(...)``.
_SCRIPT = re.compile(r".*\.mlx|/dev/stdin|/dev/fd/\d+|/proc/self/fd/\d+", re.DOTALL)


class Script(NamedTuple):
    """The text of a filter script, which a pipe gives only once, and what messages call it."""

    name: str
    data: bytes

    def examined(self) -> Findings:
        """All that a check finds in it."""
        from ..script import examined_bytes

        return examined_bytes(self.data, self.name)


def is_script(word: str) -> bool:
    """Whether a word of the command line names a script: by its ending, or as a shell's pipe."""
    return word == STANDARD_STREAM or bool(_SCRIPT.fullmatch(word.lower()))


def read_script(name: str) -> Script:
    """The script of a file or pipe; ``-`` is the standard input.

    A name without a folder that no file has can be that of a script of this package; the ending
    of its name may be left out.

    Raises `WrongUse` if there is no such file, `ScriptError` if it can't be read.
    """
    from ..mlx.decode import LARGEST, bytes_of

    if name == STANDARD_STREAM:
        # Python has no such stream where it is closed.
        return Script("standard input", sys.stdin.buffer.read(LARGEST + 1) if sys.stdin else b"")
    refuse_folder(Path(name), "script", "clean.mlx")
    if Path(name).suffix.lower().lstrip(".") in COMMON:
        raise WrongUse(
            f"{name} is a mesh by its name, no filter script; to convert meshes, write: "
            f"meshlab-willmore run -i {name} -o OUT"
        )
    if os.path.lexists(name):
        return Script(name, bytes_of(Path(name)))
    whole = f"{name}{ENDING}"
    if os.path.isfile(whole):
        raise WrongUse(f"there is no filter script {name}; there is {whole}")
    shipped = shipped_of(name)
    if shipped is None:
        hint = "'meshlab-willmore scripts' lists the shipped ones"
        raise WrongUse(f"there is no filter script {name}; {hint}")
    note(f"{shipped.name} is the script that comes with meshlab_willmore")
    return Script(shipped.name, bytes_of(shipped))


def shipped_of(name: str) -> Path | None:
    """The script of this package that has a name, whose ending may be left out."""
    there = shipped_scripts()
    return there.get(name) or there.get(f"{name}{ENDING}")


def shipped_scripts() -> dict[str, Path]:
    """The scripts of this package by name; in a checkout they are beside it."""
    package = Path(__file__).parents[1]
    installed = package / _FOLDER
    folder = installed if installed.is_dir() else package.parent / _FOLDER
    return {path.name: path for path in sorted(folder.glob("*.mlx"))}
