"""The pictures of the pages are those that their command draws."""

import re

import numpy as np
import pytest

from .pages import DOCS, README

Image = pytest.importorskip("PIL.Image")
pictures = pytest.importorskip("studies.pictures")

# Of 255, in the mean: what fonts and smoothing of lines may do.
MOST_DIFFERENCE = 2.0


def pixels(image):
    return np.asarray(image.convert("RGB"), float)


@pytest.mark.heavy
@pytest.mark.slow
@pytest.mark.parametrize("name", pictures.PICTURES)
def test_a_picture_is_drawn_by_the_command(name, tmp_path):
    pictures.draw(name, tmp_path)
    shown, drawn = Image.open(DOCS / "pictures" / name), Image.open(tmp_path / name)
    assert shown.text == drawn.text
    assert shown.size == drawn.size
    assert abs(pixels(shown) - pixels(drawn)).mean() < MOST_DIFFERENCE


def test_all_pictures_are_drawn_by_the_command():
    assert {path.name for path in (DOCS / "pictures").iterdir()} == set(pictures.PICTURES)


@pytest.mark.parametrize("page", [README, DOCS / "index.md"], ids=["README", "index"])
def test_the_text_of_a_picture_has_its_number_of_flips(page):
    captions = Image.open(DOCS / "pictures" / "face.png").text[pictures.CAPTIONS]
    (flips,) = re.findall(r"after (\d+) flips", captions)
    assert set(re.findall(r"(\d+) flips", page.read_text(encoding="utf-8"))) == {flips}
