"""How much memory this process uses, and may use, where the system has such numbers."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

GIB = 2**30
_KIB = 1024
_PROC = Path("/proc/self")
# What `clear_refs` takes to forget the peak.
_PEAK = "5"


def can_limit() -> bool:
    """Whether this system limits memory at all: Windows and macOS do not."""
    return resource is not None and sys.platform == "linux"


@contextmanager
def limited(size: int | None) -> Iterator[None]:
    """Inside, the process can have at most about `size` bytes in memory (None: no limit).

    Systems limit the addresses. So what is reserved, but not in use, comes on top.
    """
    if size is None or resource is None:
        yield
        return
    before = resource.getrlimit(resource.RLIMIT_AS)
    limits = [size + _reserved()]
    limits += [limit for limit in before if limit != resource.RLIM_INFINITY]
    try:
        resource.setrlimit(resource.RLIMIT_AS, (min(limits), before[1]))
    except (ValueError, OSError):
        # macOS has the constant, and takes no limit.
        yield
        return
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def reachable() -> int | None:
    """How many bytes this process has in memory or could have; None without /proc."""
    try:
        resident = int((_PROC / "statm").read_text().split()[1])
        lines = (_PROC.parent / "meminfo").read_text().splitlines()
    except OSError:
        return None
    free = [int(line.split()[1]) for line in lines if line.startswith("MemAvailable:")]
    return resident * os.sysconf("SC_PAGE_SIZE") + free[0] * _KIB if free else None


def _reserved() -> int:
    """Bytes of addresses that are not in memory."""
    with suppress(OSError):
        size, resident = (int(count) for count in (_PROC / "statm").read_text().split()[:2])
        return (size - resident) * os.sysconf("SC_PAGE_SIZE")
    return 0


def no_core_files() -> None:
    """Let a crash leave no file."""
    if resource is not None:
        resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


def reset_peak() -> None:
    """Count the peak anew, where that is possible: on Linux."""
    with suppress(OSError):
        (_PROC / "clear_refs").write_text(_PEAK)


def peak() -> int | None:
    """The most bytes that this process had in memory since `reset_peak`, or since its start."""
    with suppress(OSError):
        for line in (_PROC / "status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * _KIB
    if resource is None:
        return None
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (
        1 if sys.platform == "darwin" else _KIB
    )
