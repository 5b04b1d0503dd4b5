"""PyMeshLab 2025.7.post1 with the filters of meshlab_willmore.

Written by `python -m generate.pymeshlab_stubs`.
"""

from collections.abc import Callable
from typing import Any

from . import pmeshlab as pmeshlab
from .pmeshlab import BoundingBox as BoundingBox
from .pmeshlab import Color as Color
from .pmeshlab import Image as Image
from .pmeshlab import InvalidEnumException as InvalidEnumException
from .pmeshlab import InvalidPercentageException as InvalidPercentageException
from .pmeshlab import Mesh as Mesh
from .pmeshlab import MeshSet as MeshSet
from .pmeshlab import MissingCompactnessException as MissingCompactnessException
from .pmeshlab import MissingComponentException as MissingComponentException
from .pmeshlab import PercentageValue as PercentageValue
from .pmeshlab import PureValue as PureValue
from .pmeshlab import PyMeshLabException as PyMeshLabException
from .pmeshlab import filter_list as filter_list
from .pmeshlab import load_default_plugins as load_default_plugins
from .pmeshlab import load_plugin as load_plugin
from .pmeshlab import number_plugins as number_plugins
from .pmeshlab import plugin_number as plugin_number
from .pmeshlab import print_filter_list as print_filter_list
from .pmeshlab import print_filter_parameter_list as print_filter_parameter_list
from .pmeshlab import print_plugin_filter_list as print_plugin_filter_list
from .pmeshlab import print_plugin_list as print_plugin_list
from .pmeshlab import print_pymeshlab_version as print_pymeshlab_version
from .pmeshlab import search as search
from .polyscope_functions import show_polyscope as show_polyscope
from .replacer import replace_pymeshlab_filter_names as replace_pymeshlab_filter_names

this_path: str

def use_cpu_opengl() -> None: ...
def do_not_use_cpu_opengl() -> None: ...
def bind_function(name: str) -> Callable[..., dict[str, Any] | None]: ...
