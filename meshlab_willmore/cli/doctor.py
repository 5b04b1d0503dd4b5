"""`meshlab-willmore doctor`: check this machine, and name the command that fixes what is wrong."""

from __future__ import annotations

import json
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple

import click

from .. import machine, numba_settings, temporary_files
from .._version import __version__
from ..batch.lost_kernels import cache_cure
from ..messages import counted
from . import progress
from .arguments import json_option
from .errors import debug_option
from .text import WIDTH

EXAMPLES = """\b
Examples:
  meshlab-willmore doctor
  meshlab-willmore doctor --json
"""

LIBRARIES = ("pymeshlab", "numpy", "numba")
# The packages with libGL.so.1 and libOpenGL.so.0, by the program that installs them.
INSTALLERS = {
    "apt-get": machine.DEBIAN_PACKAGES,
    "dnf": "dnf install mesa-libGL libglvnd-opengl",
}
REINSTALL = f"{Path(sys.executable).name} -m pip install --force-reinstall meshlab-willmore"
UPGRADE = f"{sys.executable} -m pip install --upgrade numba"
WARM_UP = "meshlab-willmore warmup"

# Meshes and textures are written into the folder for temporary files.
ROOM_WANTED = 200 * 2**20
# How many names a message lists.
_NAMED = 6
_INDENT = "     "


class Finding(NamedTuple):
    """The result of a check; `cure` is the command that fixes what is wrong."""

    name: str
    ok: bool
    text: str
    cure: str = ""


@click.command("doctor", short_help="Check this machine.", epilog=EXAMPLES)
@json_option
@debug_option
def command(as_json: bool) -> None:
    """Check what this package needs, and name the command that fixes what is wrong.

    Checks the installed packages, PyMeshLab's plugins and filters, Numba's variables, compiler and
    cache, and the folder for temporary files. Exit code 0 if all checks pass, else 1.
    """
    findings = []
    with progress.shown("doctor", len(CHECKS)) as status:
        for check in CHECKS:
            status.next(getattr(check, "__name__", ""))
            finding = check()
            findings.append(finding)
            if not as_json:
                click.echo(_line(finding))
    failed = sum(not finding.ok for finding in findings)
    if as_json:
        click.echo(json.dumps({"ok": not failed, "findings": [f._asdict() for f in findings]}))
    else:
        result = f"{failed} of {len(findings)} checks failed"
        click.echo(result if failed else "All checks passed.")
    if failed:
        click.get_current_context().exit(1)


def _line(finding: Finding) -> str:
    text = textwrap.fill(
        f"{'ok ' if finding.ok else 'BAD'}  {finding.name}: {finding.text}",
        WIDTH,
        subsequent_indent=_INDENT,
        break_long_words=False,
        break_on_hyphens=False,
    )
    # A command stays in one line, from which it can be copied.
    return text if finding.ok else f"{text}\n{_INDENT}fix: {finding.cure}"


# --- checks ------------------------------------------------------------------------------------


def packages() -> Finding:
    """Check that all libraries are installed."""
    versions = {name: _version(name) for name in LIBRARIES}
    absent = [name for name, version in versions.items() if not version]
    if absent:
        cure = f"{sys.executable} -m pip install {' '.join(absent)}"
        return Finding("packages", False, f"{', '.join(absent)} not installed", cure)
    python = f"Python {platform.python_version()} ({sys.executable})"
    versions = {"meshlab_willmore": __version__, **versions}
    installed = ", ".join(f"{name} {version}" for name, version in versions.items())
    return Finding("packages", True, f"{installed}, {python}")


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return ""


def settings() -> Finding:
    """Check that Numba's variables have possible values."""
    answer = ask(_SETTINGS)
    if not answer.values:
        return _failure("variables", answer, "Numba can't be imported", UPGRADE)
    given = [f"{key}={value}" for key, value in os.environ.items() if key.startswith("NUMBA_")]
    return Finding("variables", True, ", ".join(sorted(given)) or "no NUMBA_ variable is set")


def pymeshlab() -> Finding:
    """Check that PyMeshLab can be imported with all its plugins."""
    answer = ask(_PYMESHLAB)
    if not answer.values:
        return _failure("PyMeshLab", answer, "can't be loaded", REINSTALL)
    plugins = sorted(set(re.findall(r"^\s*(?:lib)?(\w+)\.(?:so|dll|dylib):", answer.printed, re.M)))
    if plugins:
        missing = machine.broken_libraries(answer.printed)
        because = f" ({', '.join(missing)} can't be loaded)" if missing else ""
        text = f"plugins that did not load: {', '.join(plugins)}{because}"
        return Finding("PyMeshLab", False, text, _install_libraries())
    return Finding("PyMeshLab", True, f"loads, with {answer.values['filters']} filters")


def filters() -> Finding:
    """Check that our filters are registered, and PyMeshLab has all filters of its version."""
    answer = ask(_FILTERS)
    if not answer.values.get("registered"):
        cure = f"fix PyMeshLab first; if it is ok: {REINSTALL}"
        return _failure("filters", answer, "the Willmore filters are missing", cure)
    missing = answer.values["missing"]
    if not missing:
        return Finding("filters", True, "the Willmore filters and all native ones are there")
    more = len(missing) - _NAMED
    names = ", ".join(missing[:_NAMED]) + (f" and {more} more" if more > 0 else "")
    text = f"{len(missing)} of PyMeshLab's filters are missing: {names}"
    here, known = answer.values["version"], answer.values["recorded"]
    if here != known:
        text += f" (this is PyMeshLab {here}; the list is that of {known})"
        return Finding("filters", True, text)
    return Finding("filters", False, text, _install_libraries())


def compiler() -> Finding:
    """Check that Numba can compile."""
    if _compiler_is_off():
        text = "the compiler is off, everything is slow: NUMBA_DISABLE_JIT is set"
        return Finding("Numba", False, text, "unset NUMBA_DISABLE_JIT")
    answer = ask(_COMPILER)
    if not answer.values:
        return _failure("Numba", answer, "can't compile", UPGRADE)
    threads, cores = answer.values["threads"], answer.values["cores"]
    more = f" on {counted(cores, 'core')}, more than useful" if threads > cores else ""
    return Finding("Numba", True, f"compiles; threads: {threads}{more}")


def _compiler_is_off() -> bool:
    return os.environ.get("NUMBA_DISABLE_JIT", "").strip().lstrip("+-0") != ""


def cache() -> Finding:
    """Check that compiled kernels are kept for later processes."""
    name = "Numba's cache"
    if _compiler_is_off():
        return Finding(name, True, "not needed while the compiler is off")
    problem = numba_settings.cache_problem()
    if problem is not None:
        return Finding(name, False, *problem)
    answer = ask(_CACHE)
    if not answer.values:
        return _failure(name, answer, "can't be read", "fix the failures above")
    folder = answer.values["folder"]
    if not folder:
        text = "no writable folder: each process compiles again, for ten to thirty seconds"
        return Finding(name, False, text, cache_cure())
    why = machine.unwritable(Path(folder))
    if why:
        return Finding(name, False, f"{folder}: {why}", cache_cure())
    damaged = answer.values.get("damaged")
    if damaged:
        return _damage(name, damaged)
    return Finding(name, True, f"{folder} ({_warmth(**answer.values)})")


def _damage(name: str, paths: Sequence[str]) -> Finding:
    names = paths if len(paths) <= _NAMED else sorted({str(Path(path).parent) for path in paths})
    shown = ", ".join(names[:_NAMED])
    text = f"{counted(len(paths), 'file')} damaged, compiled again when needed: {shown}"
    return Finding(name, False, text, f"rm -r {shlex.join(names)}")


def _warmth(missing: int | None, steps: int, **_: object) -> str:
    """How much of what the filters need is compiled; None if that is unknown."""
    if missing is None:
        return f"{WARM_UP!r} compiles everything that is missing"
    if not missing:
        return "everything is compiled"
    ready = steps - missing
    done = f"{ready} of {steps} ways to flip and measure" if ready else "nothing"
    return f"{done} compiled yet; the rest on first use, or now with: {WARM_UP}"


def temporary() -> Finding:
    """Check the folder for temporary files, through which meshes pass."""
    name = "temporary files"
    problem = temporary_files.temporary_problem(ROOM_WANTED)
    if problem is not None:
        return Finding(name, False, *problem)
    folder = tempfile.gettempdir()
    free = shutil.disk_usage(folder).free
    return Finding(name, True, f"{folder}, {free // temporary_files.MIB} MiB free")


CHECKS = (packages, settings, pymeshlab, filters, compiler, cache, temporary)


def _failure(name: str, answer: Answer, text: str, cure: str) -> Finding:
    """The finding for a process that failed; a wrong variable or a missing library has its cure."""
    _, found, message = answer.printed.rpartition(f"{machine.SettingError.__name__}: ")
    if found:
        text, _, cure = message.splitlines()[0].partition(machine.FIX)
        return Finding(name, False, text, cure)
    libraries = machine.broken_libraries(answer.printed)
    if libraries:
        text = f"{text}: {', '.join(libraries)} is missing or broken"
        return Finding(name, False, text, _install_libraries())
    return Finding(name, False, f"{text}: {answer.last_line}", cure)


def _install_libraries() -> str:
    """The command for this machine, or all of them."""
    here = [command for program, command in INSTALLERS.items() if shutil.which(program)]
    return here[0] if here else " or ".join(INSTALLERS.values())


# --- questions to other processes --------------------------------------------------------------
#
# An import can crash and print what it likes, and Numba reads its variables once.

# Before the answer: PyMeshLab prints warnings on the same stream.
_MARK = "meshlab-willmore-answer:"
_SECONDS = 300

_PYMESHLAB = """
import pymeshlab
answer = {"filters": len(pymeshlab.filter_list())}
"""
_FILTERS = """
import meshlab_willmore
from meshlab_willmore.meshset import catalogue
answer = {
    "registered": meshlab_willmore.is_registered(),
    "missing": sorted(known.name for known in catalogue.missing()),
    "version": catalogue.version(),
    "recorded": catalogue.recorded_version(),
}
"""
_SETTINGS = """
from meshlab_willmore import numba_settings
numba_settings.import_numba()
answer = {"ok": True}
"""
_COMPILER = """
import meshlab_willmore
import numba
@numba.njit
def double(n):
    return 2 * n
double(1)
from meshlab_willmore.mesh.parallel import thread_count
answer = {"threads": thread_count(), "cores": numba.config.NUMBA_DEFAULT_NUM_THREADS}
"""
_CACHE = """
from meshlab_willmore import warmup
from meshlab_willmore.mesh import jit
folder = jit.cache_folder()
answer = {"folder": folder, "steps": len(warmup.steps()), "missing": None}
answer["damaged"] = jit.damaged_entries()
if folder:
    answer["missing"] = len(warmup.missing())
"""


class Answer(NamedTuple):
    """The values of a process, empty if it gave none, and everything else that it printed."""

    values: dict[str, Any]
    printed: str

    @property
    def last_line(self) -> str:
        """The last printed line, which has the error."""
        return self.printed.splitlines()[-1] if self.printed else "it ended without a message"


def ask(program: str) -> Answer:
    """Run a program that sets `answer` in a process of its own."""
    code = f"{program}\nimport json\nprint({_MARK!r} + json.dumps(answer))"
    try:
        done = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Answer({}, f"no answer in {_SECONDS} seconds")
    printed, _, text = done.stdout.partition(_MARK)
    values, _, rest = text.partition("\n")
    printed = f"{printed.rstrip()}\n{rest}{done.stderr}".strip()
    return Answer(json.loads(values) if values else {}, printed)
