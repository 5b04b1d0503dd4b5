"""The stubs are those of the installed PyMeshLab, and checkers and editors understand them."""

import ast
import json
import os
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pymeshlab
import pytest

from generate import pymeshlab_stubs
from meshlab_willmore import options
from meshlab_willmore.meshset import catalogue
from tests.extras import needs

ROOT = Path(__file__).parents[2]
FLIP = "meshing_edge_flip_by_willmore_optimization"

PYRIGHT = ("pyright", "--outputjson", "--pythonpath", sys.executable)

made_for_this = pytest.mark.skipif(
    catalogue.version() != catalogue.recorded_version(), reason="stubs of another PyMeshLab"
)

GOOD = """
    import numpy as np
    import pymeshlab

    import meshlab_willmore

    meshlab_willmore.register()
    ms = pymeshlab.MeshSet(verbose=False)
    ms.create_sphere(subdiv=3)
    flipped = ms.meshing_edge_flip_by_willmore_optimization(
        energy="mean curvature", virtualpoint=0.05, maxdeviation=pymeshlab.PercentageValue(0.1)
    )
    flips: int = flipped["flips"]
    energy: float = ms.apply_filter("get_willmore_measures")["willmore_energy"]
    percentile: float = ms.compute_scalar_by_discrete_curvature_per_vertex()["10_percentile"]
    box: pymeshlab.BoundingBox = ms.get_geometric_measures()["bbox"]
    ms.meshing_edge_flip_by_planar_optimization(planartype="delaunay", iterations=0)
    ms.meshing_edge_flip_by_planar_optimization(planartype=3)
    ms.compute_matrix_from_translation(traslmethod="XYZ translation", axisx=2)
    for name in pymeshlab.filter_list():
        returned = ms.apply_filter(name, anything=1)
        returned.get("a key")
    for mesh in ms:
        mesh.vertex_matrix().astype(np.float32)
    ms.add_mesh(pymeshlab.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), "triangle")
"""


def guide():
    """The code of the guide for editors."""
    text = (ROOT / "docs" / "guide" / "editors.md").read_text()
    return "\n".join(re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))


# Each line has one mistake, and a word that a checker must say of it.
BAD = """
    import pymeshlab
    ms = pymeshlab.MeshSet()
    ms.meshing_edge_flip_by_willmore_optimization(enrgy="willmore")  # enrgy
    ms.meshing_edge_flip_by_willmore_optimization(energy="wilmore")  # wilmore
    ms.meshing_edge_flip_by_willmore_optimization(virtualpoint="middle")  # middle
    ms.meshing_edge_flip_by_willmore_optimization(maxdeviation=0.1)  # PureValue
    ms.meshing_edge_flip_by_willmore_optimization()["flip"]  # "flip"
    ms.meshing_edge_flip_by_planar_optimization(planartype="delauny")  # delauny
    ms.meshing_isotropic_explicit_remeshing(targetlen=1.0)  # targetlen
    ms.meshing_remove_unreferenced_vertexes()  # unreferenced_vertexes
    ms.nxs_build()  # input_file
    ms.apply_filter("get_willmore_measures")["energy"]  # "energy"
    ms.current_mesh().vertices()  # vertices
"""


@pytest.fixture
def script(tmp_path):
    """Write a script of a user's, and run a checker of the environment on it."""

    def check(text, *command):
        (tmp_path / "script.py").write_text(textwrap.dedent(text))
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        return subprocess.run(
            [sys.executable, "-m", *command, "script.py"],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
        )

    return check


def mistakes(text):
    """The word that belongs to each line with a mistake, by the number of the line."""
    lines = textwrap.dedent(text).splitlines()
    return {n: line.split("  # ")[1] for n, line in enumerate(lines, 1) if "  # " in line}


def mypy_errors(run):
    """The errors of mypy in the script, by line."""
    found = {}
    for line in run.stdout.splitlines():
        name, _, rest = line.partition(":")
        number, _, message = rest.partition(": error: ")
        if name == "script.py" and message:
            found[int(number)] = found.get(int(number), "") + message
    return found


def pyright_errors(run):
    found = {}
    for error in json.loads(run.stdout)["generalDiagnostics"]:
        line = error["range"]["start"]["line"] + 1
        found[line] = found.get(line, "") + error["message"]
    return found


# --- the files ---------------------------------------------------------------------------------


@made_for_this
def test_the_files_are_what_is_generated():
    on_disk = {path.name: path.read_text() for path in pymeshlab_stubs.FOLDER.glob("*.pyi")}
    # In a process of its own: other tests change what PyMeshLab says of its functions.
    code = "import json; from generate import pymeshlab_stubs as s; print(json.dumps(s.texts()))"
    printed = subprocess.check_output([sys.executable, "-c", code], cwd=ROOT, text=True)
    assert on_disk == json.loads(printed), "run: python -m generate.pymeshlab_stubs"


@made_for_this
def test_all_filters_have_all_their_parameters():
    module = ast.parse((pymeshlab_stubs.FOLDER / "pmeshlab.pyi").read_text())
    (mesh_set,) = [node for node in module.body if getattr(node, "name", "") == "MeshSet"]
    methods = {node.name: node for node in mesh_set.body}
    for known in catalogue.everything():
        stub = [argument.arg for argument in methods[known.name].args.kwonlyargs]
        assert stub == [p.keyword for p in known.params if p.type != "RichShotf"], known.name
    assert set(pymeshlab.filter_list()) <= methods.keys()


def test_stubs_of_another_version_are_not_written(monkeypatch):
    monkeypatch.setattr(catalogue, "version", lambda: "2099.1")
    monkeypatch.setattr(pymeshlab_stubs, "FOLDER", None)
    with pytest.raises(SystemExit, match=r"PyMeshLab is 2099\.1.*record it anew"):
        pymeshlab_stubs.main()


# --- checkers ----------------------------------------------------------------------------------


@pytest.mark.slow
@needs("mypy", "types")
def test_mypy_accepts_what_is_right(script):
    run = script(GOOD, "mypy", "--strict", "--follow-imports=silent")
    assert (run.stdout, run.returncode) == ("Success: no issues found in 1 source file\n", 0)


@pytest.mark.slow
@needs("mypy", "types")
def test_mypy_finds_each_mistake(script):
    found, expected = mypy_errors(script(BAD, "mypy")), mistakes(BAD)
    assert found.keys() == expected.keys()
    assert {n: word for n, word in expected.items() if word in found[n]} == expected


@pytest.mark.slow
@needs("pyright", "types")
@pytest.mark.parametrize("text", [GOOD, guide()], ids=["script", "guide"])
def test_pyright_accepts_what_is_right(script, text):
    run = script(text, *PYRIGHT)
    assert pyright_errors(run) == {}
    assert json.loads(run.stdout)["summary"]["filesAnalyzed"] == 1


@pytest.mark.slow
@needs("pyright", "types")
def test_pyright_finds_each_mistake(script):
    found, expected = pyright_errors(script(BAD, *PYRIGHT)), mistakes(BAD)
    assert found.keys() == expected.keys()
    assert {n: word for n, word in expected.items() if word in found[n]} == expected


@made_for_this
@pytest.mark.slow
@needs("mypy", "types")
def test_the_stubs_say_what_pymeshlab_has(tmp_path):
    allowed = tmp_path / "allowed.txt"
    # Its classes have pybind11's metaclass, a set can't be printed, an image can't be made, and
    # what it imports for itself is nobody else's business. Ours are methods once registered.
    allowed.write_text(
        r"""
        pymeshlab\.pmeshlab\.\w+
        pymeshlab\.pmeshlab\.Image\.__init__
        pymeshlab\.pmeshlab\.MeshSet\.(__str__|\w+_willmore_\w+)
        pymeshlab\.(os|pathlib|platform|filter_name)
        pymeshlab\.tests.*
        """.replace("        ", "")
    )
    run = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "--concise", "pymeshlab", "--allowlist", allowed]
        + ["--ignore-unused-allowlist"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
    )
    assert (run.stdout, run.returncode) == ("", 0)


# --- editors -----------------------------------------------------------------------------------


@needs("jedi", "types")
def test_jedi_completes_parameters_and_choices():
    import jedi

    project = jedi.Project(ROOT / "nowhere", added_sys_path=[str(ROOT)])
    text = f"import pymeshlab\nms = pymeshlab.MeshSet()\nms.{FLIP}("
    script = jedi.Script(text, project=project)
    assert {f"{option.name}=" for option in options.OPTIONS} <= {c.name for c in script.complete()}
    (signature,) = script.get_signatures()
    shown = signature.to_string()
    for option in options.OPTIONS:
        assert all(f'"{choice}"' in shown for choice in option.choices), option.name
    assert signature.docstring(raw=True).startswith("Mesh optimization by edge flipping")
