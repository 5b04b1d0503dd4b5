"""Everything that knows PyMeshLab; no other room imports it."""

import contextlib
import sys

from ..machine import without_library

try:
    # PyMeshLab prints it where plugins can't be loaded, which is no output of a user's program.
    with contextlib.redirect_stdout(sys.stderr):
        import pymeshlab  # noqa: F401
except ImportError as error:
    text = without_library(error)
    if text is None:
        raise
    raise ImportError(text) from error
