"""The result of flips as notebooks show it."""

import numpy as np
import pytest

from meshlab_willmore import optimize_flips, results
from tests import meshes


def test_result_has_the_mesh_before():
    vertices, faces = meshes.bumpy_sphere(100)
    result = optimize_flips(vertices, faces)
    np.testing.assert_array_equal(result.vertices, vertices)
    np.testing.assert_array_equal(result.faces_before, faces)


def test_notebook_shows_a_table_and_both_meshes():
    vertices, faces = meshes.bumpy_sphere(100)
    result = optimize_flips(vertices, faces, energy="willmore")
    text = result._repr_html_()
    assert f"<b>{result.flips} flips made</b> of 196 faces" in text
    for value in (result.willmore_before, result.willmore_after, result.mean_shape_after):
        assert f"<td>{value:.6g}</td>" in text
    assert "willmore by parallel greedy" in text
    assert text.count("<table>") == text.count("</table>") == 1
    pictures = text.split('src="data:image/png;base64,')[1:]
    assert len(pictures) == 2
    assert pictures[0].split('"')[0] != pictures[1].split('"')[0]


def test_of_a_large_mesh_the_result_alone_is_drawn(monkeypatch):
    monkeypatch.setattr(results, "MOST_FACES_IN_BOTH", 100)
    text = optimize_flips(*meshes.bumpy_sphere(100))._repr_html_()
    assert text.count("<img") == 1
    assert "The mesh after" in text


@pytest.mark.parametrize("vertices", [np.empty((0, 3)), np.zeros((1, 3))])
def test_mesh_without_faces_can_be_shown(vertices):
    assert "0 flips" in optimize_flips(vertices, np.empty((0, 3), int))._repr_html_()
