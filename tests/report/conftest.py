"""Pages in a browser: Debian's Chromium, without a window and without a network."""

import io
import shutil
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np
import pytest

from meshlab_willmore import optimize_flips
from meshlab_willmore.report import page
from tests import meshes
from tests.extras import IS_CI

FLAGS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # WebGL 2 without a graphics card.
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]
SECONDS = 60


def unless_missing(reason):
    """Skip a test for lack of a tool; where changes are checked, that is a failure."""
    if IS_CI:
        pytest.fail(reason)
    pytest.skip(reason)


@pytest.fixture(scope="session")
def chromium():
    """The browser, for all tests of a process."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        unless_missing("playwright is not installed: pip install 'meshlab-willmore[page]'")
    program = shutil.which("chromium")
    if program is None:
        unless_missing("there is no chromium: apt-get install chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        yield browser
        browser.close()


class Opened(NamedTuple):
    """A page that is open: Playwright's, and what it complained of and asked for."""

    page: object
    complaints: list
    requests: list

    def picture(self, selector):
        """The pixels (rows, columns, 3) of an element, as they are seen."""
        from PIL import Image

        png = self.page.locator(selector).first.screenshot()
        return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)

    def choose(self, mode):
        """Click on what is to be shown."""
        self.page.check(f'input[name="mode"][value="{mode}"]')
        self.settle()

    def settle(self):
        """Wait until two frames have been drawn."""
        self.page.evaluate(
            "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
        )


@pytest.fixture
def browse(chromium):
    """Opens a page and waits for its viewer."""

    @contextmanager
    def opened(path, width=1280, state="ready", **given):
        given = {"viewport": {"width": width, "height": 900}, "reduced_motion": "reduce", **given}
        context = chromium.new_context(offline=True, **given)
        try:
            tab = context.new_page()
            complaints, requests = [], []
            tab.on("console", lambda message: complaints.append(message.text))
            tab.on("pageerror", lambda error: complaints.append(str(error)))
            tab.on("request", lambda request: requests.append(request.url))
            tab.goto(path.as_uri())
            if state:
                tab.wait_for_selector(f'html[data-state="{state}"]', timeout=1000 * SECONDS)
            yield Opened(tab, complaints, requests)
        finally:
            context.close()

    return opened


@pytest.fixture
def small_pictures(monkeypatch):
    """The pictures take nearly all the time for a page."""
    monkeypatch.setattr("meshlab_willmore.report.document.POSTER", (64, 48))


@pytest.fixture(scope="session")
def flipped():
    """A mesh and what flips along its Willmore energy make of it."""
    vertices, faces = meshes.bumpy_sphere(1200)
    return vertices, faces, optimize_flips(vertices, faces, energy="willmore")


@pytest.fixture(scope="session")
def sphere_page(flipped, tmp_path_factory):
    """The page of that mesh."""
    vertices, faces, result = flipped
    path = tmp_path_factory.mktemp("page") / "sphere.html"
    page((vertices, faces), result, path, seconds=1.5, settings={"energy": "willmore"})
    return path
