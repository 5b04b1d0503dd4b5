"""PyMeshLab 2025.7.post1 with the filters of meshlab_willmore.

Written by `python -m generate.pymeshlab_stubs`.
"""

from .pmeshlab import MeshSet

def show_polyscope(self: MeshSet) -> None: ...
