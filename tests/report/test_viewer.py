"""The viewer in a browser: what is seen, by mouse, keyboard and on a narrow screen."""

from pathlib import Path

import numpy as np
import pytest

from meshlab_willmore.report import decimate, page
from tests import meshes

MODES = ["faces", "wires", "energy", "dihedral", "flips", "reflection"]
# Of the picture of one mesh; differences of colours that are seen.
MUCH, SEEN = 0.15, 30
GUIDE = Path(__file__).parents[2] / "docs" / "guide" / "report_page.png"

pytestmark = pytest.mark.slow


def is_drawn(picture, ground=None):
    """The share of pixels that differ from the ground, which most of the upper rim is."""
    ground = np.median(picture[4:8].reshape(-1, 3), axis=0) if ground is None else ground
    return (np.abs(picture - ground).max(axis=2) > SEEN).mean()


def differs(one, other):
    """The share of pixels that differ."""
    return (np.abs(one - other).max(axis=2) > SEEN).mean()


def halves(picture):
    """The pictures before and after, without their labels and rims."""
    middle = picture.shape[1] // 2
    return picture[50:-6, 6 : middle - 6], picture[50:-6, middle + 6 : 2 * middle - 6]


def test_page_draws_both_meshes_without_a_request_or_a_complaint(browse, sphere_page):
    with browse(sphere_page) as opened:
        seen = {}
        for mode in MODES:
            opened.choose(mode)
            before, after = halves(opened.picture(".stage"))
            seen[mode] = after
            assert is_drawn(before) > MUCH, mode
            assert is_drawn(after) > MUCH, mode
            assert differs(before, after[:, : before.shape[1]]) > 0.01, mode
        for number, mode in enumerate(MODES):
            for other in MODES[:number]:
                assert differs(seen[mode], seen[other]) > 0.02, (mode, other)
        assert opened.requests == [sphere_page.as_uri()]
        assert opened.complaints == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
def test_page_fits_the_screen(browse, sphere_page, width, scheme):
    with browse(sphere_page, width, color_scheme=scheme) as opened:
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
        for pane in opened.page.locator(".pane").all():
            assert pane.bounding_box()["width"] > 250
        panes = [pane.bounding_box() for pane in opened.page.locator(".pane").all()]
        assert (panes[0]["y"] < panes[1]["y"]) == (width == 390)
        ground = opened.page.evaluate("getComputedStyle(document.body).backgroundColor")
        light = sum(int(part) for part in ground.strip("rgb()").split(","))
        assert (light > 600) == (scheme == "light")
        assert is_drawn(opened.picture(".stage")) > MUCH / 2


def test_keyboard_does_all(browse, sphere_page):
    with browse(sphere_page) as opened:
        page_ = opened.page
        page_.focus("#canvas")

        def seen_after(*keys):
            for key in keys:
                page_.keyboard.press(key)
            opened.settle()
            return opened.picture(".stage")

        start = seen_after()
        for key in ("ArrowLeft", "ArrowUp", "+", "-", "Shift+ArrowRight", "3"):
            last = opened.picture(".stage")
            assert differs(last, seen_after(key)) > 0.01, key
        assert page_.is_checked('input[value="energy"]')
        assert differs(start, seen_after("1", "0")) == 0.0
        at_first = seen_after("n")
        assert page_.get_attribute('[data-place="0"]', "aria-pressed") == "true"
        assert page_.inner_text("#said").startswith("Highest Willmore energy: W ")
        assert differs(start, at_first) > 0.1
        assert page_.locator(".ring:visible").count() == 2
        seen_after("n", "p")
        assert differs(at_first, opened.picture(".stage")) == 0.0
        assert differs(start, seen_after("0")) == 0.0
        assert opened.complaints == []


def test_keys_work_on_a_fresh_page_whose_arrows_scroll(browse, sphere_page):
    with browse(sphere_page) as opened:
        page_ = opened.page
        for number, mode in reversed([*enumerate(MODES, 1)]):
            page_.keyboard.press(f"{number}")
            assert page_.is_checked(f'input[value="{mode}"]')
        page_.keyboard.press("n")
        assert page_.get_attribute('[data-place="0"]', "aria-pressed") == "true"
        opened.settle()
        start = opened.picture("#canvas")
        page_.keyboard.press("ArrowDown")
        page_.wait_for_function("scrollY > 0")
        page_.evaluate("scrollTo(0, 0)")
        opened.settle()
        assert differs(start, opened.picture("#canvas")) == 0.0


def test_result_in_a_narrow_notebook_scrolls_by_itself(browse, flipped, tmp_path):
    path = tmp_path / "notebook.html"
    path.write_text(f"<html><body>{flipped[2]._repr_html_()}</body></html>", encoding="utf-8")
    with browse(path, 390, state="") as opened:
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= 390
        assert opened.page.locator("table").bounding_box()["width"] > 390


def test_drag_turns_and_the_wheel_zooms_once_the_picture_is_clicked(browse, sphere_page):
    with browse(sphere_page) as opened:
        mouse, box = opened.page.mouse, opened.page.locator("#canvas").bounding_box()
        opened.page.evaluate("scrollTo(0, 0)")
        x, y = box["x"] + box["width"] / 4, box["y"] + box["height"] / 3
        start = opened.picture(".stage")
        mouse.move(x, y)
        mouse.wheel(0, 100)
        opened.page.wait_for_function("scrollY > 0")
        opened.page.evaluate("scrollTo(0, 0)")
        opened.settle()
        assert differs(start, opened.picture(".stage")) == 0.0
        mouse.down()
        mouse.move(x + 120, y)
        mouse.up()
        opened.settle()
        turned = opened.picture(".stage")
        assert differs(start, turned) > 0.02
        mouse.wheel(0, -300)
        opened.settle()
        assert differs(turned, opened.picture(".stage")) > 0.05


def test_click_flies_to_a_place_where_the_mesh_is(browse, sphere_page):
    with browse(sphere_page) as opened:
        colour = "getComputedStyle(document.querySelector('.stage')).backgroundColor"
        ground = [int(part) for part in opened.page.evaluate(colour).strip("rgb()").split(",")]
        for number in range(opened.page.locator("[data-place]").count() - 1):
            opened.page.click(f'[data-place="{number}"]')
            opened.settle()
            # The label and the ring of a pane are over it, but not in its middle.
            pane = opened.picture(".pane:last-child")
            row, column = pane.shape[0] // 2, pane.shape[1] // 2
            middle = pane[row - 6 : row + 7, column - 6 : column + 7]
            # At a fold there may be ground on one side.
            assert (np.abs(middle - ground).max(axis=2) > 3).mean() > 0.3, number


@pytest.mark.parametrize("wish", ["no-preference", "reduce"])
def test_camera_flies_unless_motion_is_not_wanted(browse, sphere_page, wish):
    sizes = """async () => {
        document.querySelector('[data-place="0"]').click();
        const at_once = document.querySelector(".ring").style.width;
        await new Promise((done) => setTimeout(done, 1500));
        return [at_once, document.querySelector(".ring").style.width];
    }"""
    with browse(sphere_page, reduced_motion=wish) as opened:
        at_once, in_the_end = opened.page.evaluate(sizes)
        assert (at_once == in_the_end) == (wish == "reduce")


def test_without_webgl_the_pictures_stay_and_the_page_says_why(browse, sphere_page, tmp_path):
    text = sphere_page.read_text()
    # As a browser without it: the script is another one then, and its hash with it.
    script = text.rpartition('<script type="module">')[2].partition("</script>")[0]
    blind = script.replace('getContext("webgl2")', 'getContext("webgl9")')
    assert blind != script
    from meshlab_willmore.report.document import _hash

    path = tmp_path / "blind.html"
    path.write_text(text.replace(script, blind).replace(_hash(script), _hash(blind)))
    with browse(path, state="failed") as opened:
        assert "no WebGL 2" in opened.page.inner_text("#said")
        assert is_drawn(opened.picture(".pane img")) > MUCH


def test_decimated_view_says_so(browse, flipped, tmp_path, monkeypatch):
    vertices, faces, result = flipped
    monkeypatch.setattr(decimate, "MOST_FACES", 1000)
    monkeypatch.setattr(decimate, "WANTED", 500)
    path = tmp_path / "large.html"
    page((vertices, faces), result, path)
    with browse(path) as opened:
        assert "of 2,396 faces are shown" in opened.page.inner_text(".viewer")
        assert opened.page.locator('input[name="mode"]').count() == 3
        before, _ = halves(opened.picture(".stage"))
        assert is_drawn(before) > MUCH
        assert opened.complaints == []


def test_meshes_of_different_vertices_and_without_faces(browse, tmp_path):
    one, other = meshes.octahedron(), meshes.bumpy_sphere(300)
    points = (other[0], np.empty((0, 3), int))
    page(one, other, tmp_path / "two.html")
    page(points, other, tmp_path / "points.html")
    with browse(tmp_path / "two.html") as opened:
        before, after = halves(opened.picture(".stage"))
        assert is_drawn(before) > MUCH
        assert is_drawn(after) > MUCH
        assert opened.page.locator('input[value="flips"]').count() == 0
    with browse(tmp_path / "points.html") as opened:
        before, after = halves(opened.picture(".stage"))
        assert is_drawn(before) < 0.05
        assert is_drawn(after) > MUCH
        assert "no faces" in opened.page.inner_text(".pane")
        assert opened.complaints == []


def test_picture_in_the_guide_is_of_this_page(chromium, tmp_path):
    """But for the date on it; another machine draws letters and rims a little differently."""
    from PIL import Image

    from studies import page_picture

    picture = tmp_path / "page.png"
    page_picture.make(chromium, picture)
    both = [np.asarray(Image.open(file).convert("RGB")).astype(int) for file in (picture, GUIDE)]
    assert both[0].shape == both[1].shape
    assert differs(*both) < 0.05


def test_one_finger_turns_and_two_zoom(browse, sphere_page):
    with browse(sphere_page, 390, has_touch=True, is_mobile=True) as opened:
        touch = opened.page.context.new_cdp_session(opened.page)
        opened.page.locator(".stage").scroll_into_view_if_needed()
        box = opened.page.locator("#canvas").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 4

        def seen_after(*moves):
            for kind, points in zip(("touchStart", "touchMove", "touchEnd"), moves, strict=True):
                fingers = [{"x": x + dx, "y": y, "id": n} for n, dx in enumerate(points)]
                touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": fingers})
            opened.settle()
            return opened.picture(".pane")

        start = opened.picture(".pane")
        turned = seen_after([0], [60], [])
        assert differs(start, turned) > 0.02
        assert is_drawn(turned) == pytest.approx(is_drawn(start), abs=0.05)
        ground = turned[60, 4]
        near = seen_after([-30, 30], [-50, 50], [])
        assert is_drawn(near, ground) > 1.3 * is_drawn(turned)
        assert is_drawn(seen_after([-50, 50], [-30, 30], []), ground) < 0.8 * is_drawn(near, ground)
        assert opened.complaints == []
