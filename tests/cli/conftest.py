"""Shared by the tests of commands: a way to call them, meshes in files, scripts."""

import io
import os
import re
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pymeshlab
import pytest
from click.testing import CliRunner

from meshlab_willmore.cli import main
from tests import meshes
from tests.workers import workers_here  # noqa: F401

_PROGRESS = re.compile(r"^.*, \d+ s so far\n", re.MULTILINE)
SAMPLES = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture(autouse=True)
def _small_pictures(monkeypatch):
    """Of report pages that this process writes: they take most of the time for a page."""
    monkeypatch.setattr("meshlab_willmore.report.document.POSTER", (64, 48))


@pytest.fixture(autouse=True)
def _quick_machine(monkeypatch):
    """No line on how far a command is, however slow the machine, in what a test compares."""
    monkeypatch.setattr("meshlab_willmore.cli.progress.SECONDS_IN_A_LOG", 3600.0)


def call(*arguments, **given):
    """Run a command in this process."""
    return CliRunner().invoke(main, [str(argument) for argument in arguments], **given)


def spawn(*arguments, **given):
    """Run a command in a process of its own; see `finished`."""
    return finished([sys.executable, "-m", "meshlab_willmore", *map(str, arguments)], **given)


def finished(program, **given):
    """Run a program to its end; leave out the lines of progress that a slow machine gets."""
    done = subprocess.run(program, capture_output=True, text=True, check=False, **given)
    done.stderr = _PROGRESS.sub("", done.stderr)
    return done


# A PNG of one pixel.
ONE_PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108000000003a7e9b55"
    "0000000a49444154789c63f80f0001010100b138f6140000000049454e44ae426082"
)

SQUARE_OBJ = """mtllib square.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl A
f 1/1 2/2 3/3
usemtl B
f 1/1 3/3 4/4
"""


def square_with_textures(folder, *names):
    """A square whose triangles have the textures of these names, which are not made."""
    Path(folder).mkdir(exist_ok=True)
    materials = zip("AB", names, strict=False)
    lines = [f"newmtl {letter}\nmap_Kd {name}\n" for letter, name in materials]
    (Path(folder) / "square.mtl").write_text("".join(lines))
    path = Path(folder) / "square.obj"
    path.write_text(SQUARE_OBJ if len(names) > 1 else SQUARE_OBJ.replace("usemtl B\n", ""))
    return path


@contextmanager
def piped(data):
    """The name of a pipe with `data` in it, as a shell's ``<(...)`` gives it."""
    end, start = os.pipe()
    os.write(start, data)
    os.close(start)
    yield f"/dev/fd/{end}"
    os.close(end)


class Terminal(io.StringIO):
    """A standard error that is a terminal."""

    def isatty(self):
        return True


def cube_file(path="cube.ply"):
    """A cube with six flips to make, as a file."""
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(*meshes.cube()))
    ms.save_current_mesh(str(path))
    return Path(path)


def script_file(*steps, path="script.mlx"):
    """A script of (filter, {parameter: (type, value)}) steps."""
    lines = ["<!DOCTYPE FilterScript>", "<FilterScript>"]
    for name, params in steps:
        lines.append(f' <filter name="{name}">')
        lines += [f'  <Param name="{p}" type="{t}" value="{v}"/>' for p, (t, v) in params.items()]
        lines.append(" </filter>")
    Path(path).write_text("\n".join([*lines, "</FilterScript>"]))
    return Path(path)


# Names of filters and parameters that have changed since.
HISTORIC = """<!DOCTYPE FilterScript>
<FilterScript>
 <filter name="Surface Reconstruction: Poisson">
  <Param type="RichInt" name="OctDepth" value="7"/>
  <Param type="RichFloat" name="SamplesPerNode" value="1"/>
  <Param type="RichFloat" name="Offset" value="2"/>
 </filter>
 <filter name="Change the current layer">
  <Param type="RichMesh" name="mesh" value="1"/>
 </filter>
 <filter name="Transform: Rotate">
  <Param name="ToAll" value="true"/>
 </filter>
</FilterScript>
"""

FLIP = ("Willmore flipping optimization", {})
TAUBIN = ("Taubin Smooth", {"stepSmoothNum": ("RichInt", 2)})


class Surface(NamedTuple):
    """Arrays: a Mesh would outlive its set."""

    vertices: np.ndarray
    faces: np.ndarray


def loaded(path):
    """The only mesh of a file."""
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(path))
    mesh = ms.current_mesh()
    return Surface(mesh.vertex_matrix(), mesh.face_matrix())


def same_mesh(left, right):
    """Whether two files hold the same positions and faces, bit for bit."""
    return all(map(np.array_equal, loaded(left), loaded(right)))


def listing(folder="."):
    """All that is in a folder, hidden files too."""
    return sorted(os.listdir(folder))


@pytest.fixture
def cube():
    return cube_file()


@pytest.fixture
def script():
    return script_file(FLIP, TAUBIN)
