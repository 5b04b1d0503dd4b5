"""`compare`: its rows, table and messages."""

import json
from pathlib import Path

import pymeshlab
import pytest

import meshlab_willmore
from meshlab_willmore.cli import compare, compare_row
from meshlab_willmore.cli.progress import Status
from meshlab_willmore.compare import rows as rows_module
from meshlab_willmore.compare.quality import Quality
from meshlab_willmore.compare.reference import Sphere, deviation
from meshlab_willmore.measure import triangle_shapes
from meshlab_willmore.options import ENERGY, SEARCH
from tests import reference

from .conftest import call, cube_file, listing, loaded

PLANAR = rows_module.PEERS[1]
SOME = Quality(12, 45.757, 6.22709, 12.5664, 1e-4, 0.08151, 0.67097, 3, None, None)
CHOSEN = ("--search", "greedy", "--energy", "willmore")
NAMES = ["initial", "greedy, willmore", *(peer.name for peer in rows_module.PEERS)]


@pytest.fixture
def rows(monkeypatch):
    """The rows that were run, of which each is done; a test can say what else becomes of one."""
    ran = {}
    becomes = {}

    def run(task, row, say, _pages):
        say(compare_row.RUNNING)
        ran[row.name] = (task, row)
        done = compare_row.Outcome(0.125 if row.filter else None, SOME._asdict())
        return becomes.get(row.name, done)

    monkeypatch.setattr(compare_row, "run", run)
    ran["becomes"] = becomes
    return ran


def shown(result):
    """The lines of the table without its legend."""
    return result.stdout.split("\nflips:")[0].splitlines()


@pytest.mark.slow
def test_quality_are_those_of_direct_calls(cube, monkeypatch):
    monkeypatch.setattr(rows_module, "PEERS", (PLANAR,))
    result = call("compare", cube, *CHOSEN, "--reference", "sphere:1", "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    initial, own, planar = json.loads(result.stdout)
    vertices, before = loaded(cube)
    assert_row(initial, vertices, before, before)
    for row, filter_, given in (
        (own, "meshing_edge_flip_by_willmore_optimization", {"energy": "willmore"}),
        (planar, PLANAR.filter, PLANAR.given),
    ):
        ms = pymeshlab.MeshSet()
        ms.load_new_mesh(str(cube))
        ms.apply_filter(filter_, **given)
        assert_row(row, vertices, before, ms.current_mesh().face_matrix())
        assert 0.0 < row["seconds"] < 60.0
    assert own["flips"] > 5
    assert initial["seconds"] is None
    assert (own["search"], own["energy"], own["name"]) == ("greedy", "willmore", NAMES[1])
    assert (planar["search"], planar["name"], planar["given"]) == (None, PLANAR.name, PLANAR.given)
    assert listing() == ["cube.ply"]


def assert_row(row, vertices, before, faces):
    totals = meshlab_willmore.measures(vertices, faces)._asdict()
    del totals["gaussian_curvature"]
    assert {key: row[key] for key in totals} == pytest.approx(totals, rel=1e-12)
    shapes = triangle_shapes(vertices, faces)
    assert row["mean_shape"] == pytest.approx(shapes.mean())
    assert row["worst_shape"] == pytest.approx(sorted(shapes)[0], rel=0.5)
    assert row["flips"] == len(reference.edge_set(faces) - reference.edge_set(before))
    wanted = deviation(vertices, faces, Sphere(1.0))
    assert (row["normal_error"], row["distance"]) == pytest.approx(wanted)
    assert (row["self_intersecting"], row["timed_out"], row["error"]) == (0, False, None)


@pytest.fixture
def wide_window(monkeypatch):
    monkeypatch.setenv("COLUMNS", "140")


def test_table_in_80_columns_has_the_last_columns_below(cube, rows):
    lines = call("compare", cube, *CHOSEN, "--reference", "sphere:1").stdout.splitlines()
    assert max(map(len, lines)) <= 80
    heads = [line.split() for line in lines if line.startswith("   ")]
    assert heads == [
        ["flips", "W", "area", "|K|", "M", "worst"],
        ["mean", "cuts", "normal", "distance", "seconds"],
    ]
    for name in NAMES:
        first, second = (line.split()[-5:] for line in lines if line.startswith(f"{name} "))
        assert first == ["45.7570", "6.22709", "12.5664", "0.00010", "0.082"]
        assert "0.671" in second


def test_blocks_of_a_table_have_about_as_many_columns(cube, rows):
    lines = call("compare", cube, *CHOSEN).stdout.splitlines()
    heads = [line.split() for line in lines if line.startswith("   ")]
    assert heads == [["flips", "W", "area", "|K|", "M"], ["worst", "mean", "cuts", "seconds"]]


def test_every_column_is_shown_in_a_window_that_is_too_narrow(cube, rows, monkeypatch):
    monkeypatch.setenv("COLUMNS", "20")
    lines = call("compare", cube, *CHOSEN).stdout.splitlines()
    heads = [line.split() for line in lines if line.startswith("   ")]
    assert [len(head) for head in heads] == [1] * 9


@pytest.mark.usefixtures("wide_window")
def test_table_layout(cube, rows):
    rows["becomes"][NAMES[1]] = compare_row.Outcome(timed_out=True)
    rows["becomes"][NAMES[2]] = compare_row.Outcome(error="crashed (SIGSEGV)")
    result = call("compare", cube, *CHOSEN, "--timeout", "1.5")
    assert shown(result)[:6] == [
        "                             flips        W     area      |K|        M  worst   mean"
        "  cuts  seconds",
        "-" * 99,
        "initial                         12  45.7570  6.22709  12.5664  0.00010  0.082  0.671"
        "     3",
        "greedy, willmore" + " " * 78 + "> 1.5",
        "MeshLab planar, 1 deg" + " " * 72 + "failed",
        "MeshLab planar, 60 deg          12  45.7570  6.22709  12.5664  0.00010  0.082  0.671"
        "     3     0.12",
    ]
    assert "seconds: the filter alone" in result.stdout
    assert "normal:" not in result.stdout
    assert result.stderr == "Error: MeshLab planar, 1 deg: crashed (SIGSEGV)\n"
    assert result.exit_code == 1


def test_a_filter_that_is_too_slow_is_no_failure(cube, rows):
    rows["becomes"][NAMES[1]] = compare_row.Outcome(timed_out=True)
    result = call("compare", cube, *CHOSEN, "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    row = json.loads(result.stdout)[1]
    assert row["timed_out"]
    assert {row[key] for key in (*Quality._fields, "seconds", "error")} == {None}


@pytest.mark.usefixtures("wide_window")
def test_reference_adds_two_columns(cube, rows):
    quality = SOME._replace(normal_error=9.634, distance=0.0156789)._asdict()
    rows["becomes"]["initial"] = compare_row.Outcome(None, quality)
    nan = SOME._replace(normal_error=1.0, distance=float("nan"))._asdict()
    rows["becomes"][NAMES[1]] = compare_row.Outcome(2.0, nan)
    arguments = ("compare", cube, *CHOSEN, "--reference", "torus:3,1")
    result = call(*arguments)
    header, _, initial, own, *_ = shown(result)
    assert header.split()[-4:] == ["cuts", "normal", "distance", "seconds"]
    assert initial.split()[-3:] == ["3", "9.63", "0.0157"]
    assert own.split()[-3:] == ["3", "1.00", "2.00"]
    assert "normal: mean angle" in result.stdout
    (task, _) = rows["initial"]
    assert task == compare_row.Comparison("cube.ply", "torus:3,1", 60.0)
    assert json.loads(call(*arguments, "--json").stdout)[1]["distance"] is None


@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        (
            [],
            [
                "preset faithful",
                "preset smooth",
                "preset shape",
                "greedy, virtual willmore",
                "greedy, willmore",
            ],
        ),
        (["--preset", "shape"], ["preset shape"]),
        (["--preset", "shape", "--energy", "willmore"], ["preset shape", "greedy, willmore"]),
        (["--energy", "willmore"], ["greedy, willmore"]),
        (["--search", "greedy", "--energy", "willmore"], ["greedy, willmore"]),
        (
            ["--search", "variable-depth", "--energy", "mean-curvature"],
            ["variable depth, mean curvature"],
        ),
        (
            ["--energy", "willmore", "--energy", "virtual willmore"],
            ["greedy, willmore", "greedy, virtual willmore"],
        ),
    ],
)
@pytest.mark.usefixtures("wide_window")
def test_rows_can_be_chosen(cube, rows, monkeypatch, arguments, wanted):
    fewer = SEARCH._replace(choices=("greedy",)), ENERGY._replace(choices=ENERGY.choices[:2])
    monkeypatch.setattr(compare, "_ROWS", fewer)
    lines = shown(call("compare", cube, "--no-peers", *arguments))[2:-1]
    assert [line.split("  ")[0] for line in lines] == ["initial", *wanted]
    assert call("compare", cube, *arguments).stdout.count("MeshLab ") == len(rows_module.PEERS)


def test_parameters_of_the_filter_are_options_for_our_rows(cube, rows):
    call("compare", cube, "--featuredeg", "30", "--no-monotone", *CHOSEN)
    given = rows[NAMES[1]][1].given
    assert given == {
        "search": "greedy",
        "energy": "willmore",
        "featuredeg": 30.0,
        "monotone": False,
        "selection": False,
        "allowloss": True,
    }
    assert rows[PLANAR.name][1] == PLANAR


def test_parameters_of_the_filter_are_those_of_all_its_rows(cube, rows):
    call("compare", cube, *CHOSEN, "--seed", "9", "--no-monotone")
    assert rows[NAMES[1]][1].given["seed"] == 9
    assert rows[NAMES[1]][1].given["monotone"] is False


def test_help_omits_parameters_that_are_the_same_for_all_rows():
    text = " ".join(call("compare", "--help").stdout.split())
    assert "--selection" not in text
    assert "--allowloss" not in text
    assert "Only rows of this energy: virtual-willmore, willmore, " in text
    assert "meshlab-willmore compare torus.ply --reference torus:3,1" in text


def test_debug_shows_the_traceback_of_a_row(cube, rows):
    rows["becomes"][NAMES[1]] = compare_row.Outcome(
        error="no luck", trace="Traceback of bad luck\n"
    )
    arguments = ("compare", cube, *CHOSEN)
    assert "Traceback" not in call(*arguments).stderr
    assert "Traceback of bad luck\n\nError: " in call(*arguments, "--debug").stderr


def test_progress_shows_the_phase_of_a_row():
    status = Status("cube.ply", 2, lambda: 0.0)
    status.next("initial: reading")
    status.next("greedy, area: reading")
    compare._show_phase(status, "greedy, area", compare_row.RUNNING)
    assert status.line(80) == "cube.ply  [########--------]  50%  greedy, area: running, 0 s"


def test_initial_mesh_that_cannot_be_measured_is_an_error(cube, rows):
    rows["becomes"]["initial"] = compare_row.Outcome(error="there is something wrong")
    result = call("compare", cube, "--json")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == "Error: cube.ply: there is something wrong\n"
    assert set(rows) == {"becomes", "initial"}


@pytest.mark.usefixtures("workers_here")
@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["points.xyz"], "Error: points.xyz: the mesh has no faces, it is a point cloud\n"),
        (["bad.ply"], "Error: cannot read bad.ply: Header not found\n"),
        (
            ["cube.ply", "--reference", "points.xyz"],
            "Error: points.xyz can't be the reference: it is a point cloud, without faces\n",
        ),
    ],
)
@pytest.mark.slow
def test_failures_are_reported_in_one_line(cube, arguments, line):
    Path("bad.ply").write_text("no mesh")
    Path("points.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n")
    result = call("compare", *arguments)
    assert (result.exit_code, result.stdout, result.stderr) == (1, "", line)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ([], "Missing argument 'IN'."),
        (["cub.ply"], "there is no file cub.ply; there is cube.ply"),
        (["*.ply"], "*.ply matches 2 files; compare takes one"),
        (["cube.ply", "--energy", "x"], "Invalid value for '--energy': 'x' is not one"),
        (["cube.ply", "--search", "x"], "Invalid value for '--search': 'x' is not "),
        (["cube.ply", "--timeout", "0"], "Invalid value for '--timeout': 0.0 is not in the range"),
        (["cube.ply", "--foldangle", "181"], "--foldangle: foldangle must lie in 0"),
        (["cube.ply", "--virtualpoint", "x"], "--virtualpoint: unknown virtualpoint 'x'; choose "),
        (["cube.ply", "--seed", "99999999999"], "--seed: Parameter seed: 99999999999 is out of "),
        (["cube.ply", "--timeout", "inf"], "--timeout: inf is no number of seconds that can be"),
        (["cube.ply", "--timeout", "1e10"], "--timeout: 1e+10 is no number of seconds"),
        (["cube.ply", "--timeout", "nan"], "--timeout: nan is no number of seconds"),
        (["cube.ply", "--reference", "no.ply"], "--reference: there is no file no.ply"),
        (["cube.ply", "--reference", "torus"], "--reference: there is no file torus"),
        (["cube.ply", "--reference", "torus:3"], "--reference torus:3: it can be sphere, sphere:2"),
        (["cube.ply", "--reference", "torus:3,1,1"], "--reference torus:3,1,1: it can be sphere,"),
        (["cube.ply", "--reference", "sphere:1,2"], "--reference sphere:1,2: it can be sphere, "),
        (["cube.ply", "--reference", "sphere:-1"], "--reference sphere:-1: '-1' is no radius; it"),
        (["cube.ply", "--reference", "torus:3,x"], "--reference torus:3,x: 'x' is no radius; it "),
        (["cube.ply", "--reference", "torus:nan,1"], "--reference torus:nan,1: 'nan' is no radius"),
        (["cube.ply", "--reference", "torus:3,,1"], "--reference torus:3,,1: '' is no radius"),
    ],
)
def test_wrong_usage(cube, rows, arguments, line):
    cube_file("other.ply")
    result = call("compare", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"Error: {line}")
    assert result.stderr.count("\n") == 1
