"""Takes docs/guide/report_page.png: what a browser shows of a report page.

Run by hand, from the top of the repository, with Chromium and the extra [page] installed:

    python -m studies.page_picture docs/guide/report_page.png
"""

import shutil
import sys
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

from meshlab_willmore import optimize_flips
from meshlab_willmore.report import page
from studies import originals

MODEL = "CAD part"
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
WINDOW = {"width": 1180, "height": 1010}
# What is seen: dihedral angles.
KEY = "4"
COLOURS = 256


def take(browser, page_file, picture):
    """Open a page in Chromium, and save what is seen."""
    tab = browser.new_page(viewport=WINDOW)
    tab.goto(page_file.as_uri())
    tab.wait_for_selector('html[data-state="ready"]')
    tab.locator("#canvas").press(KEY)
    tab.evaluate("scrollTo(0, 0)")
    tab.evaluate("document.activeElement.blur()")
    tab.wait_for_timeout(500)
    tab.screenshot(path=picture)
    tab.close()
    # A palette makes the file three times as small.
    image = Image.open(picture).convert("RGB")
    image.quantize(COLOURS, dither=Image.Dither.NONE).save(picture, optimize=True)


def make(browser, picture):
    """Make the page, and its picture."""
    (start,) = originals.starts([MODEL])
    scrambled = originals.scrambled(start)
    result = optimize_flips(start.vertices, scrambled, preset="faithful")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "page.html")
        page((start.vertices, scrambled), result, file, title="part.ply")
        take(browser, file, picture)


def main(picture):
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        make(browser, picture)
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1])
