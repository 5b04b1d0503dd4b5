"""Loading a mesh in a process of its own first: PyMeshLab crashes on some files that end early.

One such file would end a run with all that comes after it.
"""

from __future__ import annotations

import faulthandler
import os
import select
import signal
import sys
import time
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

# Some files that end early make PyMeshLab read or reserve memory without end.
_SECONDS = 20.0
_SECONDS_PER_BYTE = 1e-6
# By so much later than the parent would, the process ends itself.
_LONGER = 1.0

_IMAGES = {".bmp", ".jpeg", ".jpg", ".png", ".tga", ".tif", ".tiff"}

_FINE = b"+"
_FAILED = b"-"
_CHUNK = 1 << 16
_PROC = Path("/proc")


def check(path: Path, load: Callable[[], None], why: Callable[[Exception], str]) -> None:
    """Raise if `load` fails, crashes or does not end; nothing that it does is to be seen.

    Parameters
    ----------
    path : Path
        The file; its size tells how long it may take, and that of the images in its folder.
    why : callable
        What to say of an error.

    Raises
    ------
    OSError
        In one line, without the name of the file.
    """
    if sys.platform != "linux":
        return
    seconds = _limit(path)
    end, start = os.pipe()
    with warnings.catch_warnings():
        # Threads of others don't matter to a child that loads and is gone.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        os.close(end)
        _answer(start, load, why, seconds)
    os.close(start)
    try:
        answer = _read(end, time.monotonic() + seconds)
    finally:
        os.close(end)
        with suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
    if answer is None:
        raise OSError(f"PyMeshLab does not come to an end with it in {seconds:.0f} s")
    if answer.startswith(_FAILED):
        raise OSError(answer[1:].decode("utf-8", "surrogateescape"))
    if answer != _FINE:
        name = signal.Signals(os.WTERMSIG(status)).name if os.WIFSIGNALED(status) else "no answer"
        raise OSError(f"PyMeshLab crashes on it ({name}); the file is damaged, or ends early")


def _limit(path: Path) -> float:
    """How many seconds a load may take: textures can be far larger than the mesh."""
    size = path.stat().st_size
    with suppress(OSError):
        images = (p for p in path.parent.iterdir() if p.suffix.lower() in _IMAGES)
        size += sum(image.stat().st_size for image in images)
    return _SECONDS + _SECONDS_PER_BYTE * size


def _read(end: int, until: float) -> bytes | None:
    """All that comes before the other end is closed; None if that takes too long."""
    data = b""
    while True:
        left = until - time.monotonic()
        if left <= 0.0 or not select.select([end], [], [], left)[0]:
            return None
        piece = os.read(end, _CHUNK)
        if not piece:
            return data
        data += piece


# --- in the process ----------------------------------------------------------------------------


def _answer(
    start: int, load: Callable[[], None], why: Callable[[Exception], str], seconds: float
) -> None:
    """Load, say how that went, and end."""
    try:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        # A parent that was killed ends nobody any more.
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, seconds + _LONGER)
        faulthandler.disable()
        _limit_memory()
        load()
        os.write(start, _FINE)
    except Exception as error:
        os.write(start, _FAILED + why(error).encode("utf-8", "surrogateescape")[:_CHUNK])
    finally:
        os._exit(0)


def _limit_memory() -> None:
    """Let no broken file take the memory of others, nor leave a core behind."""
    import resource

    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    wanted = _memory()
    if wanted is None:
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    limits = [limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY]
    resource.setrlimit(resource.RLIMIT_AS, (min([wanted, *limits]), hard))


def _memory() -> int | None:
    """How many bytes this process has and could have; None where no /proc tells, as in a chroot."""
    try:
        pages = int((_PROC / "self/statm").read_text().split()[0])
        lines = (_PROC / "meminfo").read_text().splitlines()
    except OSError:
        return None
    free = [int(line.split()[1]) for line in lines if line.startswith("MemAvailable:")]
    return pages * os.sysconf("SC_PAGE_SIZE") + free[0] * 1024 if free else None
