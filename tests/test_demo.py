"""The demo's models, and its experiments on small ones."""

import sys

import numpy as np
import pymeshlab
import pytest
from scipy.spatial import Delaunay, cKDTree

from meshlab_willmore.demo import scan as scan_module
from meshlab_willmore.demo.experiments import CLOSEUP_VIEW, FLIPS, Sizes, run_demo
from meshlab_willmore.demo.models import (
    Surface,
    dented_cube,
    planar_delaunay,
    sampled_torus,
    signed_areas,
    surface_of,
)
from meshlab_willmore.demo.scan import (
    CLEANING,
    REACH_MM,
    ScanNotFoundError,
    scan_file,
    scanner_plane,
    stretched_triangulation,
)
from meshlab_willmore.measure import measures, triangle_shapes
from tests.meshes import torus as reference_torus

SMALL = Sizes(torus_points=200, keep_one_of=60)


def canonical(faces):
    """Faces as sorted tuples, each turned so that its smallest index comes first."""
    faces = np.asarray(faces)
    turns = (faces.argmin(axis=1)[:, None] + np.arange(3)) % 3
    return sorted(map(tuple, np.take_along_axis(faces, turns, axis=1).tolist()))


def assert_closed_and_oriented(faces):
    """Every edge is run through exactly once in each direction."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    assert len(np.unique(edges, axis=0)) == len(edges)
    assert sorted(map(tuple, edges.tolist())) == sorted(map(tuple, edges[:, ::-1].tolist()))


# Models


def test_cube_is_the_papers():
    vertices, faces = dented_cube(0.05)
    assert (vertices.shape, faces.shape, faces.dtype) == ((14, 3), (24, 3), np.int32)
    assert_closed_and_oriented(faces)
    valence = np.bincount(faces.ravel())
    assert valence[8:].tolist() == [3] * 6
    corners = {tuple(corner) for corner in vertices[:8].tolist()}
    assert corners == {(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)}
    centres = np.sort(vertices[8:], axis=1)
    assert {tuple(centre) for centre in centres.round(12).tolist()} == {
        (0.05, 0.5, 0.5),
        (0.5, 0.5, 0.95),
    }
    signed_volume = np.linalg.det(vertices[faces]).sum() / 6
    assert signed_volume == pytest.approx(1 - 6 * (0.5 * 0.05 / 3), rel=1e-12)
    totals = measures(vertices, faces)
    assert totals.willmore_energy == pytest.approx(45.7570, abs=5e-5)
    assert totals.area == pytest.approx(6.22709, abs=5e-6)


@pytest.mark.heavy
def test_torus_is_the_reference_torus():
    vertices, faces = sampled_torus(2000, 0.3, 8.0)
    expected_vertices, expected_faces = reference_torus(2000, 0.3, 8.0)
    np.testing.assert_allclose(vertices, expected_vertices, atol=1e-14)
    assert canonical(faces) == canonical(expected_faces)
    assert_closed_and_oriented(faces)
    totals = measures(vertices, faces)
    assert len(faces) == 3850
    assert totals.willmore_energy == pytest.approx(4010.3, abs=0.05)
    assert totals.area == pytest.approx(119.624, abs=5e-4)
    assert totals.absolute_mean_curvature == pytest.approx(640.5, abs=0.05)
    assert np.quantile(triangle_shapes(vertices, faces), 0.01) == pytest.approx(0.191, abs=5e-4)


@pytest.mark.parametrize("stretch", [1.0, 7.0])
@pytest.mark.parametrize("far", [0.0, 1e4])
def test_planar_delaunay_is_scipys(stretch, far):
    points = np.random.default_rng(3).random((300, 2)) + far
    faces = planar_delaunay(points, stretch)
    assert faces.dtype == np.int32
    assert (signed_areas(points, faces) > 0).all()
    moved = (points - points.mean(axis=0)) * (stretch, 1.0)
    expected = Delaunay(moved).simplices
    clockwise = signed_areas(moved, expected) < 0
    expected[clockwise] = expected[clockwise][:, ::-1]
    assert canonical(faces) == canonical(expected)


def test_planar_delaunay_of_a_kite():
    points = np.array([(0, 0), (2, -0.5), (4, 0), (2, 0.5)], dtype=float)
    assert canonical(planar_delaunay(points)) == [(0, 1, 3), (1, 2, 3)]
    # Squeezed eight times, the kite is tall and the other diagonal is the shorter one.
    assert canonical(planar_delaunay(points, 1 / 8)) == [(0, 1, 2), (0, 2, 3)]


# The scan


@pytest.fixture(scope="module")
def cleaned():
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(scan_file()))
    for name, given in CLEANING:
        meshes.apply_filter(name, **given)
    return surface_of(meshes)


def test_the_cleaned_scan_is_one_to_one_in_the_scanners_plane(cleaned):
    assert len(cleaned.faces) > 160_000
    assert (signed_areas(scanner_plane(cleaned.vertices), cleaned.faces) > 0).all()


@pytest.fixture(scope="module")
def face(cleaned):
    return stretched_triangulation(cleaned, stretch=3.0, keep_one_of=60)


def test_vertices_of_the_face_are_points_of_the_scan(cleaned, face):
    known = {point.tobytes() for point in cleaned.vertices}
    chosen = {point.tobytes() for point in face.vertices}
    assert chosen <= known
    assert len(chosen) == len(face.vertices)
    assert len(cleaned.vertices) / 60 < len(face.vertices) < 2 * len(cleaned.vertices) / 60


def test_face_has_no_folds_and_lies_on_the_scan(cleaned, face):
    plane = scanner_plane(face.vertices)
    areas = signed_areas(plane, face.faces)
    assert (areas > 0).all()
    scanned = signed_areas(scanner_plane(cleaned.vertices), cleaned.faces).sum()
    assert 0.9 * scanned < areas.sum() < 1.05 * scanned
    # A point of a triangle is no farther from the nearest corner than the longest side / sqrt 3.
    corners = cleaned.vertices[cleaned.faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()
    centroids = face.vertices[face.faces].mean(axis=1)
    to_vertex, _ = cKDTree(cleaned.vertices).query(centroids)
    assert to_vertex.max() < REACH_MM + longest / np.sqrt(3)
    assert np.median(to_vertex) < 0.5


def test_stretch_makes_vertical_edges(cleaned, face):
    even = stretched_triangulation(cleaned, stretch=1.0, keep_one_of=60)
    np.testing.assert_array_equal(even.vertices, face.vertices)
    assert upright(even) < 0.35
    assert upright(face) > 0.55


def test_face_is_the_same_every_time(cleaned, face):
    again = stretched_triangulation(cleaned, stretch=3.0, keep_one_of=60)
    np.testing.assert_array_equal(again.vertices, face.vertices)
    np.testing.assert_array_equal(again.faces, face.faces)


def upright(surface):
    """Share of the edges that rise more than twice as far as they go across."""
    a, b = surface.vertices[surface.faces], surface.vertices[surface.faces[:, [1, 2, 0]]]
    across, along = np.abs(b - a)[:, :, 0], np.abs(b - a)[:, :, 1]
    return (along > 2 * across).mean()


# The experiments


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
        ("scan", "as scanned"),
        ("scan", "cleaned"),
        ("scan", "Willmore flips"),
        ("scan", "Taubin smoothing"),
        ("face", "initial, cleaned"),
        ("face", "Willmore flips"),
        ("face", "Taubin smoothing"),
    ]
    for stage in result.stages:
        assert f"{stage.model}: {stage.name}" in lines
    assert all("\n" not in line and line.isascii() for line in lines)


@pytest.mark.heavy
def test_flips_lower_the_energy_and_keep_the_faces(demo):
    _, result, _ = demo
    for before, after in zip(result.stages, result.stages[1:], strict=False):
        if after.flips is not None:
            assert after.flips > 0
            assert after.model == before.model
            assert after.faces == before.faces
            assert after.willmore < 0.7 * before.willmore
            assert after.area < before.area
            assert after.mean_curvature < before.mean_curvature
            assert after.worst_shape >= before.worst_shape
            assert after.seconds >= 0


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
        *(f"{model}-{state}" for model in ("cube", "torus", "scan", "face")
          for state in ("before", "after")),
        "scan-smoothed",
        "face-smoothed",
    }  # fmt: skip
    rows = {(stage.model, stage.flips is not None): stage for stage in result.stages}
    for model in ("cube", "torus", "scan", "face"):
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
        "face.png",
        "face-closeup.png",
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
    window = CLOSEUP_VIEW.window
    x, y, _ = cleaned.vertices.T
    assert x.min() < window.left < window.right < x.max()
    assert y.min() < window.bottom < window.top < y.max()


@pytest.fixture
def no_scan(monkeypatch, tmp_path):
    monkeypatch.setattr(scan_module, "SCAN_IN_WHEEL", tmp_path / "nowhere" / "face000.ply")


def test_a_build_without_the_scan_is_named(no_scan):
    with pytest.raises(ScanNotFoundError, match=r"does not carry the face scan .*face000\.ply"):
        scan_file()


@pytest.mark.heavy
def test_the_demo_goes_on_without_the_scan(no_scan, tmp_path):
    lines = []
    result = run_demo(tmp_path, lines.append, SMALL)
    assert [stage.model for stage in result.stages] == ["cube", "cube", "torus", "torus"]
    assert lines[-1].startswith("no face: this build of PyMeshLab does not carry")


@pytest.mark.heavy
def test_without_matplotlib_there_are_meshes_and_the_table(no_scan, monkeypatch, tmp_path):
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    lines = []
    result = run_demo(tmp_path, lines.append, SMALL)
    assert 'pip install "meshlab-willmore[demo]"' in lines[0]
    assert len(result.stages) == 4
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "cube-after.ply",
        "cube-before.ply",
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
