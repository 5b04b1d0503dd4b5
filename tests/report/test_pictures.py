"""The camera and the pictures."""

import numpy as np
import pytest

from meshlab_willmore.report.pictures import Camera, Window, camera_from, window_of

FROM_ABOVE = camera_from((0.0, 0.0, 1.0), up=(0.0, 1.0, 0.0))


# The camera


def test_camera_is_a_rotation_with_up_upwards():
    camera = camera_from((1.0, -2.0, 0.5), up=(0.0, 0.0, 1.0))
    np.testing.assert_allclose(camera.rotation @ camera.rotation.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(camera.rotation) == pytest.approx(1)
    right, up, towards = camera.rotation
    assert right[2] == 0
    assert up[2] > 0
    np.testing.assert_allclose(np.cross(towards, (1.0, -2.0, 0.5)), 0, atol=1e-15)


def test_window_shows_all_vertices_unless_it_is_given():
    vertices = np.array([(0, 0, 5), (4, 0, -1), (0, 2, 0)], dtype=float)
    window = window_of(vertices, FROM_ABOVE)
    assert window == pytest.approx((-0.08, 4.08, -0.08, 2.08))
    part = Window(1.0, 2.0, 0.0, 1.0)
    assert window_of(vertices, Camera(FROM_ABOVE.rotation, part)) is part


# Pictures


@pytest.fixture(scope="module")
def pictures():
    pytest.importorskip("matplotlib")
    from meshlab_willmore.report import pictures

    return pictures


def pixels(figure):
    """The page as colours (height, width, 3) from 0 to 255, and the four panels cut out of it."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    page = np.asarray(canvas.buffer_rgba())[:, :, :3].astype(int)
    panels = []
    for axes in figure.axes:
        box = axes.get_window_extent()
        bottom, top = len(page) - round(box.y0), len(page) - round(box.y1)
        panels.append(page[top:bottom, round(box.x0) : round(box.x1)])
    return page, panels


def roof():
    """A square of side 2 with its middle raised: 4 faces, as seen from above."""
    vertices = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 0.5)], dtype=float)
    return vertices, np.array([(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])


def test_four_panels_share_one_camera(pictures):
    vertices, faces = roof()
    window = Window(-0.5, 1.5, -1.0, 0.5)
    camera = Camera(FROM_ABOVE.rotation, window)
    shots = pictures.Shot("before", vertices, faces), pictures.Shot("after", vertices, faces[::-1])
    figure = pictures.comparison(camera, *shots)
    assert [(*axes.get_xlim(), *axes.get_ylim()) for axes in figure.axes] == [window] * 4
    assert [text.get_text() for text in figure.texts] == ["before", "after"]
    _, panels = pixels(figure)
    assert len({panel.shape for panel in panels}) == 1
    height, width, _ = panels[0].shape
    assert width / height == pytest.approx(2.0 / 1.5, rel=0.01)
    # The same faces in another order are the same surface.
    np.testing.assert_allclose(panels[0], panels[2], atol=64)
    assert np.abs(panels[0] - panels[2]).mean() < 1
    assert np.abs(panels[1] - panels[3]).mean() < 1


def test_three_shots_have_a_column_each(pictures):
    shot = pictures.Shot("", *roof())
    figure = pictures.comparison(FROM_ABOVE, shot, shot, shot)
    places = [axes.get_position() for axes in figure.axes]
    assert [place.x0 for place in places[::2]] == [place.x0 for place in places[1::2]]
    assert places[0].x1 < places[2].x0 < places[2].x1 < places[4].x0 < places[4].x1 <= 1.0


def test_panels_show_a_wireframe_and_shades(pictures):
    shot = pictures.Shot("", *roof())
    _, (wire, shaded, *_) = pixels(pictures.comparison(FROM_ABOVE, shot, shot))
    # Wireframe: mostly paper, some dark line; the diagonals cross in the middle.
    assert (wire.min(axis=2) > 250).mean() > 0.9
    height, width, _ = wire.shape
    middle = wire[height // 2 - 3 : height // 2 + 3, width // 2 - 3 : width // 2 + 3]
    assert middle.min() < 60
    # Shaded: four flat facets; the one that looks to the left and up is the lightest.
    left, right = shaded[height // 2, width // 4], shaded[height // 2, 3 * width // 4]
    top, bottom = shaded[height // 4, width // 2], shaded[3 * height // 4, width // 2]
    assert min(left.sum(), top.sum()) > max(right.sum(), bottom.sum()) + 30
    assert shaded[height // 2, width // 8].tolist() == left.tolist()


def test_what_is_in_front_hides_what_is_behind(pictures):
    near = np.array([(-1, -1, 2), (1, -1, 2), (0, 1, 2)], dtype=float)
    far = np.array([(-2, -2, 0), (2, -2, 1), (0, 2, 1)], dtype=float)
    vertices = np.concatenate([near, far])
    for faces in ([(0, 1, 2), (3, 4, 5)], [(3, 4, 5), (0, 1, 2)]):
        both = pictures.Shot("", vertices, np.array(faces))
        alone = pictures.Shot("", vertices, np.array([(0, 1, 2)]))
        _, (_, shaded, _, expected) = pixels(pictures.comparison(FROM_ABOVE, both, alone))
        height, width, _ = shaded.shape
        middle = height // 2, width // 2
        assert shaded[middle].tolist() == expected[middle].tolist()
        corner = height - height // 16, width // 8
        assert shaded[corner].tolist() != expected[corner].tolist() == [255, 255, 255]


def test_faces_that_look_away_or_lie_outside_are_not_drawn(pictures):
    vertices, faces = roof()
    away = pictures.facets_seen(
        pictures.Shot("", vertices, faces[:, ::-1]), FROM_ABOVE, window_of(vertices, FROM_ABOVE)
    )
    assert away.corners.shape == (0, 3, 2)
    beside = Window(1.5, 2.5, -1.0, 1.0)
    outside = pictures.facets_seen(pictures.Shot("", vertices, faces), FROM_ABOVE, beside)
    assert len(outside.corners) == 0
    right_part = Window(0.5, 2.5, -0.1, 0.1)
    seen = pictures.facets_seen(pictures.Shot("", vertices, faces), FROM_ABOVE, right_part)
    assert 1 <= len(seen.corners) < 4
    figure = pictures.comparison(
        FROM_ABOVE, pictures.Shot("", vertices, faces), pictures.Shot("", vertices, faces[:0])
    )
    _, (_, _, empty_wire, empty_shaded) = pixels(figure)
    assert empty_wire.min() == empty_shaded.min() == 255


def test_a_facet_without_area_does_not_disturb(pictures):
    vertices, faces = roof()
    flat = np.vstack([faces, [(0, 1, 1)]])
    shots = pictures.Shot("", vertices, faces), pictures.Shot("", vertices, flat)
    _, panels = pixels(pictures.comparison(FROM_ABOVE, *shots))
    np.testing.assert_array_equal(panels[0], panels[2])
    np.testing.assert_array_equal(panels[1], panels[3])
