"""The experiments of the demo on small models."""

import sys

import numpy as np
import pymeshlab
import pytest

from meshlab_willmore.demo.experiments import CLOSEUP_CAMERA, FLIPS, Sizes, run_demo
from meshlab_willmore.demo.models import (
    Surface,
    dented_cube,
    scrambled,
    surface_of,
    technical_part,
)
from meshlab_willmore.measure import measures, triangle_shapes
from tests.fuzz import promise

from .conftest import canonical, upright

SMALL = Sizes(torus_points=200, part_edge_percent=6.0, keep_one_of=60)


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    pytest.importorskip("matplotlib")
    folder = tmp_path_factory.mktemp("demo") / "new"
    lines = []
    return folder, run_demo(folder, lines.append, SMALL), lines


def assert_row_is_of(stage, surface):
    totals = measures(*surface)
    assert stage.faces == len(surface.faces)
    assert stage.willmore == pytest.approx(totals.willmore_energy, rel=1e-9)
    assert stage.area == pytest.approx(totals.area, rel=1e-12)
    assert stage.mean_curvature == pytest.approx(totals.absolute_mean_curvature, rel=1e-9)
    assert stage.worst_shape == pytest.approx(np.quantile(triangle_shapes(*surface), 0.01))


def loaded(path):
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    return surface_of(meshes)


@pytest.mark.heavy
@pytest.mark.slow
def test_the_demo_has_its_stages(demo):
    _, result, lines = demo
    assert [(stage.model, stage.name) for stage in result.stages] == [
        ("cube", "initial"),
        ("cube", "Willmore flips"),
        ("torus", "initial"),
        ("torus", "Willmore flips"),
        ("part", "scrambled"),
        ("part", "Willmore flips"),
        ("part", "faithful"),
        ("scan", "as scanned"),
        ("scan", "cleaned"),
        ("scan", "Willmore flips"),
        ("scan", "Taubin smoothing"),
        ("face", "initial, cleaned"),
        ("face", "Willmore flips"),
        ("face", "Taubin smoothing"),
        ("face", "faithful"),
    ]
    for stage in result.stages:
        assert f"{stage.model}: {stage.name}" in lines
    assert all("\n" not in line and line.isascii() for line in lines)


@pytest.mark.heavy
def test_flips_lower_the_energy_and_keep_the_faces(demo):
    _, result, _ = demo
    for before, after in zip(result.stages, result.stages[1:], strict=False):
        if after.flips is not None and not after.preset:
            assert after.flips > 0
            assert after.model == before.model
            assert after.faces == before.faces
            assert after.willmore < 0.7 * before.willmore
            assert after.area < before.area
            assert after.mean_curvature < before.mean_curvature
            assert after.worst_shape >= before.worst_shape
            assert after.seconds >= 0


@pytest.mark.heavy
def test_the_faithful_preset_leaves_the_least_mean_curvature(demo):
    _, result, _ = demo
    rows = {(stage.model, stage.name): stage for stage in result.stages}
    for model, initial in (("part", "scrambled"), ("face", "initial, cleaned")):
        found = [rows[model, name] for name in (initial, "Willmore flips", "faithful")]
        assert found[0].mean_curvature > found[1].mean_curvature > found[2].mean_curvature
        assert found[2].preset == "faithful"
        assert len({stage.faces for stage in found}) == 1


@pytest.mark.heavy
def test_the_part_is_closed_and_scrambled_by_legal_flips_only():
    part = technical_part(6.0)
    assert measures(*part).gaussian_curvature == pytest.approx(0.0, abs=1e-9)
    other = scrambled(part)
    promise.check_connectivity(part.faces, other.faces)
    new = promise.edges(promise.half_edges(other.faces)) - promise.edges(
        promise.half_edges(part.faces)
    )
    assert 0.15 < len(new) / (1.5 * len(part.faces)) <= 0.3
    assert scrambled(part).faces.tobytes() == other.faces.tobytes()
    assert scrambled(part, seed=1).faces.tobytes() != other.faces.tobytes()


@pytest.mark.heavy
def test_cubes_rows_are_exact(demo):
    _, result, _ = demo
    before, after = result.stages[:2]
    assert (before.faces, before.flips, before.seconds) == (24, None, None)
    assert before.willmore == pytest.approx(45.7570, abs=5e-5)
    assert (after.faces, after.flips) == (24, 6)
    assert after.willmore == pytest.approx(29.9173, abs=5e-5)
    assert after.area == pytest.approx(6.02993, abs=5e-6)


@pytest.mark.heavy
@pytest.mark.slow
def test_meshes_are_written_and_only_edges_differ(demo):
    folder, result, _ = demo
    assert sorted(folder.iterdir()) == sorted(result.files)
    names = {path.stem for path in result.files if path.suffix == ".ply"}
    assert names == {
        *(f"{model}-{state}" for model in ("cube", "torus", "part", "scan", "face")
          for state in ("before", "after")),
        "part-faithful",
        "face-faithful",
        "scan-smoothed",
        "face-smoothed",
    }  # fmt: skip
    rows = {
        (stage.model, stage.flips is not None): stage for stage in result.stages if not stage.preset
    }
    for model in ("cube", "torus", "part", "scan", "face"):
        path = folder / f"{model}-before.ply"
        assert path.read_bytes().startswith(b"ply\nformat binary_little_endian")
        before, after = loaded(path), loaded(folder / f"{model}-after.ply")
        assert before.vertices.tobytes() == after.vertices.tobytes()
        assert canonical(before.faces) != canonical(after.faces)
        assert_row_is_of(rows[model, True], after)
    cube = loaded(folder / "cube-after.ply")
    assert np.bincount(cube.faces.ravel())[8:].tolist() == [4] * 6
    initial, flipped = (loaded(folder / f"face-{state}.ply") for state in ("before", "after"))
    assert upright(initial) > 0.55 > upright(flipped)
    smoothed = loaded(folder / "face-smoothed.ply")
    np.testing.assert_array_equal(smoothed.faces, loaded(folder / "face-after.ply").faces)


@pytest.mark.heavy
@pytest.mark.slow
def test_pictures_are_written_and_not_blank(demo):
    image = pytest.importorskip("matplotlib.image")
    from meshlab_willmore.report.pictures import CAPTION_HEIGHT, PANEL_WIDTH, PIXELS_PER_INCH

    folder, result, _ = demo
    paths = [path for path in result.files if path.suffix == ".png"]
    assert [path.name for path in paths] == [
        "cube.png",
        "torus.png",
        "part.png",
        "face.png",
        "face-closeup.png",
        "face-presets.png",
    ]
    for path in paths:
        page = image.imread(folder / path)[:, :, :3]
        assert min(page.shape[:2]) > 800
        # Without the captions, which differ anyway.
        width, caption = (round(PIXELS_PER_INCH * x) for x in (PANEL_WIDTH, CAPTION_HEIGHT))
        before, after = page[caption:, :width], page[caption:, -width:]
        for half in (before, after):
            assert 0.1 < (half.min(axis=2) < 0.9).mean() < 0.9
        for upper_or_lower in np.array_split(np.abs(before - after), 2):
            assert upper_or_lower.mean() > 0.002


def test_closeup_lies_within_the_face(cleaned):
    window = CLOSEUP_CAMERA.window
    x, y, _ = cleaned.vertices.T
    assert x.min() < window.left < window.right < x.max()
    assert y.min() < window.bottom < window.top < y.max()


@pytest.mark.heavy
@pytest.mark.slow
def test_the_demo_goes_on_without_the_scan(no_scan, tmp_path):
    lines = []
    result = run_demo(tmp_path, lines.append, SMALL)
    models = [stage.model for stage in result.stages]
    assert models == ["cube", "cube", "torus", "torus", "part", "part", "part"]
    assert lines[-1].startswith("no face: this build of PyMeshLab does not carry")


@pytest.mark.heavy
def test_without_matplotlib_there_are_meshes_and_the_table(no_scan, monkeypatch, tmp_path):
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    lines = []
    result = run_demo(tmp_path, lines.append, SMALL)
    assert 'pip install "meshlab-willmore[demo]"' in lines[0]
    assert len(result.stages) == 7
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "cube-after.ply",
        "cube-before.ply",
        "part-after.ply",
        "part-before.ply",
        "part-faithful.ply",
        "torus-after.ply",
        "torus-before.ply",
    ]


def test_nothing_is_computed_for_a_folder_that_cannot_be_written(monkeypatch, tmp_path):
    monkeypatch.setattr("meshlab_willmore.demo.experiments.FLIPS", None)
    taken = tmp_path / "taken"
    taken.touch()
    with pytest.raises(OSError, match="it is a file"):
        run_demo(taken, pytest.fail, SMALL)


def test_the_flips_are_a_filter_of_the_mesh_set():
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(*dented_cube()))
    ((name, given),) = FLIPS
    assert meshes.apply_filter(name, **given)["flips"] == 6
    flipped = surface_of(meshes)
    assert isinstance(flipped, Surface)
    assert np.bincount(flipped.faces.ravel())[8:].tolist() == [4] * 6
