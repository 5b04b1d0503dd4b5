"""The recipe for a new energy, followed word for word in a copy of the package."""

import os
import shlex
import shutil
import subprocess
import sys

import pymeshlab
import pytest

from .pages import DOCS, NOT_RUN, ROOT, blocks

pytestmark = pytest.mark.slow
USE = """
import numpy as np
from meshlab_willmore import optimize_flips
from meshlab_willmore.demo.models import sampled_torus

vertices, faces = sampled_torus(40)


def total(faces):
    corners = vertices[faces]
    return 0.5 * ((corners - np.roll(corners, 1, axis=1)) ** 2).sum()


for search in ("greedy", "variable depth"):
    result = optimize_flips(vertices, faces, energy="squared length", search=search, depth=2)
    assert result.flips > 0 and result.converged
    assert np.isclose(total(faces) - total(result.faces), result.gain, rtol=1e-9), result
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """A folder with a copy of the package that has the energy of the recipe."""
    module, row, _ = recipe()
    folder = tmp_path_factory.mktemp("copy")
    copy = folder / "meshlab_willmore"
    ignored = shutil.ignore_patterns("__pycache__")
    for name in ("meshlab_willmore", "pymeshlab-stubs", "generate", "tests"):
        shutil.copytree(ROOT / name, folder / name, ignore=ignored)
    shutil.copy(ROOT / "pyproject.toml", folder)
    (copy / "energy" / "squared_length.py").write_text(module.text, encoding="utf-8")
    table = copy / "energy" / "table.py"
    before, end, after = table.read_text(encoding="utf-8").partition("\n}\n")
    assert end
    table.write_text(f"{before}\n{row.text}}}\n{after}", encoding="utf-8")
    options = copy / "options.py"
    before, begin, after = options.read_text(encoding="utf-8").partition("EnergyName = Literal[\n")
    # The names are in the order of the table.
    names, end, after = after.partition("]\n")
    assert end
    text = f'{before}{begin}{names}    "squared length",\n{end}{after}'
    options.write_text(text, encoding="utf-8")
    return folder


def recipe():
    """The blocks of the recipe: the module, the row, and how to try it."""
    found = [block for block in blocks(DOCS / "contributing.md") if "squared" in block.text]
    assert all(block.note.startswith(NOT_RUN) for block in found)
    return found


def run(folder, *arguments):
    environment = {**os.environ, "PYTHONPATH": str(folder), "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(
        [sys.executable, *arguments], cwd=folder, env=environment, text=True, capture_output=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_energy_of_the_recipe_falls_by_its_gain(package):
    run(package, "-c", USE)


def test_the_tests_of_the_recipe_pass(package):
    run(package, "-m", "generate.pymeshlab_stubs")
    (line,) = (line for line in recipe()[2].text.splitlines() if "pytest" in line)
    # The tests of the other energies have nothing to do with it, and take long.
    options = "tests/test_options.py"
    assert options in line
    run(package, "-m", "pytest", "-q", "-n0", options)
    assert "squared length" in (package / "pymeshlab-stubs" / "pmeshlab.pyi").read_text()


def test_the_line_of_the_recipe_runs(package):
    meshes = pymeshlab.MeshSet()
    meshes.create_torus(hsubdiv=8, vsubdiv=8)
    meshes.save_current_mesh(str(package / "torus.ply"))
    (line,) = (line for line in recipe()[2].text.splitlines() if " flip " in line)
    command = line.replace("willmore-demo/torus-before.ply", "torus.ply").split(" ", 1)[1]
    assert " flips, " in run(package, "-m", "meshlab_willmore", *shlex.split(command))
