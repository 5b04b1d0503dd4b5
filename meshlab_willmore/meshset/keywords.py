"""PyMeshLab's names for what MeshLab calls otherwise."""

from __future__ import annotations

import keyword
import re


def python_name(name: str) -> str:
    """PyMeshLab's rule that turns a name of MeshLab's into one of Python's."""
    return re.sub(r"[().,'\":+]", "", re.sub(r"[ /-]", "_", name.lower()))


def keyword_of(name: str) -> str:
    """PyMeshLab's name for something that MeshLab calls `name`, where that can be a keyword."""
    made = python_name(name)
    return made + "_" if keyword.iskeyword(made) else made
