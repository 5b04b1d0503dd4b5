"""Writes `pymeshlab-stubs`: what PyMeshLab has, for editors and type checkers (PEP 561).

PyMeshLab's own classes are known by their docstrings, MeshLab's filters by `native_filters.json`
and by the defaults that PyMeshLab gives, and ours by their table.

    python -m generate.pymeshlab_stubs

The stubs are those of the PyMeshLab that `native_filters.json` was recorded with; with another one
nothing is written.
"""

from __future__ import annotations

import functools
import json
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pymeshlab

from generate.bindings import class_lines, first_sentence, function_lines, signatures
from meshlab_willmore import options
from meshlab_willmore.meshset import catalogue, native
from meshlab_willmore.meshset.filter_info import FilterInfo, ParamInfo
from meshlab_willmore.meshset.filters import BY_NAME

FOLDER = Path(__file__).parents[1] / "pymeshlab-stubs"
_RECORDED = json.loads(Path(catalogue.__file__).with_name("native_filters.json").read_text())
# What PyMeshLab's extension module has, and the order of it: classes first.
_PUBLIC = {name: v for name, v in vars(pymeshlab.pmeshlab).items() if not name.startswith("_")}
_NAMES = sorted(_PUBLIC, key=lambda name: (not isinstance(_PUBLIC[name], type), name))
_HEADER = (
    f'"""PyMeshLab {catalogue.recorded_version()} with the filters of meshlab_willmore.\n\n'
    'Written by `python -m generate.pymeshlab_stubs`.\n"""\n'
)
# A name that is known only when the program runs gives a dict of any keys.
_OVERLAPS = "# pyright: reportOverlappingOverload=false\n"
_TYPES = {
    "RichBool": "bool",
    "RichInt": "int",
    "RichMesh": "int",
    "RichFloat": "float",
    "RichDynamicFloat": "float",
    "RichString": "str",
    "RichOpenFile": "str",
    "RichSaveFile": "str",
    "RichAbsPerc": "PercentageValue | PureValue",
    "RichColor": "Color",
    "RichPosition": "ArrayLike",
    "RichDirection": "ArrayLike",
    "RichMatrix44f": "ArrayLike",
}
# PyMeshLab ends the process if a camera is given.
_CAMERA = "RichShotf"
# The types whose defaults can be the same for all meshes.
_FIXED = ("RichBool", "RichInt", "RichFloat", "RichDynamicFloat", "RichString", "RichEnum")


def texts() -> dict[str, str]:
    """The text of each file of the stubs, by its name."""
    return {
        "__init__.pyi": _HEADER + _PACKAGE,
        "pmeshlab.pyi": _HEADER + _OVERLAPS + "\n".join(_extension_lines()) + "\n",
        "polyscope_functions.pyi": _HEADER + _POLYSCOPE,
        "replacer.pyi": _HEADER + _REPLACER,
    }


def main() -> None:
    """Write the stubs."""
    if catalogue.version() != catalogue.recorded_version():
        sys.exit(
            f"PyMeshLab is {catalogue.version()}, the catalogue was recorded with "
            f"{catalogue.recorded_version()}: record it anew first, or install that version"
        )
    FOLDER.mkdir(exist_ok=True)
    for name, text in texts().items():
        (FOLDER / name).write_text(text, encoding="utf-8")


# --- the extension module ------------------------------------------------------------------------

_IMPORTS = """
from collections.abc import Iterator, Sequence
from typing import Any, Literal, TypedDict, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import NotRequired
"""
_ORDER = ("PercentageValue", "PureValue", "Color", "BoundingBox", "Image", "Mesh")


def _extension_lines() -> Iterator[str]:
    yield _IMPORTS
    for name in (*filter(_is_error, _NAMES), *_ORDER):
        yield from class_lines(_PUBLIC[name])
        yield ""
    filters = catalogue.everything()
    for filter_ in filters:
        yield from _result_lines(filter_)
    names = ", ".join(f'"{filter_.name}"' for filter_ in filters)
    yield f"_FilterName = Literal[{names}]"
    yield ""
    yield from class_lines(pymeshlab.MeshSet, {*(f.name for f in filters), "apply_filter"})
    yield "    def show_polyscope(self) -> None:"
    yield '        """Shows all meshes in a window of Polyscope, a package of its own."""'
    yield from _apply_lines(filters)
    for filter_ in filters:
        yield from _filter_lines(filter_)
    yield ""
    for name in _NAMES:
        if not isinstance(_PUBLIC[name], type):
            yield from function_lines(signatures(_PUBLIC[name]), "")


def _is_error(name: str) -> bool:
    value = _PUBLIC[name]
    return isinstance(value, type) and issubclass(value, Exception)


def _apply_lines(filters: Iterable[FilterInfo]) -> Iterator[str]:
    """`apply_filter`: the results by the names of filters, and any name."""
    (general,) = signatures(pymeshlab.MeshSet.apply_filter)
    for filter_ in filters:
        if _returns(filter_):
            yield "    @overload"
            yield (
                f'    def apply_filter(self, filter_name: Literal["{filter_.name}"], '
                f"**kwargs: Any) -> {_result_name(filter_)}: ..."
            )
    yield "    @overload"
    yield (
        "    def apply_filter(self, filter_name: _FilterName | str, **kwargs: Any) "
        "-> dict[str, Any]:"
    )
    yield f'        """{general.summary}"""'


# --- filters -------------------------------------------------------------------------------------


def _filter_lines(filter_: FilterInfo) -> Iterator[str]:
    params = [p for p in filter_.params if p.type != _CAMERA]
    defaults = _defaults(filter_)
    yield f"    def {filter_.name}("
    yield "        self,"
    if params:
        yield "        *,"
    for param in params:
        default = "" if param.required else f" = {defaults.get(param.keyword, '...')}"
        yield f"        {param.keyword}: {_type(filter_, param)}{default},"
    yield f"    ) -> {_result_type(filter_)}:"
    yield f'        """{_summary(filter_)}"""'


def _summary(filter_: FilterInfo) -> str:
    if filter_.is_willmore:
        return first_sentence(filter_.summary)
    return f"{filter_.meshlab_name}\n\n        {filter_.summary}\n        "


def _type(filter_: FilterInfo, param: ParamInfo) -> str:
    if filter_.is_willmore and param.type == "RichString":
        # A number may be given beside the names.
        return f"{_literal(options.BY_NAME[param.name].choices)} | float"
    if param.type == "RichEnum":
        return f"{_literal(param.choices)} | int"
    return _TYPES[param.type]


def _literal(choices: Iterable[str]) -> str:
    return f"Literal[{', '.join(json.dumps(choice) for choice in choices)}]"


# --- defaults ------------------------------------------------------------------------------------


def _defaults(filter_: FilterInfo) -> dict[str, str]:
    """The defaults that don't depend on the mesh, as Python, by keyword."""
    if filter_.is_willmore:
        fixed = (p for p in BY_NAME[filter_.name].parameters if not callable(p.default))
        return {p.name: _shown(p.default) for p in fixed}
    found = {}
    first, *others = (_values(ms, filter_.name) for ms in _sets())
    for param in filter_.params:
        key = param.keyword
        if param.type in _FIXED and key in first and all(first[key] == o.get(key) for o in others):
            value = param.choices[first[key]] if param.choices else first[key]
            found[key] = _shown(value)
    return found


def _shown(value: Any) -> str:
    """A value as Python; MeshLab's floats have single precision."""
    if isinstance(value, float) and np.float32(value) == value:
        return repr(float(str(np.float32(value))))
    return json.dumps(value) if isinstance(value, str) else repr(value)


def _values(ms: pymeshlab.MeshSet, name: str) -> dict[str, Any]:
    with native.muted():
        return native.defaults(ms, name)


@functools.cache
def _sets() -> tuple[pymeshlab.MeshSet, pymeshlab.MeshSet]:
    """Two sets that differ in all that defaults may depend on."""
    return _spheres(1, selected=0), _spheres(30, selected=9)


def _spheres(radius: int, selected: int) -> pymeshlab.MeshSet:
    """A set of spheres with scalars, and with selected faces."""
    ms = pymeshlab.MeshSet()
    for number in range(radius // 10 + 1):
        ms.create_sphere(radius=radius, subdiv=number + 1)
    ms.compute_scalar_by_function_per_vertex(q=f"x*{radius}")
    ms.compute_scalar_by_function_per_face(q=f"fi*{radius}")
    ms.compute_selection_by_condition_per_face(condselect=f"fi<{selected}")
    return ms


# --- results -------------------------------------------------------------------------------------


def _returns(filter_: FilterInfo) -> tuple[tuple[str, str, str], ...]:
    """Name, type and meaning of what a filter returns; nothing if that is unknown."""
    if filter_.is_willmore:
        return BY_NAME[filter_.name].returns
    recorded = _RECORDED["filters"][filter_.name]["returns"] or ()
    return tuple((name, kind, "") for name, kind in recorded)


def _result_type(filter_: FilterInfo) -> str:
    if _returns(filter_):
        return _result_name(filter_)
    unknown = not filter_.is_willmore and _RECORDED["filters"][filter_.name]["returns"] is None
    return "dict[str, Any] | None" if unknown else "None"


def _result_name(filter_: FilterInfo) -> str:
    return "_" + "".join(word.capitalize() for word in filter_.name.split("_"))


def _result_lines(filter_: FilterInfo) -> Iterator[str]:
    returns = _returns(filter_)
    if not returns:
        return
    name = _result_name(filter_)
    if not all(key.isidentifier() for key, _, _ in returns):
        fields = ", ".join(f'"{key}": {kind}' for key, kind, _ in returns)
        yield f'{name} = TypedDict("{name}", {{{fields}}})'
        return
    yield f"class {name}(TypedDict):"
    for key, kind, meaning in returns:
        yield f"    {key}: {kind}"
        if meaning:
            yield f'    """{meaning}"""'
    yield ""


# --- PyMeshLab's own Python ----------------------------------------------------------------------

_REEXPORTED = "".join(f"from .pmeshlab import {name} as {name}\n" for name in _NAMES)
_PACKAGE = f"""
from collections.abc import Callable
from typing import Any

from . import pmeshlab as pmeshlab
{_REEXPORTED}from .polyscope_functions import show_polyscope as show_polyscope
from .replacer import replace_pymeshlab_filter_names as replace_pymeshlab_filter_names

this_path: str

def use_cpu_opengl() -> None: ...
def do_not_use_cpu_opengl() -> None: ...
def bind_function(name: str) -> Callable[..., dict[str, Any] | None]: ...
"""
_POLYSCOPE = """
from .pmeshlab import MeshSet

def show_polyscope(self: MeshSet) -> None: ...
"""
_REPLACER = """
from collections.abc import Mapping

def replace_all(text: str, dic: Mapping[str, str]) -> str: ...
def replace_pymeshlab_filter_names(input_script: str) -> None: ...
"""


if __name__ == "__main__":
    main()
