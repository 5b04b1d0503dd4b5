"""`run` on MeshLab's projects: layers with their labels, places and visibility, in and out."""

import json
import os
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore import batch
from meshlab_willmore.mesh_files.projects import save_project
from meshlab_willmore.mesh_files.saving import SaveOptions, save
from meshlab_willmore.messages import notes_taken_by

from .conftest import (
    FLIP,
    ONE_PIXEL,
    SAMPLES,
    call,
    cube_file,
    listing,
    loaded,
    same_mesh,
    script_file,
)

PLACE = np.array([[0, -1, 0, 0.1234567890123456], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1.0]])
TEXTURED = SAMPLES / "bunny10k_textured.obj"


def project_file(*layers, path="in.mlp"):
    """A project of (file, label, is visible, matrix) layers."""
    lines = ["<!DOCTYPE MeshLabDocument>", "<MeshLabProject>", " <MeshGroup>"]
    for file, label, visible, matrix in layers:
        lines.append(f'  <MLMesh label="{label}" filename="{file}" visible="{int(visible)}">')
        rows = "\n".join(" ".join(map(repr, row)) for row in np.asarray(matrix).tolist())
        lines += [f"   <MLMatrix44>\n{rows}\n</MLMatrix44>", "  </MLMesh>"]
    lines += [" </MeshGroup>", " <RasterGroup/>", "</MeshLabProject>"]
    Path(path).write_text("\n".join(lines), encoding="utf-8")
    return Path(path)


@pytest.fixture
def project():
    """A hidden layer in a folder that is moved, and another one."""
    Path("meshes").mkdir()
    cube_file("meshes/cube.ply")
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(SAMPLES / "bone.ply"))
    ms.save_current_mesh("bone.ply")
    return project_file(
        ("meshes/cube.ply", "a &quot;b&quot; &lt;ü&gt;", False, PLACE),
        ("bone.ply", "bone", True, np.eye(4)),
    )


def layers_of(path):
    """What PyMeshLab reads of a project."""
    ms = pymeshlab.MeshSet()
    ms.load_project(str(Path(path).absolute()))
    return [
        (
            mesh.label(),
            mesh.is_visible(),
            mesh.vertex_matrix().tobytes(),
            mesh.face_matrix().tobytes(),
            mesh.transform_matrix().astype(np.float32).tobytes(),
        )
        for mesh in ms
    ]


def test_meshes_of_the_project_that_is_read_change_by_force_only(project):
    call("run", "-p", project, "-w", "two.mlp")
    meshes = [Path("two_0.ply"), Path("two_1.ply")]
    before = [file.read_bytes() for file in meshes]
    arguments = ["run", script_file(FLIP), "-p", "two.mlp", "-w", "two.mlp"]
    assert "already exists" in call(*arguments).stderr
    assert [file.read_bytes() for file in meshes] == before
    assert call(*arguments, "--force").exit_code == 0
    assert [file.read_bytes() for file in meshes] != before


def test_layers_keep_mesh_label_place_and_visibility(project):
    before = listing()
    result = call("run", "-p", project, "-w", "out.mlp")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("in.mlp -> out.mlp (1886 vertices, 3046 faces): converted, ")
    assert listing() == sorted([*before, "out.mlp", "out_0.ply", "out_1.ply"])
    assert layers_of("out.mlp") == layers_of(project)
    assert [layer[:2] for layer in layers_of("out.mlp")] == [('a "b" <ü>', False), ("bone", True)]
    # Which PyMeshLab would round.
    assert "0.0 -1.0 0.0 0.1234567890123456\n" in Path("out.mlp").read_text(encoding="utf-8")


def test_steps_are_for_the_first_layer_and_others_stay(project):
    assert call("run", script_file(FLIP), "-p", project, "-w", "out.mlp").exit_code == 0
    call("flip", "meshes/cube.ply", "flipped.ply")
    assert same_mesh("out_0.ply", "flipped.ply")
    assert same_mesh("out_1.ply", "bone.ply")
    assert [layer[0] for layer in layers_of("out.mlp")] == ['a "b" <ü>', "bone"]


def test_inputs_are_further_layers_and_outputs_single_ones(project):
    cube_file("more.ply")
    result = call(
        "run", "-p", project, "-i", "more.ply", "-w", "out.mlp", "-o", "one.off", "-l", "1"
    )
    assert (result.exit_code, result.stderr) == (0, "")
    assert [layer[0] for layer in layers_of("out.mlp")][2] == "more.ply"
    assert same_mesh("out_2.ply", "more.ply")
    assert len(loaded("one.off").faces) == 3022
    call("run", "-i", "more.ply", "-w", "single.mlp")
    assert [layer[0] for layer in layers_of("single.mlp")] == ["more.ply"]


def test_masks_and_forms_are_for_all_layers(project):
    call("run", "-p", project, "-w", "out.mlp", "-m", "vn", "--ascii", "--single")
    for name in ("out_0.ply", "out_1.ply"):
        header = Path(name).read_bytes().partition(b"end_header")[0]
        assert b"format ascii" in header
        assert b"property float nx" in header


def test_layers_keep_their_textures_also_where_names_are_the_same():
    Path("one").mkdir()
    Path("two").mkdir()
    call("run", "-i", TEXTURED, "-o", "one/a.obj")
    call("run", "-i", TEXTURED, "-o", "two/a.obj")
    Path("two/TextureDouble_A.png").write_bytes(ONE_PIXEL)
    layers = [(f"{folder}/a.obj", folder, True, np.eye(4)) for folder in ("one", "two")]
    result = call("run", "-p", project_file(*layers), "-w", "out.mlp")
    assert (result.exit_code, result.stderr) == (0, "")
    assert listing() == ["TextureDouble_A.png", "in.mlp", "one", "out.mlp", "out_0.ply", "out_1",
                         "two"]  # fmt: skip
    assert listing("out_1") == ["TextureDouble_A.png", "out_1.ply"]
    assert Path("out_1/TextureDouble_A.png").read_bytes() == ONE_PIXEL
    texture = Path("one/TextureDouble_A.png").read_bytes()
    assert Path("TextureDouble_A.png").read_bytes() == texture
    assert layers_of("out.mlp") == layers_of("in.mlp")


def test_a_project_that_came_meanwhile_is_not_replaced():
    ms = pymeshlab.MeshSet()
    ms.create_cube()
    Path("out.mlp").write_text("another's")
    with pytest.raises(FileExistsError, match=r"cannot write out\.mlp: it already exists"):
        save_project(ms, Path("out.mlp"), SaveOptions())
    assert not Path("out_0.ply").exists()


@pytest.mark.parametrize("name", ["out.mlp", "out_1.ply", "out_1/out_1.ply"])
def test_no_file_is_replaced_without_force(project, name):
    before = listing()
    Path(name).parent.mkdir(exist_ok=True)
    Path(name).write_text("mine")
    result = call("run", "-p", project, "-w", "out.mlp")
    assert result.exit_code == 2
    assert f"{name} already exists; use --force to overwrite" in result.stderr
    assert Path(name).read_text() == "mine"
    # Nothing has run: there is no other layer either.
    assert listing() == sorted([*before, name.partition("/")[0]])
    assert call("run", "-p", project, "-w", "out.mlp", "--force").exit_code == 0
    assert layers_of("out.mlp") == layers_of(project)


@pytest.mark.parametrize("name", ["out_1.ply", "out_0/out_0.ply"])
def test_no_output_may_have_the_name_of_a_layer(project, name):
    Path("out_0").mkdir()
    before = listing()
    result = call("run", "-p", project, "-o", name, "-l", "0", "-w", "out.mlp")
    assert result.exit_code == 2
    assert result.stderr == f"Error: {name} may become a layer of out.mlp; use another name\n"
    assert listing() == before
    # These are no names of layers.
    others = ["-o", "out_01.ply", "-l", "0", "-o", "out_x.ply", "-l", "1", "-o", "out_1.off"]
    assert call("run", "-p", project, *others, "-l", "1", "-w", "out.mlp").exit_code == 0


def test_no_layer_replaces_another_input(project):
    cube_file("in_0.ply")
    result = call("run", "-i", project, "-i", "in_0.ply", "-w", "{name}.mlp", "--force")
    assert result.exit_code == 2
    assert result.stderr == "Error: the result of in.mlp would replace the input in_0.ply\n"


def test_an_error_leaves_no_layer(project, monkeypatch):
    def fail(ms, path, options):
        if path.name == "out_1.ply":
            raise OSError("cannot write out_1.ply: No space left on device")
        return save(ms, path, options)

    before = listing()
    monkeypatch.setattr("meshlab_willmore.mesh_files.projects.save", fail)
    result = call("run", "-p", project, "-w", "out.mlp")
    assert result.exit_code == 1
    assert listing() == before
    # What was there before stays.
    Path("out_0.ply").write_text("mine")
    assert call("run", "-p", project, "-w", "out.mlp", "--force").exit_code == 1
    assert listing() == sorted([*before, "out_0.ply"])


@pytest.mark.usefixtures("workers_here")
def test_projects_are_a_batch(project):
    project_file(("bone.ply", "b", True, np.eye(4)), path="other.mlp")
    project_file(("none.ply", "n", True, np.eye(4)), path="wrong.mlp")
    Path("out").mkdir()
    arguments = ("run", "-i", "*.mlp", "-w", "out/{name}.mlp", "--json", "log.jsonl")
    result = call(*arguments)
    assert result.exit_code == 1
    assert "Error: cannot read wrong.mlp: there is no file none.ply" in result.stderr
    assert layers_of("out/in.mlp") == layers_of(project)
    assert len(layers_of("out/other.mlp")) == 1
    # A batch sees that a mesh of a project has changed.
    call("run", "-i", SAMPLES / "bone.ply", "-o", "meshes/cube.ply", "--force")
    result = call(*arguments, "--resume", "--force")
    records = [json.loads(line) for line in Path("log.jsonl").read_text().splitlines()]
    done = [record["input"] for record in records if record.get("status") == "done"]
    assert sorted(done) == ["in.mlp", "in.mlp", "other.mlp"]
    assert len(loaded("out/in_0.ply").faces) == 3022
    # Nor does one that goes on replace a file from before it.
    assert call(*arguments, "--retry-failed").exit_code == 1
    Path("out/wrong_0.ply").write_text("mine")
    os.utime("out/wrong_0.ply", (0, 0))
    result = call(*arguments, "--retry-failed")
    assert result.exit_code == 2
    assert result.stderr.startswith("Error: out/wrong_0.ply already exists")


def test_python_function_takes_projects(project):
    (result,) = batch.run(lambda ms: ms.mesh_number(), project, "{name}_out.mlp")
    assert result.is_done
    assert [step.returned for step in result.returned] == [{"value": 2}]
    assert layers_of("in_out.mlp") == layers_of(project)


def test_dry_run_reads_and_writes_nothing(project):
    before = listing()
    result = call("run", "-p", project, "-w", "out.mlp", "--dry-run")
    assert result.stdout == "in.mlp: ok; 0 steps to run, then out.mlp to write\n"
    Path("bone.ply").write_text("no mesh")
    result = call("run", "-p", project, "-w", "out.mlp", "--dry-run")
    assert result.stderr == "Error: cannot read bone.ply: Header not found\n"
    assert listing() == before


def test_log_names_the_layers(project):
    call("run", "-p", project, "-w", "out.mlp", "--log", "log.txt")
    text = Path("log.txt").read_text()
    assert "input in.mlp (2 layers)\n" in text
    assert "output out.mlp out_0.ply out_1.ply (2 layers)\n" in text


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("no project", "it is no project, "),
        ("<MeshLabProject/>", "there is no mesh in it"),
        ('<P><MLMesh label="l"/></P>', "its layer 'l' has no file"),
        (
            '<P><MLMesh filename="f.ply"><MLMatrix44>1 0 0</MLMatrix44></MLMesh></P>',
            "the matrix of f.ply is not 16 numbers",
        ),
        ('<P><MLMesh filename="f.ply"/></P>', "there is no file f.ply"),
        ('<P><MLMesh filename="in.mlp"/></P>', "in.mlp is a project; "),
        (
            '<!DOCTYPE a [<!ENTITY b "c">]><P><MLMesh filename="&b;"/></P>',
            "it is no project, ",
        ),
    ],
)
def test_what_is_no_project(text, problem):
    Path("in.mlp").write_text(text)
    result = call("run", "-p", "in.mlp", "-w", "out.mlp")
    assert result.exit_code == 1
    assert result.stderr.startswith(f"Error: cannot read in.mlp: {problem}")
    assert result.stderr.count("\n") == 1
    assert listing() == ["in.mlp"]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["flip", "in.mlp", "a.ply"], "in.mlp is a project; it takes 'run' to read"),
        (["measure", "in.mlp"], "in.mlp is a project; it takes 'run' to read"),
        (["flip", "bone.ply", "a.mlp"], "a.mlp would be a project; only run writes projects"),
        (["run", "-i", "in.aln", "-o", "a.ply"], "in.aln is a project; only .mlp projects are"),
    ],
)
@pytest.mark.usefixtures("project")
def test_only_run_takes_projects(arguments, line):
    Path("in.aln").write_text("1")
    result = call(*arguments)
    assert result.exit_code in (1, 2)
    assert result.stderr.startswith(f"Error: {line}")


def test_images_of_a_project_are_a_noted_loss():
    Path("pixel.png").write_bytes(ONE_PIXEL)
    ms = pymeshlab.MeshSet()
    ms.create_cube()
    ms.load_new_raster("pixel.png")
    notes = []
    with notes_taken_by(notes.append):
        save_project(ms, Path("out.mlp"), SaveOptions())
    assert notes == ["out.mlp: the project's images (rasters) are not written: 1"]
    assert len(layers_of("out.mlp")) == 1
