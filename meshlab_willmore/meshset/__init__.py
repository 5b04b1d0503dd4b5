"""Filters for PyMeshLab, and running filter scripts; lower packages don't import PyMeshLab."""

import contextlib
import sys

from ..machine import without_library

try:
    # PyMeshLab prints plugins that it can't load, which is not output of a user's program.
    with contextlib.redirect_stdout(sys.stderr):
        import pymeshlab  # noqa: F401
except ImportError as error:
    text = without_library(error)
    if text is None:
        raise
    raise ImportError(text) from error
