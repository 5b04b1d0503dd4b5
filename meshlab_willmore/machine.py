"""Faults of the machine, and not of the mesh, as errors and warnings that name the cure."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

# Bytes that can't be written on a full disk.
_LITTLE = 65536
# Between what is wrong and the command that fixes it.
FIX = "; fix it with: "

# The packages with libGL.so.1 and libOpenGL.so.0, which PyMeshLab needs.
DEBIAN_PACKAGES = "apt-get install libgl1 libopengl0"
_BROKEN_LIBRARY = re.compile(
    r"(lib[\w.+-]+\.so[\w.]*): (?:cannot open shared|file too short|invalid ELF)"
)
_NOT_LOADED = "PyMeshLab could not be loaded: "


class Problem(NamedTuple):
    """What is wrong, and a command that fixes it."""

    text: str
    cure: str

    def __str__(self) -> str:
        return f"{self.text}{FIX}{self.cure}"


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
    """The message for an import that failed at a library of the system; None if it did not."""
    text = str(error)
    if text.startswith(_NOT_LOADED) or not broken_libraries(text):
        return None
    return (
        f"{_NOT_LOADED}{text}. On Debian and Ubuntu its system libraries come with: "
        f"{DEBIAN_PACKAGES}"
    )


def core_count() -> int:
    """How many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def fault_of(error: BaseException | None) -> MachineError | None:
    """The fault of the machine that an error comes from, None if there is none."""
    while error is not None:
        if isinstance(error, MachineError):
            return error
        error = error.__cause__
    return None


def stops_all(error: BaseException) -> bool:
    """Whether all other inputs would fail in the same way: a library or a setting is wrong."""
    return isinstance(fault_of(error) or error, ImportError)


def unset(*names: str) -> str:
    """The command that removes environment variables."""
    return f"unset {' '.join(names)}"


def unwritable(folder: Path) -> str:
    """Why no file can be written into a folder that may not exist yet; empty if one can."""
    existing = next((p for p in (folder, *folder.parents) if os.path.lexists(p)), folder)
    if not existing.is_dir():
        return "it is a file" if existing == folder else f"{existing} is a file"
    try:
        write_a_little(existing)
    except OSError as error:
        return os.strerror(error.errno) if error.errno else str(error)
    return ""


def write_a_little(folder: Path) -> None:
    """Write a small temporary file into a folder, or raise `OSError`."""
    with tempfile.TemporaryFile(dir=folder) as file:
        file.write(bytes(_LITTLE))
        file.flush()
        os.fsync(file.fileno())
