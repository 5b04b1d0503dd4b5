"""Where a script comes from: a file, a pipe, or the standard input."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from .errors import wrong_use
from .inputs import refuse_folder

if TYPE_CHECKING:
    from ..meshset.check import Findings

STANDARD_STREAM = "-"
# Names with the ending of a script, the standard input, and what stands for ``<(...)``.
_SCRIPT = re.compile(r".*\.mlx|/dev/stdin|/dev/fd/\d+|/proc/self/fd/\d+", re.DOTALL)
_STANDARD_INPUT = "standard input"


class Source(NamedTuple):
    """A script's text, which a pipe gives only once.

    Attributes
    ----------
    name : str
        What messages call it.
    data : bytes
        All of it, or as much as shows that it is too large for a script.
    """

    name: str
    data: bytes

    def examined(self) -> Findings:
        """All that a check finds in it."""
        from ..script import examined_bytes

        return examined_bytes(self.data, self.name)


def is_script(word: str) -> bool:
    """Whether a word among others names a script: by its ending, or because a shell made it so."""
    return word == STANDARD_STREAM or bool(_SCRIPT.fullmatch(word.lower()))


def source_of(name: str) -> Source:
    """The script of a file or pipe; ``-`` is the standard input.

    Raises
    ------
    WrongUse
        If there is no such file.
    ScriptError
        If it can't be read.
    """
    from ..mlx.source import LARGEST, bytes_of

    if name == STANDARD_STREAM:
        # Python has no such stream where it is closed.
        data = sys.stdin.buffer.read(LARGEST + 1) if sys.stdin else b""
        return Source(_STANDARD_INPUT, data)
    refuse_folder(Path(name), "script", "clean.mlx")
    if not os.path.exists(name):
        raise wrong_use(f"there is no filter script {name}")
    return Source(name, bytes_of(Path(name)))
