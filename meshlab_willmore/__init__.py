"""Willmore-energy edge flips for PyMeshLab, MeshLab scripts and NumPy arrays.

Importing this package adds its filters to `pymeshlab.MeshSet`.
"""

from __future__ import annotations

import importlib
import re
from typing import TYPE_CHECKING, Any

try:
    import pymeshlab  # noqa: F401
except ImportError as error:
    if not re.search(r"lib\S+\.so\S*: cannot open shared object", str(error)):
        raise
    raise ImportError(
        f"PyMeshLab could not be loaded: {error}. On Debian and Ubuntu its system libraries come "
        "with: apt-get install libgl1 libopengl0"
    ) from error

from ._version import __version__
from .meshset.register import is_registered, register, unregister

if TYPE_CHECKING:
    from .measure import (
        Measures,
        intersection_angles,
        measures,
        vertex_willmore_energy,
        willmore_energy,
    )
    from .optimize import FlipResult, optimize_flips

# Numba takes longer to import than PyMeshLab: what needs it is fetched when it is first used.
_HOMES = {
    "FlipResult": "optimize",
    "Measures": "measure",
    "intersection_angles": "measure",
    "measures": "measure",
    "optimize_flips": "optimize",
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
    "unregister",
    "vertex_willmore_energy",
    "willmore_energy",
]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])


register()
