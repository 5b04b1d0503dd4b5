"""Kernels compiled once for each state of their sources, and which tests run.

The package keys its cache by the sources of all kernels, so the folder is kept from run to run.
Before workers of pytest-xdist start, everything is compiled, on all cores.
"""

import atexit
import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import hypothesis
import pytest

# Started in the background (nohup, some CI), a process ignores these, and so would its children.
signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)

# PyMeshLab reads names of files as the locale says, and tests have some with all kinds of letters.
os.environ["LC_ALL"] = "C.UTF-8"

# The same cases in each run: a change fails by what it changes, not by chance or by a slow machine.
hypothesis.settings.register_profile("same cases", derandomize=True, deadline=None)
hypothesis.settings.load_profile("same cases")

JIT_IS_OFF = os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")
IS_WORKER = "PYTEST_XDIST_WORKER" in os.environ
# States of the sources whose kernels are kept.
KEPT = 16
WARM_UP = """
import contextlib, pathlib
from meshlab_willmore.mesh.jit import cache_folder
from meshlab_willmore.machine import core_count
from meshlab_willmore.warmup import warm_up
mark = pathlib.Path(cache_folder()).parent / "warm"
lock = open(mark.with_name("lock"), "w")
with contextlib.suppress(ImportError):
    # A run that begins while another one compiles the same waits for it. Not on Windows.
    import fcntl
    fcntl.flock(lock, fcntl.LOCK_EX)
if not mark.exists():
    print("Compiling all kernels, this takes a minute or two ...", flush=True)
    print(f"compiled {warm_up(lambda line: None, core_count()).compiled}")
    mark.touch()
mark.parent.touch()
"""


def _cache():
    """The folder in the user's cache; of those who have none, one for this session."""
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    folder = Path(home, "meshlab_willmore-tests")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        folder = Path(tempfile.mkdtemp(prefix="meshlab_willmore-tests-"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


if not JIT_IS_OFF and not IS_WORKER:
    # Through the environment, so that workers and subprocesses share it; before Numba is imported.
    os.environ["NUMBA_CACHE_DIR"] = str(_cache())


def pytest_sessionstart(session):
    has_workers = getattr(session.config.option, "numprocesses", None)
    if JIT_IS_OFF or session.config.option.collectonly:
        return
    if IS_WORKER or not has_workers:
        from tests.called_kernels import keep

        keep()
        return
    subprocess.run([sys.executable, "-c", WARM_UP], check=True)
    cache = Path(os.environ["NUMBA_CACHE_DIR"])
    with contextlib.suppress(FileNotFoundError):  # where another run deletes them at the same time
        states = sorted(cache.iterdir(), key=lambda folder: folder.stat().st_mtime)
        for old in states[:-KEPT]:
            shutil.rmtree(old, ignore_errors=True)


def pytest_collection_modifyitems(config, items):
    # After a native filter that failed, PyMeshLab prints nothing more in a process: tests that read
    # what it prints come first, at the beginning of the first worker's share. Then those that take
    # so long that they have a timeout of their own: no worker should wait for one in the end.
    items.sort(
        key=lambda item: ("capfd" not in item.fixturenames, not item.get_closest_marker("timeout"))
    )
    if JIT_IS_OFF:
        for item in items:
            if item.get_closest_marker("heavy"):
                item.add_marker(pytest.mark.skip(reason="heavy, and the JIT is off"))
    if "nightly" not in config.option.markexpr:
        nightly = [item for item in items if item.get_closest_marker("nightly")]
        config.hook.pytest_deselected(items=nightly)
        items[:] = [item for item in items if not item.get_closest_marker("nightly")]
