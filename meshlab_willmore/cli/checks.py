"""What a machine needs for this package, a finding for each."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sys
import tempfile
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

from .. import machine
from .._version import __version__
from . import cache_notes, probe
from .columns import counted

OLDEST_PYTHON = (3, 10)
LIBRARIES = ("pymeshlab", "numpy", "numba")

# The packages with libGL.so.1 and libOpenGL.so.0, by the program that installs them.
INSTALLERS = {
    "apt-get": machine.DEBIAN_PACKAGES,
    "dnf": "dnf install mesa-libGL libglvnd-opengl",
}
REINSTALL = f"{Path(sys.executable).name} -m pip install --force-reinstall meshlab-willmore"
WARM_UP = "meshlab-willmore warmup"

# Meshes and textures pass through the folder for temporary files.
ROOM_WANTED = 200 * 2**20
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
        missing = machine.broken_libraries(answer.printed)
        because = f" ({', '.join(missing)} can't be loaded)" if missing else ""
        text = f"plugins that did not load: {', '.join(plugins)}{because}"
        return Finding("PyMeshLab", False, text, _system_libraries())
    return Finding("PyMeshLab", True, f"loads, with {answer.values['filters']} filters")


def _import_problem(printed: str) -> tuple[str, str]:
    missing = machine.broken_libraries(printed)
    if missing:
        return f"can't be loaded: {', '.join(missing)} is missing or broken", _system_libraries()
    lines = printed.splitlines() or ["it ended without a word"]
    return f"can't be loaded: {lines[-1]}", REINSTALL


def _system_libraries() -> str:
    """The command for this machine, or all of them."""
    here = [command for program, command in INSTALLERS.items() if shutil.which(program)]
    return here[0] if here else " or ".join(INSTALLERS.values())


def filters() -> Finding:
    """Our filters are registered, and PyMeshLab has all that its version should have."""
    answer = probe.ask(probe.FILTERS)
    wrong = _wrong_setting("filters", answer)
    if wrong:
        return wrong
    missing = machine.broken_libraries(answer.printed)
    if not answer.values and missing:
        text = f"the Willmore filters are not there: {', '.join(missing)} is missing or broken"
        return Finding("filters", False, text, _system_libraries())
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


def settings() -> Finding:
    """Numba's variables have values that they can have."""
    name = "variables"
    answer = probe.ask(probe.SETTINGS)
    given = [f"{key}={value}" for key, value in os.environ.items() if key.startswith("NUMBA_")]
    return _wrong_setting(name, answer) or Finding(
        name, True, ", ".join(sorted(given)) or "no NUMBA_ variable is set"
    )


def _wrong_setting(name: str, answer: probe.Answer) -> Finding | None:
    """The finding if a process ended because of one of Numba's variables."""
    _, found, said = answer.printed.rpartition(f"{machine.SettingError.__name__}: ")
    if not found or answer.values:
        return None
    text, _, cure = said.splitlines()[0].partition(machine.MEND)
    return Finding(name, False, text, cure)


def compiler() -> Finding:
    """Numba can compile."""
    if _compiler_is_off():
        text = "the compiler is switched off, all is slow: NUMBA_DISABLE_JIT is set"
        return Finding("Numba", False, text, "unset NUMBA_DISABLE_JIT")
    answer = probe.ask(probe.COMPILER)
    wrong = _wrong_setting("Numba", answer)
    if wrong:
        return wrong
    if not answer.values:
        lines = answer.printed.splitlines() or ["it ended without a word"]
        cure = f"{sys.executable} -m pip install --upgrade numba"
        return Finding("Numba", False, f"can't compile: {lines[-1]}", cure)
    threads, cores = answer.values["threads"], answer.values["cores"]
    more = f" on {counted(cores, 'core')}, more than help" if threads > cores else ""
    return Finding("Numba", True, f"compiles; threads: {threads}{more}")


def _compiler_is_off() -> bool:
    return os.environ.get("NUMBA_DISABLE_JIT", "").strip().lstrip("+-0") != ""


def cache() -> Finding:
    """What Numba compiles is kept for later processes."""
    name = "Numba's cache"
    if _compiler_is_off():
        return Finding(name, True, "not needed while the compiler is off")
    problem = machine.cache_problem()
    if problem is not None:
        return Finding(name, False, *problem)
    answer = probe.ask(probe.CACHE)
    wrong = _wrong_setting(name, answer)
    if wrong:
        return wrong
    if not answer.values:
        lines = answer.printed.splitlines() or ["it ended without a word"]
        return Finding(name, False, f"can't be looked at: {lines[-1]}", "mend what is wrong above")
    folder = answer.values["folder"]
    text = "no writable folder: each process compiles anew, for ten to thirty seconds"
    if folder:
        text = f"{folder}: {machine.unwritable(Path(folder))}"
    if not folder or machine.unwritable(Path(folder)):
        return Finding(name, False, text, cache_notes.cure())
    if answer.values.get("damaged"):
        return _damage(answer.values["damaged"])
    return Finding(name, True, f"{folder} ({_warmth(**answer.values)})")


def _damage(paths: Sequence[str]) -> Finding:
    """The finding for files of the cache that are not as they were written."""
    names = paths if len(paths) <= _NAMED else sorted({str(Path(path).parent) for path in paths})
    shown = ", ".join(names[:_NAMED])
    text = f"{counted(len(paths), 'file')} damaged, compiled anew when needed: {shown}"
    return Finding("Numba's cache", False, text, f"rm -r {shlex.join(names)}")


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
    name = "temporary files"
    problem = machine.temporary_problem(ROOM_WANTED)
    if problem is not None:
        return Finding(name, False, *problem)
    folder = tempfile.gettempdir()
    free = shutil.disk_usage(folder).free
    return Finding(name, True, f"{folder}, {free // machine.MIB} MiB free")


ALL = (python, libraries, settings, pymeshlab, filters, compiler, cache, temporary)
