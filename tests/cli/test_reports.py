"""`--report`: pages of one mesh, of each of several, and of a batch."""

import json
import re
from html import unescape
from html.parser import HTMLParser
from pathlib import Path

import pytest

from meshlab_willmore import batch
from meshlab_willmore.batch import pages, work
from meshlab_willmore.batch.jobs import Job
from meshlab_willmore.batch.recipe import Recipe
from meshlab_willmore.batch.records import Result, StepResult
from meshlab_willmore.demo.models import Surface
from meshlab_willmore.mesh_files import loading
from meshlab_willmore.mesh_files.paths import Output
from meshlab_willmore.messages import WrongUse
from tests import meshes

from .conftest import FLIP, TAUBIN, call, cube_file, listing, script_file

EVIL = "<script>alert(1)</script>"


class Table(HTMLParser):
    """The rows of a batch's page: texts, pictures and links; and the names of all elements."""

    def __init__(self, path):
        super().__init__()
        self.rows, self.links, self.pictures, self.tags = [], [], 0, []
        self.feed(Path(path).read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag == "tr":
            self.rows.append("")
        elif tag == "small":
            self.rows[-1] += "|"
        elif tag == "a":
            self.links.append(dict(attrs)["href"])
        self.pictures += tag == "img"

    def handle_endtag(self, tag):
        if tag in ("td", "th", "small"):
            self.rows[-1] += "|"

    def handle_data(self, data):
        if self.rows and self.tags[-1] != "script":
            self.rows[-1] += data.strip()


@pytest.mark.parametrize("command", ["flip", "run"])
def test_page_of_one_mesh(cube, command):
    cube = Path(cube).absolute()
    words = ["flip", cube, "out.ply", "--energy", "willmore"]
    if command == "run":
        words = ["run", script_file(TAUBIN, FLIP), "-i", cube, "-o", "out.ply"]
    result = call(*words, "--report", "page.html")
    assert (result.exit_code, result.stderr) == (0, "")
    text = Path("page.html").read_text(encoding="utf-8")
    assert "<h1>cube.ply</h1>" in text
    assert f"<dd>{cube}</dd>" in text
    assert "out.ply" in text
    assert ("energy = &#x27;willmore&#x27;" in text) == (command == "flip")
    assert "flips = " in text
    head = json.loads(re.search(r'id="head">(.*?)</script>', text)[1])
    assert head["isSame"] == (command == "flip")
    assert listing(".") == sorted(
        ["cube.ply", "out.ply", "page.html"] + ["script.mlx"] * (command == "run")
    )


def test_page_names_what_was_lost_and_escapes_it(monkeypatch):
    name = f"{EVIL.replace('/', ':')}.obj"
    Path(name).write_text("mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 3 2 4\n")
    result = call("flip", name, "out.ply", "--report", "page.html")
    assert result.exit_code == 0
    assert "Note: " in result.stderr
    text = Path("page.html").read_text(encoding="utf-8")
    assert "<script>alert" not in text
    assert 'aria-label="Notes"' in text
    assert "&lt;script&gt;alert(1)&lt;:script&gt;.obj" in text


@pytest.mark.slow
def test_batch_has_a_table_and_pages(request):
    for name in ("one", "two"):
        cube_file(f"{name}.ply")
    Path("bad.ply").write_text(f"no mesh {EVIL}")
    words = ["flip", "one.ply", "bad.ply", "two.ply", "{name}.off", "--workers", 1]
    result = call(*words, "--report", "all.html", "--report", "pages/{name}.html")
    assert result.exit_code == 2
    assert "the folder pages does not exist" in result.stderr
    Path("pages").mkdir()
    result = call(*words, "--report", "all.html", "--report", "pages/{name}.html",
                  "--json", "log.jsonl")  # fmt: skip
    assert result.exit_code == 1
    assert listing("pages") == ["one.html", "two.html"]
    table = Table("all.html")
    assert [row.split("|")[1] for row in table.rows] == ["Name", "bad.ply", "one.ply", "two.ply"]
    assert "bad file" in table.rows[1]
    assert "cannot read bad.ply" in table.rows[1]
    assert re.search(r"\|done\|24\|6\|45.76\|", table.rows[2])
    assert table.links == ["pages/one.html", "pages/two.html"]
    assert table.pictures == 2
    assert "picture" not in Path("log.jsonl").read_text()

    # A batch that goes on has its earlier results in the table, and their pages.
    request.getfixturevalue("workers_here")
    Path("one.ply").touch()
    again = call(*words, "--report", "all.html", "--report", "pages/{name}.html",
                 "--json", "log.jsonl", "--resume")  # fmt: skip
    assert again.exit_code == 1
    table = Table("all.html")
    assert [row.split("|")[1] for row in table.rows] == ["Name", "bad.ply", "one.ply", "two.ply"]
    assert table.links == ["pages/one.html", "pages/two.html"]


@pytest.mark.usefixtures("workers_here")
@pytest.mark.parametrize("option", ["--resume", "--retry-failed"])
@pytest.mark.parametrize("name", ["mine.html", "{name}.html"])
def test_batch_that_goes_on_replaces_no_page_of_others(cube, option, name):
    two = cube_file("two.ply")
    file = Path(name.format(name="two"))
    file.write_text("<html>mine, not by meshlab_willmore</html>")
    words = ["flip", cube, two, "{name}.off", "--json", "r.jsonl", option, "--report", name]
    result = call(*words)
    assert result.exit_code == 2
    assert f"{file} already exists; use --force to overwrite" in result.stderr
    given = {"script": script_file(FLIP), "inputs": [cube, two], "log": "r.jsonl", "report": name}
    with pytest.raises(WrongUse, match=f"{file} already exists"):
        next(batch.run(**given, **{option.strip("-").replace("-", "_"): True}))
    assert file.read_text().startswith("<html>mine")
    assert call(*words, "--force").exit_code == 0
    assert call(*words).exit_code == 0
    assert "<title>" in file.read_text()


@pytest.mark.usefixtures("workers_here")
def test_a_mesh_that_is_named_twice_has_two_lines_rows_and_pages(cube):
    words = ["flip", cube, cube, "flipped_{index}.off", "--workers", 1]
    report = ["--report", "all.html", "--report", "page_{index}.html"]
    result = call(*words, *report)
    assert result.exit_code == 0
    starts = [line.partition(":")[0] for line in result.stdout.splitlines()]
    assert starts == ["cube.ply -> flipped_1.off", "cube.ply -> flipped_2.off"]
    table = Table("all.html")
    assert [row.split("|")[1] for row in table.rows] == ["Name", "cube.ply", "cube.ply"]
    assert table.links == ["page_1.html", "page_2.html"]


@pytest.mark.usefixtures("workers_here")
def test_each_share_has_a_table_of_its_own():
    # The first share has "three.ply", the second "one.ply".
    for name in ("three", "one"):
        cube_file(f"{name}.ply")
    words = ["flip", "three.ply", "one.ply", "{name}.off", "--json", "log.jsonl", "--resume"]
    refused = call(*words, "--shard", "1/2", "--report", "all.html")
    assert refused.exit_code == 2
    assert refused.stderr == (
        "Error: all.html would be the table of each share, and the last one would replace the "
        "others; write the share's number into the name, such as 'all-{shard}.html'\n"
    )
    with pytest.raises(WrongUse, match=r"all\.html would be the table of each share"):
        next(batch.run(script_file(FLIP), ["three.ply", "one.ply"], shard="1/2", report="all.html"))
    assert listing(".") == ["one.ply", "script.mlx", "three.ply"]
    for share in ("1/2", "2/2"):
        report = ["--report", "all-{shard}.html", "--report", "{name}-{shard}.html"]
        assert call(*words, "--shard", share, *report).exit_code == 0
    rows = [Table(f"all-{number}.html").rows[1].split("|")[1] for number in (1, 2)]
    assert rows == ["three.ply", "one.ply"]
    assert {"three-1.html", "one-2.html"} <= set(listing("."))
    # Of all shares at once.
    assert call(*words, "--report", "all.html").exit_code == 0
    assert len(Table("all.html").rows) == 3


def test_everything_in_a_table_is_escaped():
    step = StepResult(1, EVIL, 0.5, {"flips": 3})
    results = [
        Result(EVIL, EVIL, step=EVIL, reason=EVIL, notes=(EVIL,)),
        Result("fine", "done", notes=(EVIL,), returned=(step,), picture=b"\x89PNG", place=1),
    ]
    jobs = [Job((Path(one.input),), ()) for one in results]
    pages.write_table(Path("all.html"), EVIL, jobs, results)
    harmless = dict.fromkeys(("input", "status", "step", "reason"), "x")
    plain = [one._replace(**harmless, notes=("x",)) for one in results]
    plain[1] = plain[1]._replace(input="y", status="done")
    jobs = [Job((Path(one.input),), ()) for one in plain]
    pages.write_table(Path("plain.html"), "x", jobs, plain)
    assert Table("all.html").tags == Table("plain.html").tags
    assert Table("all.html").tags.count("script") == 1


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["--report", "page.ply"], "--report page.ply: a page needs a name such as report.html"),
        (["--report", "no/page.html"], "the folder no does not exist"),
        (["--report", "mine.html"], "mine.html already exists; use --force to overwrite"),
        (["--report", "."], "--report .: a page needs a name"),
        (
            ["--report", "a.html", "--report", "b.html"],
            "the table of all meshes has a name already",
        ),
        (["--report", "{name}.html", "--report", "x{name}.html"], "the page of a mesh has a name"),
        (["--report", "{nam}.html"], "{nam} in '{nam}.html' is no placeholder"),
    ],
)
def test_wrong_name_is_named_before_anything_is_done(cube, words, line):
    Path("mine.html").write_text("mine")
    result = call("flip", cube, "out.ply", *words)
    assert result.exit_code == 2
    assert line in result.stderr
    assert listing(".") == ["cube.ply", "mine.html"]


def test_pages_of_one_name_are_refused(cube):
    cube_file("two.ply")
    result = call("flip", cube, "two.ply", "{name}.off", "--report", "x{{}}{ext}.html")
    assert result.exit_code == 2
    assert "would both be written to x{}ply.html; use {name} or {index}" in result.stderr


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["--report", "cube.html", "--report", "{name}.html"],
         "cube.html would be both the table of --report and the page of cube.ply"),
        (["--report", "no/../t.html", "--report", "{name}.html", "--json", "./t.html"],
         "t.html would be both the records of --json and the table of --report"),
        (["--json", "out-cube.ply"],
         "out-cube.ply would be both the records of --json and the output of cube.ply"),
        (["--log", "all.html", "--report", "all.html", "--report", "{name}.html"],
         "--log all.html: the log would be written into all.html"),
        (["--log", "cube.html", "--report", "{name}.html"],
         "--log cube.html: the log would be written into cube.html"),
        (["--log", "r.jsonl", "--json", "r.jsonl"],
         "--log r.jsonl: the log would be written into r.jsonl"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("is_batch", [False, True])
def test_no_file_of_a_run_replaces_another(cube, words, line, is_batch):
    Path("no").mkdir()
    if is_batch:
        cube_file("two.ply")
    before = {path: path.read_bytes() for path in Path().glob("*.*")}
    meshes = [cube, "two.ply"] if is_batch else [cube]
    result = call("run", "-i", *meshes, "-o", "out-{name}.ply", *words)
    assert result.exit_code == 2
    assert line in result.stderr
    assert {path: path.read_bytes() for path in Path().glob("*.*")} == before


def test_table_from_python_does_not_replace_the_log(cube):
    with pytest.raises(WrongUse, match=r"t\.html would be both the log and the table"):
        next(batch.run(script_file(FLIP), cube, report="t.html", log="t.html"))
    assert not Path("t.html").exists()


@pytest.mark.usefixtures("workers_here")
def test_table_and_page_of_the_only_match(cube):
    report = ["--report", "all.html", "--report", "{name}.html"]
    result = call("flip", "c*.ply", "x_{name}.off", *report)
    assert (result.exit_code, result.stderr) == (0, "")
    table = Table("all.html")
    assert [row.split("|")[1] for row in table.rows] == ["Name", "cube.ply"]
    assert table.links == ["cube.html"]
    # Without a pattern for pages it is the page of the mesh, as with one name.
    assert call("flip", "c*.ply", "y_{name}.off", "--report", "one.html").exit_code == 0
    assert "<h1>cube.ply</h1>" in Path("one.html").read_text()


def test_page_may_be_replaced_with_force(cube):
    Path("page.html").write_text("mine")
    result = call("flip", cube, "out.ply", "--report", "page.html", "--force")
    assert result.exit_code == 0
    assert Path("page.html").read_text() != "mine"


def test_nothing_to_compare_is_said(cube):
    script = script_file(("Sphere", {}))
    result = call("run", script, "-o", "sphere.ply", "--report", "page.html")
    assert result.exit_code == 2
    assert "there is no input" in result.stderr
    dry = call("run", script_file(FLIP), "-i", cube, "--report", "page.html", "--dry-run")
    assert dry.exit_code == 0
    assert not Path("page.html").exists()


@pytest.mark.usefixtures("workers_here")
def test_page_names_the_layer_that_it_shows(cube):
    two = cube_file("two.ply")
    words = ["-i", cube, two, "--layers"]
    result = call("run", script_file(FLIP), *words, "-o", "a.ply", "--report", "a.html")
    assert result.exit_code == 0, result.stderr
    text = unescape(Path("a.html").read_text())
    assert "<h1>cube.ply, two.ply, layer 'cube.ply' of 2</h1>" in text
    assert "<p>This page shows layer 'cube.ply' of 2, which is the current one, and no" in text
    flatten = script_file(("Flatten Visible Layers", {}))
    result = call("run", flatten, *words, "-o", "b.ply", "--report", "b.html", "--json", "r.jsonl")
    assert result.exit_code == 0, result.stderr
    text = unescape(Path("b.html").read_text())
    assert "<p>This page compares two layers: layer 'cube.ply' of 2 before, and layer 'M" in text
    assert "of 1 after, which may be different meshes." in text
    # One layer needs no name.
    assert call("flip", cube, "c.ply", "--report", "c.html").exit_code == 0
    assert "layer" not in re.sub(
        r"<(script|style).*?</\1>", "", Path("c.html").read_text(), flags=16
    )


def test_page_says_that_a_matrix_is_applied(cube):
    scaled = ("Transform: Scale, Normalize", {"axisX": ("RichFloat", 3.0),
        "uniformFlag": ("RichBool", "false"), "Freeze": ("RichBool", "false")})  # fmt: skip
    result = call("run", script_file(scaled), "-i", cube, "-o", "a.ply", "--report", "a.html")
    assert result.exit_code == 0, result.stderr
    assert "<p>The layer has a matrix. Meshes and numbers" in Path("a.html").read_text()
    # Then the page's W is not the one that flips return, as the note says.
    result = call("run", script_file(scaled, FLIP), "-i", cube, "-o", "c.ply", "--report", "c.html")
    assert result.exit_code == 0, result.stderr
    text = Path("c.html").read_text()
    returned = re.search(r"willmore_after = ([\d.]+)", text)[1]
    shown = re.search(r"Willmore energy W<small>.*?</td><td>([\d.,]+)</td>", text)[1]
    assert float(returned) != pytest.approx(float(shown.replace(",", "")), rel=1e-3)
    assert "edge flips, and what they return, go by the coordinates without it" in text
    assert call("flip", cube, "b.ply", "--report", "b.html").exit_code == 0
    assert "has a matrix" not in Path("b.html").read_text()


def test_mesh_without_a_page_is_saved_all_the_same(cube):
    script = script_file(("Geometric Function", {"x": ("RichString", "0/0")}))
    result = call("run", script, "-i", cube, "-o", "out.ply", "--report", "page.html")
    assert result.exit_code == 0, result.stderr
    assert "Note: page.html is not written: vertex 0 has a coordinate that is" in result.stderr
    assert listing(".") == ["cube.ply", "out.ply", "script.mlx"]


@pytest.mark.usefixtures("workers_here")
def test_comparison_has_a_table_and_pages(cube):
    words = ["compare", cube, "--preset", "faithful", "--preset", "shape", "--no-peers"]
    result = call(*words, "--report", "rows.html", "--report", "{name}.html")
    assert (result.exit_code, result.stderr) == (0, "")
    table = Table("rows.html")
    names = ["Name", "initial", "preset faithful", "preset shape"]
    assert [row.split("|")[1] for row in table.rows] == names
    assert table.links == ["preset-faithful.html", "preset-shape.html"]
    assert table.pictures == 3
    page = Path("preset-shape.html").read_text()
    assert "<dt>Cuts, as in the table of compare</dt><dd>0 after, counted by MeshLab" in page
    again = call(*words, "--report", "rows.html")
    assert again.exit_code == 2
    assert "rows.html already exists" in again.stderr


@pytest.mark.parametrize(
    ("names", "use"),
    [
        (["preset-faithful.html", "{name}.html"], "the table and the page of preset faithful"),
        (["x{ext}.html"], "the page of preset faithful and the page of preset shape"),
    ],
)
def test_pages_of_a_comparison_do_not_replace_each_other(cube, names, use):
    words = ["compare", cube, "--preset", "faithful", "--preset", "shape", "--no-peers"]
    result = call(*words, *(word for name in names for word in ("--report", name)))
    assert result.exit_code == 2
    assert f"would be both {use}" in result.stderr
    assert listing(".") == ["cube.ply"]


@pytest.mark.usefixtures("workers_here")
def test_batch_from_python_has_them_too():
    cube_file("one.ply")
    cube_file("two.ply")
    given = {"script": script_file(FLIP), "inputs": ["one.ply", "two.ply"], "workers": 1}
    # Also where the caller takes no more.
    running = batch.run(**given, report="all.html")
    first = next(running)
    running.close()
    assert [row.split("|")[1] for row in Table("all.html").rows] == ["Name", first.input]
    with pytest.raises(WrongUse, match=r"all\.html already exists"):
        list(batch.run(**given, report="all.html"))
    assert [one.status for one in batch.run(**given, report="{name}.html")] == ["done", "done"]
    assert "<h1>two.ply</h1>" in Path("two.html").read_text()


def test_rounding_errors_that_a_step_returned_are_zero(cube):
    ms = loading.loaded(cube)
    returned = {"drop": -0.0, "energy": -8.88e-16, "flips": 6, "share": -0.25}
    job = Job((cube,), (), page=Path("page.html"))
    step = StepResult(1, "x", 0.5, returned)
    pages.write_page(job, pages.current_layer(ms), ms, (), [step], 0.5, ())
    text = Path("page.html").read_text()
    assert "drop = 0, energy = 0, flips = 6, share = -0.25" in text


def test_picture_of_many_faces_is_one_of_some(monkeypatch):
    vertices, faces = meshes.bumpy_sphere(2000)
    whole = pages.picture(Surface(vertices, faces))
    monkeypatch.setattr(pages, "MOST_FACES", 500)
    some = pages.picture(Surface(vertices, faces))
    assert some != whole
    assert len(some) > len(whole) / 4
    assert pages.picture(Surface(vertices * float("nan"), faces)) == b""


@pytest.mark.parametrize(
    ("place", "error", "reason"),
    [
        ("report.document.examined", MemoryError("no room"), "no room"),
        ("files.atomic_write", OSError(28, "No space left on device"), "No space left on device"),
        ("batch.pages.current_surface", MemoryError(), "MemoryError"),
    ],
)
def test_mesh_without_room_for_its_page_is_saved_all_the_same(
    cube, monkeypatch, place, error, reason
):
    job = Job((cube,), (Output("out.ply"),), page=Path("page.html"))
    surface = pages.current_surface(loading.loaded(cube))
    heard = []

    def fail_once_it_is_saved(*_given):
        if Path("out.ply").exists():
            raise error
        return surface

    monkeypatch.setattr(f"meshlab_willmore.{place}", fail_once_it_is_saved)
    done = work.do(work.Work(job, Recipe((), "none", is_pictured=True)), heard.append)
    assert [saved.file for saved in done.outputs] == ["out.ply"]
    assert work.Note(f"page.html is not written: {reason}") in heard
    assert listing(".") == ["cube.ply", "out.ply"]
    Path("out.ply").unlink()
    result = call("flip", cube, "out.ply", "--report", "page.html")
    assert result.exit_code == 0
    assert result.stderr == f"Note: page.html is not written: {reason}\n"
    assert listing(".") == ["cube.ply", "out.ply"]


def test_mesh_without_room_for_its_picture_is_saved_all_the_same(cube, monkeypatch):
    def fail(*_given):
        raise MemoryError

    monkeypatch.setattr("meshlab_willmore.thumbnail.picture", fail)
    heard = []
    job = Job((cube,), (Output("out.ply"),))
    done = work.do(work.Work(job, Recipe((), "none", is_pictured=True)), heard.append)
    assert [saved.file for saved in done.outputs] == ["out.ply"]
    notes = [one for one in heard if isinstance(one, work.Note)]
    assert notes == [work.Note("its picture is not written: MemoryError")]
