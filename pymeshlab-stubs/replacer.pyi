"""PyMeshLab 2025.7.post1 with the filters of meshlab_willmore.

Written by `python -m generate.pymeshlab_stubs`.
"""

from collections.abc import Mapping

def replace_all(text: str, dic: Mapping[str, str]) -> str: ...
def replace_pymeshlab_filter_names(input_script: str) -> None: ...
