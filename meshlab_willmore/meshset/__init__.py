"""Everything that knows PyMeshLab; no other room imports it."""

import re

try:
    import pymeshlab  # noqa: F401
except ImportError as error:
    if not re.search(r"lib\S+\.so\S*: cannot open shared object", str(error)):
        raise
    raise ImportError(
        f"PyMeshLab could not be loaded: {error}. On Debian and Ubuntu its system libraries come "
        "with: apt-get install libgl1 libopengl0"
    ) from error
