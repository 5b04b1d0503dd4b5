"""Completion in shells: what is offered, and how bash, zsh and fish put it into the line."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.shell_completion import ShellComplete

from meshlab_willmore.cli import completion, main
from meshlab_willmore.options import SEARCHES

from .conftest import call, cube_file

FLIP = "meshing_edge_flip_by_willmore_optimization"


def offered(*words):
    """Type and value of what is offered for the last word."""
    *args, incomplete = words
    shell = ShellComplete(main, {}, "meshlab-willmore", "_MESHLAB_WILLMORE_COMPLETE")
    return [(item.type, item.value) for item in shell.get_completions(args, incomplete)]


def names(*words):
    return [value for kind, value in offered(*words) if kind == "plain"]


def test_commands_and_options_are_offered():
    assert set(names("")) == set(main.commands)
    assert names("fli") == ["flip"]
    assert "--search" in names("flip", "--")
    assert names("run", "--wri") == ["--write-project"]


def test_choices_need_no_quotes():
    assert names("flip", "--search", "v") == ["variable-depth"]
    assert names("flip", "--energy", "mean") == ["mean-curvature"]
    assert names("flip", "a.ply", "b.ply", "--preset=s") == ["smooth", "shape"]
    assert names("flip", "--energy", "mean c") == ["mean curvature"]
    assert "vn" in names("run", "-i", "a.ply", "-o", "b.ply", "-m", "v")


def test_filters_are_offered_by_both_names():
    assert FLIP in names("filters", "")
    assert names("filters", "meshing_edge_flip_by_w") == [FLIP]
    assert "Willmore flipping optimization" in names("filters", "Will")
    assert names("filters", "Select 'p") == ["Select 'problematic' faces"]
    assert names("filters", "qq") == []


@pytest.mark.parametrize(
    "line",
    [
        ["flip", "a"],
        ["flip", "a.ply", "b"],
        ["measure", ""],
        ["compare", ""],
        ["compare", "a.ply", "--reference", ""],
        ["lint", ""],
        ["convert", "a"],
        ["convert", "a.mlx", ""],
        ["summary", ""],
        ["run", "-i", ""],
        ["run", "-i", "a.ply", "b"],
        ["run", "-o", ""],
        ["run", "-p", ""],
        ["run", "a.mlx", "-w", ""],
        ["run", "a.mlx", "--log", ""],
        ["run", "a.mlx", "--report", ""],
        ["run", "a.mlx", "--json", ""],
        ["measure", "a.ply", "--json", ""],
    ],
)
def test_files_are_left_to_the_shell(line):
    assert offered(*line) == [("file", line[-1])]


@pytest.mark.parametrize("line", [["scripts", "--copy", ""], ["demo", "-o", "a"]])
def test_folders_are_left_to_the_shell(line):
    assert offered(*line) == [("dir", line[-1])]


def test_scripts_are_files_or_those_of_the_package():
    assert names("scripts", "f") == [
        "faithful.mlx",
        "flip.mlx",
        "flip_smooth_measure.mlx",
        "flip_technical_part.mlx",
    ]
    assert "clean_and_flip.mlx" in names("run", "c")
    assert offered("run", "my") == [("file", "my")]
    cube_file("cube.ply")
    assert offered("run", "c") == [("file", "c")]


@pytest.mark.parametrize("line", [["run", "-o", "-l", "x", ""], ["-i", ""], ["run", "-d", ""]])
def test_a_line_that_is_wrong_so_far_is_no_error(line):
    offered(*line)


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_script_of_each_shell(shell):
    result = call("completion", shell)
    assert result.exit_code == 0
    assert f"_MESHLAB_WILLMORE_COMPLETE={shell}_complete" in result.stdout
    if shutil.which(shell):
        check = [shell, "-n"] if shell != "fish" else ["fish", "--no-execute"]
        subprocess.run(check, input=result.stdout, text=True, check=True)


@pytest.fixture
def program(tmp_path, monkeypatch):
    """The command `meshlab-willmore` in the PATH, where it might not be installed."""
    folder = tmp_path / "bin"
    folder.mkdir()
    path = folder / "meshlab-willmore"
    path.write_text(f'#!/bin/sh\nexec {sys.executable} -m meshlab_willmore "$@"\n')
    path.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:/usr/bin:/bin")
    monkeypatch.setenv("PYTHONPATH", str(Path(completion.__file__).parents[2]))
    (tmp_path / "script").write_text(call("completion", "bash").stdout)
    return path


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("bash"), reason="there is no bash")
@pytest.mark.parametrize(
    ("words", "replies"),
    [
        (["filters", "Willmore\\ f"], ["Willmore flipping optimization"]),
        (["filters", "'Willmore f"], ["Willmore flipping optimization"]),
        (["filters", "Transform:\\ Translate,"], ["Transform: Translate, Center, set Origin"]),
        (["flip", "--search", "va"], ["variable-depth"]),
        (["flip", "--search", "=", "va"], ["variable-depth"]),
        (["flip", "--search", "="], [name.replace(" ", "-") for name in SEARCHES]),
        (["flip", "--search", "=", "greedy", "--energy", "=", "mean"], ["mean-curvature"]),
        (["flip", "--energy", '"mean c'], ["mean curvature"]),
    ],
)
def test_bash_gets_whole_values(program, words, replies):
    line = [f"COMP_WORDS=(meshlab-willmore {' '.join(map(quoted, words))})"]
    text = "\n".join(
        [
            "compopt() { echo option $2; }",
            "source ./script",
            *line,
            f"COMP_CWORD={len(words)}",
            "_meshlab_willmore_completion meshlab-willmore",
            'printf "%s\\n" "${COMPREPLY[@]}"',
        ]
    )
    done = subprocess.run(["bash", "-c", text], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["option filenames", *replies]


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("zsh"), reason="there is no zsh")
@pytest.mark.usefixtures("program")
def test_zsh_keeps_the_option_before_its_value():
    """Completion functions run in an editor only: these take the place of its commands."""
    Path("zsh-script").write_text(call("completion", "zsh").stdout)
    lines = [
        "compdef() { }",
        "compset() { IPREFIX=${words[CURRENT]%%=*}=; }",
        'compadd() { print -r -- "$@" "$completions"; }',
        "source ./zsh-script",
        "words=(meshlab-willmore flip --energy=mea); CURRENT=3",
        "_meshlab_willmore_completion",
    ]
    done = subprocess.run(
        ["zsh", "-f", "-c", "\n".join(lines)], capture_output=True, text=True, check=True
    )
    assert done.stdout == "-U -i --energy= -V unsorted -a completions mean-curvature\n"


def quoted(word):
    """A word of a line as bash keeps it for a completion, with its quotes."""
    return "'" + word.replace("'", "'\\''") + "'"
