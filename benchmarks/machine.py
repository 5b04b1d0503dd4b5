"""What a figure depends on, and how figures are taken."""

import contextlib
import datetime
import importlib.metadata
import os
import pathlib
import platform
import statistics
import time
import warnings

import numba

import meshlab_willmore

LIBRARIES = ("numpy", "numba", "pymeshlab", "meshlib", "libigl")


def description():
    """A line each: date, machine, versions."""
    versions = {
        "Python": platform.python_version(),
        "meshlab_willmore": meshlab_willmore.__version__,
        **{name: _version(name) for name in LIBRARIES},
    }
    return [
        datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        f"{_processor()}, {platform.system()}, {os.cpu_count()} cores, "
        f"{numba.config.NUMBA_NUM_THREADS} threads, load {_load()}",
        ", ".join(f"{name} {version}" for name, version in versions.items()),
    ]


def _version(name):
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "not installed"


def _processor():
    info = pathlib.Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _load():
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"


@contextlib.contextmanager
def threads_set(count):
    """Let kernels run on so many threads inside."""
    with warnings.catch_warnings():
        # Numba starts a threading layer of its own, and may find an old one beside PyMeshLab.
        warnings.simplefilter("ignore")
        before = numba.get_num_threads()
        numba.set_num_threads(count)
    try:
        yield
    finally:
        numba.set_num_threads(before)


def timed(run):
    """Wall-clock time of a call, and what it returned."""
    start = time.perf_counter()
    result = run()
    return time.perf_counter() - start, result


def seconds_of(run):
    """Wall-clock time of a call."""
    return timed(run)[0]


def interleaved(contenders, rounds):
    """The median of the seconds of each contender, who take turns.

    Parameters
    ----------
    contenders : dict of str to callable
        Each returns the seconds that it took: what prepares it is not counted.
    rounds : int

    Returns
    -------
    dict of str to (float, float, float)
        Median, least, most.
    """
    found = {name: [] for name in contenders}
    for _ in range(rounds):
        for name, contender in contenders.items():
            found[name].append(contender())
    return {name: (statistics.median(s), min(s), max(s)) for name, s in found.items()}
