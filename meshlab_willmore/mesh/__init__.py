"""What a mesh is: checked arrays, half-edge connectivity, and the flip."""

from .. import numba_settings

# Before the first import of Numba.
numba_settings.import_numba()
