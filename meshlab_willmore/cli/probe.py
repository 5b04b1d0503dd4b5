"""What `doctor` asks other processes; each runs one of these and prints a line of JSON.

A process of its own, because an import can end in a crash, prints what it likes, and Numba fixes
its threading layer once.
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
THREADS = """
import warnings
warnings.simplefilter("ignore")
try:
    import pymeshlab  # brings a TBB of its own, which Numba may find first
except ImportError:
    pass
import numba
@numba.njit(parallel=True)
def count(n):
    total = 0
    for i in numba.prange(n):
        total += i
    return total
count(2)
answer = {"layer": numba.threading_layer(), "threads": numba.get_num_threads()}
"""
CACHE = """
from meshlab_willmore import warmup
from meshlab_willmore.mesh import compiling, jit
folder = jit.cache_folder()
answer = {"folder": folder, "steps": len(warmup.steps()), "missing": None}
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
