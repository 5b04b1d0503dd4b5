"""What the page says of meshes that hardly differ, and of those that are no flips of each other."""

import numpy as np
import pytest

from meshlab_willmore import optimize_flips
from meshlab_willmore.report.examine import examined
from meshlab_willmore.report.places import groups
from meshlab_willmore.report.rows import MINUS, Row, change, meaningful, rows, table_rows, written
from meshlab_willmore.report.table import Entry, percent, table_page
from tests import meshes

from .test_document import elements

pytestmark = pytest.mark.usefixtures("small_pictures")


def test_unchanged_mesh_has_no_rounding_errors():
    vertices, faces = meshes.bumpy_sphere(400)
    mesh = examined(vertices, faces)
    # The same faces in another order: sums are rounded otherwise.
    other = examined(vertices, faces[::-1])
    text = table_rows(rows(mesh, other, 0))
    assert "e-" not in text
    assert "better" not in text
    assert "worse" not in text
    flat = examined(*meshes.grid(5, 5))
    tilted = flat._replace(
        energy=flat.energy - 8.88e-16,
        totals=flat.totals._replace(willmore_energy=-8.88e-16, absolute_mean_curvature=3e-14),
    )
    assert "e-" not in table_rows(rows(flat, tilted, 0))
    bumpy = flat._replace(energy=flat.energy + 1e-3)
    values = [place.value for group in groups(bumpy, tilted, True) for place in group.places]
    assert "W 0" in values
    assert not any("-" in value for value in values)


def test_negative_numbers_have_one_minus_sign():
    assert written(-0.25) == f"{MINUS}0.25000"
    assert change(Row("x", "", 2.0 / 3.0, 2.0 / 3.0 - 1e-16, better=-1)) == "same"
    assert meaningful(1e-12) == 0.0
    assert meaningful(1e-12, 1e-6) == 1e-12
    assert f"{percent(3.0, 3.0 - 4e-16)}" == "0.0"
    page = table_page("x", "x", ["W %"], [Entry("x", "done", True, numbers={"W %": -12.5})])
    assert f">{MINUS}12.5</td>" in page


def test_only_flips_are_better_or_worse(tmp_path):
    vertices, faces = meshes.bumpy_sphere(200)
    before = vertices, faces
    flipped = optimize_flips(vertices, faces, energy="willmore").faces
    text = elements(tmp_path, before, (vertices, flipped)).text
    assert "better" in text
    for after in [(vertices, flipped[:0]), (vertices, flipped[:-9]), (vertices * 0.9, flipped)]:
        found = elements(tmp_path, before, after).text
        assert "better" not in found
        assert "worse" not in found
        assert "Most improved" not in found


def test_no_places_are_said_in_one_sentence(tmp_path):
    flat = meshes.octahedron()[0], np.empty((0, 3), int)
    text = elements(tmp_path, flat, flat).text
    assert "There are none." in text
    assert "Click on one" not in text
    bumpy = meshes.bumpy_sphere(100)
    assert "Click on one to fly there." in elements(tmp_path, bumpy, bumpy).text


def test_labels_say_what_is_counted(tmp_path):
    bumpy = meshes.bumpy_sphere(100)
    text = elements(tmp_path, bumpy, bumpy).text
    assert "Edges that differ" in text
    assert "The flips made may be more" in text
    assert "Faces that cut or touch others" in text
    assert "MeshLab's filter" in text
