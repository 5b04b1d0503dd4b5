"""`run` without a script: meshes in other formats, as text, and in single precision."""

import json
import re
from pathlib import Path

import numpy as np
import pymeshlab
import pytest

from .conftest import SAMPLES, call, cube_file, listing, loaded, same_mesh

TEXTURED = SAMPLES / "bunny10k_textured.obj"


def properties(path):
    """The properties of a PLY file, by element."""
    header = Path(path).read_bytes().partition(b"end_header")[0].decode()
    found = {}
    for line in header.splitlines():
        words = line.split()
        if words[0] == "element":
            element = found.setdefault(words[1], [])
        elif words[0] == "property":
            element.append(" ".join(words[1:]))
    return found


@pytest.mark.parametrize("ending", ["obj", "off", "stl", "ply", "3ds"])
def test_the_ending_determines_the_format(cube, ending):
    result = call("run", "-i", cube, "-o", f"out.{ending}")
    assert (result.exit_code, result.stderr) == (0, "")
    assert re.fullmatch(
        rf"cube\.ply -> out\.{ending} \(14 vertices, 24 faces\): converted, \d+\.\d s\n",
        result.stdout,
    )
    assert len(loaded(f"out.{ending}").faces) == 24
    assert listing() == ["cube.ply", f"out.{ending}"]


def test_losses_are_noted_and_textures_are_copied():
    result = call("run", "-i", TEXTURED, "-o", "a.ply", "-o", "b.stl", "--layers")
    assert result.exit_code == 1
    assert "2 outputs" in result.stderr
    assert call("run", "-i", TEXTURED, "-o", "a.ply").exit_code == 0
    assert listing() == ["TextureDouble_A.png", "a.ply"]
    result = call("run", "-i", "a.ply", "-o", "b.stl")
    assert result.stderr == "Note: b.stl: .stl files hold no wedge texture coordinates\n"


def test_nothing_is_overwritten_without_force(cube):
    Path("out.off").write_text("mine")
    result = call("run", "-i", cube, "-o", "out.off")
    assert (result.exit_code, Path("out.off").read_text()) == (2, "mine")
    assert call("run", "-i", cube, "-o", "out.off", "--force").exit_code == 0
    assert len(loaded("out.off").faces) == 24


@pytest.mark.slow
def test_several_inputs_are_a_batch_with_records_and_a_log(cube):
    cube_file("other.ply")
    Path("bad.ply").write_text("no mesh")
    result = call(
        "run", "-i", "*.ply", "-o", "{name}.off", "--json", "log.jsonl", "--log", "log.txt"
    )
    assert result.exit_code == 1
    assert len(re.findall(r"^\w+\.ply -> \w+\.off \(.*\): converted, ", result.stdout, re.M)) == 2
    assert "cannot read bad.ply" in result.stderr
    assert same_mesh("other.off", "other.ply")
    records = [json.loads(line) for line in Path("log.jsonl").read_text().splitlines()]
    assert {r["input"]: r["status"] for r in records if "input" in r} == {
        "cube.ply": "done",
        "other.ply": "done",
        "bad.ply": "bad file",
    }
    assert " run conversion\n" in Path("log.txt").read_text()


def test_dry_run_writes_nothing(cube):
    result = call("run", "-i", cube, "-o", "out.off", "--dry-run")
    assert result.stdout == "cube.ply: ok; 0 steps to run, then out.off to write\n"
    assert listing() == ["cube.ply"]


# --- text and single precision -------------------------------------------------------------------


@pytest.mark.parametrize("command", ["run", "flip"])
@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("text", [False, True])
def test_ply_as_text_and_in_single_precision(command, single, text):
    path = SAMPLES / "bone.ply"
    options = [*(["--single"] if single else []), *(["--ascii"] if text else [])]
    if command == "run":
        result = call("run", "-i", path, "-o", "out.ply", *options)
    else:
        result = call("flip", path, "out.ply", "--maxflips", "0", *options)
    assert (result.exit_code, result.stderr) == (0, "")
    kind = "float" if single else "double"
    assert properties("out.ply")["vertex"][:3] == [f"{kind} x", f"{kind} y", f"{kind} z"]
    assert (b"format ascii 1.0" in Path("out.ply").read_bytes()) == text
    given, got = loaded(path), loaded("out.ply")
    assert np.array_equal(given.faces, got.faces)
    if single:
        assert np.array_equal(given.vertices.astype(np.float32), got.vertices.astype(np.float32))
    elif not text:
        assert np.array_equal(given.vertices, got.vertices)
    assert listing() == ["out.ply"]


def test_single_precision_far_from_the_origin_is_a_noted_loss(cube):
    ms = pymeshlab.MeshSet()
    ms.add_mesh(pymeshlab.Mesh(loaded(cube).vertices + 3e7, loaded(cube).faces))
    ms.save_current_mesh("far.ply")
    result = call("run", "-i", "far.ply", "-o", "near.ply", "--single")
    assert result.stderr.startswith("Note: near.ply: so far from the origin, .ply files")


def test_what_has_no_text_or_single_precision_is_noted(cube):
    result = call("run", "-i", cube, "-o", "out.3ds", "--ascii", "--single")
    assert result.exit_code == 0
    assert result.stderr == (
        "Note: .3ds files are binary in any case\n"
        "Note: only PLY files can be in single precision, no .3ds files\n"
    )
    assert call("run", "-i", cube, "-o", "out.obj", "--ascii").stderr == ""
    assert call("run", "-i", cube, "-o", "out.stl", "--ascii").stderr == ""
    assert Path("out.stl").read_bytes().startswith(b"solid ")


def test_a_mask_keeps_its_parts_beside_text(cube):
    call("run", "-i", cube, "-o", "out.ply", "-m", "vn", "--ascii", "--single")
    assert properties("out.ply")["vertex"] == [
        f"float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")
    ]


@pytest.mark.usefixtures("workers_here")
def test_another_precision_is_another_batch(cube):
    log = ("--json", "log.jsonl", "--resume")
    assert call("run", "-i", cube, "-o", "{name}.off.ply", *log).exit_code == 0
    result = call("run", "-i", cube, "-o", "{name}.off.ply", "--single", *log)
    assert "already exists" in result.stderr


def test_full_disk_is_named(monkeypatch, cube):
    def fail(path):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("meshlab_willmore.mesh_files.single.to_single", fail)
    result = call("run", "-i", cube, "-o", "out.ply", "--single")
    assert result.exit_code == 1
    assert result.stderr == "Error: cannot write out.ply: No space left on device\n"
    assert listing() == ["cube.ply"]
