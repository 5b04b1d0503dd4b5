"""What a machine needs for this package, a finding for each."""

from __future__ import annotations

import os
import re
import shutil
import sys
import tempfile
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

from .._version import __version__
from . import probe

OLDEST_PYTHON = (3, 10)
LIBRARIES = ("pymeshlab", "numpy", "numba")

# The packages with libGL.so.1 and libOpenGL.so.0, by the program that installs them.
INSTALLERS = {
    "apt-get": "apt-get install libgl1 libopengl0",
    "dnf": "dnf install mesa-libGL libglvnd-opengl",
}
REINSTALL = f"{Path(sys.executable).name} -m pip install --force-reinstall meshlab-willmore"
WARM_UP = "meshlab-willmore warmup"

# Meshes and textures pass through the folder for temporary files.
ROOM_WANTED = 200 * 2**20
_MIB = 2**20
# More filters than this are counted, not named.
_NAMED = 6


class Finding(NamedTuple):
    """One thing that was looked at.

    Attributes
    ----------
    name : str
        What it is.
    ok : bool
        Whether it is fit.
    text : str
        What was found.
    cure : str
        The command that mends it, empty where nothing is wrong.
    """

    name: str
    ok: bool
    text: str
    cure: str = ""


def python() -> Finding:
    """The interpreter is new enough."""
    version = ".".join(map(str, sys.version_info[:3]))
    wanted = ".".join(map(str, OLDEST_PYTHON))
    if sys.version_info[:2] < OLDEST_PYTHON:
        return Finding(
            "Python", False, f"{version} is too old", f"install Python {wanted} or later"
        )
    return Finding("Python", True, f"{version} ({sys.executable})")


def libraries() -> Finding:
    """What is installed."""
    versions = {name: _version(name) for name in LIBRARIES}
    absent = [name for name, version in versions.items() if not version]
    if absent:
        cure = f"{sys.executable} -m pip install {' '.join(absent)}"
        return Finding("packages", False, f"{', '.join(absent)} not installed", cure)
    versions = {"meshlab_willmore": __version__, **versions}
    return Finding("packages", True, ", ".join(f"{n} {v}" for n, v in versions.items()))


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return ""


def pymeshlab() -> Finding:
    """PyMeshLab can be imported, and all its plugins were loaded."""
    answer = probe.ask(probe.PYMESHLAB)
    if not answer.values:
        return Finding("PyMeshLab", False, *_import_problem(answer.printed))
    plugins = sorted(set(re.findall(r"^\s*(?:lib)?(\w+)\.(?:so|dll|dylib):", answer.printed, re.M)))
    if plugins:
        missing = _missing_libraries(answer.printed)
        because = f" ({', '.join(missing)} can't be loaded)" if missing else ""
        text = f"plugins that did not load: {', '.join(plugins)}{because}"
        return Finding("PyMeshLab", False, text, _system_libraries())
    return Finding("PyMeshLab", True, f"loads, with {answer.values['filters']} filters")


def _import_problem(printed: str) -> tuple[str, str]:
    missing = _missing_libraries(printed)
    if missing:
        return f"can't be loaded: {', '.join(missing)} is missing or broken", _system_libraries()
    lines = printed.splitlines() or ["it ended without a word"]
    return f"can't be loaded: {lines[-1]}", REINSTALL


def _system_libraries() -> str:
    """The command for this machine, or all of them."""
    here = [command for program, command in INSTALLERS.items() if shutil.which(program)]
    return here[0] if here else " or ".join(INSTALLERS.values())


def _missing_libraries(printed: str) -> list[str]:
    found = re.findall(
        r"(lib[\w.+-]+\.so[\w.]*): (?:cannot open shared|file too short|invalid ELF)", printed
    )
    return sorted(set(found))


def filters() -> Finding:
    """Our filters are registered, and PyMeshLab has all that its version should have."""
    answer = probe.ask(probe.FILTERS)
    if not answer.values.get("registered"):
        lines = answer.printed.splitlines() or ["no reason was given"]
        text = f"the Willmore filters are not there: {lines[-1]}"
        return Finding("filters", False, text, "mend PyMeshLab first; if it is fit: " + REINSTALL)
    gone = answer.values["missing"]
    here, known = answer.values["version"], answer.values["recorded"]
    if not gone:
        return Finding("filters", True, "the Willmore filters and all native ones are there")
    text = f"{len(gone)} of PyMeshLab's filters are gone: {_named(gone)}"
    if here != known:
        text += f" (this is PyMeshLab {here}; the list is that of {known})"
        return Finding("filters", True, text)
    return Finding("filters", False, text, _system_libraries())


def _named(names: list[str]) -> str:
    more = len(names) - _NAMED
    return ", ".join(names[:_NAMED]) + (f" and {more} more" if more > 0 else "")


def threads() -> Finding:
    """Numba can compile, and has a threading layer."""
    if _compiler_is_off():
        text = "the compiler is switched off, all is slow: NUMBA_DISABLE_JIT is set"
        return Finding("Numba", False, text, "unset NUMBA_DISABLE_JIT")
    answer = probe.ask(probe.THREADS)
    if not answer.values:
        lines = answer.printed.splitlines() or ["it ended without a word"]
        cure = f"{sys.executable} -m pip install --upgrade numba"
        return Finding("Numba", False, f"can't compile: {lines[-1]}", cure)
    layer, count = answer.values["layer"], answer.values["threads"]
    return Finding("Numba", True, f"compiles; threading layer {layer}, threads: {count}")


def _compiler_is_off() -> bool:
    return os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


def cache() -> Finding:
    """What Numba compiles is kept for later processes."""
    if _compiler_is_off():
        return Finding("Numba's cache", True, "not needed while the compiler is off")
    answer = probe.ask(probe.CACHE)
    folder = answer.values.get("folder")
    if not folder:
        cure = f"export NUMBA_CACHE_DIR={Path.home() / '.cache' / 'numba'}"
        text = "no writable folder: each process compiles anew, for ten to thirty seconds"
        return Finding("Numba's cache", False, text, cure)
    problem = _unwritable(Path(folder))
    if problem:
        cure = f"export NUMBA_CACHE_DIR={Path.home() / '.cache' / 'numba'}"
        return Finding("Numba's cache", False, f"{folder}: {problem}", cure)
    return Finding("Numba's cache", True, f"{folder} ({_warmth(**answer.values)})")


def _warmth(missing: int | None, steps: int, **_: object) -> str:
    """How much of what the filters need is compiled; None: that can't be told."""
    if missing is None:
        return f"{WARM_UP!r} compiles all that is not in it"
    if not missing:
        return "all is compiled"
    if missing == steps:
        done = "nothing"
    else:
        done = f"{steps - missing} of {steps} ways to flip and measure"
    return f"{done} compiled yet; the rest at its first use, or now with: {WARM_UP}"


def temporary() -> Finding:
    """Meshes pass through the folder for temporary files."""
    folder = Path(tempfile.gettempdir())
    problem = _unwritable(folder)
    cure = "export TMPDIR=/a/folder/with/room"
    if problem:
        return Finding("temporary files", False, f"{folder}: {problem}", cure)
    free = shutil.disk_usage(folder).free
    text = f"{folder}, {free // _MIB} MiB free"
    if free < ROOM_WANTED:
        return Finding("temporary files", False, f"{text}: little", cure)
    return Finding("temporary files", True, text)


def _unwritable(folder: Path) -> str:
    """Why no file can be written into a folder that may not exist yet; empty if one can."""
    existing = next((p for p in (folder, *folder.parents) if p.exists()), folder)
    try:
        tempfile.TemporaryFile(dir=existing).close()
    except OSError as error:
        return os.strerror(error.errno) if error.errno else str(error)
    return ""


ALL = (python, libraries, pymeshlab, filters, threads, cache, temporary)
