"""What `doctor` asks other processes; each runs one of these and prints a line of JSON.

A process of its own, because an import can end in a crash, prints what it likes, and Numba reads
its variables once.
"""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any, NamedTuple

# Before the answer: PyMeshLab prints warnings on the same stream.
_MARK = "meshlab-willmore-answer:"
_SECONDS = 300

PYMESHLAB = """
import pymeshlab
answer = {"filters": len(pymeshlab.filter_list())}
"""
FILTERS = """
import meshlab_willmore
from meshlab_willmore.meshset import catalogue
answer = {
    "registered": meshlab_willmore.is_registered(),
    "missing": sorted(known.name for known in catalogue.missing()),
    "version": catalogue.version(),
    "recorded": catalogue.recorded_version(),
}
"""
SETTINGS = """
from meshlab_willmore import quick_start
quick_start.import_numba()
answer = {"wrong": False}
"""
COMPILER = """
import meshlab_willmore
import numba
@numba.njit
def double(n):
    return 2 * n
double(1)
from meshlab_willmore.mesh.workers import thread_count
answer = {"threads": thread_count(), "cores": numba.config.NUMBA_DEFAULT_NUM_THREADS}
"""
CACHE = """
from meshlab_willmore import warmup
from meshlab_willmore.mesh import compiling, jit
folder = jit.cache_folder()
answer = {"folder": folder, "steps": len(warmup.steps()), "missing": None}
answer["damaged"] = jit.damaged_entries()
if folder and compiling.CAN_TELL:
    answer["missing"] = len(warmup.missing())
"""


class Answer(NamedTuple):
    """What came back: the values, empty if there was none, and all that was printed beside."""

    values: dict[str, Any]
    printed: str


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
    values: dict[str, Any] = {}
    rest = []
    for line in done.stdout.splitlines():
        before, mark, text = line.partition(_MARK)
        rest.append(before)
        if mark:
            values = json.loads(text)
    return Answer(values, "\n".join([*rest, *done.stderr.splitlines()]).strip())
