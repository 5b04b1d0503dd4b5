"""What tests of filter scripts percentage."""

import subprocess
import sys

from meshlab_willmore.mlx.read import read, read_bytes
from tests import meshes
from tests.meshset.conftest import set_of

FLIP_NAME = "Willmore flipping optimization"
REMESH = "Remeshing: Isotropic Explicit Remeshing"
HAUSDORFF = "Hausdorff Distance"
MATRIX = "Matrix: Set/Copy Transformation"
TAUBIN = "Taubin Smooth"


def sphere():
    return set_of(*meshes.bumpy_sphere(150))


def state(ms):
    """All meshes of a set, to the last bit."""
    return [
        (
            mesh.vertex_matrix().tobytes(),
            mesh.face_matrix().tobytes(),
            mesh.transform_matrix().tobytes(),
            mesh.face_selection_array().tobytes(),
            mesh.vertex_scalar_array().tobytes() if mesh.has_vertex_scalar() else b"",
        )
        for mesh in ms
    ]


def names(path):
    return [step.filter for step in read(path)]


def printed(ms, capfd):
    capfd.readouterr()
    ms.print_filter_script()
    return capfd.readouterr().out


def natively(code, *args):
    run = subprocess.run(
        [sys.executable, "-c", code, *map(str, args)], capture_output=True, text=True, check=True
    )
    return run.stdout, run.stderr


def step(name, *params):
    return f"<filter name='{name}'>{''.join(params)}</filter>"


def old_step(name, **values):
    params = "".join(f"<xmlparam name='{k}' value='{v}'/>" for k, v in values.items())
    return f"<xmlfilter name='{name}'>{params}</xmlfilter>"


def param(name, kind, **attributes):
    text = " ".join(f"{key}='{value}'" for key, value in attributes.items())
    return f"<Param name='{name}' type='{kind}' {text}/>"


def energy(index, *choices):
    named = {f"enum_val{i}": choice for i, choice in enumerate(choices)}
    return param("energy", "RichEnum", value=index, enum_cardinality=9, **named)


def percentage(name, value):
    return param(name, "RichAbsPerc", value=value, min=0, max=100)


def steps_of(*steps):
    return read_bytes(f"<FilterScript>{''.join(steps)}</FilterScript>".encode(), "s.mlx")
