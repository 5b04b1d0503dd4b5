"""What tests of filter scripts share."""

import subprocess
import sys

from meshlab_willmore.mlx.read import read
from tests import meshes
from tests.meshset.conftest import set_of


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
