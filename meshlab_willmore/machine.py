"""Faults of the machine, told as such and with their cure: nothing is wrong with the mesh."""

from __future__ import annotations

import functools
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

CACHE_DIR = "NUMBA_CACHE_DIR"
TEMPORARY = "TMPDIR"
MIB = 2**20
_STEP = 1024

_LAYERS = ("default", "safe", "threadsafe", "forksafe", "tbb", "omp", "workqueue")
_LEVELS = ("0", "1", "2", "3", "max")
_PROCESSOR = ("NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES")
# LLVM only prints of names that it does not know, and ends the process at what is no list.
_TRY_PROCESSOR = """
import sys
from llvmlite import binding
binding.initialize_native_target()
name, features = sys.argv[1:]
binding.Target.from_default_triple().create_target_machine(cpu=name, features=features)
"""
_UNKNOWN = "is not a recognized"

# Who ran out of room leaves less than this.
_LITTLE = 65536
# Between what is wrong and the command that mends it.
MEND = "; mend it with: "

# The packages with libGL.so.1 and libOpenGL.so.0, which PyMeshLab needs.
DEBIAN_PACKAGES = "apt-get install libgl1 libopengl0"
_BROKEN_LIBRARY = re.compile(
    r"(lib[\w.+-]+\.so[\w.]*): (?:cannot open shared|file too short|invalid ELF)"
)
_NOT_LOADED = "PyMeshLab could not be loaded: "


class Problem(NamedTuple):
    """What is wrong, and a command that mends it."""

    text: str
    cure: str

    def __str__(self) -> str:
        return f"{self.text}{MEND}{self.cure}"


class MachineError(Exception):
    """Something of the machine is at fault; the message has the cure."""


class SettingError(MachineError, ImportError):
    """A variable of Numba's has a value that it can't have."""


class RoomError(MachineError, OSError):
    """The folder for temporary files can't be used, or is full."""


class MachineWarning(RuntimeWarning):
    """Something of the machine makes work slow."""


def join(problems: Iterable[Problem]) -> Problem:
    """Several problems as one."""
    texts, cures = zip(*problems, strict=True)
    return Problem(" and ".join(texts), "; ".join(cures))


def broken_libraries(text: str) -> list[str]:
    """The libraries of the system that can't be loaded, by what the loader says of them."""
    return sorted(set(_BROKEN_LIBRARY.findall(text)))


def without_library(error: ImportError) -> str | None:
    """What to say of an import that failed at a library of the system; None if it did not."""
    text = str(error)
    if text.startswith(_NOT_LOADED) or not broken_libraries(text):
        return None
    return (
        f"{_NOT_LOADED}{text}. On Debian and Ubuntu its system libraries come with: "
        f"{DEBIAN_PACKAGES}"
    )


def fault_of(error: BaseException | None) -> MachineError | None:
    """The fault of the machine that an error comes from, None if there is none."""
    while error is not None:
        if isinstance(error, MachineError):
            return error
        error = error.__cause__
    return None


# --- variables ---------------------------------------------------------------------------------


def wrong_settings() -> list[Problem]:
    """What is wrong with variables of Numba's that it takes without a look, or can't read."""
    problems = [
        Problem(
            f"the variable {name} is {os.environ[name]!r}, but has to be {wanted}", _unset(name)
        )
        for name, wanted, is_right in (
            ("NUMBA_NUM_THREADS", "a whole number of threads, 1 or more", _is_count),
            ("NUMBA_OPT", _one_of(_LEVELS), _LEVELS.__contains__),
            ("NUMBA_THREADING_LAYER", _one_of(_LAYERS), _LAYERS.__contains__),
            ("NUMBA_THREADING_LAYER_PRIORITY", "tbb, omp and workqueue in any order", _is_order),
        )
        if name in os.environ and not is_right(os.environ[name])
    ]
    return [*problems, *_processor()]


def unread(name: str) -> Problem:
    """The problem of a variable that Numba can't read."""
    return Problem(
        f"the variable {name} is {os.environ.get(name, '')!r}, which Numba can't read", _unset(name)
    )


def cache_problem() -> Problem | None:
    """What is wrong with the folder that ``NUMBA_CACHE_DIR`` names; None: nothing, or not set."""
    value = os.environ.get(CACHE_DIR)
    if not value:
        return None
    if not os.path.isabs(value):
        return Problem(
            f"the variable {CACHE_DIR} is {value!r}: each working folder gets a cache of its own",
            f"export {CACHE_DIR}={os.path.abspath(value)}",
        )
    problem = unwritable(Path(value))
    if problem:
        text = f"the folder of {CACHE_DIR}, {value}, can't be written: {problem}"
        return Problem(text, _unset(CACHE_DIR))
    return None


def unwritable(folder: Path) -> str:
    """Why no file can be written into a folder that may not exist yet; empty if one can."""
    existing = next((p for p in (folder, *folder.parents) if os.path.lexists(p)), folder)
    if not existing.is_dir():
        return "it is a file" if existing == folder else f"{existing} is a file"
    try:
        _write_a_little(existing)
    except OSError as error:
        return os.strerror(error.errno) if error.errno else str(error)
    return ""


def _write_a_little(folder: Path) -> None:
    with tempfile.TemporaryFile(dir=folder) as file:
        file.write(bytes(_LITTLE))
        file.flush()
        os.fsync(file.fileno())


def _is_count(text: str) -> bool:
    try:
        return int(text) > 0
    except ValueError:
        return False


def _is_order(text: str) -> bool:
    return sorted(text.split()) == ["omp", "tbb", "workqueue"]


def _one_of(names: tuple[str, ...]) -> str:
    return f"{', '.join(names[:-1])} or {names[-1]}"


def _unset(*names: str) -> str:
    return f"unset {' '.join(names)}"


def _processor() -> list[Problem]:
    """The variables of the processor, if LLVM does not know what they say."""
    given = {name: os.environ[name] for name in _PROCESSOR if os.environ.get(name)}
    if not given or _is_known(*(given.get(name, "") for name in _PROCESSOR)):
        return []
    shown = " and ".join(f"{name} is {value!r}" for name, value in given.items())
    return [Problem(f"the variable {shown}, which LLVM does not know", _unset(*given))]


@functools.cache
def _is_known(name: str, features: str) -> bool:
    done = subprocess.run(
        [sys.executable, "-c", _TRY_PROCESSOR, name, features],
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    return done.returncode == 0 and _UNKNOWN not in done.stderr


def allow_all_names() -> None:
    """Let PyMeshLab open files with letters outside of ASCII in the C locale of batch systems.

    Python does the same for itself, but not where ``LC_ALL`` is set.
    """
    if sys.platform == "linux" and os.environ.get("LC_ALL") in ("C", "POSIX"):
        os.environ["LC_ALL"] = "C.UTF-8"


# --- temporary files ---------------------------------------------------------------------------


@contextmanager
def temporary_folder(needed: int = 0) -> Iterator[Path]:
    """A new folder among the temporary files, which is gone in the end.

    Parameters
    ----------
    needed : int
        How many bytes will be written into it, about.

    Raises
    ------
    RoomError
        There is no such folder, it has less room than that, or it was full in the end. In one line:
        which folder, how much is needed and how much is free.
    """
    try:
        name = tempfile.mkdtemp(prefix="meshlab_willmore_")
    except OSError as error:
        raise RoomError(str(_no_folder(error))) from error
    folder = Path(name)
    try:
        if shutil.disk_usage(folder).free < needed:
            raise RoomError(str(_no_room(folder, needed)))
        yield folder
    except Exception as error:
        if fault_of(error) or not _is_full(folder):
            raise
        raise RoomError(str(_no_room(folder, needed))) from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _is_full(folder: Path) -> bool:
    """Whether not even a little more can be written; who failed at it need not have told."""
    try:
        _write_a_little(folder)
    except OSError:
        return True
    return False


def temporary_problem(wanted: int) -> Problem | None:
    """What is wrong with the folder for temporary files, where `wanted` bytes should be free."""
    try:
        folder = Path(tempfile.gettempdir())
    except OSError as error:
        return _no_folder(error)
    problem = unwritable(folder)
    if problem:
        return Problem(f"no temporary file can be written into {folder}: {problem}", _OTHER_FOLDER)
    free = shutil.disk_usage(folder).free
    if free < wanted:
        text = f"the folder for temporary files, {folder}, has only {_size(free)} free"
        return Problem(text, _OTHER_FOLDER)
    given = os.environ.get(TEMPORARY)
    if given and Path(os.path.abspath(given)) != folder:
        why = unwritable(Path(given)) or "there is no such folder"
        text = f"{TEMPORARY} names {given}, where no file can be written: {why}; {folder} is used"
        return Problem(text, _unset(TEMPORARY))
    return None


_OTHER_FOLDER = f"export {TEMPORARY}=/a/folder/with/room"


def _no_folder(error: OSError) -> Problem:
    return Problem(f"no folder for temporary files: {error.strerror}", _OTHER_FOLDER)


def _no_room(folder: Path, needed: int) -> Problem:
    what = f"about {_size(needed)} are needed, " if needed else ""
    free = _size(shutil.disk_usage(folder).free)
    text = f"no room for temporary files in {folder.parent}: {what}{free} are free"
    return Problem(text, _OTHER_FOLDER)


def _size(count: int) -> str:
    size, unit = float(count), "bytes"
    for larger in ("KiB", "MiB", "GiB"):
        if size < _STEP:
            break
        size, unit = size / _STEP, larger
    return f"{size:.0f} {unit}" if unit in ("bytes", "KiB") else f"{size:.1f} {unit}"
