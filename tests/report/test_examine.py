"""What is measured of a mesh, its worst places, and its simplified picture."""

import numpy as np
import pytest

from meshlab_willmore import optimize_flips
from meshlab_willmore.report.decimate import cell_size, decimated
from meshlab_willmore.report.examine import examined
from meshlab_willmore.report.places import groups
from meshlab_willmore.report.rows import DASH, MINUS, Row, change, normal_change, rows, written
from tests import meshes


def test_octahedron_is_measured():
    found = examined(*meshes.octahedron())
    np.testing.assert_allclose(found.dihedral, np.degrees(np.arccos(1 / 3)))
    np.testing.assert_allclose(found.angles, 60.0)
    np.testing.assert_allclose(found.shapes, 1.0)
    np.testing.assert_array_equal(found.valences, 4)
    np.testing.assert_allclose(found.normals, found.vertices)
    assert found.cuts == 0
    assert examined(*meshes.cube(push=0.0)).cuts > 0


def test_boundary_has_no_dihedral_angle():
    found = examined(*meshes.grid(2, 2))
    assert np.isnan(found.dihedral).any()
    np.testing.assert_allclose(np.nanmax(found.dihedral), 0.0, atol=1e-9)


@pytest.mark.parametrize("scale", [1e-200, 1e200])
def test_scale_does_not_matter(scale):
    vertices, faces = meshes.bumpy_sphere(60)
    one, other = examined(vertices, faces), examined(vertices * scale, faces)
    for name in ("energy", "normals", "dihedral", "angles", "shapes"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), atol=1e-9)


def test_worst_places_are_the_worst_and_apart():
    vertices, faces = meshes.bumpy_sphere(400)
    before = examined(vertices, faces)
    after = examined(vertices, optimize_flips(vertices, faces, energy="willmore").faces)
    found = {group.title: group.places for group in groups(before, after, True)}
    assert list(found) == [
        "Highest Willmore energy",
        "Sharpest folds",
        "Worst triangles",
        "Most improved",
    ]
    worst = found["Highest Willmore energy"][0]
    v = after.energy.argmax()
    np.testing.assert_array_equal(worst.point, vertices[v])
    assert worst.value == f"W {after.energy[v]:.3g}"
    assert worst.was == f"was {before.energy[v]:.3g}"
    assert found["Sharpest folds"][0].value == f"{np.nanmax(after.dihedral):.1f}°"
    assert found["Worst triangles"][0].value == f"shape {after.shapes.min():.3f}"
    diagonal = np.linalg.norm(np.ptp(vertices, axis=0))
    for places in found.values():
        points = np.array([place.point for place in places])
        apart = np.linalg.norm(points[:, None] - points, axis=2)[~np.eye(len(points), dtype=bool)]
        assert apart.min() > 0.02 * diagonal
    assert not groups(after, examined(vertices, faces[:0]), True)


def test_rows_of_two_meshes():
    vertices, faces = meshes.bumpy_sphere(400)
    result = optimize_flips(vertices, faces, energy="willmore")
    before, after = examined(vertices, faces), examined(vertices, result.faces)
    found = {row.name: row for row in rows(before, after, 17)}
    assert found["Edges that differ"].after == 17
    assert found["Willmore energy W"].after == pytest.approx(result.willmore_after)
    assert found["Mean shape"].before == pytest.approx(result.mean_shape_before)
    assert found["Normal change"].after == pytest.approx(normal_change(before, after))
    assert "Edges that differ" not in {row.name for row in rows(before, after, None)}
    assert normal_change(before, before) == 0.0
    turned = before._replace(normals=before.normals[:, [1, 2, 0]])
    cosines = (before.normals * turned.normals).sum(axis=1)
    assert normal_change(before, turned) == pytest.approx(np.degrees(np.arccos(cosines)).mean())


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, DASH),
        (166259, "166,259"),
        (63945.0265, "63,945"),
        (0.871112, "0.87111"),
        (45.757012, "45.757"),
        (0, "0"),
        (3e-7, "3.0000e-07"),
        (1.5e78, "1.5000e+78"),
        (float("inf"), "inf"),
    ],
)
def test_numbers_are_written_for_people(value, text):
    assert written(value) == text


@pytest.mark.parametrize(
    ("before", "after", "better", "text"),
    [
        (200.0, 100.0, -1, f'<span class="good">{MINUS}50 % better</span>'),
        (0.5, 0.25, 1, f'<span class="bad">{MINUS}50 % worse</span>'),
        (200.0, 300.0, 0, "+50 %"),
        (3, 5, -1, '<span class="bad">+2 worse</span>'),
        (0, 2, -1, '<span class="bad">+2 worse</span>'),
        (7, 7, -1, "same"),
        (None, 7, -1, ""),
        (float("inf"), 7.0, -1, ""),
    ],
)
def test_change_says_whether_it_is_better(before, after, better, text):
    assert change(Row("x", "", before, after, better=better)) == text


def test_fewer_faces_keep_the_surface(monkeypatch):
    monkeypatch.setattr("meshlab_willmore.report.decimate.WANTED", 600)
    mesh = examined(*meshes.bumpy_sphere(1500, bump=0.0))
    found = decimated(mesh, cell_size(mesh))
    assert 200 < len(found.faces) <= 750
    radii = np.linalg.norm(found.vertices, axis=1)
    assert 0.95 < radii.min() <= radii.max() <= 1.0
    assert found.energy.max() == mesh.energy.max()
    corners = found.vertices[found.faces]
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("fx,fx->f", outward, corners.mean(axis=1)) > 0).mean() > 0.95
    assert len(np.unique(np.sort(found.faces, axis=1), axis=0)) > 0.9 * len(found.faces)


def test_faces_without_extent_become_none(monkeypatch):
    mesh = examined(np.zeros((4, 3)), [[0, 1, 2], [1, 2, 3]])
    assert len(decimated(mesh, cell_size(mesh)).faces) == 0
