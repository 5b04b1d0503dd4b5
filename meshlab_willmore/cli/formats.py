"""Which formats PyMeshLab writes, and what each holds; asked of PyMeshLab itself."""

from __future__ import annotations

import functools
from typing import Any

# What PyMeshLab writes, for people; whether it does is asked.
COMMON = ("ply", "obj", "stl", "off", "3ds", "dae", "wrl", "x3d", "xyz", "dxf")

# Their writers cut a path at its first dot, and leave files beside the folder they were given.
_ASTRAY = frozenset({"u3d", "idtf"})


def is_written(ending: str) -> bool:
    """Whether PyMeshLab writes files with this ending (without the dot)."""
    return ending.lower() not in _ASTRAY and _takes(ending.lower())


def holds(ending: str, keyword: str) -> bool:
    """Whether files with this ending take a ``save_...`` keyword of ``save_current_mesh``."""
    return _takes(ending.lower(), keyword)


@functools.cache
def _takes(ending: str, *keywords: str) -> bool:
    import numpy as np
    import pymeshlab

    from ..meshset import native

    if ending in pymeshlab.filter_list():
        return False
    helper = pymeshlab.MeshSet()
    native.add(helper, pymeshlab.Mesh(np.zeros((1, 3))))
    given: dict[str, Any] = dict.fromkeys(keywords, True)
    try:
        with native.muted():
            helper.filter_parameter_values(ending, **given)
    except native.ERRORS:
        return False
    return True
