"""Records of a batch: a file with a line of JSON for each mesh, written as it ends.

The first line of each run of the batch says when it began and with what. A line that a killed
process left unfinished is skipped.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import IO, Any, NamedTuple

from .._version import __version__
from ..files import UnwritableError, is_stream, opened_stream
from ..messages import WrongUse
from .process import DONE

BEGUN = "begun"
# The status of an input that is no mesh; the others are those of tasks.
BAD_FILE = "bad file"
_HASH = 16


class Saved(NamedTuple):
    """An output file, and the mesh in it."""

    file: str
    bytes: int
    vertices: int
    faces: int


class StepResult(NamedTuple):
    """What a step returned, as in `meshlab_willmore.meshset.play.Played`, fit for JSON."""

    number: int
    name: str
    seconds: float
    returned: dict[str, Any]


class Result(NamedTuple):
    """The outcome for one input.

    Attributes
    ----------
    input : str
        Its name; several names of layers are joined by commas.
    status : str
        "done", "error", "crash", "timeout", "memory" or "bad file".
    outputs : tuple of Saved
        The files that were written.
    step : str
        Where it failed: "reading", "saving", or the step's number and name; empty if it did not.
    reason : str
        Why, in one line.
    seconds : float
        From the start of the last attempt to its end.
    memory : int or None
        The most bytes in memory meanwhile; None if unknown, as after a crash.
    attempts : int
        How often it was tried.
    steps : int
        How many steps ran; 0 if it failed.
    returned : tuple of StepResult
        What steps returned.
    before, after : dict or None
        Vertices, faces and measures of the mesh as it was read, and of the one that was saved.
    notes : tuple of str
        What was lost in loading or saving.
    size, modified : int
        Bytes of the input, and the time of its last change in nanoseconds.
    recipe : str
        A hash of the script, its parameters, and how outputs are saved.
    versions : dict
        Of this package, of PyMeshLab and of Python.
    host, ended : str
        On which machine, and when.
    trace, lines, picture, place : str, tuple of str, bytes, int
        The traceback of an error, the lines for a log, a PNG file for a report, and which of the
        batch's inputs it is, from 0; these are not recorded.
    """

    input: str
    status: str
    outputs: tuple[Saved, ...] = ()
    step: str = ""
    reason: str = ""
    seconds: float = 0.0
    memory: int | None = None
    attempts: int = 1
    steps: int = 0
    returned: tuple[StepResult, ...] = ()
    before: dict[str, Any] | None = None
    after: dict[str, Any] | None = None
    notes: tuple[str, ...] = ()
    size: int = 0
    modified: int = 0
    recipe: str = ""
    versions: dict[str, str] = {}  # noqa: RUF012 - never changed
    host: str = ""
    ended: str = ""
    trace: str = ""
    lines: tuple[str, ...] = ()
    picture: bytes = b""
    place: int = 0

    @property
    def is_done(self) -> bool:
        """Whether the mesh was processed and saved."""
        return self.status == DONE

    def as_json(self) -> dict[str, Any]:
        """The record of it."""
        record = self._asdict()
        for key in ("trace", "lines", "picture", "place"):
            del record[key]
        record["outputs"] = [saved._asdict() for saved in self.outputs]
        record["returned"] = [step._asdict() for step in self.returned]
        return record


def from_json(record: Mapping[str, Any]) -> Result:
    """The result that a record is of."""
    known = {key: value for key, value in record.items() if key in Result._fields}
    known["outputs"] = tuple(Saved(**saved) for saved in known.get("outputs", ()))
    known["returned"] = tuple(StepResult(**step) for step in known.get("returned", ()))
    known["notes"] = tuple(known.get("notes", ()))
    return Result(**known)


@cache
def versions() -> dict[str, str]:
    """What the results may depend on."""
    return {
        "meshlab_willmore": __version__,
        "pymeshlab": version("pymeshlab"),
        "python": platform.python_version(),
    }


def recipe_of(*parts: object) -> str:
    """A hash of what is done to each mesh."""
    text = repr((parts, versions()["meshlab_willmore"], versions()["pymeshlab"]))
    return hashlib.sha256(text.encode()).hexdigest()[:_HASH]


def stamp(inputs: Iterable[Path]) -> tuple[int, int]:
    """The size of files and the time of the last change, to see whether they are the same."""
    found = []
    for path in inputs:
        # What can't be read has none.
        with suppress(OSError):
            found.append(path.stat())
    return sum(file.st_size for file in found), max((f.st_mtime_ns for f in found), default=0)


class Records:
    """The file, pipe or device that records are added to, each line at once."""

    def __init__(self, path: Path, recipe: str) -> None:
        self._path = path
        self._file: IO[bytes] = _opened(path)
        self._add({BEGUN: time.time(), "recipe": recipe, "versions": versions()})

    def add(self, result: Result) -> None:
        """Add a line."""
        self._add(result.as_json())

    def _add(self, record: Mapping[str, Any]) -> None:
        try:
            self._file.write(json.dumps(record, allow_nan=False).encode() + b"\n")
            self._file.flush()
        except OSError as error:
            raise UnwritableError(self._path, error.strerror) from error

    def close(self) -> None:
        """Close the file."""
        with suppress(OSError):
            # That its disk is full was an error before.
            self._file.close()


def _opened(path: Path) -> IO[bytes]:
    """Open for lines to be added; a line that was cut off is ended."""
    try:
        if is_stream(path):
            return opened_stream(path)
        file = path.open("ab")
    except OSError as error:
        raise UnwritableError(path, error.strerror) from error
    if _is_cut(path):
        file.write(b"\n")
    return file


def _is_cut(path: Path) -> bool:
    """Whether a file ends within a line."""
    with path.open("rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(size - 1, 0))
        return file.read() not in (b"", b"\n")


class Earlier(NamedTuple):
    """What a file of records says: the last result of each input, and when each recipe began."""

    results: dict[str, Result]
    begun: dict[str, float]

    def settles(
        self, name: str, recipe: str, stamp: tuple[int, int], outputs: Sequence[str]
    ) -> Result | None:
        """The result of an input if it still holds.

        It does for the same input, recipe and names of outputs, if those are whole.
        """
        result = self.results.get(name)
        if result is None or result.recipe != recipe or (result.size, result.modified) != stamp:
            return None
        if result.is_done and [saved.file for saved in result.outputs] != list(outputs):
            return None
        is_whole = all(
            os.path.isfile(saved.file) and os.path.getsize(saved.file) == saved.bytes
            for saved in result.outputs
        )
        return result if is_whole else None


def read(path: Path) -> Earlier:
    """What earlier runs recorded; nothing if there is no such file.

    Raises `WrongUse` for a file that holds something else.
    """
    results: dict[str, Result] = {}
    begun: dict[str, float] = {}
    if path.exists():
        try:
            for record in _lines(path):
                if BEGUN in record:
                    begun.setdefault(record["recipe"], record[BEGUN])
                else:
                    results[record["input"]] = from_json(record)
        except (AttributeError, KeyError, TypeError) as error:
            raise _other_file(path) from error
    return Earlier(results, begun)


def _lines(path: Path) -> Iterator[dict[str, Any]]:
    is_first = True
    with path.open("rb") as file:
        for line in file:
            try:
                record = json.loads(line)
                is_record = isinstance(record, dict) and ("input" in record or BEGUN in record)
            except ValueError:
                is_record = False
            if is_record:
                yield record
            elif is_first and line.strip() and line.endswith(b"\n"):
                raise _other_file(path)
            is_first = False


def _other_file(path: Path) -> WrongUse:
    return WrongUse(f"{path} holds no records of a batch; use a new name")


def check(path: Path, is_continued: bool, force: bool) -> None:
    """Raise `WrongUse` if no records can be written to the file, or it has some already."""
    if path.is_dir():
        raise WrongUse(f"{path} is a folder; name a file in it, such as '{path / 'log.jsonl'}'")
    if is_stream(path):
        # Nothing can be read there: a pipe would be waited for, and a device may have no end.
        if is_continued:
            raise WrongUse(f"{path} is no file, so no batch can go on from it; name a file")
        return
    if not path.parent.is_dir():
        raise WrongUse(f"cannot write {path}: the folder {path.parent} does not exist")
    if not path.exists():
        return
    read(path)
    if not is_continued and not force and path.stat().st_size > 0:
        raise WrongUse(
            f"{path} already exists; use --resume to go on with that batch, or --force to add to it"
        )
