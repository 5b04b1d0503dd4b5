"""PyMeshLab's names for what MeshLab calls otherwise."""

from __future__ import annotations

import keyword
import re


def keyword_of(name: str) -> str:
    """PyMeshLab's name for something that MeshLab calls `name`."""
    made = re.sub(r"[().,'\":+]", "", re.sub(r"[ /-]", "_", name.lower()))
    return made + "_" if keyword.iskeyword(made) else made
