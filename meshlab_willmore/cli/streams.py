"""A place for what is printed, also where the standard streams are closed."""

from __future__ import annotations

import os
import sys
from pathlib import Path

_DESCRIPTORS = (0, 1, 2)


def completed() -> None:
    """Open what is closed to nowhere.

    Else the next file that is opened, an output perhaps, would take the place of a stream, and
    what C++ code prints would go into it.
    """
    for descriptor in _DESCRIPTORS:
        if not _is_open(descriptor):
            # The lowest free number is this one.
            os.open(os.devnull, os.O_RDWR)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))  # noqa: SIM115


def _is_open(descriptor: int) -> bool:
    try:
        os.fstat(descriptor)
    except OSError:
        return False
    return True
