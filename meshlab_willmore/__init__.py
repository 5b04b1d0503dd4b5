"""Willmore-energy edge flips for PyMeshLab, MeshLab scripts and NumPy arrays.

Importing this package adds its filters to `pymeshlab.MeshSet`.
"""

from __future__ import annotations

import importlib
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import machine, quick_start
from ._version import __version__

if TYPE_CHECKING:
    from . import script
    from .measure import (
        Measures,
        intersection_angles,
        measures,
        vertex_willmore_energy,
        willmore_energy,
    )
    from .meshset.register import is_registered, register, unregister
    from .optimize import FlipResult, optimize_flips

# Kernels take their time to load: what needs them is fetched when it is first used.
_HOMES = {
    "FlipResult": "optimize",
    "Measures": "measure",
    "intersection_angles": "measure",
    "is_registered": "meshset.register",
    "measures": "measure",
    "optimize_flips": "optimize",
    "register": "meshset.register",
    "script": "",
    "unregister": "meshset.register",
    "vertex_willmore_energy": "measure",
    "willmore_energy": "measure",
}

__all__ = [
    "FlipResult",
    "Measures",
    "__version__",
    "intersection_angles",
    "is_registered",
    "measures",
    "optimize_flips",
    "register",
    "script",
    "unregister",
    "vertex_willmore_energy",
    "willmore_energy",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = _HOMES[name]
    if not home:
        return importlib.import_module(f".{name}", __name__)
    return getattr(importlib.import_module(f".{home}", __name__), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])


def _is_command_line() -> bool:
    # As `python -m` it begins with this import.
    return Path(sys.argv[0]).stem in ("meshlab-willmore", "-m")


def _register_where_possible() -> None:
    """Register the filters, or warn that PyMeshLab's system libraries are missing."""
    try:
        importlib.import_module(".meshset.register", __name__).register()
    except ImportError as error:
        if error.__cause__ is None:
            raise
        # The command line says it in its own way.
        if not _is_command_line():
            warnings.warn(f"{error}. Until then only the functions on arrays work.", stacklevel=3)


if _is_command_line():
    # Before PyMeshLab is imported, which then settles how it reads names of files.
    machine.allow_all_names()
_register_where_possible()
# Most of what the first filter would wait for. Many commands do without.
if not _is_command_line():
    quick_start.import_numba()
