"""The page as a file: what it takes, what it says, and that nothing in it runs but its script."""

import base64
import hashlib
import json
import re
from html.parser import HTMLParser
from types import SimpleNamespace

import numpy as np
import pymeshlab
import pytest

import meshlab_willmore
from meshlab_willmore import optimize_flips
from meshlab_willmore.demo.models import surface_of
from meshlab_willmore.demo.scan import ScanNotFoundError, scan_file
from meshlab_willmore.mesh.build import changed_edges
from meshlab_willmore.report import page
from meshlab_willmore.report.document import POSTER, for_script
from tests import meshes

pytestmark = pytest.mark.usefixtures("small_pictures")
EVIL = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&"


class Elements(HTMLParser):
    """The names and attributes of all elements, and the text outside of scripts."""

    def __init__(self, text):
        super().__init__()
        self.found, self.text, self._inside = [], "", ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))
        self._inside = tag

    def handle_endtag(self, tag):
        self._inside = ""

    def handle_data(self, data):
        if self._inside not in ("script", "style"):
            self.text += data

    def all(self, tag):
        return [attributes for name, attributes in self.found if name == tag]


@pytest.fixture(scope="module")
def sphere():
    vertices, faces = meshes.bumpy_sphere(200)
    return vertices, faces, optimize_flips(vertices, faces, energy="willmore")


def elements(tmp_path, *given, **more):
    page(*given, tmp_path / "page.html", **more)
    return Elements((tmp_path / "page.html").read_text(encoding="utf-8"))


def test_page_says_what_changed(sphere, tmp_path):
    vertices, faces, result = sphere
    found = elements(tmp_path, (vertices, faces), result, seconds=12.5, settings={"depth": 7})
    text = "".join(found.text.split())
    assert f"Edgesthatdiffer{changed_edges(faces, result.faces)}" in text
    assert f"{result.willmore_before:,.2f}{result.willmore_after:,.2f}" in text
    assert "12.5s" in text
    assert "depth7" in text
    assert "willmorebyparallelgreedy" in text
    assert meshlab_willmore.__version__ in text


@pytest.mark.parametrize("kind", ["pair", "pymeshlab", "trimesh", "lists"])
def test_meshes_of_any_kind(sphere, tmp_path, kind):
    vertices, faces, result = sphere
    mesh = {
        "pair": (vertices, faces),
        "pymeshlab": pymeshlab.Mesh(vertices, faces),
        "trimesh": SimpleNamespace(vertices=vertices, faces=faces),
        "lists": [vertices.tolist(), faces.tolist()],
    }[kind]
    found = elements(tmp_path, mesh, (vertices, result.faces))
    assert f"{len(faces)}" in found.text


@pytest.mark.parametrize(
    ("before", "error", "message"),
    [
        (3, TypeError, "before must be a pair (vertices, faces) or a mesh of PyMeshLab or trimesh"),
        (([[0, 0, np.nan]], []), ValueError, "vertex 0 has a coordinate that is not finite"),
        (([[0, 0, 0]], [[0, 1, 2]]), ValueError, "face 0 has a vertex index"),
    ],
)
def test_what_is_no_mesh_is_named(sphere, tmp_path, before, error, message):
    path = tmp_path / "page.html"
    path.write_text("mine")
    with pytest.raises(error, match=re.escape(message)):
        page(before, sphere[:2], path)
    assert path.read_text() == "mine"


def test_file_that_cannot_be_written_is_named(sphere, tmp_path):
    with pytest.raises(OSError, match=r"cannot write .*missing/page.html"):
        page(sphere[:2], sphere[2], tmp_path / "missing" / "page.html")


def test_nothing_from_outside_becomes_markup(sphere, tmp_path):
    vertices, faces, result = sphere
    given = {"title": EVIL, "settings": {EVIL: EVIL}, "notes": [EVIL]}
    plain = elements(tmp_path, (vertices, faces), result, notes=["x"], settings={"x": "x"})
    found = elements(tmp_path, (vertices, faces), result, **given)
    assert [tag for tag, _ in found.found] == [tag for tag, _ in plain.found]
    assert found.text.count(EVIL) >= 4


def test_data_ends_no_script():
    text = for_script({EVIL: EVIL})
    assert "<" not in text
    assert json.loads(text) == {EVIL: EVIL}


@pytest.mark.slow
def test_pair_of_the_face_scan_takes_three_megabytes_at_most(tmp_path, monkeypatch):
    monkeypatch.setattr("meshlab_willmore.report.document.POSTER", POSTER)
    try:
        path = scan_file()
    except ScanNotFoundError as missing:
        pytest.skip(str(missing))
    ms = pymeshlab.MeshSet()
    ms.load_new_mesh(str(path))
    vertices, faces = surface_of(ms)
    assert len(faces) > 166_000
    result = optimize_flips(vertices, faces, energy="willmore")
    page((vertices, faces), result, tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size < 3_000_000


def test_policy_allows_the_own_script_and_style_only(sphere, tmp_path):
    found = elements(tmp_path, sphere[:2], sphere[2])
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    (policy,) = [meta["content"] for meta in found.all("meta") if "http-equiv" in meta]
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    for name, pattern in (
        ("script-src", r'<script type="module">(.*?)</script>'),
        ("style-src", r"<style>(.*?)</style>"),
    ):
        (inside,) = re.findall(pattern, text, re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(inside.encode()).digest()).decode()
        assert rules[name] == f"'sha256-{digest}'"
    assert rules["default-src"] == "'none'"
    assert rules["img-src"] == "data:"
    for _, attributes in found.found:
        assert not any(name.startswith("on") or name == "style" for name in attributes)
        for name in ("src", "href"):
            assert attributes.get(name, "data:").startswith("data:")


def test_pictures_and_histograms_have_text(sphere, tmp_path):
    found = elements(tmp_path, sphere[:2], sphere[2])
    assert all(image["alt"] for image in found.all("img"))
    assert len(found.all("svg")) == 5
    for svg in found.all("svg"):
        assert svg["role"] == "img"
        assert re.match(r"Histogram. .*: median .* → .* before and after", svg["aria-label"])
    (canvas,) = found.all("canvas")
    assert "Willmore energy W" in canvas["aria-label"]
    assert canvas["tabindex"] == "0"


def test_no_element_has_the_id_of_another(sphere, tmp_path):
    ids = [a["id"] for _, a in elements(tmp_path, sphere[:2], sphere[2]).found if "id" in a]
    assert len(ids) == len(set(ids))


def test_worse_is_called_worse(sphere, tmp_path):
    vertices, faces, result = sphere
    text = elements(tmp_path, (vertices, result.faces), (vertices, faces)).text
    assert "% worse" in text


@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
@pytest.mark.parametrize("kind", ["points", "flat", "one face", "coincident"])
def test_meshes_at_the_limits(tmp_path, kind, scale):
    vertices = scale * np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    faces = np.array([[0, 1, 2], [2, 1, 3]])
    if kind == "points":
        faces = faces[:0]
    elif kind == "one face":
        faces = faces[:1]
    elif kind == "coincident":
        vertices = np.zeros((4, 3)) + scale
    found = elements(tmp_path, (vertices, faces), (vertices, faces))
    assert "nan" not in found.text.lower()
