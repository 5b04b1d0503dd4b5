"""Writes `native_filters.json`: how MeshLab names its filters and parameters, what they return.

PyMeshLab has no function for these names, but the script of a set contains each filter that was
applied, with all its parameters. So each filter is applied to a small model and the script is read.
Some filters crash on such models or for want of a graphics card: each runs in a child process, and
the few that can't be run keep the entry that they have in the file, which was read from MeshLab's
sources and is marked by an empty model.

    python -m generate.native_filters

With ``--check`` nothing is written, and what differs from the file is printed.
"""

from __future__ import annotations

import functools
import json
import os
import signal
import sys
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np
import pymeshlab
from pymeshlab import MeshSet

FILE = Path(__file__).parents[1] / "meshlab_willmore" / "meshset" / "native_filters.json"
SAMPLES = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"
TEXTURE = SAMPLES / "TextureDouble_A.png"
SECONDS = 150
PIPE_SIZE = 65536
# Around the type of what a filter does not always return.
RARE = "NotRequired"
# No filter has a parameter of this name.
MARK = "no such parameter"


# --- models ------------------------------------------------------------------------------------


def spheres() -> MeshSet:
    """Two layers with scalars, colours and some selected faces."""
    ms = MeshSet()
    ms.create_sphere(subdiv=2)
    ms.create_sphere(subdiv=2, radius=1.1)
    ms.compute_scalar_by_function_per_vertex(q="x")
    ms.compute_color_by_function_per_vertex()
    ms.compute_selection_by_condition_per_face(condselect="fi<30")
    return ms


def cube() -> MeshSet:
    ms = MeshSet()
    ms.load_new_mesh(str(SAMPLES / "cube.obj"))
    return ms


def textured() -> MeshSet:
    ms = MeshSet()
    for _ in range(2):
        ms.load_new_mesh(str(SAMPLES / "bunny10k_textured.obj"))
    ms.compute_scalar_by_function_per_vertex(q="x")
    return ms


def points() -> MeshSet:
    """A sphere, and points on it with normals, which are current."""
    ms = MeshSet()
    ms.create_sphere(subdiv=3)
    ms.generate_sampling_poisson_disk(samplenum=300)
    ms.compute_normal_for_point_clouds()
    return ms


def points_beside() -> MeshSet:
    """The same, with the sphere current."""
    ms = points()
    ms.set_current_mesh(0)
    return ms


def face_scalars() -> MeshSet:
    ms = spheres()
    ms.compute_scalar_by_function_per_face(q="fi")
    return ms


def vertex_texture() -> MeshSet:
    ms = spheres()
    ms.compute_texcoord_by_function_per_vertex()
    return ms


def wedge_texture() -> MeshSet:
    """Texture coordinates, and no texture."""
    ms = spheres()
    ms.compute_texcoord_parametrization_triangle_trivial_per_wedge(textdim=512)
    return ms


def painted() -> MeshSet:
    ms = wedge_texture()
    ms.set_texture_per_mesh(textname=str(TEXTURE))
    return ms


def raster() -> MeshSet:
    ms = spheres()
    ms.load_new_raster(str(TEXTURE))
    return ms


def project() -> MeshSet:
    """A mesh with rasters that have cameras."""
    ms = MeshSet()
    ms.load_project(str(SAMPLES / "sample_project.mlp"))
    return ms


def quads() -> MeshSet:
    ms = cube()
    ms.meshing_tri_to_quad_by_smart_triangle_pairing()
    return ms


MODELS: dict[str, Callable[[], MeshSet]] = {
    model.__name__: model
    for model in (
        spheres,
        cube,
        textured,
        points,
        points_beside,
        face_scalars,
        vertex_texture,
        wedge_texture,
        painted,
        raster,
        project,
        quads,
    )
} | {"empty": MeshSet}


@functools.cache
def model_set(model: str) -> MeshSet:
    """The set of a model, made once; only children may change it."""
    ms = MODELS[model]()
    ms.clear_filter_script()
    return ms


# What some filters need besides a model, or to be quick.
GIVEN: dict[str, dict[str, Any]] = {
    "apply_coord_craters_from_point_cloud": {"target_mesh": 0, "samples_mesh": 1},
    "compute_texmap_from_color": {"textname": "colour.png"},
    "generate_marching_cubes_apss": {"resolution": 20},
    "generate_marching_cubes_rimls": {"resolution": 20},
    "generate_sampling_volumetric": {
        "samplevolnum": 500,
        "poissonradius": pymeshlab.PercentageValue(20),
    },
    "set_texture_per_mesh": {"textname": str(TEXTURE)},
    "transfer_attributes_to_texture_per_vertex": {"sourcemesh": 1, "targetmesh": 1},
}


# --- children ----------------------------------------------------------------------------------


class Said(NamedTuple):
    """What a child wrote: to its pipe, and to its streams."""

    answer: bytes
    noise: bytes


def in_child(task: Callable[[], bytes], until: bytes = b"\0") -> Said:
    """The answer of `task`, run in a child; empty if it raised, crashed or took too long.

    The child is stopped as soon as its streams hold `until`.
    """
    answers, noises = os.pipe(), os.pipe()
    child = os.fork()
    if child == 0:
        _run_child(task, answers[1], noises[1])
    os.close(answers[1])
    os.close(noises[1])
    noise = b""
    for part in _parts(noises[0]):
        noise += part
        if until in noise:
            os.kill(child, signal.SIGKILL)
            break
    answer = b"".join(_parts(answers[0]))
    os.close(answers[0])
    os.close(noises[0])
    os.waitpid(child, 0)
    return Said(answer, noise)


def _run_child(task: Callable[[], bytes], answers: int, noises: int) -> None:
    try:
        signal.alarm(SECONDS)
        os.dup2(noises, 1)
        os.dup2(noises, 2)
        answer = task()
        os.closerange(noises, noises + 1)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(1, 2)
        with os.fdopen(answers, "wb") as pipe:
            pipe.write(answer)
    finally:
        os._exit(0)


def _parts(descriptor: int) -> Iterator[bytes]:
    while part := os.read(descriptor, PIPE_SIZE):
        yield part


# --- one filter --------------------------------------------------------------------------------


class Applied(NamedTuple):
    """A filter after it was applied: its step, the layers it added, names and types it returned."""

    step: ET.Element
    layers: int
    returns: list[list[str]]


def apply(name: str, model: str, given: dict[str, Any]) -> Applied | None:
    """Apply a filter in a child process; None if that fails."""
    ms = model_set(model)

    def task() -> bytes:
        before = ms.mesh_number()
        returned = ms.apply_filter(name, **given)
        path = Path(f"{os.getpid()}.mlx")
        ms.save_filter_script(str(path))
        returns = [[key, type_of(value)] for key, value in sorted(returned.items())]
        facts = json.dumps([ms.mesh_number() - before, returns])
        return facts.encode() + b"\n" + path.read_bytes()

    facts, _, script = in_child(task).answer.partition(b"\n")
    return Applied(ET.fromstring(script)[0], *json.loads(facts)) if script else None


def type_of(value: object) -> str:
    """The type of what a filter returned, as an annotation."""
    if isinstance(value, np.ndarray):
        return f"NDArray[np.{value.dtype}]"
    return type(value).__name__


def params_of(step: ET.Element) -> list[list[Any]]:
    """Name, type and, of an enum, the choices of each parameter."""
    params = []
    for element in step:
        name, kind = element.attrib["name"], element.attrib["type"]
        choices = [
            element.attrib[f"enum_val{i}"] for i in range(int(element.get("enum_cardinality", 0)))
        ]
        params.append([name, kind, choices] if choices else [name, kind])
    return params


def flags_of(name: str, model: str, given: dict[str, Any]) -> dict[str, bool | None]:
    """The value of each parameter that is a flag, by keyword; None for the others."""
    ms = model_set(model)

    def task() -> bytes:
        values = ms.filter_parameter_values(name, **given)
        flags = {k: value if type(value) is bool else None for k, value in values.items()}
        return json.dumps(flags).encode()

    return json.loads(in_child(task).answer)


def variants(applied: Applied, name: str, model: str) -> Iterator[dict[str, Any]]:
    """What a filter can be given: every other value of each flag and each enum in turn."""
    given = GIVEN.get(name, {})
    flags = flags_of(name, model, given)
    yield from ({**given, k: not value} for k, value in flags.items() if value is not None)
    for keyword, (_, _, *choices) in zip(flags, params_of(applied.step), strict=True):
        yield from ({**given, keyword: i} for i in range(len(choices[0]) if choices else 0))


def required_of(applied: Applied, name: str, model: str) -> list[str]:
    """The keywords of the given texts without which the filter fails on every model."""
    required = []
    for keyword in (k for k, value in GIVEN.get(name, {}).items() if isinstance(value, str)):
        tries = [GIVEN[name], *variants(applied, name, model)]
        others = [{k: v for k, v in given.items() if k != keyword} for given in tries]
        if not any(apply(name, any_model, given) for any_model in MODELS for given in others):
            required.append(keyword)
    return required


def rarely_returned(name: str, usual: Applied) -> list[list[str]]:
    """Name and type of values that a filter returns of other models only."""
    if not usual.returns:
        return []
    others = filter(None, (apply(name, model, GIVEN.get(name, {})) for model in MODELS))
    types = {key: kind for other in others for key, kind in other.returns}
    usually = dict(usual.returns)
    return [[key, f"{RARE}[{kind}]"] for key, kind in sorted(types.items()) if key not in usually]


def needs_mesh(name: str) -> bool:
    """Whether the filter refuses an empty set, or crashes on it."""

    def task() -> bytes:
        try:
            MeshSet().filter_parameter_values(name)
            MeshSet().apply_filter(name)
        except pymeshlab.PyMeshLabException as error:
            return str(error).encode()
        return b"applied"

    answer = in_child(task).answer
    wanting = (b"requires at least one mesh", b"No mesh layer selected")
    return not answer or any(words in answer for words in wanting)


def record(name: str, old: dict[str, Any]) -> dict[str, Any]:
    """The entry of a filter, recorded on the first model that suits; else its old one."""
    models = dict.fromkeys([*filter(None, [old.get("model")]), *MODELS])
    given = GIVEN.get(name, {})
    for model in models if old.get("model") != "" else ():
        applied = apply(name, model, given)
        if applied is None:
            continue
        tries = (apply(name, model, variant) for variant in variants(applied, name, model))
        return {
            "name": applied.step.attrib["name"],
            "model": model,
            "needs_mesh": needs_mesh(name),
            "makes_layers": applied.layers > 0 or any(t and t.layers > 0 for t in tries),
            "required": required_of(applied, name, model),
            "params": params_of(applied.step),
            "returns": [*applied.returns, *rarely_returned(name, applied)],
        }
    return old


# --- names, without running the filter ---------------------------------------------------------


def names_are_known(meshlab_name: str, params: list[list[Any]]) -> bool:
    """Whether PyMeshLab has a filter of this MeshLab name with parameters of these names.

    It warns of every parameter of a script that the filter does not have, before it runs: the
    first warning must be that of the mark, which comes last.
    """
    ms = model_set("face_scalars")

    def task() -> bytes:
        path = Path(f"{os.getpid()}.mlx")
        steps = "".join(f"<Param name={quoteattr(p)} type='RichString' value=''/>" for p in names)
        path.write_text(
            f"<FilterScript><filter name={quoteattr(meshlab_name)}>{steps}</filter></FilterScript>"
        )
        ms.load_filter_script(str(path))
        ms.apply_filter_script()
        return b""

    names = [*(p[0] for p in params), MARK]
    noise = in_child(task, until=b" not required by filter").noise
    return noise.partition(b"Warning: parameter ")[2].startswith(MARK.encode())


# --- all of them -------------------------------------------------------------------------------


def one_line_each(filters: dict[str, Any]) -> str:
    """The file's text: a line for each filter."""
    lines = ",\n".join(
        f"{json.dumps(name)}: {json.dumps(entry)}" for name, entry in filters.items()
    )
    return f'{{"pymeshlab": {json.dumps(version("pymeshlab"))}, "filters": {{\n{lines}\n}}}}\n'


def write_anew() -> None:
    """Record all filters of the installed PyMeshLab anew."""
    old = json.loads(FILE.read_text())["filters"]
    filters = {}
    for name in pymeshlab.filter_list():
        filters[name] = record(name, old.get(name, {}))
        if not filters[name]:
            sys.exit(f"{name} can't be applied to any model: read it from MeshLab's sources")
    FILE.write_text(one_line_each(filters))


def differences(name: str, entry: dict[str, Any]) -> Iterator[str]:
    """In what an entry of the file differs from what one run of the filter shows."""
    applied = apply(name, entry["model"], GIVEN.get(name, {}))
    if applied is None:
        yield "model"
        return
    if applied.step.attrib["name"] != entry["name"]:
        yield "name"
    if params_of(applied.step) != entry["params"]:
        yield "params"
    if applied.returns != [one for one in entry["returns"] if not one[1].startswith(RARE)]:
        yield "returns"
    if applied.layers > 0 and not entry["makes_layers"]:
        yield "makes_layers"


def check(sample: list[str]) -> None:
    """Print in what the file differs from the installed PyMeshLab, a line for each difference.

    Names and the need of a mesh are checked of all, and what a run shows of the sample or of all.
    """
    filters = json.loads(FILE.read_text())["filters"]
    for name, entry in filters.items():
        if not names_are_known(entry["name"], entry["params"]):
            print(f"{name}: names")
        if entry["model"] and needs_mesh(name) != entry["needs_mesh"]:
            print(f"{name}: needs_mesh")
        if entry["model"] and (not sample or name in sample):
            for difference in differences(name, entry):
                print(f"{name}: {difference}")
    print(f"{len(filters)} checked")


def main(arguments: list[str]) -> None:
    """Record, or with ``--check`` only compare; names of filters after it are those to run."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if arguments[:1] == ["--check"]:
            check(arguments[1:])
        else:
            write_anew()


if __name__ == "__main__":
    main(sys.argv[1:])
