"""`scripts`: the filter scripts that come with the package; `run` finds them by their names."""

from pathlib import Path

import pytest

from meshlab_willmore.cli import scripts

from .conftest import TAUBIN, call, listing, same_mesh, script_file

FOLDER = Path(__file__).parents[2] / "filter_scripts"
NAMES = sorted(path.name for path in FOLDER.glob("*.mlx"))


def test_list_says_what_each_script_is_for():
    result = call("scripts")
    assert (result.exit_code, result.stderr) == (0, "")
    lines = result.stdout.splitlines()
    assert [line for line in lines if line[0] != " "] == NAMES
    assert max(map(len, lines)) <= 80
    assert "\n    For scans: clean the mesh, then flip edges. " in result.stdout


@pytest.mark.parametrize("name", ["flip.mlx", "flip"])
def test_script_is_printed_as_it_is(name):
    assert call("scripts", name).stdout == (FOLDER / "flip.mlx").read_text(encoding="utf-8")


def test_scripts_are_copied_all_or_some():
    result = call("scripts", "--copy", "new/folder")
    assert listing("new/folder") == NAMES
    assert result.stdout.splitlines() == [str(Path("new/folder", name)) for name in NAMES]
    call("scripts", "flip.mlx", "--copy", ".")
    assert Path("flip.mlx").read_bytes() == (FOLDER / "flip.mlx").read_bytes()
    assert listing() == ["flip.mlx", "new"]


def test_copies_replace_nothing_without_force():
    Path("faithful.mlx").write_text("mine")
    result = call("scripts", "--copy", ".")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == "Error: faithful.mlx already exists; use --force to overwrite\n"
    assert listing() == ["faithful.mlx"]
    assert call("scripts", "--copy", ".", "--force").exit_code == 0
    assert listing() == NAMES
    assert Path("faithful.mlx").read_bytes() == (FOLDER / "faithful.mlx").read_bytes()


def test_unknown_name_lists_those_that_there_are():
    result = call("scripts", "flop.mlx")
    assert result.exit_code == 2
    assert result.stderr.startswith("Error: no script 'flop.mlx' comes with this package; there ")
    assert all(name in result.stderr for name in NAMES)


def test_run_finds_a_shipped_script_by_its_name(cube):
    result = call("run", "flip.mlx", "-i", cube, "-o", "out.ply")
    assert result.exit_code == 0
    assert result.stderr == "Note: flip.mlx is the script that comes with meshlab_willmore\n"
    call("flip", cube, "expected.ply")
    assert same_mesh("out.ply", "expected.ply")
    assert not same_mesh("out.ply", cube)


def test_a_file_of_that_name_comes_first(cube):
    script_file(TAUBIN, path="flip.mlx")
    result = call("run", "flip.mlx", "-i", cube)
    assert (result.exit_code, result.stderr) == (0, "")
    assert "1 step" in result.stdout
    Path("flip.mlx").unlink()
    Path("flip.mlx").symlink_to("nowhere.mlx")
    assert "no such file" in call("run", "flip.mlx", "-i", cube).stderr


@pytest.mark.parametrize("arguments", [["flip"], ["-s", "flip"]])
def test_the_ending_may_be_left_out(cube, arguments):
    result = call("run", *arguments, "-i", cube)
    assert result.exit_code == 0
    assert "Note: flip.mlx is the script that comes with meshlab_willmore\n" in result.stderr
    assert ": 1 step, " in result.stdout


def test_a_file_whose_ending_is_left_out_is_named(cube):
    script_file(TAUBIN, path="flip.mlx")
    result = call("run", "flip", "-i", cube)
    assert result.exit_code == 2
    assert result.stderr == "Error: there is no filter script flip; there is flip.mlx\n"


@pytest.mark.parametrize("name", ["./flip.mlx", "scripts/flip.mlx", "flop.mlx"])
def test_other_names_are_files_only(cube, name):
    result = call("run", name, "-i", cube)
    assert result.exit_code == 2
    assert result.stderr.startswith(f"Error: there is no filter script {name}; ")
    assert "'meshlab-willmore scripts' lists" in result.stderr


def test_lint_and_convert_find_them_too():
    assert call("lint", "flip.mlx").stdout == "flip.mlx: ok, 1 step\n"
    assert call("convert", "flip.mlx", "mine.mlx").exit_code == 0
    assert call("lint", "mine.mlx").exit_code == 0


@pytest.mark.usefixtures("cube")
@pytest.mark.parametrize("command", [["convert", "cube.ply", "a.obj"], ["run", "cube.ply"]])
def test_a_mesh_in_place_of_a_script_points_to_conversion(command):
    result = call(*command)
    assert result.exit_code == 2
    assert result.stderr == (
        "Error: cube.ply is a mesh by its name, no filter script; to convert meshes, write: "
        "meshlab-willmore run -i cube.ply -o OUT\n"
    )


def test_installed_scripts_are_inside_the_package(monkeypatch, tmp_path):
    package = tmp_path / "site-packages" / "meshlab_willmore"
    (package / "filter_scripts").mkdir(parents=True)
    (package / "filter_scripts" / "only.mlx").touch()
    (package.parent / "filter_scripts").mkdir()
    (package.parent / "filter_scripts" / "not_ours.mlx").touch()
    monkeypatch.setattr(scripts, "__file__", str(package / "cli" / "scripts.py"))
    assert list(scripts.shipped_scripts()) == ["only.mlx"]
