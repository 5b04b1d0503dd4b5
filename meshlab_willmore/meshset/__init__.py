"""Everything that knows PyMeshLab; no other room imports it."""

import contextlib
import re
import sys

_BROKEN_LIBRARY = r"lib\S+\.so\S*: (cannot open shared object|file too short|invalid ELF header)"

try:
    # PyMeshLab prints it where plugins can't be loaded, which is no output of a user's program.
    with contextlib.redirect_stdout(sys.stderr):
        import pymeshlab  # noqa: F401
except ImportError as error:
    if not re.search(_BROKEN_LIBRARY, str(error)):
        raise
    raise ImportError(
        f"PyMeshLab could not be loaded: {error}. On Debian and Ubuntu its system libraries come "
        "with: apt-get install libgl1 libopengl0"
    ) from error
