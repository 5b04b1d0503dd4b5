"""Willmore-energy edge flips for PyMeshLab, MeshLab scripts and NumPy arrays.

Importing this package adds its filters to `pymeshlab.MeshSet`.
"""

from __future__ import annotations

import functools
import importlib
import logging
import warnings
from typing import TYPE_CHECKING, Any

from ._version import __version__

if TYPE_CHECKING:
    from . import batch, report, script
    from .measure import (
        Measures,
        intersection_angles,
        measures,
        vertex_willmore_energy,
        willmore_energy,
    )
    from .meshset.register import is_registered, register, unregister
    from .optimize import optimize_flips
    from .progress import Cancelled
    from .results import FlipResult

# Kernels take their time to load: what needs them is fetched when it is first used.
_HOMES = {
    "Cancelled": "progress",
    "FlipResult": "results",
    "Measures": "measure",
    "intersection_angles": "measure",
    "is_registered": "meshset.register",
    "measures": "measure",
    "optimize_flips": "optimize",
    "register": "meshset.register",
    "report": "",
    "batch": "",
    "script": "",
    "unregister": "meshset.register",
    "vertex_willmore_energy": "measure",
    "willmore_energy": "measure",
}

__all__ = [
    "Cancelled",
    "FlipResult",
    "Measures",
    "__version__",
    "batch",
    "intersection_angles",
    "is_registered",
    "measures",
    "optimize_flips",
    "register",
    "report",
    "script",
    "unregister",
    "vertex_willmore_energy",
    "willmore_energy",
]


# Silent unless the program that imports this package wants to have its log.
logging.getLogger(__name__).addHandler(logging.NullHandler())


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    _warn_of_missing_library()
    home = _HOMES[name]
    if not home:
        return importlib.import_module(f".{name}", __name__)
    return getattr(importlib.import_module(f".{home}", __name__), name)


@functools.cache
def _warn_of_missing_library() -> None:
    # Not on import: the command line, which begins with it, reports it as an error.
    if _missing:
        warnings.warn(f"{_missing}. Until then only the functions on arrays work.", stacklevel=3)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])


def _register() -> str:
    """Register the filters; return why that is impossible where a system library is missing."""
    try:
        importlib.import_module(".meshset.register", __name__).register()
    except ImportError as error:
        if error.__cause__ is None:
            raise
        return str(error)
    return ""


_missing = _register()
